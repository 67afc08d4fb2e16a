// Parts of C++20 that the C++ library of emscripten 3.1.6 (libc++ 13) lacks. The preset wasm includes this
// header before everything else.
#pragma once

#if defined(__cplusplus) && defined(__EMSCRIPTEN__)
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#ifdef __EMSCRIPTEN_PTHREADS__
// Where a landing pad and the library's search for a handler meet. clang 14 assumes that all threads share
// it, but the library has one for each thread: without this no exception is caught.
extern "C" {
struct carom_landing_pad {
    int index;
    const void* table;
    int selector;
};
extern __thread carom_landing_pad __wasm_lpad_context __attribute__((tls_model("local-exec")));
}
__attribute__((used)) static carom_landing_pad* carom_landing_pad_of_thread() {
    return &__wasm_lpad_context;
}
#endif

#if _LIBCPP_VERSION < 14000
namespace std {
/// The shortest text that reads back to the same bits; of two equally long ones the one without an exponent.
inline to_chars_result to_chars(char* first, char* last, double value) {
    constexpr int kMostDecimals = 16;
    char text[32], plain[32];
    int size = 0, decimals = -1;
    do {
        size = snprintf(text, sizeof text, "%.*e", ++decimals, value);
    } while (decimals < kMostDecimals && strtod(text, nullptr) != value);
    if (const char* exponent = strchr(text, 'e')) {
        const int left = decimals - atoi(exponent + 1);
        const int plain_size = snprintf(plain, sizeof plain, "%.*f", left > 0 ? left : 0, value);
        if (plain_size <= size) memcpy(text, plain, static_cast<size_t>(size = plain_size));
    }
    if (last - first < size) return {last, errc::value_too_large};
    memcpy(first, text, static_cast<size_t>(size));
    return {first + size, errc()};
}
}  // namespace std
_LIBCPP_BEGIN_NAMESPACE_STD
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}
_LIBCPP_END_NAMESPACE_STD
#endif

#if _LIBCPP_VERSION < 200000
namespace std {
// By strtod, which musl rounds correctly. Callers have checked that the text is a number of their format.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
    constexpr size_t kLongest = 1100;  // more digits than any double needs
    char buffer[kLongest + 1];
    const auto size = static_cast<size_t>(last - first);
    if (size == 0 || size > kLongest || *first == '+' || *first == ' ')
        return {first, errc::invalid_argument};
    memcpy(buffer, first, size);
    buffer[size] = '\0';
    char* end = nullptr;
    const double x = strtod(buffer, &end);
    if (end == buffer) return {first, errc::invalid_argument};
    value = x;
    return {first + (end - buffer), errc()};
}
}  // namespace std
#endif
#endif
