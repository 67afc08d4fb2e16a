// Functions that JavaScript calls (web/npm/core.js). They return 0, or 1 after an error. Their results are a
// handle and a text, which stay valid until the next call: carom_handle(), carom_text(), carom_text_size().
// After an error the text is JSON: {kind, message, file, line, column}.
//
// Texts come as a pointer and a size in bytes, in UTF-8. Handles are pointers, which carom_free_*() free.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"
#include "carom/games/rules.h"

#define CAROM_WEB extern "C" __attribute__((used, visibility("default")))

namespace carom::web {

/// A scene and its source. Later changes of numbers are kept separately, because writing them into the source
/// takes longer than a shot.
struct WebScene {
    Scene scene;
    std::string source;
    std::vector<NewValue> changed;
};

struct WebShot {
    Scene scene;
    Record record;
    Outcome outcome;
};

struct WebVerdict {
    games::Verdict verdict;
};

/// An invalid argument; the kind of the error is "argument".
class BadArgument : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The shot took longer than the caller allows; the kind of the error is "limit".
class TooLong : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

using Json = nlohmann::ordered_json;

void give(void* handle, std::string text);
/// Bytes that are not UTF-8 become the replacement character.
std::string dumped(const Json& json);
/// Describes the exception that is being handled. @returns 1
int give_error() noexcept;

/// Calls `work`, which may throw and returns its results through give().
template <class Work>
int guarded(Work&& work) noexcept {
    try {
        work();
        return 0;
    } catch (...) {
        return give_error();
    }
}

}  // namespace carom::web
