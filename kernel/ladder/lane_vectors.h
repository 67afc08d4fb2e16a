// Vectors of W doubles as the compiler's vector types, and the few operations that need an instruction.
#pragma once

#include <immintrin.h>

namespace carom::kernel {
namespace {

template <int W>
struct LaneVector;
template <>
struct LaneVector<4> {
    using Type = double __attribute__((vector_size(32)));
    using Mask = long __attribute__((vector_size(32)));
};
template <>
struct LaneVector<8> {
    using Type = double __attribute__((vector_size(64)));
    using Mask = long __attribute__((vector_size(64)));
};

template <int W>
inline typename LaneVector<W>::Type all(double a) {
    return a - typename LaneVector<W>::Type{};
}

template <int W>
inline typename LaneVector<W>::Type keep_lanes(typename LaneVector<W>::Mask mask,
                                               typename LaneVector<W>::Type a) {
    return (typename LaneVector<W>::Type)(mask & (typename LaneVector<W>::Mask)a);
}

template <int W>
inline bool any(typename LaneVector<W>::Mask mask) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return _mm512_movepi64_mask((__m512i)mask) != 0;
    else
        return _mm256_movemask_pd((__m256d)mask) != 0;
#elif defined(__AVX__)
    __m256d part[W / 4];
    __builtin_memcpy(part, &mask, sizeof mask);
    int bits = 0;
    for (__m256d p : part) bits |= _mm256_movemask_pd(p);
    return bits != 0;
#else
    __m128d part[W / 2];
    __builtin_memcpy(part, &mask, sizeof mask);
    int bits = 0;
    for (__m128d p : part) bits |= _mm_movemask_pd(p);
    return bits != 0;
#endif
}

// Whether a < b in any lane, or not a < b in any: compares straight into a mask register where there is one.
template <int W>
inline bool any_below(typename LaneVector<W>::Type a, typename LaneVector<W>::Type b) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ) != 0;
#endif
    return any<W>(a < b);
}

template <int W>
inline bool all_below(typename LaneVector<W>::Type a, typename LaneVector<W>::Type b) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_NLT_UQ) == 0;
#endif
    return !any<W>(~(a < b));
}

template <int W>
inline typename LaneVector<W>::Type root(typename LaneVector<W>::Type a) {
#if defined(__AVX512F__)
    if constexpr (W == 8) return (typename LaneVector<W>::Type)_mm512_sqrt_pd((__m512d)a);
#endif
#if defined(__AVX__)
    __m256d part[W / 4];
    __builtin_memcpy(part, &a, sizeof a);
    for (__m256d& p : part) p = _mm256_sqrt_pd(p);
#else
    __m128d part[W / 2];
    __builtin_memcpy(part, &a, sizeof a);
    for (__m128d& p : part) p = _mm_sqrt_pd(p);
#endif
    __builtin_memcpy(&a, part, sizeof a);
    return a;
}

// 12 bits from rsqrtps, or 14 from AVX-512.
template <int W>
inline typename LaneVector<W>::Type approximate_rsqrt(typename LaneVector<W>::Type a) {
#if defined(__AVX512F__)
    if constexpr (W == 8)
        return (typename LaneVector<W>::Type)_mm512_rsqrt14_pd((__m512d)a);
    else
        return (typename LaneVector<W>::Type)_mm256_rsqrt14_pd((__m256d)a);
#elif defined(__AVX__)
    __m256d part[W / 4];
    __builtin_memcpy(part, &a, sizeof a);
    for (__m256d& p : part) p = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(p)));
#else
    __m128d part[W / 2];
    __builtin_memcpy(part, &a, sizeof a);
    for (__m128d& p : part) p = _mm_cvtps_pd(_mm_rsqrt_ps(_mm_cvtpd_ps(p)));
#endif
#if !defined(__AVX512F__)
    __builtin_memcpy(&a, part, sizeof a);
    return a;
#endif
}

#if defined(__FMA__)
struct FusedArithmetic {
    template <class V>
    static V madd(V a, V b, V c) {
        if constexpr (sizeof(V) == 32) return (V)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#if defined(__AVX512F__)
        else
            return (V)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#endif
    }
    template <class V>
    static V nmadd(V a, V b, V c) {  // c - a b
        if constexpr (sizeof(V) == 32) return (V)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#if defined(__AVX512F__)
        else
            return (V)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#endif
    }
};
#endif

}  // namespace
}  // namespace carom::kernel
