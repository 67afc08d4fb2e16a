// The engine's own sine and cosine against the C library in extended precision.
#include "carom/engine/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace {

using carom::sin_cos;
using carom::sin_cos_deg;
using carom::SinCos;

double next_random(std::uint64_t& state) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
}

/// Error in units of the last place of the result.
double ulps(double got, long double truth) {
    const double near = std::abs(static_cast<double>(truth));
    const double ulp = std::nextafter(near, std::numeric_limits<double>::infinity()) - near;
    return static_cast<double>(std::abs((static_cast<long double>(got) - truth) / ulp));
}

TEST(Math, RadiansWithinOneUlp) {
    static_assert(std::numeric_limits<long double>::digits >= 64);
    std::uint64_t state = 1;
    double worst = 0.0;
    for (const double range : {0.8, 7.0, 1e3, 1e6}) {
        for (int i = 0; i < 200000; ++i) {
            const double x = (2.0 * next_random(state) - 1.0) * range;
            const SinCos a = sin_cos(x);
            worst = std::fmax(worst, ulps(a.sin, std::sin(static_cast<long double>(x))));
            worst = std::fmax(worst, ulps(a.cos, std::cos(static_cast<long double>(x))));
        }
    }
    EXPECT_LE(worst, 1.0);
}

TEST(Math, RadiansNearWholeQuadrants) {
    // The doubles next to k pi/2 lose the most bits in the reduction.
    double worst = 0.0;
    for (int k = -636000; k <= 636000; k += 7) {
        const double x = static_cast<double>(k * (std::numbers::pi_v<long double> / 2));
        const SinCos a = sin_cos(x);
        // glibc reduces the extended argument exactly.
        worst = std::fmax(worst, ulps(a.sin, std::sin(static_cast<long double>(x))));
        worst = std::fmax(worst, ulps(a.cos, std::cos(static_cast<long double>(x))));
    }
    EXPECT_LE(worst, 1.0);
}

TEST(Math, LargeRadiansDegradeAsPromised) {
    std::uint64_t state = 7;
    for (double range = 1e6; range < 1e15; range *= 10) {
        for (int i = 0; i < 1000; ++i) {
            const double x = (2.0 * next_random(state) - 1.0) * range;
            const SinCos a = sin_cos(x);
            const double bound = range * 0x1p-51;
            EXPECT_NEAR(a.sin, static_cast<double>(std::sin(static_cast<long double>(x))), bound) << x;
            EXPECT_NEAR(a.cos, static_cast<double>(std::cos(static_cast<long double>(x))), bound) << x;
        }
    }
}

TEST(Math, SmallAndSpecialRadians) {
    EXPECT_EQ(sin_cos(0.0).sin, 0.0);
    EXPECT_EQ(sin_cos(0.0).cos, 1.0);
    EXPECT_EQ(sin_cos(1e-300).sin, 1e-300);
    EXPECT_EQ(sin_cos(std::numeric_limits<double>::denorm_min()).sin,
              std::numeric_limits<double>::denorm_min());
    const double inf = std::numeric_limits<double>::infinity();
    for (const double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN(), 0x1p50, -1e300}) {
        EXPECT_TRUE(std::isnan(sin_cos(bad).sin)) << bad;
        EXPECT_TRUE(std::isnan(sin_cos(bad).cos)) << bad;
    }
}

TEST(Math, SymmetryIsExact) {
    std::uint64_t state = 3;
    for (int i = 0; i < 10000; ++i) {
        const double x = 100.0 * next_random(state);
        EXPECT_EQ(sin_cos(-x).sin, -sin_cos(x).sin);
        EXPECT_EQ(sin_cos(-x).cos, sin_cos(x).cos);
        EXPECT_EQ(sin_cos_deg(-x).sin, -sin_cos_deg(x).sin);
        EXPECT_EQ(sin_cos_deg(-x).cos, sin_cos_deg(x).cos);
    }
}

TEST(Math, WholeQuadrantsInDegreesAreExact) {
    const double want[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int k = -1000; k <= 1000; ++k) {
        const SinCos a = sin_cos_deg(90.0 * k);
        EXPECT_EQ(a.sin, want[((k % 4) + 4) % 4][0]) << k;
        EXPECT_EQ(a.cos, want[((k % 4) + 4) % 4][1]) << k;
        EXPECT_FALSE(std::signbit(a.sin) && a.sin == 0.0) << k;
        EXPECT_FALSE(std::signbit(a.cos) && a.cos == 0.0) << k;
    }
}

