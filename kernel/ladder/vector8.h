// Eight doubles in whatever registers the instruction set has: one, two or four. (gcc 12 moves its own
// vectors of 64 bytes, and arrays of vectors, through memory.) Only + - * / sqrt, lane by lane, so that every
// instruction set and compiler gives the same bits; sums over lanes have one written order.
#pragma once

#include <immintrin.h>

namespace carom::kernel {
namespace {

#if defined(__AVX512F__)
using Piece = __m512d;
#elif defined(__AVX__)
using Piece = __m256d;
#else
using Piece = __m128d;
#endif

inline Piece all_piece(double a) {
    return a - Piece{};
}

inline Piece load_piece(const double* a) {
    Piece p;
    __builtin_memcpy(&p, a, sizeof p);
    return p;
}

inline void store_piece(double* a, Piece p) {
    __builtin_memcpy(a, &p, sizeof p);
}

inline Piece square_root_piece(Piece p) {
#if defined(__AVX512F__)
    return _mm512_sqrt_pd(p);
#elif defined(__AVX__)
    return _mm256_sqrt_pd(p);
#else
    return _mm_sqrt_pd(p);
#endif
}

inline Piece absolute_piece(Piece p) {
#if defined(__AVX512F__)
    return _mm512_abs_pd(p);
#elif defined(__AVX__)
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), p);
#else
    return _mm_andnot_pd(_mm_set1_pd(-0.0), p);
#endif
}

using MaskPiece = decltype(Piece{} < Piece{});  // all bits, or none, lane by lane

inline int bits_piece(MaskPiece m) {
#if defined(__AVX512F__)
    return _mm512_movepi64_mask((__m512i)m);
#elif defined(__AVX__)
    return _mm256_movemask_pd((__m256d)m);
#else
    return _mm_movemask_pd((__m128d)m);
#endif
}

#if defined(__AVX512F__)
struct Vector8 {
    Piece a;
};
struct Mask8 {
    MaskPiece a;
};
#define CAROM_EACH(F) \
    { F(a) }
#define CAROM_PIECES(F) F(a, 0)
#elif defined(__AVX__)
struct Vector8 {
    Piece a, b;
};
struct Mask8 {
    MaskPiece a, b;
};
#define CAROM_EACH(F) \
    { F(a), F(b) }
#define CAROM_PIECES(F) F(a, 0) F(b, 4)
#else
struct Vector8 {
    Piece a, b, c, d;
};
struct Mask8 {
    MaskPiece a, b, c, d;
};
#define CAROM_EACH(F) \
    { F(a), F(b), F(c), F(d) }
#define CAROM_PIECES(F) F(a, 0) F(b, 2) F(c, 4) F(d, 6)
#endif

inline Vector8 all8(double x) {
#define CAROM_ALL(m) all_piece(x)
    return CAROM_EACH(CAROM_ALL);
}

inline Vector8 load8(const double* from) {
    Vector8 v;
#define CAROM_LOAD(m, offset) v.m = load_piece(from + (offset));
    CAROM_PIECES(CAROM_LOAD)
    return v;
}

inline void store8(double* to, Vector8 v) {
#define CAROM_STORE(m, offset) store_piece(to + (offset), v.m);
    CAROM_PIECES(CAROM_STORE)
}

#define CAROM_PLUS(m) (x.m + y.m)
#define CAROM_MINUS(m) (x.m - y.m)
#define CAROM_TIMES(m) (x.m * y.m)
#define CAROM_BY(m) (x.m / y.m)
#define CAROM_OPERATOR(op, OP)                         \
    inline Vector8 operator op(Vector8 x, Vector8 y) { \
        return CAROM_EACH(OP);                         \
    }                                                  \
    inline Vector8 operator op(double x, Vector8 y) {  \
        return all8(x) op y;                           \
    }                                                  \
    inline Vector8 operator op(Vector8 x, double y) {  \
        return x op all8(y);                           \
    }
CAROM_OPERATOR(+, CAROM_PLUS)
CAROM_OPERATOR(-, CAROM_MINUS)
CAROM_OPERATOR(*, CAROM_TIMES)
CAROM_OPERATOR(/, CAROM_BY)

inline Vector8 square_root8(Vector8 x) {
#define CAROM_ROOT(m) square_root_piece(x.m)
    return CAROM_EACH(CAROM_ROOT);
}

inline Vector8 absolute8(Vector8 x) {
#define CAROM_ABSOLUTE(m) absolute_piece(x.m)
    return CAROM_EACH(CAROM_ABSOLUTE);
}

// Comparisons with a NaN are false.
inline Mask8 operator<(Vector8 x, Vector8 y) {
#define CAROM_LESS(m) x.m < y.m
    return CAROM_EACH(CAROM_LESS);
}

inline Mask8 operator&(Mask8 x, Mask8 y) {
#define CAROM_AND(m) (x.m & y.m)
    return CAROM_EACH(CAROM_AND);
}

inline Mask8 operator|(Mask8 x, Mask8 y) {
#define CAROM_OR(m) (x.m | y.m)
    return CAROM_EACH(CAROM_OR);
}

inline Mask8 operator!(Mask8 x) {
#define CAROM_NOT(m) ~x.m
    return CAROM_EACH(CAROM_NOT);
}

inline Vector8 select8(Mask8 mask, Vector8 x, Vector8 y) {
#define CAROM_SELECT(m) (Piece)(mask.m ? x.m : y.m)
    return CAROM_EACH(CAROM_SELECT);
}

// Bit i is lane i.
inline int bits8(Mask8 x) {
    int bits = 0;
#define CAROM_BITS(m, offset) bits |= bits_piece(x.m) << (offset);
    CAROM_PIECES(CAROM_BITS)
    return bits;
}

inline bool all_below8(Vector8 x, double bound) {
    return bits8(x < all8(bound)) == 0xff;
}

// ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7))
inline double sum8(Vector8 x) {
#if defined(__AVX512F__)
    const __m256d four =
        __builtin_shufflevector(x.a, x.a, 0, 1, 2, 3) + __builtin_shufflevector(x.a, x.a, 4, 5, 6, 7);
    const __m128d two = _mm256_castpd256_pd128(four) + _mm256_extractf128_pd(four, 1);
#elif defined(__AVX__)
    const __m256d four = x.a + x.b;
    const __m128d two = _mm256_castpd256_pd128(four) + _mm256_extractf128_pd(four, 1);
#else
    const __m128d two = (x.a + x.c) + (x.b + x.d);
#endif
    return two[0] + two[1];
}

#undef CAROM_EACH
#undef CAROM_PIECES
#undef CAROM_ALL
#undef CAROM_LOAD
#undef CAROM_STORE
#undef CAROM_PLUS
#undef CAROM_MINUS
#undef CAROM_TIMES
#undef CAROM_BY
#undef CAROM_OPERATOR
#undef CAROM_ROOT
#undef CAROM_ABSOLUTE
#undef CAROM_LESS
#undef CAROM_AND
#undef CAROM_OR
#undef CAROM_NOT
#undef CAROM_SELECT
#undef CAROM_BITS

}  // namespace
}  // namespace carom::kernel
