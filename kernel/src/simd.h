// Four doubles at once, the only vector shape of the kernel
// by tolerance: one ymm register with AVX2, two xmm without.
//
// Every operation is + - * / or a square root of one lane, each correctly rounded, and sums over lanes have
// one written order. So all instruction sets, compilers and optimisation levels give the same bits. No fused
// multiply-add: without it plain x86-64 needs no software emulation, and it would save little, because square
// roots and divisions dominate. Included by files built for one instruction set: no std templates here,
// everything inline in an anonymous namespace.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// The functions below are inlined, so that no vector crosses an ABI boundary.
#pragma GCC diagnostic ignored "-Wpsabi"

#define CAROM_INLINE inline __attribute__((always_inline))

namespace carom::kernel {
namespace {

typedef double V4 __attribute__((vector_size(32)));

CAROM_INLINE V4 all(double x) {
    return V4{x, x, x, x};
}

CAROM_INLINE V4 load4(const double* from) {
    V4 v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

CAROM_INLINE void store4(double* to, V4 v) {
    __builtin_memcpy(to, &v, sizeof v);
}

CAROM_INLINE V4 square_root(V4 v) {
#if defined(__AVX__)
    return (V4)_mm256_sqrt_pd((__m256d)v);
#elif defined(__SSE2__)
    const __m128d lo = _mm_sqrt_pd(__m128d{v[0], v[1]}), hi = _mm_sqrt_pd(__m128d{v[2], v[3]});
    return V4{lo[0], lo[1], hi[0], hi[1]};
#else
    return V4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]), __builtin_sqrt(v[3])};
#endif
}

template <int kLane>
CAROM_INLINE V4 broadcast(V4 v) {
    return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}

// (v0 + v2) + (v1 + v3): the order in which two halves of a register are added.
CAROM_INLINE double sum(V4 v) {
    return (v[0] + v[2]) + (v[1] + v[3]);
}

CAROM_INLINE double largest(double a, double b) {
    return a > b ? a : b;
}

CAROM_INLINE double smallest(double a, double b) {
    return a < b ? a : b;
}

}  // namespace
}  // namespace carom::kernel
