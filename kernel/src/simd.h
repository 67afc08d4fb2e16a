// Vectors of doubles: Pack<N> has N of them, Mask<N> one truth value for each (all bits or none).
//
// Every operation acts on each lane separately and is + - * / or a square root, correctly rounded; a sum over
// lanes has a fixed order. Therefore all instruction sets, compilers and optimisation levels give the same
// bits. Fused multiply-add is not used: plain x86-64 would have to emulate it in software, and it would save
// little, because square roots and divisions dominate.
//
// A pack that fits into a register of the instruction set is the compiler's own vector type. A wider one is
// two halves, because gcc 12 moves its own wide vectors through memory and splits them lane by lane in
// shuffles and comparisons.
//
// This header is included by files that are built once per instruction set: everything is inline and in an
// anonymous namespace, without std templates, because a weak symbol built for a higher instruction set could
// win at link time and crash the program on an older processor.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

// No vector crosses a function call: all functions below are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

#define CAROM_INLINE inline __attribute__((always_inline))

namespace carom::kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kRegisterLanes = 8;
#elif defined(__AVX__)
constexpr int kRegisterLanes = 4;
#else
constexpr int kRegisterLanes = 2;
#endif

// Two packs, or two masks, used as one: `lo` has the lower lanes.
template <class Half>
struct Halves {
    Half lo, hi;
};

template <int N>
struct PackType {
    using Type = Halves<typename PackType<N / 2>::Type>;
};
template <>
struct PackType<2> {
    using Type = double __attribute__((vector_size(16)));
};
#if defined(__AVX__)
template <>
struct PackType<4> {
    using Type = double __attribute__((vector_size(32)));
};
#endif
#if defined(__AVX512F__)
template <>
struct PackType<8> {
    using Type = double __attribute__((vector_size(64)));
};
#endif

template <int N>
using Pack = typename PackType<N>::Type;

// Operators of halves; the compiler provides those of packs that fit into a register.
#define CAROM_BINARY(op)                                                   \
    template <class Half>                                                  \
    CAROM_INLINE auto operator op(Halves<Half> a, Halves<Half> b) {        \
        return Halves<decltype(a.lo op b.lo)>{a.lo op b.lo, a.hi op b.hi}; \
    }
#define CAROM_WITH_NUMBER(op)                                     \
    CAROM_BINARY(op)                                              \
    template <class Half>                                         \
    CAROM_INLINE auto operator op(double a, Halves<Half> b) {     \
        return Halves<decltype(a op b.lo)>{a op b.lo, a op b.hi}; \
    }                                                             \
    template <class Half>                                         \
    CAROM_INLINE auto operator op(Halves<Half> a, double b) {     \
        return Halves<decltype(a.lo op b)>{a.lo op b, a.hi op b}; \
    }
#define CAROM_ASSIGNMENT(op)                                         \
    template <class Half>                                            \
    CAROM_INLINE void operator op(Halves<Half>& a, Halves<Half> b) { \
        a.lo op b.lo;                                                \
        a.hi op b.hi;                                                \
    }
CAROM_WITH_NUMBER(+)
CAROM_WITH_NUMBER(-)
CAROM_WITH_NUMBER(*)
CAROM_WITH_NUMBER(/)
CAROM_WITH_NUMBER(<)
CAROM_WITH_NUMBER(<=)
CAROM_WITH_NUMBER(>)
CAROM_WITH_NUMBER(>=)
CAROM_WITH_NUMBER(==)
CAROM_BINARY(&)
CAROM_BINARY(|)
CAROM_ASSIGNMENT(+=)
CAROM_ASSIGNMENT(&=)
CAROM_ASSIGNMENT(|=)
#undef CAROM_BINARY
#undef CAROM_WITH_NUMBER
#undef CAROM_ASSIGNMENT

template <class Half>
CAROM_INLINE Halves<Half> operator-(Halves<Half> a) {
    return {-a.lo, -a.hi};
}

template <class Half>
CAROM_INLINE Halves<Half> operator~(Halves<Half> a) {
    return {~a.lo, ~a.hi};
}

template <int N>
using Mask = decltype(Pack<N>{} < Pack<N>{});

template <int N>
CAROM_INLINE Pack<N> broadcast(double x) {
    // not a sum, which would turn -0 into +0
    if constexpr (N <= kRegisterLanes)
        return x - Pack<N>{};
    else
        return {broadcast<N / 2>(x), broadcast<N / 2>(x)};
}

// `from` and `to` need no alignment.
template <int N>
CAROM_INLINE Pack<N> load(const double* from) {
    if constexpr (N <= kRegisterLanes) {
        Pack<N> v;
        __builtin_memcpy(&v, from, sizeof v);
        return v;
    } else {
        return {load<N / 2>(from), load<N / 2>(from + N / 2)};
    }
}

