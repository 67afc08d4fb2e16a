// The table of the ladder. What a rung does stands in ladder/, one file each; ladder_<isa>.cpp builds them.
#include "ladder/ladder.h"

namespace carom::kernel {

void march_scalar(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;
void march_v3(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;
void march_v4(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;

#define CAROM_MARCH(function) \
    void function(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;
#define CAROM_BATCH(function) void function(const ImpactBatch&, int, const ImpactBatchResult&) noexcept;
namespace scalar {
CAROM_MARCH(fewer_roots)
CAROM_MARCH(rsqrt_raw)
CAROM_MARCH(rsqrt_newton)
CAROM_MARCH(branch_hints)
CAROM_MARCH(branch_order)
CAROM_MARCH(unconditional_roots)
CAROM_MARCH(masks)
CAROM_MARCH(two_stage)
CAROM_MARCH(precomputed)
CAROM_MARCH(packed_blocks)
CAROM_MARCH(simd_ssa)
CAROM_MARCH(combined)
CAROM_MARCH(reduced)
CAROM_MARCH(summed)
CAROM_BATCH(summed_batch)
}  // namespace scalar
namespace v3 {
CAROM_MARCH(fewer_roots)
CAROM_MARCH(rsqrt_raw)
CAROM_MARCH(rsqrt_newton)
CAROM_MARCH(branch_hints)
CAROM_MARCH(branch_order)
CAROM_MARCH(unconditional_roots)
CAROM_MARCH(masks)
CAROM_MARCH(two_stage)
CAROM_MARCH(precomputed)
CAROM_MARCH(explicit_fma)
CAROM_MARCH(packed_blocks)
CAROM_MARCH(simd_around)
CAROM_MARCH(simd_loop)
CAROM_MARCH(simd_ssa)
CAROM_MARCH(combined)
CAROM_MARCH(paper_flags)
CAROM_MARCH(reduced)
CAROM_MARCH(packed)
CAROM_MARCH(extrapolated_seed)
CAROM_MARCH(pipelined)
CAROM_MARCH(carried_roots)
CAROM_MARCH(decoupled_roots)
CAROM_MARCH(summed)
CAROM_BATCH(four_lanes)
CAROM_BATCH(four_lanes_fma)
CAROM_BATCH(four_lanes_rsqrt)
CAROM_BATCH(four_lanes_carried)
CAROM_BATCH(two_by_four_lanes)
CAROM_BATCH(summed_batch)
}  // namespace v3
namespace v4 {
CAROM_MARCH(fewer_roots)
CAROM_MARCH(rsqrt_raw)
CAROM_MARCH(rsqrt_newton)
CAROM_MARCH(branch_hints)
CAROM_MARCH(branch_order)
CAROM_MARCH(unconditional_roots)
CAROM_MARCH(masks)
CAROM_MARCH(two_stage)
CAROM_MARCH(precomputed)
CAROM_MARCH(explicit_fma)
CAROM_MARCH(packed_blocks)
CAROM_MARCH(simd_around)
CAROM_MARCH(simd_loop)
CAROM_MARCH(simd_ssa)
CAROM_MARCH(combined)
CAROM_MARCH(paper_flags)
CAROM_MARCH(reduced)
CAROM_MARCH(packed)
CAROM_MARCH(extrapolated_seed)
CAROM_MARCH(pipelined)
CAROM_MARCH(carried_roots)
CAROM_MARCH(decoupled_roots)
CAROM_MARCH(summed)
CAROM_BATCH(four_lanes)
CAROM_BATCH(four_lanes_fma)
CAROM_BATCH(four_lanes_rsqrt)
CAROM_BATCH(four_lanes_carried)
CAROM_BATCH(two_by_four_lanes)
CAROM_BATCH(eight_lanes)
CAROM_BATCH(two_by_eight_lanes)
CAROM_BATCH(summed_batch)
}  // namespace v4
#undef CAROM_MARCH
#undef CAROM_BATCH

namespace {

constexpr Rung kLadder[] = {
    {"baseline", "3.1", Isa::kScalar, march_scalar, nullptr, true, 0.0, 0.0,
     "the published march in double, equation by equation"},
    {"baseline", "3.1", Isa::kV3, march_v3, nullptr, true, 0.0, 0.0,
     "the published march in double, equation by equation"},
    {"baseline", "3.1", Isa::kV4, march_v4, nullptr, true, 0.0, 0.0,
     "the published march in double, equation by equation"},
    {"fewer square roots", "3.2", Isa::kScalar, scalar::fewer_roots, nullptr, true, 1e-14, 1e-09,
     "cutoffs tested on squares, no root where its friction is zero"},
    {"fewer square roots", "3.2", Isa::kV3, v3::fewer_roots, nullptr, true, 1e-14, 1e-09,
     "cutoffs tested on squares, no root where its friction is zero"},
    {"fewer square roots", "3.2", Isa::kV4, v4::fewer_roots, nullptr, true, 1e-14, 1e-09,
     "cutoffs tested on squares, no root where its friction is zero"},
    {"rsqrt", "3.2", Isa::kScalar, scalar::rsqrt_raw, nullptr, false, 1e-04, 1e-03,
     "rsqrtss as it comes, 12 bits: the loss that motivates the refinement"},
    {"rsqrt", "3.2", Isa::kV3, v3::rsqrt_raw, nullptr, false, 1e-04, 1e-03,
     "rsqrtss as it comes, 12 bits: the loss that motivates the refinement"},
    {"rsqrt", "3.2", Isa::kV4, v4::rsqrt_raw, nullptr, false, 1e-04, 1e-03,
     "rsqrtss as it comes, 12 bits: the loss that motivates the refinement"},
    {"rsqrt newton", "3.2", Isa::kScalar, scalar::rsqrt_newton, nullptr, false, 1e-14, 1e-09,
     "rsqrtss and two Newton steps"},
    {"rsqrt newton", "3.2", Isa::kV3, v3::rsqrt_newton, nullptr, false, 1e-14, 1e-09,
     "rsqrtss and two Newton steps"},
    {"rsqrt newton", "3.2", Isa::kV4, v4::rsqrt_newton, nullptr, false, 1e-14, 1e-09,
     "rsqrtss and two Newton steps"},
    {"branch hints", "3.3", Isa::kScalar, scalar::branch_hints, nullptr, true, 0.0, 0.0,
     "[[likely]] on slip and cloth slip"},
    {"branch hints", "3.3", Isa::kV3, v3::branch_hints, nullptr, true, 0.0, 0.0,
     "[[likely]] on slip and cloth slip"},
    {"branch hints", "3.3", Isa::kV4, v4::branch_hints, nullptr, true, 0.0, 0.0,
     "[[likely]] on slip and cloth slip"},
    {"branch order", "3.3", Isa::kScalar, scalar::branch_order, nullptr, true, 0.0, 0.0,
     "the pressed ball is asked for first, the exceptions last"},
    {"branch order", "3.3", Isa::kV3, v3::branch_order, nullptr, true, 0.0, 0.0,
     "the pressed ball is asked for first, the exceptions last"},
    {"branch order", "3.3", Isa::kV4, v4::branch_order, nullptr, true, 0.0, 0.0,
     "the pressed ball is asked for first, the exceptions last"},
    {"unconditional roots", "3.3", Isa::kScalar, scalar::unconditional_roots, nullptr, true, 1e-14, 1e-09,
     "inverted branches: all roots before any question"},
    {"unconditional roots", "3.3", Isa::kV3, v3::unconditional_roots, nullptr, true, 1e-14, 1e-09,
     "inverted branches: all roots before any question"},
    {"unconditional roots", "3.3", Isa::kV4, v4::unconditional_roots, nullptr, true, 1e-14, 1e-09,
     "inverted branches: all roots before any question"},
    {"masks", "3.3", Isa::kScalar, scalar::masks, nullptr, true, 1e-14, 1e-09,
     "bit masks instead of branches"},
    {"masks", "3.3", Isa::kV3, v3::masks, nullptr, true, 1e-14, 1e-09, "bit masks instead of branches"},
    {"masks", "3.3", Isa::kV4, v4::masks, nullptr, true, 1e-14, 1e-09, "bit masks instead of branches"},
    {"two stages", "3.3", Isa::kScalar, scalar::two_stage, nullptr, true, 0.0, 0.0,
     "compression and restitution in loops of their own"},
    {"two stages", "3.3", Isa::kV3, v3::two_stage, nullptr, true, 0.0, 0.0,
     "compression and restitution in loops of their own"},
    {"two stages", "3.3", Isa::kV4, v4::two_stage, nullptr, true, 0.0, 0.0,
     "compression and restitution in loops of their own"},
    {"precomputed", "3.4", Isa::kScalar, scalar::precomputed, nullptr, true, 1e-12, 1e-09,
     "spins as speeds, impulses per mass, products of constants once"},
    {"precomputed", "3.4", Isa::kV3, v3::precomputed, nullptr, true, 1e-12, 1e-09,
     "spins as speeds, impulses per mass, products of constants once"},
    {"precomputed", "3.4", Isa::kV4, v4::precomputed, nullptr, true, 1e-12, 1e-09,
     "spins as speeds, impulses per mass, products of constants once"},
    {"fma", "3.4", Isa::kV3, v3::explicit_fma, nullptr, false, 1e-14, 1e-09,
     "fused multiply-add where the step has product and sum"},
    {"fma", "3.4", Isa::kV4, v4::explicit_fma, nullptr, false, 1e-14, 1e-09,
     "fused multiply-add where the step has product and sum"},
    {"packed blocks", "3.5", Isa::kScalar, scalar::packed_blocks, nullptr, true, 1e-12, 1e-09,
     "register relief: pairs (ball 1, ball 2) in scoped blocks"},
    {"packed blocks", "3.5", Isa::kV3, v3::packed_blocks, nullptr, true, 1e-12, 1e-09,
     "register relief: pairs (ball 1, ball 2) in scoped blocks"},
    {"packed blocks", "3.5", Isa::kV4, v4::packed_blocks, nullptr, true, 1e-12, 1e-09,
     "register relief: pairs (ball 1, ball 2) in scoped blocks"},
    {"simd around", "3.7", Isa::kV3, v3::simd_around, nullptr, false, 0.0, 0.0,
     "SIMD for the frame, the scalar loop inside"},
    {"simd around", "3.7", Isa::kV4, v4::simd_around, nullptr, false, 0.0, 0.0,
     "SIMD for the frame, the scalar loop inside"},
    {"simd loop", "3.7", Isa::kV3, v3::simd_loop, nullptr, false, 1e-14, 1e-09,
     "one register a vector, the whole loop"},
    {"simd loop", "3.7", Isa::kV4, v4::simd_loop, nullptr, false, 1e-14, 1e-09,
     "one register a vector, the whole loop"},
    {"simd ssa", "3.7", Isa::kScalar, scalar::simd_ssa, nullptr, true, 1e-12, 1e-09,
     "pairs, both sides computed, every value assigned once"},
    {"simd ssa", "3.7", Isa::kV3, v3::simd_ssa, nullptr, true, 1e-12, 1e-09,
     "pairs, both sides computed, every value assigned once"},
    {"simd ssa", "3.7", Isa::kV4, v4::simd_ssa, nullptr, true, 1e-12, 1e-09,
     "pairs, both sides computed, every value assigned once"},
    {"combined", "4", Isa::kScalar, scalar::combined, nullptr, false, 1e-12, 1e-09,
     "the paper's best: rsqrt, no waiting branch, two stages, precomputed"},
    {"combined", "4", Isa::kV3, v3::combined, nullptr, false, 1e-12, 1e-09,
     "the paper's best: rsqrt, no waiting branch, two stages, precomputed"},
    {"combined", "4", Isa::kV4, v4::combined, nullptr, false, 1e-12, 1e-09,
     "the paper's best: rsqrt, no waiting branch, two stages, precomputed"},
    {"paper flags", "4", Isa::kV3, v3::paper_flags, nullptr, false, 1e-12, 1e-09,
     "the baseline's loop under -Ofast -march=znver3"},
    {"paper flags", "4", Isa::kV4, v4::paper_flags, nullptr, false, 1e-12, 1e-09,
     "the baseline's loop under -Ofast -march=znver3"},
    {"reduced state", "past it", Isa::kScalar, scalar::reduced, nullptr, true, 1e-12, 1e-09,
     "six numbers and linear invariants instead of ten velocities"},
    {"reduced state", "past it", Isa::kV3, v3::reduced, nullptr, true, 1e-12, 1e-09,
     "six numbers and linear invariants instead of ten velocities"},
    {"reduced state", "past it", Isa::kV4, v4::reduced, nullptr, true, 1e-12, 1e-09,
     "six numbers and linear invariants instead of ten velocities"},
    {"packed", "past it", Isa::kV3, v3::packed, nullptr, false, 1e-12, 1e-08,
     "the reduced state in one register, sqrt and division"},
    {"packed", "past it", Isa::kV4, v4::packed, nullptr, false, 1e-12, 1e-08,
     "the reduced state in one register, sqrt and division"},
    {"extrapolated seed", "past it", Isa::kV3, v3::extrapolated_seed, nullptr, false, 1e-12, 1e-08,
     "reciprocal lengths extrapolated linearly and refined: no root"},
    {"extrapolated seed", "past it", Isa::kV4, v4::extrapolated_seed, nullptr, false, 1e-12, 1e-08,
     "reciprocal lengths extrapolated linearly and refined: no root"},
    {"pipelined", "past it", Isa::kV3, v3::pipelined, nullptr, false, 1e-12, 1e-08,
     "extrapolated to fourth order, used at once, corrected late"},
    {"pipelined", "past it", Isa::kV4, v4::pipelined, nullptr, false, 1e-12, 1e-08,
     "extrapolated to fourth order, used at once, corrected late"},
    {"carried roots", "past it", Isa::kV3, v3::carried_roots, nullptr, false, 1e-12, 1e-08,
     "the same from values a step older"},
    {"carried roots", "past it", Isa::kV4, v4::carried_roots, nullptr, false, 1e-12, 1e-08,
     "the same from values a step older"},
    {"decoupled roots", "past it", Isa::kV3, v3::decoupled_roots, nullptr, false, 1e-11, 1e-07,
     "extrapolated roots used as they are, their errors made good two steps later"},
    {"decoupled roots", "past it", Isa::kV4, v4::decoupled_roots, nullptr, false, 1e-11, 1e-07,
     "extrapolated roots used as they are, their errors made good two steps later"},
    {"summed", "past it", Isa::kScalar, scalar::summed, nullptr, true, 1e-11, 1e-09,
     "the Euler sequence summed exactly over blocks of up to 1024 steps"},
    {"summed", "past it", Isa::kV3, v3::summed, nullptr, true, 1e-11, 1e-09,
     "the Euler sequence summed exactly over blocks of up to 1024 steps"},
    {"summed", "past it", Isa::kV4, v4::summed, nullptr, true, 1e-11, 1e-09,
     "the Euler sequence summed exactly over blocks of up to 1024 steps"},
    {"four lanes", "3.8", Isa::kV3, nullptr, v3::four_lanes, false, 1e-11, 5e-09,
     "four impacts in lanes, sqrt and division"},
    {"four lanes", "3.8", Isa::kV4, nullptr, v4::four_lanes, false, 1e-11, 5e-09,
     "four impacts in lanes, sqrt and division"},
    {"four lanes fma", "3.8", Isa::kV3, nullptr, v3::four_lanes_fma, false, 1e-11, 5e-09,
     "with fused multiply-add"},
    {"four lanes fma", "3.8", Isa::kV4, nullptr, v4::four_lanes_fma, false, 1e-11, 5e-09,
     "with fused multiply-add"},
    {"four lanes rsqrt", "3.8", Isa::kV3, nullptr, v3::four_lanes_rsqrt, false, 1e-11, 5e-09,
     "with rsqrt and Newton"},
    {"four lanes rsqrt", "3.8", Isa::kV4, nullptr, v4::four_lanes_rsqrt, false, 1e-11, 5e-09,
     "with rsqrt and Newton"},
    {"four lanes carried", "past it", Isa::kV3, nullptr, v3::four_lanes_carried, false, 1e-11, 5e-09,
     "with carried reciprocal roots"},
    {"four lanes carried", "past it", Isa::kV4, nullptr, v4::four_lanes_carried, false, 1e-11, 5e-09,
     "with carried reciprocal roots"},
    {"2x4 lanes", "past it", Isa::kV3, nullptr, v3::two_by_four_lanes, false, 1e-11, 5e-09,
     "two vectors of four interleaved, carried roots"},
    {"2x4 lanes", "past it", Isa::kV4, nullptr, v4::two_by_four_lanes, false, 1e-11, 5e-09,
     "two vectors of four interleaved, carried roots"},
    {"8 lanes", "past it", Isa::kV4, nullptr, v4::eight_lanes, false, 1e-11, 5e-09,
     "eight lanes, carried roots"},
    {"2x8 lanes", "past it", Isa::kV4, nullptr, v4::two_by_eight_lanes, false, 1e-11, 5e-09,
     "two vectors of eight, carried roots"},
    {"summed batch", "past it", Isa::kScalar, nullptr, scalar::summed_batch, true, 1e-11, 1e-10,
     "collide_balls_batch: the summed march, or the published arithmetic in lanes where rounding decides"},
    {"summed batch", "past it", Isa::kV3, nullptr, v3::summed_batch, true, 1e-11, 1e-10,
     "collide_balls_batch: the summed march, or the published arithmetic in lanes where rounding decides"},
    {"summed batch", "past it", Isa::kV4, nullptr, v4::summed_batch, true, 1e-11, 1e-10,
     "collide_balls_batch: the summed march, or the published arithmetic in lanes where rounding decides"},
};

}  // namespace

std::span<const Rung> ladder() noexcept {
    return kLadder;
}

void collide_balls_batch(Isa isa, const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return scalar::summed_batch(batch, n, result);
        case Isa::kV3:
            return v3::summed_batch(batch, n, result);
        case Isa::kV4:
            return v4::summed_batch(batch, n, result);
    }
}

}  // namespace carom::kernel
