// The lanes of a batch by tolerance: the arrays of a batch in one row, impacts loaded into lanes and posed
// there, solved by one collocation, and written back. tolerance_batch_impl.h says which impacts go this way.
#pragma once

#include "carom/kernel/batch.h"
#include "tolerance/impl.h"
#include "tolerance/wide.h"

namespace carom::kernel {
namespace {

// The arrays of a batch in one row, so that lanes can be copied without a formula for each.
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
constexpr int kOutputs = 12;

struct BatchView {
    const double* in[kInputs];
    double* out[kOutputs];
    ImpactStatus* status;
    long* steps;
    ToleranceMethod* method;
    ClothSlip cloth_slip;
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
        v.out[k] = result.ball1.v[k];
        v.out[3 + k] = result.ball1.w[k];
        v.out[6 + k] = result.ball2.v[k];
        v.out[9 + k] = result.ball2.w[k];
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
    return v;
}

// What a block of lanes leaves: results, and which lanes have one or are worth a try with more nodes.
struct BlockResult {
    Wide out[kOutputs];
    Wide sweeps;
    WideMask good, done, resolvable;
};

struct WideFrame {
    Wide yx, yy, x1, y1, wx1, wy1, wz1, x2, y2, wx2, wy2, wz2;
};

// enter_frame in lanes; a lane that it would turn away is not in the mask.
CAROM_INLINE WideMask wide_enter(const Wide (&in)[kInputs], WideFrame& f) {
    Wide wrong = {};
    // 0, or a NaN where an input is not finite.
    for (int i = 0; i < kInputs; ++i) wrong += in[i] - in[i];  // NOLINT(misc-redundant-expression): see above
    const Wide dx = in[kR2] - in[kR1], dy = in[kR2 + 1] - in[kR1 + 1], dz = in[kR2 + 2] - in[kR1 + 2];
    const Wide d = wide_root(dx * dx + dy * dy);
    f.yx = dx / d;
    f.yy = dy / d;
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
        ((magnitude(f.x1) + magnitude(f.y1)) + (magnitude(f.x2) + magnitude(f.y2))) +
        in[kRadius] * ((magnitude(f.wx1) + magnitude(f.wy1)) + (magnitude(f.wz1) + magnitude(f.wx2)) +
                       (magnitude(f.wy2) + magnitude(f.wz2)));
    // Lanes of an extreme range of speeds go to the single kernel, which knows where an impact ends to be one.
    return (wrong == 0.0) & (d > 0.0) & (magnitude(dz) <= kHeightTolerance * d) & (in[kRadius] > 1e-100) &
           (in[kMass] > 0.0) & (in[kMuS1] >= 0.0) & (in[kMuS2] >= 0.0) & (in[kMuB] > 0.0) &
           (in[kMuS1] <= kLargestFriction) & (in[kMuS2] <= kLargestFriction) &
           (in[kMuB] <= kLargestFriction) & (in[kEB] >= 0.0) & (in[kEB] <= 1.0) & (approach > 1e-100) &
           (scale < 1e100) & (approach > 1e-12 * scale);
}

CAROM_INLINE Wide wide_ellipse(Wide sum_of_axes) {
    const Wide S = choose(sum_of_axes > 2.0, sum_of_axes, wide(2.0));
    return 0.5 * (S + wide_root(S * S - 4.0));
}

// Impacts in their canonical form, scaled by the approach speed.
struct WidePose {
    WideFrame f;
    WideModel m;
    WideStart start;
    Wide n;                      // approach speed
    WideMask second, from_rest;  // ball 2 is pressed on the cloth; its cloth slip is zero
    WideMask good;               // an impact between balls with slip between them
};

// As enter_frame and pose().
CAROM_INLINE void wide_pose(const Wide (&in)[kInputs], ClothSlip cloth_slip, double tolerance, WidePose& q) {
    const WideMask entered = wide_enter(in, q.f);
    const WideFrame& f = q.f;
    const Wide R = in[kRadius], n = f.y1 - f.y2, scale = 1.0 / n;
    const Wide x = f.x1 - f.x2 - R * (f.wz1 + f.wz2), z = R * (f.wx1 + f.wx2);
    const WideMask second = z < 0.0;
    const bool published = cloth_slip == ClothSlip::kAsPublished;
    const Wide vx = choose(second, f.x2, -f.x1), vy = choose(second, f.y2, -f.y1);
    const Wide wx = R * choose(second, f.wx2, -f.wx1), wy = R * choose(second, f.wy2, -f.wy1);
    const Wide a = published ? vx + wy : vx - wy, b = published ? vy - wx : vy + wx;
    const Wide noise = kSlipNoise * ((magnitude(vx) + magnitude(wy)) + (magnitude(vy) + magnitude(wx)));
    const Wide slight = choose(noise > (0.01 * tolerance) * n, noise, (0.01 * tolerance) * n);
    q.from_rest = a * a + b * b <= slight * slight;
    q.m.mu_b = in[kMuB];
    q.m.mu_s = choose(second, in[kMuS2], in[kMuS1]);
    q.m.e_b = in[kEB];
    q.m.sigma = published ? 2.5 : -2.5;
    q.m.kappa = published ? -1.5 : 3.5;
    q.start.x = x * scale;
    q.start.z = magnitude(z) * scale;
    q.start.a = choose(q.from_rest, wide(0.0), a * scale);
    q.start.b = choose(q.from_rest, wide(0.0), b * scale);
    q.n = n;
    q.second = second;
    q.good = entered & (q.start.z > 0.0);
}

// As apply() and leave_frame.
CAROM_INLINE void wide_apply(const Wide (&in)[kInputs], const WidePose& q, const WideResult& t,
                             BlockResult& block) {
    const WideFrame& f = q.f;
    const Wide n = q.n, R = in[kRadius];
    const WideMask second = q.second;
    const Wide p = n * t.p, xi = n * t.xi, down = n * t.zeta, zeta = choose(second, down, -down);
    const Wide g_a = n * t.g_a, g_b = n * t.g_b, spin = 2.5 / R, none = {};
    const Wide on_a1 = choose(second, none, g_a), on_b1 = choose(second, none, g_b);
    const Wide on_a2 = choose(second, -g_a, none), on_b2 = choose(second, -g_b, none);
    const Wide x1 = f.x1 + (on_a1 - xi), y1 = f.y1 + (on_b1 - p), x2 = f.x2 + (on_a2 + xi),
               y2 = f.y2 + (on_b2 + p);
    const Wide wx1 = f.wx1 + spin * (zeta + on_b1), wy1 = f.wy1 - spin * on_a1, wz1 = f.wz1 + spin * xi;
    const Wide wx2 = f.wx2 + spin * (zeta + on_b2), wy2 = f.wy2 - spin * on_a2, wz2 = f.wz2 + spin * xi;
    block.out[0] = x1 * f.yy + y1 * f.yx;
    block.out[1] = y1 * f.yy - x1 * f.yx;
    block.out[2] = in[kV1 + 2];
    block.out[3] = wx1 * f.yy + wy1 * f.yx;
    block.out[4] = wy1 * f.yy - wx1 * f.yx;
    block.out[5] = wz1;
    block.out[6] = x2 * f.yy + y2 * f.yx;
    block.out[7] = y2 * f.yy - x2 * f.yx;
    block.out[8] = in[kV2 + 2];
    block.out[9] = wx2 * f.yy + wy2 * f.yx;
    block.out[10] = wy2 * f.yy - wx2 * f.yx;
    block.out[11] = wz2;
}

// The guards of solve(), and the collocation, in lanes.
template <int N>
CAROM_INLINE void solve_block(const Wide (&in)[kInputs], ClothSlip cloth_slip, double tolerance,
                              BlockResult& block) {
    WidePose q;
    wide_pose(in, cloth_slip, tolerance, q);
    const WideModel& m = q.m;
    const WideStart& start = q.start;
    const bool published = cloth_slip == ClothSlip::kAsPublished;
    const Wide guess = 0.5 * (1.0 + m.e_b);
    const Wide s = wide_root(start.x * start.x + start.z * start.z), cx = start.x / s, cz = start.z / s;
    const Wide fall = m.mu_b * ((7.0 * cx * cx + 5.0 * cz * cz) + 2.7 * (m.mu_s * cz));
    const Wide rho_s = wide_ellipse(4.0 * s / (fall * guess) - 2.0);
    const Wide a1 = start.a + guess * (m.mu_b * cx), b1 = start.b + guess * (1.0 - m.sigma * (m.mu_b * cz));
    const Wide u0 = wide_root(start.a * start.a + start.b * start.b), u1 = wide_root(a1 * a1 + b1 * b1);
    const Wide bend = guess * ((published ? 1.5 : 3.5) * (m.mu_s * m.mu_b));
    const Wide beside = wide_ellipse(2.0 * ((u0 + u1) - bend) / (guess * (1.0 + 2.5 * m.mu_b)));
    const Wide rho_u = choose(q.from_rest, wide(1e30), beside);
    const Wide s2 = rho_s * rho_s, u2 = rho_u * rho_u, s4 = s2 * s2, u4 = u2 * u2;
    const Wide size_s = kSizeS * m.mu_b, size_u = kSizeU * (m.mu_b * m.mu_s);
    block.resolvable =
        q.good & (tolerance * (s4 * s4 * s4) >= size_s) & (tolerance * (u4 * u4 * u2) >= 0.5 * size_u);
    const WideMask four = q.good & (tolerance * (s4 * s2) >= size_s) & (tolerance * (u4 * rho_u) >= size_u);
    const WideMask wanted = N == 4 ? four : block.resolvable;

    WideResult t = {};
    wide_collocate<N>(m, start, wanted, tolerance, t);
    block.good = q.good;
    block.done = t.converged;
    block.sweeps = t.sweeps;
    wide_apply(in, q, t, block);
}

CAROM_INLINE void write_lane(const BatchView& v, const BlockResult& block, int lane, long i,
                             ToleranceMethod method) {
    for (int k = 0; k < kOutputs; ++k) v.out[k][i] = block.out[k][lane];
    v.status[i] = ImpactStatus::kOk;
    if (v.steps != nullptr) v.steps[i] = static_cast<long>(block.sweeps[lane]);
    if (v.method != nullptr) v.method[i] = method;
}

CAROM_INLINE void gather(const BatchView& v, const long* index, int lanes, Wide (&in)[kInputs]) {
    long from[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) from[lane] = index[lane < lanes ? lane : 0];
    for (int k = 0; k < kInputs; ++k) {
        for (int lane = 0; lane < kWidth; ++lane) in[k][lane] = v.in[k][from[lane]];
    }
}

}  // namespace
}  // namespace carom::kernel
