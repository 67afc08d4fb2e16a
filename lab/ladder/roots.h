// Reciprocal square roots. rsqrtss needs floats: squares of velocities outside [1e-30, 1e30] use square root
// and division.
#pragma once

#include <immintrin.h>

#include "frame.h"

namespace carom::kernel {
namespace {

inline bool fits_float(double square) {
    return square > 1e-30 && square < 1e30;
}

// 12 bits, which differ between Intel and AMD.
inline double raw_rsqrt(double square) {
    return static_cast<double>(_mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(static_cast<float>(square)))));
}

struct ExactRoot {
    static double inverse(double square) { return 1.0 / square_root(square); }
};

struct RawRoot {
    static double inverse(double square) {
        return fits_float(square) ? raw_rsqrt(square) : ExactRoot::inverse(square);
    }
};

// Two Newton steps yield 46 bits: 12 -> 23 -> 46. The published code uses one step and has an error of 1e-7.
struct NewtonRoot {
    static double inverse(double square) {
        if (!fits_float(square)) return ExactRoot::inverse(square);
        const double half = 0.5 * square;
        double y = raw_rsqrt(square);
        y = y * (1.5 - half * y * y);
        return y * (1.5 - half * y * y);
    }
};

}  // namespace
}  // namespace carom::kernel
