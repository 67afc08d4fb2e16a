// The same bits from every instruction set and at every position in a batch, and a status for any input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "tolerance_support.h"

namespace carom::test {
namespace {

using namespace kernel;
using reference::random_impact;

constexpr std::uint64_t kBitsOfEveryCompiler = 0x646ad6702b328f49ull;

std::vector<Impact> mixed(std::uint64_t seed, int count, ClothSlip slip) {
    Generator rng(seed);
    std::vector<Impact> impacts;
    for (int n = 0; n < count; ++n) {
        Impact i = n % 3 == 0 ? hard_random_impact(rng, 0.5, 0.8, slip) : random_impact(rng);
        i.params.cloth_slip = slip;
        if (n % 50 == 0) i.params.mu_b = 0.0;
        if (n % 51 == 0) i.ball1.w[0] = i.ball2.w[0] = i.ball1.w[1] = i.ball2.w[1] = 0.0;
        if (n % 52 == 0) i.ball1.v[1] = std::numeric_limits<double>::quiet_NaN();
        if (n % 53 == 0) std::swap(i.ball1.v, i.ball2.v);  // some of these separate
        if (n % 54 == 0) i.params.mu_b = 1.5;
        impacts.push_back(i);
    }
    return impacts;
}

void expect_same(const ImpactResult& a, const ImpactResult& b, int& differing) {
    differing +=
        !(same_velocities(a, b) && a.status == b.status && a.steps == b.steps && a.method == b.method);
}

TEST(ToleranceBits, EveryInstructionSetAgrees) {
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        const std::vector<Impact> impacts = mixed(61, 6000, slip);
        for (double tolerance : {1e-3, 1e-6, 1e-10, 1e-13}) {
            Lanes expected(impacts);
            tolerance_batch_function(Isa::kScalar)(expected.batch(), tolerance, expected.results());
            for (Isa isa : isas()) {
                Lanes lanes(impacts);
                tolerance_batch_function(isa)(lanes.batch(), tolerance, lanes.results());
                int differing = 0;
                for (std::size_t n = 0; n < impacts.size(); ++n) {
                    expect_same(lanes.result(n), expected.result(n), differing);
                    expect_same(solve(impacts[n], tolerance, isa), solve(impacts[n], tolerance, Isa::kScalar),
                                differing);
                }
                EXPECT_EQ(differing, 0) << name(isa) << " at " << tolerance;
            }
        }
    }
}

// gcc and clang, with and without optimisation, must all match this hash. If a change of the method changes
// it, renew it here; every compiler must still agree.
TEST(ToleranceBits, EveryCompilerAgrees) {
    Generator rng(65);
    std::uint64_t hash = 0xCBF29CE484222325ull;
    const auto add = [&hash](const double(&a)[3]) {
        for (double x : a) {
            std::uint64_t bits;
            std::memcpy(&bits, &x, sizeof bits);
            hash = (hash ^ bits) * 0x100000001B3ull;
        }
    };
    for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        std::vector<Impact> impacts;
        for (int n = 0; n < 3000; ++n) {  // only + - * /: sin and cos differ between libraries
            Impact i{};
            i.params = {
                0.03,          0.2, rng.uniform(0.0, 0.5), rng.uniform(0.0, 0.5), rng.uniform(0.0, 0.2),
                rng.uniform(), slip};
            i.ball2.r[0] = rng.uniform(-0.1, 0.1);
            i.ball2.r[1] = rng.uniform(-0.1, 0.1);
            const double faster = n % 3 == 0 ? 0.01 : 1.0;
            for (int k = 0; k < 3; ++k) {
                i.ball1.v[k] = k < 2 ? rng.uniform(-1.0, 1.0) : 0.0;
                i.ball1.w[k] = rng.uniform(-40.0, 40.0) * faster;
                i.ball2.w[k] = rng.uniform(-40.0, 40.0) * faster;
            }
            impacts.push_back(i);
        }
        for (double tolerance : {1e-3, 1e-6, 1e-10, 1e-13}) {
            Lanes lanes(impacts);
            tolerance_batch_function(best_isa())(lanes.batch(), tolerance, lanes.results());
            for (std::size_t n = 0; n < impacts.size(); ++n) {
                for (const ImpactResult& r : {solve(impacts[n], tolerance), lanes.result(n)}) {
                    add(r.v1);
                    add(r.w1);
                    add(r.v2);
                    add(r.w2);
                }
            }
        }
    }
    EXPECT_EQ(hash, kBitsOfEveryCompiler) << "0x" << std::hex << hash;
}

TEST(ToleranceBits, PlaceAndLengthOfABatchDoNotMatter) {
    const std::vector<Impact> impacts = mixed(62, 1500, ClothSlip::kConsistent);
    for (Isa isa : isas()) {
        const ToleranceBatchFunction batch = tolerance_batch_function(isa);
        Lanes whole(impacts);
        batch(whole.batch(), 1e-6, whole.results());
        for (std::size_t length : {std::size_t{1}, std::size_t{3}, std::size_t{7}, std::size_t{8},
                                   std::size_t{29}, std::size_t{700}}) {
            Lanes pieces(impacts);
            for (std::size_t first = 0; first < impacts.size(); first += length) {
                const std::size_t count = std::min(length, impacts.size() - first);
                batch(pieces.batch(first, count), 1e-6, pieces.results(first));
            }
            int differing = 0;
            for (std::size_t n = 0; n < impacts.size(); ++n)
                expect_same(pieces.result(n), whole.result(n), differing);
            EXPECT_EQ(differing, 0) << name(isa) << ", pieces of " << length;
        }
    }
}

