// The contact frame of an impact, for all kernels: validation, projection, back-projection.
#pragma once

#include <cstdint>

#include "carom/kernel/impact.h"
#include "numbers.h"

namespace carom::kernel {
namespace {

// Velocities in the contact frame of the 2014 paper: y points from centre 1 to centre 2, z points up,
// x = y x z.
struct FrameState {
    double v1x, v1y, w1x, w1y, w1z;
    double v2x, v2y, w2x, w2y, w2z;
};

struct Frame {
    double yx, yy;  // the horizontal unit vector y in table coordinates; x is (yy, -yx)
};

// Largest height difference of the centres, relative to their distance: the impact is planar. It allows for
// rounding of heights that should be equal.
constexpr double kHeightTolerance = 1e-9;
// Smallest approach speed [m/s], and smallest fraction of the sum of all speeds. Below it the square of the
// approach speed underflows in the work integral, and the balls do not count as approaching (hard case H30).
constexpr double kSlowestApproach = 1e-150;

inline bool finite(const double (&a)[3]) {
    return finite(a[0]) && finite(a[1]) && finite(a[2]);
}

// Tests both balls at once: a difference is 0, or NaN if a number is not finite.
inline bool finite(const Ball& a, const Ball& b) {
    double wrong[3];
    for (int k = 0; k < 3; ++k)
        wrong[k] = ((a.r[k] - a.r[k]) + (a.v[k] - a.v[k])) + ((a.w[k] - a.w[k]) + (b.r[k] - b.r[k])) +
                   ((b.v[k] - b.v[k]) + (b.w[k] - b.w[k]));
    return wrong[0] + wrong[1] + wrong[2] == 0.0;
}

// A cloth slip [m/s] up to this floor is rounding of the v and R w of a rolling ball. It has no direction,
// and the step has no cloth friction, as for a slip of exactly zero. Used for the consistent sign only: there
// rolling balls usually have u = 0, and two correct integrations would otherwise differ by the friction of a
// whole step. The published code has no such floor.
inline double cloth_slip_floor(const FrameState& s, double R, int sign) {
    if (sign > 0) return 0.0;
    const double v = absolute(s.v1x) + absolute(s.v1y) + absolute(s.v2x) + absolute(s.v2y);
    const double w = absolute(s.w1x) + absolute(s.w1y) + absolute(s.w2x) + absolute(s.w2y);
    return 8.0 * 0x1p-52 * (v + R * w);
}

// [m/s] The sum of the absolute values of all components of v and R w.
template <bool kMagnitude = false>
inline double sum_of_speeds(const FrameState& s, double R) {
    const auto size = [](double x) { return kMagnitude ? magnitude(x) : absolute(x); };
    return size(s.v1x) + size(s.v1y) + size(s.v2x) + size(s.v2y) +
           R * (size(s.w1x) + size(s.w1y) + size(s.w1z) + size(s.w2x) + size(s.w2y) + size(s.w2z));
}

// The result if nothing is computed: the velocities before the impact.
inline void copy_input(const Ball& b1, const Ball& b2, ImpactStatus status, ImpactResult& out) {
    for (int k = 0; k < 3; ++k) {
        out.v1[k] = b1.v[k];
        out.w1[k] = b1.w[k];
        out.v2[k] = b2.v[k];
        out.w2[k] = b2.w[k];
    }
    out.steps = 0;
    out.status = status;
    out.method = ToleranceMethod::kNone;
}

template <bool kAnyMasses>
inline bool in_range(const ImpactParams& p) {
    return finite(p.R) && p.R > 0.0 && finite(p.m) && p.m > 0.0 && finite(p.mu_s1) && p.mu_s1 >= 0.0 &&
           finite(p.mu_s2) && p.mu_s2 >= 0.0 && finite(p.mu_b) && p.mu_b >= 0.0 && p.e_b >= 0.0 &&
           p.e_b <= 1.0 && (kAnyMasses || (p.mass_ratio == 1.0 && p.radius_ratio == 1.0));
}

// Checks the input and projects it into the contact frame. For any status except kOk there is nothing to
// compute, and `out` contains the input.
template <bool kAnyMasses = false>
inline ImpactStatus enter_frame(const Ball& b1, const Ball& b2, const ImpactParams& p, Frame& f,
                                FrameState& s, ImpactResult& out) {
    ImpactStatus status = ImpactStatus::kOk;
    if (!in_range<kAnyMasses>(p)) status = ImpactStatus::kBadParameter;
    if (status == ImpactStatus::kOk && !finite(b1, b2)) status = ImpactStatus::kBadState;
    if (status == ImpactStatus::kOk) {
        const double dx = b2.r[0] - b1.r[0], dy = b2.r[1] - b1.r[1], dz = b2.r[2] - b1.r[2];
        const double d2 = dx * dx + dy * dy, d = square_root(d2);
        if (!(d > 0.0) || !finite(d) || absolute(dz) > kHeightTolerance * d) {
            status = ImpactStatus::kBadState;
        } else if constexpr (kAnyMasses) {
            // Here the division does not wait for the root. The published integration keeps its bits.
            const double by_d = d * (1.0 / d2);
            f.yx = dx * by_d;
            f.yy = dy * by_d;
        } else {
            f.yx = dx / d;
            f.yy = dy / d;
        }
    }
    if (status != ImpactStatus::kOk) {
        copy_input(b1, b2, status, out);
        return status;
    }
    s.v1x = b1.v[0] * f.yy - b1.v[1] * f.yx;
    s.v1y = b1.v[0] * f.yx + b1.v[1] * f.yy;
    s.w1x = b1.w[0] * f.yy - b1.w[1] * f.yx;
    s.w1y = b1.w[0] * f.yx + b1.w[1] * f.yy;
    s.w1z = b1.w[2];
    s.v2x = b2.v[0] * f.yy - b2.v[1] * f.yx;
    s.v2y = b2.v[0] * f.yx + b2.v[1] * f.yy;
    s.w2x = b2.w[0] * f.yy - b2.w[1] * f.yx;
    s.w2y = b2.w[0] * f.yx + b2.w[1] * f.yy;
    s.w2z = b2.w[2];
    const double approach = s.v1y - s.v2y;
    const double scale = sum_of_speeds<kAnyMasses>(s, p.R);
    // Speeds whose squares overflow are a bad state, like NaN.
    if (!finite(scale) || !finite(scale * scale))
        status = ImpactStatus::kBadState;
    else if (!(approach > 0.0) || approach < kSlowestApproach || approach < kSlowestApproach * scale)
        status = ImpactStatus::kNotApproaching;
    if (status != ImpactStatus::kOk) copy_input(b1, b2, status, out);
    return status;
}

// Projects back to table coordinates. Vertical velocities do not change.
inline void leave_frame(const Ball& b1, const Ball& b2, const Frame& f, const FrameState& s,
                        std::int64_t steps, ImpactResult& out) {
    out.v1[0] = s.v1x * f.yy + s.v1y * f.yx;
    out.v1[1] = s.v1y * f.yy - s.v1x * f.yx;
    out.v1[2] = b1.v[2];
    out.w1[0] = s.w1x * f.yy + s.w1y * f.yx;
    out.w1[1] = s.w1y * f.yy - s.w1x * f.yx;
    out.w1[2] = s.w1z;
    out.v2[0] = s.v2x * f.yy + s.v2y * f.yx;
    out.v2[1] = s.v2y * f.yy - s.v2x * f.yx;
    out.v2[2] = b2.v[2];
    out.w2[0] = s.w2x * f.yy + s.w2y * f.yx;
    out.w2[1] = s.w2y * f.yy - s.w2x * f.yx;
    out.w2[2] = s.w2z;
    out.steps = steps;
    out.status = ImpactStatus::kOk;
    out.method = ToleranceMethod::kNone;
}

}  // namespace
}  // namespace carom::kernel
