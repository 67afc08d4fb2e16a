// The few functions of one number that the kernels need, all inline and in an anonymous namespace: files
// built for one instruction set include no std templates (reason: simd.h).
#pragma once

namespace carom::kernel {
namespace {

inline bool finite(double x) {
    return x - x == 0.0;
}

inline double square_root(double x) {
    return __builtin_sqrt(x);
}

inline double absolute(double x) {
    return x < 0.0 ? -x : x;
}

// As absolute(), in one instruction. The published integration keeps the other: it is the baseline of all
// measurements.
inline double magnitude(double x) {
    return __builtin_fabs(x);
}

inline double largest(double a, double b) {
    return a > b ? a : b;
}

inline double smallest(double a, double b) {
    return a < b ? a : b;
}

}  // namespace
}  // namespace carom::kernel
