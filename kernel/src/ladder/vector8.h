// Eight doubles in whatever registers the instruction set has. Only + - * / sqrt, lane by lane, so that every
// instruction set and compiler gives the same bits; sums over lanes have one written order.
#pragma once

#include <immintrin.h>

namespace carom::kernel {
namespace {

using Vector8 = double __attribute__((vector_size(64)));

inline Vector8 load8(const double* a) {
    Vector8 v;
    __builtin_memcpy(&v, a, sizeof v);
    return v;
}

inline Vector8 all8(double a) {
    return Vector8{a, a, a, a, a, a, a, a};
}

inline Vector8 square_root8(Vector8 a) {
#if defined(__AVX512F__)
    return (Vector8)_mm512_sqrt_pd((__m512d)a);
#elif defined(__AVX__)
    __m256d h[2];
    __builtin_memcpy(h, &a, sizeof a);
    h[0] = _mm256_sqrt_pd(h[0]);
    h[1] = _mm256_sqrt_pd(h[1]);
    __builtin_memcpy(&a, h, sizeof a);
    return a;
#else
    __m128d q[4];
    __builtin_memcpy(q, &a, sizeof a);
    for (__m128d& x : q) x = _mm_sqrt_pd(x);
    __builtin_memcpy(&a, q, sizeof a);
    return a;
#endif
}

inline double sum8(Vector8 a) {
    const auto four = __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
    const auto two = __builtin_shufflevector(four, four, 0, 1) + __builtin_shufflevector(four, four, 2, 3);
    return two[0] + two[1];
}

inline Vector8 absolute8(Vector8 a) {
    using Bits = long __attribute__((vector_size(64)));
    return (Vector8)((Bits)a & 0x7fffffffffffffffL);
}

}  // namespace
}  // namespace carom::kernel
