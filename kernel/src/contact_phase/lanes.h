// Four doubles for the contact phase: the vector of the kernel by tolerance where registers hold four, a pair
// of vectors of two where they hold two (compilers take such vectors of four apart lane by lane in shuffles
// and comparisons). Same bits either way.
#pragma once

#include "simd.h"

namespace carom::kernel {
namespace {

#if defined(__AVX__)

typedef V4 Four;

CAROM_INLINE Four four(double a, double b, double c, double d) {
    return Four{a, b, c, d};
}

CAROM_INLINE Four every(double x) {
    return four(x, x, x, x);
}

CAROM_INLINE Four load(const double* from) {
    return load4(from);
}

CAROM_INLINE void store(double* to, Four v) {
    store4(to, v);
}

// (a0 - b0, a1 + b1, a2 - b2, a3 + b3)
CAROM_INLINE Four subtract_add(Four a, Four b) {
    return (Four)_mm256_addsub_pd((__m256d)a, (__m256d)b);
}

// Bits of the lanes in which a < b.
CAROM_INLINE int less(Four a, Four b) {
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}

// In each lane x where a < b, else y.
CAROM_INLINE Four where_less(Four a, Four b, Four x, Four y) {
    return a < b ? x : y;
}

// Rows to columns; its own inverse.
CAROM_INLINE void transpose(Four& a, Four& b, Four& c, Four& d) {
    const Four ab_lo = __builtin_shufflevector(a, b, 0, 4, 2, 6),
               ab_hi = __builtin_shufflevector(a, b, 1, 5, 3, 7),
               cd_lo = __builtin_shufflevector(c, d, 0, 4, 2, 6),
               cd_hi = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_lo, cd_lo, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_hi, cd_hi, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab_lo, cd_lo, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab_hi, cd_hi, 2, 3, 6, 7);
}

#else

typedef double V2 __attribute__((vector_size(16)));

struct Four {
    V2 lo, hi;
};

CAROM_INLINE Four four(double a, double b, double c, double d) {
    return {V2{a, b}, V2{c, d}};
}

CAROM_INLINE Four every(double x) {
    return four(x, x, x, x);
}

CAROM_INLINE Four load(const double* from) {
    Four v;
    __builtin_memcpy(&v.lo, from, sizeof v.lo);
    __builtin_memcpy(&v.hi, from + 2, sizeof v.hi);
    return v;
}

CAROM_INLINE void store(double* to, Four v) {
    __builtin_memcpy(to, &v.lo, sizeof v.lo);
    __builtin_memcpy(to + 2, &v.hi, sizeof v.hi);
}

CAROM_INLINE Four operator+(Four a, Four b) {
    return {a.lo + b.lo, a.hi + b.hi};
}

CAROM_INLINE Four operator-(Four a, Four b) {
    return {a.lo - b.lo, a.hi - b.hi};
}

CAROM_INLINE Four operator*(Four a, Four b) {
    return {a.lo * b.lo, a.hi * b.hi};
}

CAROM_INLINE Four operator*(double a, Four b) {
    return {a * b.lo, a * b.hi};
}

CAROM_INLINE Four operator/(Four a, Four b) {
    return {a.lo / b.lo, a.hi / b.hi};
}

CAROM_INLINE Four operator-(Four a) {
    return {-a.lo, -a.hi};
}

CAROM_INLINE Four square_root(Four v) {
#if defined(__SSE2__)
    return {(V2)_mm_sqrt_pd((__m128d)v.lo), (V2)_mm_sqrt_pd((__m128d)v.hi)};
#else
    return four(__builtin_sqrt(v.lo[0]), __builtin_sqrt(v.lo[1]), __builtin_sqrt(v.hi[0]),
                __builtin_sqrt(v.hi[1]));
#endif
}

CAROM_INLINE Four subtract_add(Four a, Four b) {
    const V2 sign{-1.0, 1.0};
    return {a.lo + sign * b.lo, a.hi + sign * b.hi};
}

CAROM_INLINE int less(Four a, Four b) {
#if defined(__SSE2__)
    return _mm_movemask_pd(_mm_cmplt_pd((__m128d)a.lo, (__m128d)b.lo)) |
           _mm_movemask_pd(_mm_cmplt_pd((__m128d)a.hi, (__m128d)b.hi)) << 2;
#else
    return (a.lo[0] < b.lo[0] ? 1 : 0) | (a.lo[1] < b.lo[1] ? 2 : 0) | (a.hi[0] < b.hi[0] ? 4 : 0) |
           (a.hi[1] < b.hi[1] ? 8 : 0);
#endif
}

CAROM_INLINE Four where_less(Four a, Four b, Four x, Four y) {
    return {a.lo < b.lo ? x.lo : y.lo, a.hi < b.hi ? x.hi : y.hi};
}

CAROM_INLINE void transpose(Four& a, Four& b, Four& c, Four& d) {
    const Four a0 = {V2{a.lo[0], b.lo[0]}, V2{c.lo[0], d.lo[0]}},
               a1 = {V2{a.lo[1], b.lo[1]}, V2{c.lo[1], d.lo[1]}},
               a2 = {V2{a.hi[0], b.hi[0]}, V2{c.hi[0], d.hi[0]}},
               a3 = {V2{a.hi[1], b.hi[1]}, V2{c.hi[1], d.hi[1]}};
    a = a0;
    b = a1;
    c = a2;
    d = a3;
}

#endif

}  // namespace
}  // namespace carom::kernel
