// Every variant of the ladder against the baseline.
#include "ladder/ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ladder/variants.h"
#include "reference/random_impacts.h"
#include "support/impact_cases.h"
#include "variant_runner.h"

namespace carom::test {
using reference::BatchArrays;
using reference::Generator;
using reference::Impact;
using reference::random_impacts;

namespace {

using namespace kernel;

class EveryVariant : public testing::TestWithParam<Variant> {
  protected:
    void SetUp() override {
        if (!available(GetParam().isa)) GTEST_SKIP() << name(GetParam().isa) << " is not available here";
    }
};

class PortableVariant : public EveryVariant {};
class BatchVariant : public EveryVariant {};

INSTANTIATE_TEST_SUITE_P(Ladder, EveryVariant, testing::ValuesIn(ladder().begin(), ladder().end()),
                         variant_name);
INSTANTIATE_TEST_SUITE_P(Ladder, PortableVariant,
                         testing::ValuesIn(variants_where([](const Variant& variant) {
                             return variant.portable_bits && variant.isa != Isa::kScalar;
                         })),
                         variant_name);
INSTANTIATE_TEST_SUITE_P(Ladder, BatchVariant, testing::ValuesIn(variants_where([](const Variant& variant) {
                             return variant.batch != nullptr;
                         })),
                         variant_name);

std::vector<Impact> five_states() {
    std::vector<Impact> impacts;
    for (const ReferenceImpact& r : reference_impacts("paper_states.json"))
        impacts.push_back({r.ball1, r.ball2, r.params});
    return impacts;
}

TEST_P(EveryVariant, FollowsTheBaselineOnTheFiveStates) {
    const std::vector<Impact> impacts = five_states();
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        const auto expected = run_variant(baseline_variant(), impacts, 1000, slip);
        const auto got = run_variant(GetParam(), impacts, 1000, slip);
        for (std::size_t i = 0; i < impacts.size(); ++i) {
            EXPECT_EQ(got[i].steps, expected[i].steps) << "state " << i;
            EXPECT_LE(difference(got[i], expected[i], impacts[i].params.R),
                      GetParam().bound_five * approach_speed(impacts[i].ball1, impacts[i].ball2))
                << "state " << i;
        }
    }
}

TEST_P(EveryVariant, FollowsTheBaselineOnRandomImpacts) {
    const std::vector<Impact> impacts = random_impacts(1, 2000);
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        const auto expected = run_variant(baseline_variant(), impacts, 1000, slip);
        const auto got = run_variant(GetParam(), impacts, 1000, slip);
        int same = 0;
        for (std::size_t i = 0; i < impacts.size(); ++i) {
            ASSERT_EQ(got[i].status, ImpactStatus::kOk);
            const double off = difference(got[i], expected[i], impacts[i].params.R) /
                               approach_speed(impacts[i].ball1, impacts[i].ball2);
            // If the last step differs, the result differs by up to that step.
            EXPECT_LE(off, got[i].steps == expected[i].steps ? GetParam().bound_random : 3e-3)
                << "impact " << i;
            same += got[i].steps == expected[i].steps;
        }
        EXPECT_GE(same, 1990);
    }
}

TEST_P(EveryVariant, FollowsTheBaselineAtOtherN) {
    const std::vector<Impact> impacts = random_impacts(2, 60);
    for (int n : {1, 2, 7, 40, 100, 333, 5000}) {
        const auto expected = run_variant(baseline_variant(), impacts, n, ClothSlip::kConsistent);
        const auto got = run_variant(GetParam(), impacts, n, ClothSlip::kConsistent);
        int same = 0;
        for (std::size_t i = 0; i < impacts.size(); ++i) {
            ASSERT_EQ(got[i].status, expected[i].status) << "impact " << i << ", N = " << n;
            if (got[i].steps != expected[i].steps) continue;
            ++same;
            EXPECT_LE(
                difference(got[i], expected[i], impacts[i].params.R),
                // At small N a step is a large share of the slip, and so are differences from rounding
                // decisions.
                (GetParam().bound_random + 1e-12 * n) * approach_speed(impacts[i].ball1, impacts[i].ball2))
                << "impact " << i << ", N = " << n;
        }
        EXPECT_GE(same, 59) << "N = " << n;
    }
}

TEST_P(PortableVariant, HasTheBitsOfScalar) {
    const Variant* scalar = nullptr;
    for (const Variant& variant : ladder())
        if (std::string(variant.name) == GetParam().name && variant.isa == Isa::kScalar) scalar = &variant;
    ASSERT_NE(scalar, nullptr);
    const std::vector<Impact> impacts = random_impacts(3, 500);
    const auto expected = run_variant(*scalar, impacts, 1000, ClothSlip::kConsistent);
    const auto got = run_variant(GetParam(), impacts, 1000, ClothSlip::kConsistent);
    for (std::size_t i = 0; i < impacts.size(); ++i)
        EXPECT_TRUE(same_bits(got[i], expected[i])) << "impact " << i;
}