TEST(Math, FamiliarAnglesInDegrees) {
    EXPECT_EQ(sin_cos_deg(30).sin, 0.5);
    EXPECT_EQ(sin_cos_deg(60).cos, 0.5);
    EXPECT_EQ(sin_cos_deg(-150).sin, -0.5);
    EXPECT_EQ(sin_cos_deg(45).sin, sin_cos_deg(45).cos);
    EXPECT_EQ(sin_cos_deg(135).sin, -sin_cos_deg(135).cos);
    EXPECT_EQ(sin_cos_deg(45).sin, std::sqrt(0.5));
    EXPECT_EQ(carom::tan_deg(45), 1.0);
    EXPECT_NEAR(carom::tan_deg(60), std::sqrt(3.0), 4e-16);
}

TEST(Math, DegreesWithinOneUlp) {
    std::uint64_t state = 5;
    double worst = 0.0;
    for (int i = 0; i < 400000; ++i) {
        const double x = (2.0 * next_random(state) - 1.0) * 720.0;
        const long double rad =
            std::fmod(static_cast<long double>(x), 360.0L) * (std::numbers::pi_v<long double> / 180);
        const SinCos a = sin_cos_deg(x);
        // The reference loses bits near its zeros, which WholeQuadrantsInDegreesAreExact and
        // RadiansNearWholeQuadrants cover.
        if (std::abs(a.sin) > 1e-2) worst = std::fmax(worst, ulps(a.sin, std::sin(rad)));
        if (std::abs(a.cos) > 1e-2) worst = std::fmax(worst, ulps(a.cos, std::cos(rad)));
    }
    EXPECT_LE(worst, 1.0);
}

TEST(Math, HugeDegreesAreReducedExactly) {
    // 2^60 mod 360 = 136 (2^60 = 1152921504606846976).
    EXPECT_EQ(sin_cos_deg(0x1p60).sin, sin_cos_deg(136).sin);
    EXPECT_EQ(sin_cos_deg(0x1p60).cos, sin_cos_deg(136).cos);
    const SinCos largest = sin_cos_deg(std::numeric_limits<double>::max());
    EXPECT_NEAR(largest.sin * largest.sin + largest.cos * largest.cos, 1.0, 1e-15);
    EXPECT_TRUE(std::isnan(sin_cos_deg(std::numeric_limits<double>::infinity()).sin));
    EXPECT_TRUE(std::isnan(sin_cos_deg(std::numeric_limits<double>::quiet_NaN()).cos));
}

TEST(Math, ArcCosine) {
    EXPECT_EQ(carom::arc_cos(1.0), 0.0);
    EXPECT_EQ(carom::arc_cos(-1.0), std::numbers::pi);
    EXPECT_NEAR(carom::arc_cos(0.0), std::numbers::pi / 2, 3e-16);
    EXPECT_TRUE(std::isnan(carom::arc_cos(1.0000001)));
    EXPECT_TRUE(std::isnan(carom::arc_cos(std::numeric_limits<double>::quiet_NaN())));
    std::uint64_t state = 6;
    for (int i = 0; i < 200000; ++i) {
        double x = 2.0 * next_random(state) - 1.0;
        if (i % 3 == 0) x = 1.0 - 1e-9 * next_random(state);
        const long double want = std::acos(static_cast<long double>(x));
        EXPECT_NEAR(carom::arc_cos(x), static_cast<double>(want),
                    4.5e-16 * std::fmax(1.0, static_cast<double>(want)))
            << x;
        if (i % 3 == 0) {
            EXPECT_NEAR(carom::arc_cos(x) / static_cast<double>(want), 1.0, 6e-16) << x;
        }
    }
}

TEST(Math, Exponential) {
    EXPECT_EQ(carom::exponential(0.0), 1.0);
    EXPECT_EQ(carom::exponential(-800.0), 0.0);
    EXPECT_EQ(carom::exponential(-std::numeric_limits<double>::infinity()), 0.0);
    EXPECT_EQ(carom::exponential(std::numeric_limits<double>::infinity()),
              std::numeric_limits<double>::infinity());
    EXPECT_EQ(carom::exponential(709.79), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(carom::exponential(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_GT(carom::exponential(-745.0), 0.0);
    std::uint64_t state = 7;
    double worst = 0.0;
    for (int i = 0; i < 400000; ++i) {
        const double x = (2.0 * next_random(state) - 1.0) * (i % 2 ? 700.0 : 2.0);
        worst = std::fmax(worst, ulps(carom::exponential(x), std::exp(static_cast<long double>(x))));
    }
    EXPECT_LE(worst, 2.0);
}

}  // namespace
