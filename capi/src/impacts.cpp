// The C interface: impacts.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/kernel/tolerance.h"
#include "guard.h"

using namespace carom::c;
using namespace carom::kernel;

namespace {

/// [-] Impacts that are transposed and solved together; their data fit into the first-level cache.
constexpr std::size_t kBlock = 64;

void check_tolerance(double tolerance) {
    if (tolerance >= kTightestTolerance && tolerance <= kLoosestTolerance) return;
    throw BadArgument("tolerance: expected a number from 1e-13 to 1e-1");
}

Ball ball_of(const double* rvw) {
    Ball ball{};
    std::copy_n(rvw, 3, ball.r);
    std::copy_n(rvw + 3, 3, ball.v);
    std::copy_n(rvw + 6, 3, ball.w);
    return ball;
}

ImpactParams params_of(const carom_impact_params& p) {
    return {p.R, p.m, p.mu_s1, p.mu_s2, p.mu_b, p.e_b, ClothSlip::kConsistent};
}

bool computed(ImpactStatus status) {
    return status == ImpactStatus::kOk || status == ImpactStatus::kNotApproaching;
}

/// One value of every impact in a block.
using Lane = std::array<double, kBlock>;

/// One ball of every impact in a block: r, v, w.
struct BallBlock {
    std::array<Lane, 9> lanes;

    void load(const double* rvw, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 9; ++k) lanes[k][i] = rvw[9 * i + k];
    }
    BallLanes read() const {
        const auto at = [this](std::size_t k) { return lanes[k].data(); };
        return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
    }
};

struct VelocityBlock {
    std::array<Lane, 6> lanes;

    VelocityLanes write() {
        const auto at = [this](std::size_t k) { return lanes[k].data(); };
        return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
    }
    void store(double* rvw, const double* in, std::size_t count) const {
        for (std::size_t i = 0; i < count; ++i) {
            std::copy_n(in + 9 * i, 3, rvw + 9 * i);
            for (std::size_t k = 0; k < 6; ++k) rvw[9 * i + 3 + k] = lanes[k][i];
        }
    }
};

struct ParamBlock {
    std::array<Lane, 6> lanes;

    void load(const carom_impact_params* params, std::size_t count, std::size_t stride) {
        for (std::size_t i = 0; i < count; ++i) {
            const carom_impact_params& p = params[i * stride];
            const double values[] = {p.R, p.m, p.mu_s1, p.mu_s2, p.mu_b, p.e_b};
            for (std::size_t k = 0; k < 6; ++k) lanes[k][i] = values[k];
        }
    }
    ParamLanes read() const {
        const auto at = [this](std::size_t k) { return lanes[k].data(); };
        return {at(0), at(1), at(2), at(3), at(4), at(5), ClothSlip::kConsistent};
    }
};

}  // namespace

carom_status carom_collide_balls(const double in1[9], const double in2[9], const carom_impact_params* params,
                                 double tolerance, double out1[9], double out2[9]) {
    return guarded([&] {
        need({in1, in2, params, out1, out2});
        check_tolerance(tolerance);
        ImpactResult result{};
        tolerance_function(chosen_isa())(ball_of(in1), ball_of(in2), params_of(*params), tolerance, result);
        const std::array<double, 3> r1{in1[0], in1[1], in1[2]}, r2{in2[0], in2[1], in2[2]};
        std::copy_n(r1.data(), 3, out1);
        std::copy_n(r2.data(), 3, out2);
        std::copy_n(result.v1, 3, out1 + 3);
        std::copy_n(result.w1, 3, out1 + 6);
        std::copy_n(result.v2, 3, out2 + 3);
        std::copy_n(result.w2, 3, out2 + 6);
        if (!computed(result.status)) throw BadArgument(describe(result.status));
    });
}

carom_status carom_collide_balls_batch(size_t count, const double* in1, const double* in2,
                                       const carom_impact_params* params, size_t params_count,
                                       double tolerance, double* out1, double* out2, int32_t* status) {
    return guarded([&] {
        if (count == 0) return;
        need({in1, in2, params, out1, out2});
        check_tolerance(tolerance);
        if (params_count != 1 && params_count != count)
            throw BadArgument("params_count: expected 1 or the number of impacts");
        const std::size_t stride = params_count == 1 ? 0 : 1;
        const ToleranceBatchFunction solve = tolerance_batch_function(chosen_isa());
        BallBlock ball1, ball2;
        VelocityBlock after1, after2;
        ParamBlock block_params;
        std::array<ImpactStatus, kBlock> block_status{};
        std::string wrong;
        for (std::size_t start = 0; start < count; start += kBlock) {
            const std::size_t n = std::min(kBlock, count - start);
            const double *from1 = in1 + 9 * start, *from2 = in2 + 9 * start;
            ball1.load(from1, n);
            ball2.load(from2, n);
            block_params.load(params + start * stride, n, stride);
            const ImpactBatch batch{static_cast<std::int64_t>(n), ball1.read(), ball2.read(),
                                    block_params.read()};
            solve(batch, tolerance, {after1.write(), after2.write(), block_status.data(), nullptr, nullptr});
            after1.store(out1 + 9 * start, from1, n);
            after2.store(out2 + 9 * start, from2, n);
            for (std::size_t i = 0; i < n; ++i) {
                if (status) status[start + i] = static_cast<int32_t>(block_status[i]);
                if (!computed(block_status[i]) && wrong.empty())
                    wrong = "impact " + std::to_string(start + i) + ": " + describe(block_status[i]);
            }
        }
        if (!wrong.empty()) throw BadArgument(wrong);
    });
}

static_assert(static_cast<int>(ImpactStatus::kOk) == CAROM_IMPACT_OK);
static_assert(static_cast<int>(ImpactStatus::kNotApproaching) == CAROM_IMPACT_NOT_APPROACHING);
static_assert(static_cast<int>(ImpactStatus::kBadState) == CAROM_IMPACT_BAD_STATE);
static_assert(static_cast<int>(ImpactStatus::kBadParameter) == CAROM_IMPACT_BAD_PARAMETER);
static_assert(static_cast<int>(ImpactStatus::kStepLimit) == CAROM_IMPACT_STEP_LIMIT);