// If all impacts of a batch need 8 nodes, or stretches, the lists that collect them fill up.
TEST(ToleranceBits, BatchesOfOneKind) {
    for (ToleranceMethod kind : {ToleranceMethod::kCollocation8, ToleranceMethod::kAdaptive}) {
        Generator rng(66);
        std::vector<Impact> impacts;
        while (impacts.size() < 1500) {
            const Impact i = random_impact(rng);
            if (solve(i, 1e-10).method == kind) impacts.push_back(i);
        }
        for (Isa isa : isas()) {
            Lanes whole(impacts), one(impacts);
            tolerance_batch_function(isa)(whole.batch(), 1e-10, whole.results());
            int differing = 0;
            for (std::size_t n = 0; n < impacts.size(); ++n) {
                tolerance_batch_function(isa)(one.batch(n, 1), 1e-10, one.results(n));
                expect_same(one.result(n), whole.result(n), differing);
            }
            EXPECT_EQ(differing, 0) << name(isa) << ", " << name(kind);
        }
    }
}

TEST(ToleranceBits, EmptyBatchesAndBatchesWithoutDiagnostics) {
    const std::vector<Impact> impacts = mixed(63, 100, ClothSlip::kConsistent);
    Lanes lanes(impacts), plain(impacts);
    const ToleranceBatchFunction batch = tolerance_batch_function(best_isa());
    batch(lanes.batch(), 1e-6, lanes.results());
    ImpactBatchResult bare = plain.results();
    bare.steps = nullptr;
    bare.method = nullptr;
    batch(plain.batch(0, 0), 1e-6, bare);
    ImpactBatch negative = plain.batch();
    negative.count = -5;
    batch(negative, 1e-6, bare);
    EXPECT_EQ(plain.result(1).v2[0], 0.0);  // nothing was written
    batch(plain.batch(), 1e-6, bare);
    for (std::size_t n = 0; n < impacts.size(); ++n) {
        EXPECT_TRUE(same_velocities(plain.result(n), lanes.result(n)));
        EXPECT_EQ(plain.result(n).status, lanes.result(n).status);
        EXPECT_EQ(plain.result(n).steps, 0);
    }
    batch(plain.batch(), 2.0, plain.results());  // not a tolerance
    for (std::size_t n = 0; n < impacts.size(); ++n) {
        EXPECT_EQ(plain.result(n).status, ImpactStatus::kBadParameter);
    }
}

double any_double(Generator& rng) {
    const std::uint64_t bits = rng.next();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

bool all_finite(const ImpactResult& r) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        for (double x : {r.v1[k], r.w1[k], r.v2[k], r.w2[k]}) sum += x - x;
    }
    return sum == 0.0;
}

// Bit patterns of every exponent, in all fields or some: each call ends, and results are finite.
void expect_answers(std::uint64_t seed, int count) {
    Generator rng(seed);
    const double tolerances[] = {1e-1, 1e-3, 1e-6, 1e-10, 1e-13};
    std::vector<Impact> impacts;
    for (int n = 0; n < count; ++n) {
        Impact i{};
        if (n % 4 != 0)
            i = n % 2 == 0 ? random_impact(rng) : hard_random_impact(rng, 1.0, 1.0, ClothSlip::kConsistent);
        i.params.cloth_slip = rng.next() % 2 == 0 ? ClothSlip::kConsistent : ClothSlip::kAsPublished;
        double* fields[] = {&i.params.R,   &i.params.m,   &i.params.mu_s1, &i.params.mu_s2, &i.params.mu_b,
                            &i.params.e_b, &i.ball1.r[0], &i.ball1.r[1],   &i.ball1.r[2],   &i.ball1.v[0],
                            &i.ball1.v[1], &i.ball1.v[2], &i.ball1.w[0],   &i.ball1.w[1],   &i.ball1.w[2],
                            &i.ball2.r[0], &i.ball2.r[1], &i.ball2.r[2],   &i.ball2.v[0],   &i.ball2.v[1],
                            &i.ball2.v[2], &i.ball2.w[0], &i.ball2.w[1],   &i.ball2.w[2]};
        constexpr std::size_t kFields = std::size(fields);
        if (n % 4 == 0) {
            for (double* field : fields) *field = any_double(rng);
        } else {
            const std::uint64_t changes = rng.next() % 3 + 1;
            for (std::uint64_t k = 0; k < changes; ++k) *fields[rng.next() % kFields] = any_double(rng);
        }
        const double tolerance = rng.next() % 64 == 0 ? any_double(rng) : tolerances[rng.next() % 5];
        const ImpactResult r = solve(i, tolerance);
        if (r.status == ImpactStatus::kOk) {
            ASSERT_TRUE(all_finite(r)) << "impact " << n;
            ASSERT_GE(r.steps, 1);
        } else {
            ASSERT_EQ(r.steps, 0);
            ASSERT_EQ(std::memcmp(r.v1, i.ball1.v, sizeof r.v1), 0);
            ASSERT_EQ(std::memcmp(r.w2, i.ball2.w, sizeof r.w2), 0);
        }
        if (n % 10 == 0) impacts.push_back(i);
    }
    Lanes lanes(impacts);
    tolerance_batch_function(best_isa())(lanes.batch(), 1e-6, lanes.results());
    for (std::size_t n = 0; n < impacts.size(); ++n) {
        const ImpactResult r = lanes.result(n);
        ASSERT_TRUE(r.status != ImpactStatus::kOk || all_finite(r)) << "lane " << n;
    }
}

TEST(ToleranceBits, AnyInputEndsWithAStatus) {
    expect_answers(64, 200000);
}

TEST(ToleranceBits, TwoMillionInputsHaveAnAnswer) {
    expect_answers(67, 2000000);
}

}  // namespace
}  // namespace carom::test