template <class Register>
CAROM_INLINE void store(double* to, Register v) {
    __builtin_memcpy(to, &v, sizeof v);
}

template <class Half>
CAROM_INLINE void store(double* to, Halves<Half> v) {
    store(to, v.lo);
    store(to + sizeof v.lo / sizeof *to, v.hi);
}

// One lane of a pack or of a mask (-1 or 0).
template <class Register>
CAROM_INLINE auto lane(const Register& v, int i) {
    return v[i];
}

template <class Half>
CAROM_INLINE auto lane(const Halves<Half>& v, int i) {
    constexpr int kHalf = sizeof v.lo / sizeof(double);
    return i < kHalf ? lane(v.lo, i) : lane(v.hi, i - kHalf);
}

template <class Register, class Number>
CAROM_INLINE void set_lane(Register& v, int i, Number x) {
    v[i] = x;
}

template <class Half, class Number>
CAROM_INLINE void set_lane(Halves<Half>& v, int i, Number x) {
    constexpr int kHalf = sizeof v.lo / sizeof(double);
    if (i < kHalf)
        set_lane(v.lo, i, x);
    else
        set_lane(v.hi, i - kHalf, x);
}

// Per lane: `yes` if the mask is set, otherwise `no`.
template <class M, class Register>
CAROM_INLINE Register select(M mask, Register yes, Register no) {
    return mask ? yes : no;
}

template <class M, class Half>
CAROM_INLINE Halves<Half> select(Halves<M> mask, Halves<Half> yes, Halves<Half> no) {
    return {select(mask.lo, yes.lo, no.lo), select(mask.hi, yes.hi, no.hi)};
}

// Per lane: the larger of a and b, and the smaller; b if they are equal or one is NaN.
template <class Register>
CAROM_INLINE Register larger(Register a, Register b) {
    return select(a > b, a, b);
}

template <class Register>
CAROM_INLINE Register smaller(Register a, Register b) {
    return select(a < b, a, b);
}

#if defined(__AVX__)
CAROM_INLINE Pack<4> larger(Pack<4> a, Pack<4> b) {
    return (Pack<4>)_mm256_max_pd((__m256d)a, (__m256d)b);
}

CAROM_INLINE Pack<4> smaller(Pack<4> a, Pack<4> b) {
    return (Pack<4>)_mm256_min_pd((__m256d)a, (__m256d)b);
}
#endif

template <class Register>
CAROM_INLINE Register absolute(Register v) {
    using M = decltype(v < v);
    return (Register)((M)v & (M{} + 0x7fffffffffffffffL));
}

template <class Half>
CAROM_INLINE Halves<Half> absolute(Halves<Half> v) {
    return {absolute(v.lo), absolute(v.hi)};
}

#if defined(__x86_64__)
CAROM_INLINE Pack<2> square_root(Pack<2> v) {
    return (Pack<2>)_mm_sqrt_pd((__m128d)v);
}

// Bit i is lane i of the mask.
CAROM_INLINE int bits(Mask<2> mask) {
    return _mm_movemask_pd((__m128d)mask);
}
#elif defined(__wasm_simd128__)
CAROM_INLINE Pack<2> square_root(Pack<2> v) {
    return (Pack<2>)wasm_f64x2_sqrt((v128_t)v);
}

CAROM_INLINE int bits(Mask<2> mask) {
    return static_cast<int>(wasm_i64x2_bitmask((v128_t)mask));
}
#else
CAROM_INLINE Pack<2> square_root(Pack<2> v) {
    return Pack<2>{__builtin_sqrt(v[0]), __builtin_sqrt(v[1])};
}

CAROM_INLINE int bits(Mask<2> mask) {
    return static_cast<int>(mask[0] & 1) | static_cast<int>(mask[1] & 2);
}
#endif

// Bit i: whether a < b in lane i.
CAROM_INLINE int bits_less(Pack<2> a, Pack<2> b) {
    return bits(a < b);
}

#if defined(__AVX__)
CAROM_INLINE Pack<4> square_root(Pack<4> v) {
    return (Pack<4>)_mm256_sqrt_pd((__m256d)v);
}

CAROM_INLINE int bits(Mask<4> mask) {
    return _mm256_movemask_pd((__m256d)mask);
}

// gcc 12 needs fewer instructions for this than for bits(a < b).
CAROM_INLINE int bits_less(Pack<4> a, Pack<4> b) {
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}
#endif

#if defined(__AVX512F__)
CAROM_INLINE Pack<8> square_root(Pack<8> v) {
    return (Pack<8>)_mm512_maskz_sqrt_pd(0xff, (__m512d)v);  // gcc 12 warns inside the form without a mask
}

CAROM_INLINE int bits(Mask<8> mask) {
    return _mm512_movepi64_mask((__m512i)mask);
}

CAROM_INLINE int bits_less(Pack<8> a, Pack<8> b) {
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
}
#endif

