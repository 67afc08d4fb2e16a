#include "guard.h"

#include <cstdlib>
#include <new>
#include <string>

#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"

namespace carom::c {
namespace {

thread_local std::string last_error;

void remember(const char* text) noexcept {
    try {
        last_error = text;
    } catch (...) {
        last_error.clear();  // no memory for the message: only the status is returned
    }
}

}  // namespace

carom_status keep_error() noexcept {
    try {
        throw;
    } catch (const BadArgument& error) {
        remember(error.what());
        return CAROM_BAD_ARGUMENT;
    } catch (const SceneError& error) {
        remember(error.what());
        return CAROM_BAD_SCENE;
    } catch (const SimulationError& error) {
        remember(error.what());
        return CAROM_FAILED;
    } catch (const std::bad_alloc&) {
        remember("out of memory");
        return CAROM_NO_MEMORY;
    } catch (const std::exception& error) {
        remember(error.what());
        return CAROM_INTERNAL;
    } catch (...) {
        remember("unknown error");
        return CAROM_INTERNAL;
    }
}

void need(std::initializer_list<const void*> pointers) {
    for (const void* pointer : pointers)
        if (pointer == nullptr) throw BadArgument("a required pointer is NULL");
}

void check_index(std::size_t index, std::size_t count, const char* what) {
    if (index < count) return;
    throw BadArgument(std::string(what) + " " + std::to_string(index) + " is out of range; there are " +
                      std::to_string(count));
}

kernel::Isa chosen_isa() {
    const auto [isa, problem] = kernel::isa_from_environment();
    if (*problem != '\0') throw BadArgument(problem);
    return isa;
}

}  // namespace carom::c

const char* carom_last_error(void) {
    return carom::c::last_error.c_str();
}

const char* carom_version(void) {
    return CAROM_VERSION;
}
