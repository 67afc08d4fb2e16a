// Breaks with balls of different sizes come to rest and keep every law. CAROM_ODD_BREAKS=from:to runs that
// range of seeds and prints one line for each that fails.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/odd_breaks.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

#ifdef CAROM_SANITIZED
constexpr std::uint64_t kFewBreaks = 100, kManyBreaks = 2000;
#else
constexpr std::uint64_t kFewBreaks = 500, kManyBreaks = 30000;
#endif
constexpr std::uint64_t kParts = 20;

void come_to_rest(std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t seed = from; seed < to; ++seed) {
        const Scene scene = OddBreak(seed).take();
        const std::string what = what_breaks(scene);
        EXPECT_EQ(what, "") << "seed " << seed << "\n" << dump(scene);
    }
}

TEST(OddBreaks, Few) {
    unsigned long from = 1000000, to = from + kFewBreaks;
    if (const char* range = std::getenv("CAROM_ODD_BREAKS")) std::sscanf(range, "%lu:%lu", &from, &to);
    come_to_rest(from, to);
}

// The march has a set number of steps, and the event names the other ball first.
TEST(OddBreaks, AMarchIsCheckedInTheOrderOfTheLoop) {
    come_to_rest(12532, 12533);
}

class ManyOddBreaks : public testing::TestWithParam<std::uint64_t> {};

TEST_P(ManyOddBreaks, ComeToRest) {
    come_to_rest(GetParam() * (kManyBreaks / kParts), (GetParam() + 1) * (kManyBreaks / kParts));
}

INSTANTIATE_TEST_SUITE_P(Part, ManyOddBreaks, testing::Range(std::uint64_t{0}, kParts));

}  // namespace
}  // namespace carom
