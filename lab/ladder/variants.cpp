// The list of kernel variants for one instruction set, in the paper's order. Built once per instruction set.
#include "ladder/variants.h"

#include "kernel_set.h"
#include "ladder/branch_hints.h"
#include "ladder/branch_order.h"
#include "ladder/fewer_roots.h"
#include "ladder/masks.h"
#include "ladder/precomputed.h"
#include "ladder/reduced.h"
#include "ladder/summed_batch.h"
#include "ladder/unconditional_roots.h"
#ifdef __x86_64__
#include "ladder/combined.h"
#include "ladder/packed_blocks.h"
#include "ladder/rsqrt.h"
#include "ladder/simd_ssa.h"
#endif
#ifdef __AVX2__
#include "ladder/batch_driver.h"
#include "ladder/decoupled.h"
#include "ladder/explicit_fma.h"
#include "ladder/packed_march.h"
#include "ladder/paper_flags.h"
#include "ladder/simd_loop.h"
#include "ladder/simd_outside.h"
#endif

namespace carom::kernel::CAROM_ISA_NAMESPACE {
namespace {

// In its own function, gcc 12 keeps a loop's state in registers; listed directly, it is 8 to 17 % slower.
template <auto kImpact>
void one(const Ball& ball1, const Ball& ball2, const ImpactParams& p, int n, ImpactResult& result) noexcept {
    kImpact(ball1, ball2, p, n, result);
}

constexpr Variant single(const char* name, const char* section, MarchFunction march, bool portable_bits,
                         double bound_five, double bound_random, const char* idea) {
    return {name, section, kIsa, march, nullptr, portable_bits, bound_five, bound_random, idea};
}

constexpr Variant batch(const char* name, const char* section, BatchFunction batch, bool portable_bits,
                        double bound_five, double bound_random, const char* idea) {
    return {name, section, kIsa, nullptr, batch, portable_bits, bound_five, bound_random, idea};
}

// clang-format off
constexpr Variant kList[] = {
    single("baseline", "3.1", march, true, 0.0, 0.0, "the published march in double, equation by equation"),
    single("fewer square roots", "3.2", one<drive<FewerRoots>>, true, 1e-14, 1e-09,
           "cutoffs tested on squares, no root where its friction is zero"),
#ifdef __x86_64__
    single("rsqrt", "3.2", one<drive<RsqrtRaw>>, false, 1e-04, 1e-03,
           "rsqrtss as it comes, 12 bits: the loss that motivates the refinement"),
    single("rsqrt newton", "3.2", one<drive<RsqrtNewton>>, false, 1e-14, 1e-09,
           "rsqrtss and two Newton steps"),
#endif
    single("branch hints", "3.3", one<drive<BranchHints>>, true, 0.0, 0.0,
           "[[likely]] on slip and cloth slip"),
    single("branch order", "3.3", one<drive<BranchOrder>>, true, 0.0, 0.0,
           "the pressed ball is asked for first, the exceptions last"),
    single("unconditional roots", "3.3", one<drive<UnconditionalRoots>>, true, 1e-14, 1e-09,
           "inverted branches: all roots before any question"),
    single("masks", "3.3", one<drive<Masks>>, true, 1e-14, 1e-09, "bit masks instead of branches"),
    single("two stages", "3.3", one<drive<TwoStage>>, true, 0.0, 0.0,
           "compression and restitution in loops of their own"),
    single("precomputed", "3.4", one<drive<Precomputed>>, true, 1e-12, 1e-09,
           "spins as speeds, impulses per mass, products of constants once"),
#ifdef __AVX2__
    single("fma", "3.4", one<drive<ExplicitFma>>, false, 1e-14, 1e-09,
           "fused multiply-add where the step has product and sum"),
#endif
#ifdef __x86_64__
    single("packed blocks", "3.5", one<drive<PackedBlocks>>, true, 1e-12, 1e-09,
           "register relief: pairs (ball 1, ball 2) in scoped blocks"),
#endif
#ifdef __AVX2__
    single("simd around", "3.7", one<simd_outside>, false, 0.0, 0.0,
           "SIMD for the frame, the scalar loop inside"),
    single("simd loop", "3.7", one<drive<SimdLoop>>, false, 1e-14, 1e-09,
           "one register a vector, the whole loop"),
#endif
#ifdef __x86_64__
    single("simd ssa", "3.7", one<drive<SimdSsa>>, true, 1e-12, 1e-09,
           "pairs, both sides computed, every value assigned once"),
    single("combined", "4", one<drive<Combined>>, false, 1e-12, 1e-09,
           "the paper's best: rsqrt, no waiting branch, two stages, precomputed"),
#endif
#ifdef __AVX2__
    single("paper flags", "4", one<drive<PaperFlags>>, false, 1e-12, 1e-09,
           "the baseline's loop under -Ofast -march=znver3"),
#endif
    single("reduced state", "past it", one<drive<ReducedState>>, true, 1e-12, 1e-09,
           "six numbers and linear invariants instead of ten velocities"),
#ifdef __AVX2__
    single("packed", "past it", one<drive<PackedExact>>, false, 1e-12, 1e-08,
           "the reduced state in one register, sqrt and division"),
    single("extrapolated seed", "past it", one<drive<ExtrapolatedSeed>>, false, 1e-12, 1e-08,
           "reciprocal lengths extrapolated linearly and refined: no root"),
    single("pipelined", "past it", one<drive<Pipelined>>, false, 1e-12, 1e-08,
           "extrapolated to fourth order, used at once, corrected late"),
    single("carried roots", "past it", one<drive<CarriedRoots>>, false, 1e-12, 1e-08,
           "the same from values a step older"),
    single("decoupled roots", "past it", one<drive<Decoupled>>, false, 1e-11, 1e-07,
           "extrapolated roots used as they are, their errors made good two steps later"),
#endif
    single("summed", "past it", summed_march, true, 1e-11, 1e-09,
           "the kernel's: the Euler sequence summed exactly over blocks of up to 1024 steps"),
#ifdef __AVX2__
    batch("four lanes", "3.8", batch_march<4, 1, LaneExactRoots, SeparateArithmetic>, false, 1e-11, 5e-09,
          "four impacts in lanes, sqrt and division"),
    batch("four lanes fma", "3.8", batch_march<4, 1, LaneExactRoots, FusedArithmetic>, false, 1e-11, 5e-09,
          "with fused multiply-add"),
    batch("four lanes rsqrt", "3.8", batch_march<4, 1, LaneRsqrtRoots, FusedArithmetic>, false, 1e-11, 5e-09,
          "with rsqrt and Newton"),
    batch("four lanes carried", "past it", batch_march<4, 1, LaneCarriedRoots, FusedArithmetic>, false,
          1e-11, 5e-09, "with carried reciprocal roots"),
    batch("2x4 lanes", "past it", batch_march<4, 2, LaneCarriedRoots, FusedArithmetic>, false, 1e-11, 5e-09,
          "two vectors of four interleaved, carried roots"),
#endif
#ifdef __AVX512F__
    batch("8 lanes", "past it", batch_march<8, 1, LaneCarriedRoots, FusedArithmetic>, false, 1e-11, 5e-09,
          "eight lanes, carried roots"),
    batch("2x8 lanes", "past it", batch_march<8, 2, LaneCarriedRoots, FusedArithmetic>, false, 1e-11, 5e-09,
          "two vectors of eight, carried roots"),
#endif
    batch("summed batch", "past it", summed_batch, true, 1e-11, 1e-09,
          "the summed march, or the published arithmetic in lanes where rounding decides"),
};
// clang-format on

}  // namespace

constinit const std::span<const Variant> kVariants = kList;

}  // namespace carom::kernel::CAROM_ISA_NAMESPACE
