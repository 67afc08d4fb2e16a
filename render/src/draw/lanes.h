// Four pixels at a time: vectors of floats, and the equivalent of GLSL's vec3, for painting on pictures in
// memory.
//
// The vector extensions of gcc and clang give + - * / and comparisons on every processor; a comparison sets
// all bits where it holds. Every lane is computed alike, so a pixel has the same bits whichever pixels are
// painted with it.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace carom::render::lanes {

inline constexpr int kLanes = 4;
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

inline Floats all(float value) {
    return Floats{value, value, value, value};
}

inline Floats choose(Ints where, Floats yes, Floats no) {
    return where ? yes : no;
}

#ifdef __SSE2__
inline Floats min(Floats a, Floats b) {
    return _mm_min_ps(a, b);
}
inline Floats max(Floats a, Floats b) {
    return _mm_max_ps(a, b);
}
inline Floats sqrt(Floats a) {
    return _mm_sqrt_ps(a);
}
inline bool any(Ints where) {
    return _mm_movemask_epi8(reinterpret_cast<__m128i>(where)) != 0;
}
#else
inline Floats min(Floats a, Floats b) {
    return choose(a < b, a, b);
}
inline Floats max(Floats a, Floats b) {
    return choose(a > b, a, b);
}
inline Floats sqrt(Floats a) {
    for (int i = 0; i < kLanes; ++i) a[i] = std::sqrt(a[i]);
    return a;
}
inline bool any(Ints where) {
    return (where[0] | where[1] | where[2] | where[3]) != 0;
}
#endif

inline Floats min(Floats a, float b) {
    return min(a, all(b));
}
inline Floats max(Floats a, float b) {
    return max(a, all(b));
}
inline Floats clamp(Floats a, float low, float high) {
    return min(max(a, low), high);
}
inline Floats abs(Floats a) {
    return max(a, -a);
}
inline Floats inversesqrt(Floats a) {
    return 1.0F / sqrt(a);
}
inline Floats mix(Floats a, Floats b, Floats t) {
    return a + (b - a) * t;
}
inline Floats smoothstep(float low, float high, Floats a) {
    const Floats t = clamp((a - low) * (1.0F / (high - low)), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

struct Vec {
    Floats x, y, z;
};

inline Vec vec(const float (&v)[3]) {
    return {all(v[0]), all(v[1]), all(v[2])};
}
inline Vec operator+(const Vec& a, const Vec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(const Vec& a, const Vec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(const Vec& a, Floats f) {
    return {a.x * f, a.y * f, a.z * f};
}
inline Vec operator*(const Vec& a, const Vec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Floats dot(const Vec& a, const Vec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross3(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec mix(const Vec& a, const Vec& b, Floats t) {
    return a + (b - a) * t;
}

/// Radiance to screen values, as in shaders/common.glsl.
inline Floats to_screen(Floats c) {
    const Floats over = 1.0F + max(c - 0.5F, all(0.0F));
    return sqrt(clamp(c, 0.0F, 0.5F) + 0.5F - 0.5F / (over * over));
}

/// Values of four neighbours, four bytes each; fewer at the end of a row.
template <class Four>
Four load(const void* from, int count) {
    static_assert(sizeof(Four) == 16);
    Four four{};
    if (count == kLanes)
        std::memcpy(&four, from, sizeof four);
    else
        std::memcpy(&four, from, static_cast<std::size_t>(count) * 4);
    return four;
}

/// One byte of each of four pixels: 0..255.
inline Floats channel(Ints pixels, int shift) {
    return __builtin_convertvector((pixels >> shift) & 255, Floats);
}

/// The inverse, rounded; the values must be within 0..255.
inline Ints pixels_of(Floats r, Floats g, Floats b, Floats a) {
    const auto rounded = [](Floats value) { return __builtin_convertvector(value + 0.5F, Ints); };
    return rounded(r) | rounded(g) << 8 | rounded(b) << 16 | rounded(a) << 24;
}

inline void store(std::uint8_t* to, Ints pixels, int count) {
    if (count == kLanes)
        std::memcpy(to, &pixels, sizeof pixels);
    else
        std::memcpy(to, &pixels, static_cast<std::size_t>(count) * 4);
}

}  // namespace carom::render::lanes
