// Every impact conserves energy and momentum and commutes, bit for bit, with mirror images, turns by 90
// degrees, exchange of the balls and powers of two of its speeds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "tolerance_support.h"

namespace carom::test {
namespace {

using namespace kernel;

Impact any_impact(Generator& rng) {
    return rng.next() % 2 == 0 ? reference::random_impact(rng)
                               : hard_random_impact(rng, 0.3, 0.6, ClothSlip::kConsistent);
}

// U4. Some rounding remains: the energies are sums of squares of rounded numbers.
TEST(ToleranceEnergy, NeverRises) {
    Generator rng(51);
    for (double tolerance : {1e-1, 1e-3, 1e-6, 1e-10}) {
        const int count = tolerance < 1e-8 ? 30000 : 100000;
        std::vector<Impact> impacts;
        for (int n = 0; n < count; ++n) impacts.push_back(any_impact(rng));
        for (int n = 0; n < count; n += 4) impacts[n].params.e_b = 1.0;
        Lanes lanes(impacts);
        tolerance_batch_function(best_isa())(lanes.batch(), tolerance, lanes.results());
        int rises = 0;
        for (std::size_t n = 0; n < impacts.size(); ++n) {
            const Impact& i = impacts[n];
            const double before = energy_before(i), rounding = 1e-14 * before;
            rises += !(energy_after(i, solve(i, tolerance)) <= before + rounding);
            rises += !(energy_after(i, lanes.result(n)) <= before + rounding);
        }
        EXPECT_EQ(rises, 0) << "of " << impacts.size() << " at " << tolerance;
    }
}

// The pair gains only the cloth's momentum, which acts on one ball and is at most mu_s mu_b times the normal
// impulse.
TEST(ToleranceMomentum, OnlyTheClothChangesIt) {
    Generator rng(52);
    for (int n = 0; n < 20000; ++n) {
        Impact i = any_impact(rng);
        if (n % 2 == 0) i.params.mu_s1 = i.params.mu_s2 = 0.0;
        const ImpactResult r = solve(i, 1e-6);
        const double mu_s = std::fmax(i.params.mu_s1, i.params.mu_s2), rounding = 1e-15 * speed_scale(i);
        double square = 0.0;
        for (int k = 0; k < 2; ++k) {
            const double change = (r.v1[k] - i.ball1.v[k]) + (r.v2[k] - i.ball2.v[k]);
            square += change * change;
        }
        EXPECT_LE(std::sqrt(square), mu_s * i.params.mu_b * 1.5 * approach_speed(i) + 8.0 * rounding);
        // Both side spins change equally, by 5/(2R) of the horizontal friction.
        EXPECT_NEAR(r.w1[2] - i.ball1.w[2], r.w2[2] - i.ball2.w[2], 4.0 * rounding / i.params.R);
        EXPECT_EQ(r.v1[2], i.ball1.v[2]);
        EXPECT_EQ(r.v2[2], i.ball2.v[2]);
    }
}

using Map = void (*)(double (&r)[3], double (&v)[3], double (&w)[3]);

void mirror_x(double (&r)[3], double (&v)[3], double (&w)[3]) {  // x -> -x; a spin is a pseudovector
    r[0] = -r[0];
    v[0] = -v[0];
    w[1] = -w[1];
    w[2] = -w[2];
}

void quarter_turn(double (&r)[3], double (&v)[3], double (&w)[3]) {
    for (double* a : {r, v, w}) {
        const double x = a[0];
        a[0] = -a[1];
        a[1] = x;
    }
}

template <class Transform>
void expect_equivariant(Transform transform, std::uint64_t seed) {
    Generator rng(seed);
    int differing = 0;
    std::vector<Impact> impacts, images;
    for (int n = 0; n < 5000; ++n) {
        impacts.push_back(any_impact(rng));
        images.push_back(impacts.back());
        transform(images.back());
    }
    for (double tolerance : {1e-3, 1e-6, 1e-10}) {
        Lanes lanes(impacts), image_lanes(images);
        tolerance_batch_function(best_isa())(lanes.batch(), tolerance, lanes.results());
        tolerance_batch_function(best_isa())(image_lanes.batch(), tolerance, image_lanes.results());
        for (std::size_t n = 0; n < impacts.size(); ++n) {
            for (int batch = 0; batch < 2; ++batch) {
                const ImpactResult r = batch ? lanes.result(n) : solve(impacts[n], tolerance);
                const ImpactResult image = batch ? image_lanes.result(n) : solve(images[n], tolerance);
                Impact after = impacts[n];
                for (int k = 0; k < 3; ++k) {
                    after.ball1.v[k] = r.v1[k];
                    after.ball1.w[k] = r.w1[k];
                    after.ball2.v[k] = r.v2[k];
                    after.ball2.w[k] = r.w2[k];
                }
                transform(after);
                for (int k = 0; k < 3; ++k) {  // == instead of bits: a mirrored 0 is -0
                    differing += !(after.ball1.v[k] == image.v1[k] && after.ball1.w[k] == image.w1[k] &&
                                   after.ball2.v[k] == image.v2[k] && after.ball2.w[k] == image.w2[k]);
                }
            }
        }
    }
    EXPECT_EQ(differing, 0);
}

template <Map kMap>
void both(Impact& i) {
    kMap(i.ball1.r, i.ball1.v, i.ball1.w);
    kMap(i.ball2.r, i.ball2.v, i.ball2.w);
}

TEST(ToleranceSymmetry, Mirror) {
    expect_equivariant(both<mirror_x>, 53);
}

TEST(ToleranceSymmetry, QuarterTurn) {
    expect_equivariant(both<quarter_turn>, 54);
}

TEST(ToleranceSymmetry, Exchange) {
    expect_equivariant(
        [](Impact& i) {
            std::swap(i.ball1, i.ball2);
            std::swap(i.params.mu_s1, i.params.mu_s2);
        },
        55);
}

TEST(ToleranceSymmetry, PowersOfTwo) {
    for (double scale : {0x1p-40, 0.5, 0x1p30}) {
        expect_equivariant(
            [scale](Impact& i) {
                for (int k = 0; k < 3; ++k) {
                    i.ball1.v[k] *= scale;
                    i.ball1.w[k] *= scale;
                    i.ball2.v[k] *= scale;
                    i.ball2.w[k] *= scale;
                }
            },
            56);
    }
}

}  // namespace
}  // namespace carom::test
