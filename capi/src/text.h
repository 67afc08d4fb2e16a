// Texts that the C interface hands to its caller.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "guard.h"

namespace carom::c {

/// Writes up to `size` bytes of what `make` returns, including the final 0. @return the length without it, or
/// (size_t)-1 on failure
template <class Make>
std::size_t written(char* text, std::size_t size, Make&& make) {
    std::size_t length = static_cast<std::size_t>(-1);
    guarded([&] {
        if (size > 0) need({text});
        const std::string whole = make();
        if (size > 0) {
            const std::size_t part = std::min(whole.size(), size - 1);
            std::memcpy(text, whole.data(), part);
            text[part] = '\0';
        }
        length = whole.size();
    });
    return length;
}

}  // namespace carom::c
