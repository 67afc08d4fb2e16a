// Memory, results and errors.
#include <cstdlib>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "carom/version.h"
#include "web.h"

namespace carom::web {
namespace {

struct Result {
    void* handle = nullptr;
    std::string text;
};

Result& result() {
    static Result of_last_call;
    return of_last_call;
}

Json error_json(const char* kind, const std::string& message) {
    return {{"kind", kind}, {"message", message}, {"file", ""}, {"line", 0}, {"column", 0}};
}

/// The exception that is being handled.
Json error_json() {
    try {
        throw;
    } catch (const SceneError& error) {
        return {{"kind", "scene"},
                {"message", error.message()},
                {"file", error.file()},
                {"line", error.where().line},
                {"column", error.where().column}};
    } catch (const SimulationError& error) {
        return error_json("simulation", error.what());
    } catch (const TooLong& error) {
        return error_json("limit", error.what());
    } catch (const std::bad_alloc&) {
        return error_json("memory", "out of memory");
    } catch (const BadArgument& error) {
        return error_json("argument", error.what());
    } catch (const std::exception& error) {
        // Errors of the libraries: std::invalid_argument, VariationError, UsageError.
        return error_json("argument", error.what());
    }
}

}  // namespace

void give(void* handle, std::string text) {
    result() = {handle, std::move(text)};
}

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

int give_error() noexcept {
    try {
        give(nullptr, dumped(error_json()));
    } catch (...) {
        result().handle = nullptr;
        result().text.clear();
    }
    return 1;
}

CAROM_WEB void* carom_allocate(std::size_t size) {
    return std::malloc(size);
}
CAROM_WEB void carom_release(void* memory) {
    std::free(memory);
}
CAROM_WEB void* carom_handle() {
    return result().handle;
}
CAROM_WEB const char* carom_text() {
    return result().text.data();
}
CAROM_WEB std::size_t carom_text_size() {
    return result().text.size();
}
CAROM_WEB int carom_version() {
    return guarded([] { give(nullptr, CAROM_VERSION); });
}

}  // namespace carom::web