// Batches may have any length, and an impact's result does not depend on its neighbours.
TEST_P(BatchVariant, BatchesMayHaveAnyLength) {
    const std::vector<Impact> impacts = random_impacts(4, 67);
    const auto whole = run_variant(GetParam(), impacts, 200, ClothSlip::kConsistent);
    for (std::size_t length : {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 15u, 16u, 17u, 31u, 33u, 66u}) {
        const std::vector<Impact> part(impacts.begin(), impacts.begin() + static_cast<long>(length));
        const auto got = run_variant(GetParam(), part, 200, ClothSlip::kConsistent);
        for (std::size_t i = 0; i < length; ++i)
            EXPECT_TRUE(same_bits(got[i], whole[i])) << "impact " << i << " of " << length;
    }
    std::vector<Impact> reversed(impacts.rbegin(), impacts.rend());
    const auto got = run_variant(GetParam(), reversed, 200, ClothSlip::kConsistent);
    for (std::size_t i = 0; i < impacts.size(); ++i)
        EXPECT_TRUE(same_bits(got[impacts.size() - 1 - i], whole[i])) << "impact " << i;
}

// Slows the approach to `share` of the fastest speed: a glancing impact, in which rounding matters most.
void make_glancing(Impact& impact, double share) {
    Ball &b1 = impact.ball1, &b2 = impact.ball2;
    const double dx = b2.r[0] - b1.r[0], dy = b2.r[1] - b1.r[1], d = std::hypot(dx, dy);
    const double n[2] = {dx / d, dy / d};
    const double approach = approach_speed(b1, b2), fastest = approach + std::hypot(b1.v[0], b1.v[1]) +
                                                              std::hypot(b2.v[0], b2.v[1]) +
                                                              impact.params.R * std::hypot(b1.w[0], b1.w[1]);
    for (int k = 0; k < 2; ++k) b1.v[k] += (share * fastest - approach) * n[k];
}

// In lanes or alone: the bits of the kernel's summed march, whose bound another test checks.
TEST(Ladder, BatchesHaveTheBitsOfTheSummedMarch) {
    std::vector<Impact> impacts = random_impacts(21, 4000);
    Generator rng(22);
    for (std::size_t i = 0; i < impacts.size(); i += 2)
        make_glancing(impacts[i], std::pow(10.0, rng.uniform(-6.0, -1.0)));
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        for (const Variant& variant : ladder()) {
            if (std::string(variant.name) != "summed batch" || !available(variant.isa)) continue;
            const auto got = run_variant(variant, impacts, 1000, slip);
            for (std::size_t i = 0; i < impacts.size(); ++i) {
                kernel::ImpactParams params = impacts[i].params;
                params.cloth_slip = slip;
                ImpactResult alone;
                summed_march_function(variant.isa)(impacts[i].ball1, impacts[i].ball2, params, 1000, alone);
                EXPECT_TRUE(same_bits(got[i], alone)) << "impact " << i << " on " << name(variant.isa);
            }
        }
    }
}

// Other processors have only the variants without x86-64 instructions.
#if defined(__x86_64__)
TEST(Ladder, TheTableIsComplete) {
    std::set<std::pair<std::string, Isa>> seen;
    std::map<std::string, std::string> sections;
    for (const Variant& variant : ladder()) {
        EXPECT_TRUE(seen.insert({variant.name, variant.isa}).second) << variant.name << " twice";
        EXPECT_NE(variant.march == nullptr, variant.batch == nullptr) << variant.name;
        EXPECT_NE(std::string(variant.idea), "");
        EXPECT_EQ(sections.emplace(variant.name, variant.section).first->second, variant.section)
            << variant.name;
    }
    for (const char* needed :
         {"baseline",     "fewer square roots",  "rsqrt",          "rsqrt newton",     "branch hints",
          "branch order", "unconditional roots", "masks",          "two stages",       "precomputed",
          "fma",          "packed blocks",       "simd around",    "simd loop",        "simd ssa",
          "combined",     "four lanes",          "four lanes fma", "four lanes rsqrt", "reduced state",
          "packed",       "extrapolated seed",   "pipelined",      "carried roots",    "decoupled roots",
          "2x4 lanes"})
        EXPECT_TRUE(seen.count({needed, Isa::kV3})) << needed;
    for (const char* needed : {"8 lanes", "2x8 lanes"}) EXPECT_TRUE(seen.count({needed, Isa::kV4})) << needed;
    EXPECT_STREQ(baseline_variant().name, "baseline");
    EXPECT_EQ(ladder().size(), scalar::kVariants.size() + v3::kVariants.size() + v4::kVariants.size());
}
#endif

// The one lossy variant states its loss: the difference is nonzero, and within the table's bound.
TEST(Ladder, RawRsqrtIsLossy) {
    for (const Variant& variant : ladder()) {
        if (std::string(variant.name) != "rsqrt" || !available(variant.isa)) continue;
        const std::vector<Impact> impacts = five_states();
        const auto expected = run_variant(baseline_variant(), impacts, 1000, ClothSlip::kAsPublished);
        const auto got = run_variant(variant, impacts, 1000, ClothSlip::kAsPublished);
        double most = 0.0;
        for (std::size_t i = 0; i < impacts.size(); ++i)
            most = std::max(most, difference(got[i], expected[i], impacts[i].params.R));
        EXPECT_GT(most, 1e-9);
    }
}

}  // namespace
}  // namespace carom::test
