// Converts exceptions to a status and a message.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <stdexcept>

#include "carom/carom.h"
#include "carom/kernel/isa.h"

namespace carom::c {

/// Becomes CAROM_BAD_ARGUMENT; what() names the invalid argument and the reason. The library throws it, too.
using BadArgument = std::invalid_argument;

/// Stores the message of the exception that is being handled. @returns the corresponding status
carom_status keep_error() noexcept;

/// Calls `work`, which may throw.
template <class Work>
carom_status guarded(Work&& work) noexcept {
    try {
        work();
        return CAROM_OK;
    } catch (...) {
        return keep_error();
    }
}

/// @throws BadArgument if one of them is null
void need(std::initializer_list<const void*> pointers);

/// @throws BadArgument if there is no such index
void check_index(std::size_t index, std::size_t count, const char* what);

/// Returns a new object to the caller, or NULL on failure.
template <class T, class Make>
carom_status made(T** out, Make&& make) {
    return guarded([&] {
        need({out});
        *out = nullptr;
        auto object = std::make_unique<T>();
        make(*object);
        *out = object.release();
    });
}

/// The instruction set in CAROM_ISA, else the fastest one for every kernel. @throws BadArgument if CAROM_ISA
/// cannot be used here
kernel::Isa chosen_isa();

}  // namespace carom::c