template <class Half>
CAROM_INLINE Halves<Half> square_root(Halves<Half> v) {
    return {square_root(v.lo), square_root(v.hi)};
}

template <class Half>
CAROM_INLINE int bits(Halves<Half> mask) {
    return bits(mask.lo) | bits(mask.hi) << sizeof mask.lo / sizeof(double);
}

template <class Half>
CAROM_INLINE int bits_less(Halves<Half> a, Halves<Half> b) {
    return bits_less(a.lo, b.lo) | bits_less(a.hi, b.hi) << sizeof a.lo / sizeof(double);
}

template <class M>
CAROM_INLINE bool any(M mask) {
    return bits(mask) != 0;
}

// A NaN is not below the bound.
template <class P>
CAROM_INLINE bool all_below(P v, double bound) {
    constexpr int kLanes = sizeof v / sizeof bound;
    return bits_less(v, broadcast<kLanes>(bound)) == (1 << kLanes) - 1;
}

// Adds the two halves of a pack until one number is left: for four lanes (v0 + v2) + (v1 + v3).
CAROM_INLINE double sum(Pack<2> v) {
    return v[0] + v[1];
}

#if defined(__AVX__)
CAROM_INLINE double sum(Pack<4> v) {
    return sum(__builtin_shufflevector(v, v, 0, 1) + __builtin_shufflevector(v, v, 2, 3));
}
#endif

#if defined(__AVX512F__)
CAROM_INLINE double sum(Pack<8> v) {
    return sum(__builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7));
}
#endif

template <class Half>
CAROM_INLINE double sum(Halves<Half> v) {
    return sum(v.lo + v.hi);
}

// Operations for packs of four only.
#if defined(__AVX__)

CAROM_INLINE Pack<4> pack(double a, double b, double c, double d) {
    return Pack<4>{a, b, c, d};
}

// Lane kLane in all lanes.
template <int kLane>
CAROM_INLINE Pack<4> broadcast_lane(Pack<4> v) {
    return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}

// (a0 - b0, a1 + b1, a2 - b2, a3 + b3)
CAROM_INLINE Pack<4> subtract_add(Pack<4> a, Pack<4> b) {
    return (Pack<4>)_mm256_addsub_pd((__m256d)a, (__m256d)b);
}

// Rows to columns; its own inverse.
CAROM_INLINE void transpose(Pack<4>& a, Pack<4>& b, Pack<4>& c, Pack<4>& d) {
    const Pack<4> ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                  cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

#else

CAROM_INLINE Pack<4> pack(double a, double b, double c, double d) {
    return {Pack<2>{a, b}, Pack<2>{c, d}};
}

template <int kLane>
CAROM_INLINE Pack<4> broadcast_lane(Pack<4> v) {
    const Pack<2> half = kLane < 2 ? v.lo : v.hi,
                  all = __builtin_shufflevector(half, half, kLane % 2, kLane % 2);
    return {all, all};
}

CAROM_INLINE Pack<4> subtract_add(Pack<4> a, Pack<4> b) {
    const Pack<2> sign{-1.0, 1.0};
    return {a.lo + sign * b.lo, a.hi + sign * b.hi};
}

CAROM_INLINE void transpose(Pack<4>& a, Pack<4>& b, Pack<4>& c, Pack<4>& d) {
    const Pack<4> a0 = pack(a.lo[0], b.lo[0], c.lo[0], d.lo[0]),
                  a1 = pack(a.lo[1], b.lo[1], c.lo[1], d.lo[1]),
                  a2 = pack(a.hi[0], b.hi[0], c.hi[0], d.hi[0]),
                  a3 = pack(a.hi[1], b.hi[1], c.hi[1], d.hi[1]);
    a = a0;
    b = a1;
    c = a2;
    d = a3;
}

#endif

// Lane kLane of eight in all lanes.
#if defined(__AVX512F__)
template <int kLane>
CAROM_INLINE Pack<8> broadcast_lane(Pack<8> v) {
    return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane, kLane, kLane, kLane, kLane);
}
#else
template <int kLane>
CAROM_INLINE Pack<8> broadcast_lane(Pack<8> v) {
    const Pack<4> all = broadcast_lane<kLane % 4>(kLane < 4 ? v.lo : v.hi);
    return {all, all};
}
#endif

// Lane kLane in all lanes of a pack of N, which has as many lanes as `v` or twice as many.
template <int N, int kLane, class P>
CAROM_INLINE Pack<N> spread_lane(P v) {
    const P all = broadcast_lane<kLane>(v);
    if constexpr (sizeof(P) == sizeof(Pack<N>))
        return all;
    else if constexpr (N <= kRegisterLanes)
        return __builtin_shufflevector(all, all, 0, 0, 0, 0, 0, 0, 0, 0);
    else
        return {all, all};
}

}  // namespace
}  // namespace carom::kernel
