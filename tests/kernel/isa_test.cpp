// The instruction set of every kernel, by name and by default.
#include "carom/kernel/isa.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "carom/kernel/contact_phase.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom::test {
namespace {

using namespace kernel;

constexpr KernelKind kTestedKinds[] = {KernelKind::kMarch, KernelKind::kSummedMarch, KernelKind::kTolerance,
                                       KernelKind::kToleranceBatch, KernelKind::kContactPhase};

TEST(Isa, FastestIsAvailableOnThisProcessor) {
    static_assert(sizeof kTestedKinds / sizeof *kTestedKinds == kKernelKinds);
    for (const KernelKind kind : kTestedKinds) {
        const Isa isa = fastest_isa(kind);
        EXPECT_NE(isa, Isa::kFastest);
        EXPECT_TRUE(available(isa));
        if (measured_processor() == nullptr) {
            EXPECT_EQ(isa, best_isa());
        }
    }
}

TEST(Isa, EveryKernelUsesItsOwnFastest) {
    EXPECT_EQ(march_function(Isa::kFastest), march_function(fastest_isa(KernelKind::kMarch)));
    EXPECT_EQ(summed_march_function(Isa::kFastest),
              summed_march_function(fastest_isa(KernelKind::kSummedMarch)));
    EXPECT_EQ(tolerance_function(Isa::kFastest), tolerance_function(fastest_isa(KernelKind::kTolerance)));
    EXPECT_EQ(tolerance_batch_function(Isa::kFastest),
              tolerance_batch_function(fastest_isa(KernelKind::kToleranceBatch)));
    EXPECT_EQ(contact_phase_function(Isa::kFastest),
              contact_phase_function(fastest_isa(KernelKind::kContactPhase)));
}

TEST(Isa, NamesReadBackButFastestCannotBeForced) {
    for (const Isa isa : {Isa::kScalar, Isa::kV3, Isa::kV4}) {
        Isa read = Isa::kFastest;
        EXPECT_TRUE(parse_isa(name(isa), read));
        EXPECT_EQ(read, isa);
    }
    Isa read = Isa::kScalar;
    EXPECT_FALSE(parse_isa(name(Isa::kFastest), read));
    EXPECT_EQ(read, Isa::kScalar);
    EXPECT_TRUE(available(Isa::kFastest));
}

}  // namespace
}  // namespace carom::test
