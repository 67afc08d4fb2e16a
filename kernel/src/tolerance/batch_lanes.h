// The lanes of a batch solved to a tolerance: impacts are loaded into lanes, brought into canonical form,
// solved by one collocation, and written back. tolerance.cpp chooses the impacts.
#pragma once

#include <cstdint>

#include "carom/kernel/batch.h"
#include "tolerance/single.h"
#include "tolerance/wide.h"

namespace carom::kernel {
namespace {

// The arrays of a batch by number, for loops over them. A vector has three numbers, one per component.
enum Input {
    kR1 = 0,
    kV1 = 3,
    kW1 = 6,
    kR2 = 9,
    kV2 = 12,
    kW2 = 15,
    kRadius = 18,
    kMass,
    kMuS1,
    kMuS2,
    kMuB,
    kEB,
    kInputs
};
enum Output { kOutV1 = 0, kOutW1 = 3, kOutV2 = 6, kOutW2 = 9, kOutputs = 12 };

struct BatchView {
    const double* in[kInputs];
    double* out[kOutputs];
    ImpactStatus* status;
    std::int64_t* steps;
    ToleranceMethod* method;
    ClothSlip cloth_slip;
    const double *mass_ratio, *radius_ratio;  // null: 1

    bool alike(std::int64_t i) const {
        return (mass_ratio == nullptr || mass_ratio[i] == 1.0) &&
               (radius_ratio == nullptr || radius_ratio[i] == 1.0);
    }
};

inline BatchView view(const ImpactBatch& batch, const ImpactBatchResult& result) {
    BatchView v;
    for (int k = 0; k < 3; ++k) {
        v.in[kR1 + k] = batch.ball1.r[k];
        v.in[kV1 + k] = batch.ball1.v[k];
        v.in[kW1 + k] = batch.ball1.w[k];
        v.in[kR2 + k] = batch.ball2.r[k];
        v.in[kV2 + k] = batch.ball2.v[k];
        v.in[kW2 + k] = batch.ball2.w[k];
        v.out[kOutV1 + k] = result.ball1.v[k];
        v.out[kOutW1 + k] = result.ball1.w[k];
        v.out[kOutV2 + k] = result.ball2.v[k];
        v.out[kOutW2 + k] = result.ball2.w[k];
    }
    v.in[kRadius] = batch.params.R;
    v.in[kMass] = batch.params.m;
    v.in[kMuS1] = batch.params.mu_s1;
    v.in[kMuS2] = batch.params.mu_s2;
    v.in[kMuB] = batch.params.mu_b;
    v.in[kEB] = batch.params.e_b;
    v.status = result.status;
    v.steps = result.steps;
    v.method = result.method;
    v.cloth_slip = batch.params.cloth_slip;
    v.mass_ratio = batch.params.mass_ratio;
    v.radius_ratio = batch.params.radius_ratio;
    return v;
}

// The results of a block of lanes: the proper impacts, the solved ones, and those that more nodes may solve.
struct BlockResult {
    Wide out[kOutputs];
    Wide sweeps;
    // Fraction of the slip that friction can remove per unit of impulse: more sweeps if it is larger.
    Wide hardness;
    WideMask good, done, resolvable;
};

struct WideFrame {
    Wide yx, yy, x1, y1, wx1, wy1, wz1, x2, y2, wx2, wy2, wz2;
};

// As enter_frame(). The mask excludes lanes whose status would not be kOk.
CAROM_INLINE WideMask wide_enter(const Wide (&in)[kInputs], WideFrame& f) {
    Wide wrong = {};
    // The sum is 0, or NaN if an input is not finite.
    for (int i = 0; i < kInputs; ++i) wrong += in[i] - in[i];  // NOLINT(misc-redundant-expression): see above
    const Wide dx = in[kR2] - in[kR1], dy = in[kR2 + 1] - in[kR1 + 1], dz = in[kR2 + 2] - in[kR1 + 2];
    const Wide d = square_root(dx * dx + dy * dy), by_d = 1.0 / d;
    f.yx = dx * by_d;
    f.yy = dy * by_d;
    f.x1 = in[kV1] * f.yy - in[kV1 + 1] * f.yx;
    f.y1 = in[kV1] * f.yx + in[kV1 + 1] * f.yy;
    f.wx1 = in[kW1] * f.yy - in[kW1 + 1] * f.yx;
    f.wy1 = in[kW1] * f.yx + in[kW1 + 1] * f.yy;
    f.wz1 = in[kW1 + 2];
    f.x2 = in[kV2] * f.yy - in[kV2 + 1] * f.yx;
    f.y2 = in[kV2] * f.yx + in[kV2 + 1] * f.yy;
    f.wx2 = in[kW2] * f.yy - in[kW2 + 1] * f.yx;
    f.wy2 = in[kW2] * f.yx + in[kW2 + 1] * f.yy;
    f.wz2 = in[kW2 + 2];
    const Wide approach = f.y1 - f.y2;
    const Wide scale =
        ((absolute(f.x1) + absolute(f.y1)) + (absolute(f.x2) + absolute(f.y2))) +
        in[kRadius] * ((absolute(f.wx1) + absolute(f.wy1)) + (absolute(f.wz1) + absolute(f.wx2)) +
                       (absolute(f.wy2) + absolute(f.wz2)));
    // Impacts with an extreme range of speeds are left to the single kernel, which decides whether they are
    // impacts at all.
    return (wrong == 0.0) & (d > 0.0) & (absolute(dz) <= kHeightTolerance * d) & (in[kRadius] > 1e-100) &
           (in[kMass] > 0.0) & (in[kMuS1] >= 0.0) & (in[kMuS2] >= 0.0) & (in[kMuB] > 0.0) &
           (in[kMuS1] <= kLargestFriction) & (in[kMuS2] <= kLargestFriction) &
           (in[kMuB] <= kLargestFriction) & (in[kEB] >= 0.0) & (in[kEB] <= 1.0) & (approach > 1e-100) &
           (scale < 1e100) & (approach > 1e-12 * scale);
}

// As Problem: impacts in canonical form, scaled by the approach speed.
struct WidePose {
    WideFrame f;
    WideModel m;
    WideStart start;
    Wide n;                      // approach speed
    WideMask second, from_rest;  // ball 2 is pressed on the cloth; the cloth slip is zero
    WideMask good;               // an impact with slip between the balls
};

// As enter_frame() and pose().
CAROM_INLINE void wide_pose(const Wide (&in)[kInputs], ClothSlip cloth_slip, double tolerance, WidePose& q) {
    const WideMask entered = wide_enter(in, q.f);
    const WideFrame& f = q.f;
    const Wide R = in[kRadius], n = f.y1 - f.y2, scale = 1.0 / n;
    const Wide x = f.x1 - f.x2 - R * (f.wz1 + f.wz2), z = R * (f.wx1 + f.wx2);
    const WideMask second = z < 0.0;
    const bool published = cloth_slip == ClothSlip::kAsPublished;
    const Wide vx = select(second, f.x2, -f.x1), vy = select(second, f.y2, -f.y1);
    const Wide wx = R * select(second, f.wx2, -f.wx1), wy = R * select(second, f.wy2, -f.wy1);
    const Wide a = published ? vx + wy : vx - wy, b = published ? vy - wx : vy + wx;
    const Wide noise = kSlipNoise * ((absolute(vx) + absolute(wy)) + (absolute(vy) + absolute(wx)));
    const Wide slight = select(noise > (0.01 * tolerance) * n, noise, (0.01 * tolerance) * n);
    q.from_rest = a * a + b * b <= slight * slight;
    q.m.mu_b = in[kMuB];
    q.m.mu_s = select(second, in[kMuS2], in[kMuS1]);
    q.m.e_b = in[kEB];
    q.m.sigma = published ? 2.5 : -2.5;
    q.m.kappa = published ? -1.5 : 3.5;
    q.start.x = x * scale;
    q.start.z = absolute(z) * scale;
    q.start.a = select(q.from_rest, broadcast<kWidth>(0.0), a * scale);
    q.start.b = select(q.from_rest, broadcast<kWidth>(0.0), b * scale);
    q.n = n;
    q.second = second;
    q.good = entered & (q.start.z > 0.0);
}

// As apply() and leave_frame().
CAROM_INLINE void wide_apply(const Wide (&in)[kInputs], const WidePose& q, const WideResult& t,
                             BlockResult& block) {
    const WideFrame& f = q.f;
    const Wide n = q.n, R = in[kRadius];
    const WideMask second = q.second;
    const Wide p = n * t.p, xi = n * t.xi, down = n * t.zeta, zeta = select(second, down, -down);
    const Wide g_a = n * t.g_a, g_b = n * t.g_b, spin = 2.5 / R, none = {};
    const Wide on_a1 = select(second, none, g_a), on_b1 = select(second, none, g_b);
    const Wide on_a2 = select(second, -g_a, none), on_b2 = select(second, -g_b, none);
    const Wide x1 = f.x1 + (on_a1 - xi), y1 = f.y1 + (on_b1 - p), x2 = f.x2 + (on_a2 + xi),
               y2 = f.y2 + (on_b2 + p);
    const Wide wx1 = f.wx1 + spin * (zeta + on_b1), wy1 = f.wy1 - spin * on_a1, wz1 = f.wz1 + spin * xi;
    const Wide wx2 = f.wx2 + spin * (zeta + on_b2), wy2 = f.wy2 - spin * on_a2, wz2 = f.wz2 + spin * xi;
    block.out[kOutV1] = x1 * f.yy + y1 * f.yx;
    block.out[kOutV1 + 1] = y1 * f.yy - x1 * f.yx;
    block.out[kOutV1 + 2] = in[kV1 + 2];
    block.out[kOutW1] = wx1 * f.yy + wy1 * f.yx;
    block.out[kOutW1 + 1] = wy1 * f.yy - wx1 * f.yx;
    block.out[kOutW1 + 2] = wz1;
    block.out[kOutV2] = x2 * f.yy + y2 * f.yx;
    block.out[kOutV2 + 1] = y2 * f.yy - x2 * f.yx;
    block.out[kOutV2 + 2] = in[kV2 + 2];
    block.out[kOutW2] = wx2 * f.yy + wy2 * f.yx;
    block.out[kOutW2 + 1] = wy2 * f.yy - wx2 * f.yx;
    block.out[kOutW2 + 2] = wz2;
}

// As solve(), for impacts that one collocation of N nodes solves.
template <int N>
CAROM_INLINE void solve_block(const Wide (&in)[kInputs], ClothSlip cloth_slip, double tolerance,
                              BlockResult& block) {
    WidePose q;
    wide_pose(in, cloth_slip, tolerance, q);
    const WideModel& m = q.m;
    const WideStart& start = q.start;
    const bool published = cloth_slip == ClothSlip::kAsPublished;
    const Wide guess = 0.5 * (1.0 + m.e_b);
    const Wide s = square_root(start.x * start.x + start.z * start.z), root_s = 1.0 / s;
    const Wide cx = start.x * root_s, cz = start.z * root_s;
    const Wide fall = m.mu_b * ((7.0 * cx * cx + 5.0 * cz * cz) + 2.7 * (m.mu_s * cz));
    const Wide two = broadcast<kWidth>(2.0);
    const Wide axes_s = 4.0 * s / (fall * guess) - 2.0;
    const Wide a1 = start.a + guess * (m.mu_b * cx), b1 = start.b + guess * (1.0 - m.sigma * (m.mu_b * cz));
    const Wide u0 = square_root(start.a * start.a + start.b * start.b), u1 = square_root(a1 * a1 + b1 * b1);
    const Wide bend = guess * ((published ? 1.5 : 3.5) * (m.mu_s * m.mu_b));
    const Wide beside = 2.0 * ((u0 + u1) - bend) / (guess * (1.0 + 2.5 * m.mu_b));
    const Wide axes_u = select(q.from_rest, broadcast<kWidth>(kFarAway), beside);
    const Powers<Wide> rho_s = powers(select(axes_s > two, axes_s, two)),
                       rho_u = powers(select(axes_u > two, axes_u, two));
    block.resolvable = q.good & eight_will_do(rho_s, rho_u, m.mu_b, m.mu_s, tolerance);
    const WideMask four = q.good & four_will_do(rho_s, rho_u, m.mu_b, m.mu_s, tolerance);
    const WideMask wanted = N == 4 ? four : block.resolvable;

    WideResult t = {};
    wide_collocate<N>(m, start, wanted, root_s, tolerance, t);
    block.hardness = fall * root_s;
    block.good = q.good;
    block.done = t.converged;
    block.sweeps = t.sweeps;
    wide_apply(in, q, t, block);
}

// Writes lane `from` of a block as result i of the batch.
CAROM_INLINE void write_lane(const BatchView& v, const BlockResult& block, int from, std::int64_t i,
                             ToleranceMethod method) {
    for (int k = 0; k < kOutputs; ++k) v.out[k][i] = lane(block.out[k], from);
    v.status[i] = ImpactStatus::kOk;
    if (v.steps != nullptr) v.steps[i] = static_cast<std::int64_t>(lane(block.sweeps, from));
    if (v.method != nullptr) v.method[i] = method;
}

// Loads the impacts index[0], ..., index[lanes - 1]; the first one fills the remaining lanes.
CAROM_INLINE void gather(const BatchView& v, const std::int64_t* index, int lanes, Wide (&in)[kInputs]) {
    std::int64_t from[kWidth];
    for (int i = 0; i < kWidth; ++i) from[i] = index[i < lanes ? i : 0];
    for (int k = 0; k < kInputs; ++k) {
        for (int i = 0; i < kWidth; ++i) set_lane(in[k], i, v.in[k][from[i]]);
    }
}

}  // namespace
}  // namespace carom::kernel
