// The kernels' bits, as hashes valid on every processor: for this machine's instruction sets, and for another
// processor that builds the same sources. The impacts use only + - * /, because sin and pow differ between
// libraries.
#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/fnv.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"
#include "reference/batch_arrays.h"
#include "reference/random_impacts.h"

namespace carom::test {
namespace {

using namespace kernel;
using reference::BatchArrays;
using reference::Generator;
using reference::Impact;

Impact plain_impact(Generator& rng, ClothSlip slip) {
    Impact impact{};
    impact.params = {0.028575,
                     0.17,
                     rng.uniform(0.1, 0.4),
                     rng.uniform(0.1, 0.4),
                     rng.uniform(0.01, 0.12),
                     rng.uniform(0.8, 1.0),
                     slip};
    const double t = rng.uniform(-1.0, 1.0), R = impact.params.R;
    const double nx = (1.0 - t * t) / (1.0 + t * t), ny = 2.0 * t / (1.0 + t * t);
    impact.ball2.r[0] = 2.0 * R * nx;
    impact.ball2.r[1] = 2.0 * R * ny;
    const double along = rng.uniform(0.01, 3.0), across = rng.uniform(-3.0, 3.0);
    impact.ball1.v[0] = along * nx - across * ny;
    impact.ball1.v[1] = along * ny + across * nx;
    const std::uint64_t kind = rng.next() % 4;
    for (double& w : impact.ball1.w) w = kind == 0 ? 0.0 : rng.uniform(-60.0, 60.0);
    if (kind == 1) {  // it rolls
        impact.ball1.w[0] = -impact.ball1.v[1] / R;
        impact.ball1.w[1] = impact.ball1.v[0] / R;
    }
    if (kind == 2)
        for (double& w : impact.ball2.w) w = rng.uniform(-60.0, 60.0);
    return impact;
}

void add(const ImpactResult& result, Fnv& hash) {
    for (int k = 0; k < 3; ++k)
        for (const double x : {result.v1[k], result.w1[k], result.v2[k], result.w2[k]}) hash.add(x);
    hash.add(static_cast<std::uint64_t>(result.steps));
    hash.add(static_cast<std::uint64_t>(result.status));
}

std::string hex(const Fnv& hash) {
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[hash.value() >> shift & 15];
    return text;
}

struct Hashes {
    Fnv march, summed, single, batch;
};

Hashes hashes_on(Isa isa) {
    Hashes all;
    for (const ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        Generator rng(2026);
        std::vector<Impact> impacts;
        for (int i = 0; i < 1000; ++i) impacts.push_back(plain_impact(rng, slip));
        ImpactResult out;
        for (const Impact& i : impacts) {
            march_function(isa)(i.ball1, i.ball2, i.params, 150, out);
            add(out, all.march);
            summed_march_function(isa)(i.ball1, i.ball2, i.params, 1000, out);
            add(out, all.summed);
        }
        for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
            for (const Impact& i : impacts) {
                tolerance_function(isa)(i.ball1, i.ball2, i.params, tolerance, out);
                add(out, all.single);
            }
            const BatchArrays arrays(impacts, slip);
            tolerance_batch_function(isa)(arrays.batch, tolerance, arrays.result);
            for (std::size_t i = 0; i < impacts.size(); ++i) add(arrays.get(i), all.batch);
        }
    }
    return all;
}

TEST(GoldenBits, AreTheSameOnEveryProcessor) {
    for (const Isa isa : {Isa::kScalar, Isa::kV3, Isa::kV4, Isa::kFastest}) {
        if (!available(isa)) continue;
        const Hashes got = hashes_on(isa);
        EXPECT_EQ(hex(got.march), "c3d7ca31d204d821") << name(isa);
        EXPECT_EQ(hex(got.summed), "5042aca6010066e5") << name(isa);
        EXPECT_EQ(hex(got.single), "8f073beca0f58f35") << name(isa);
        EXPECT_EQ(hex(got.batch), "4410f1b0bcf8c1ed") << name(isa);
    }
}

}  // namespace
}  // namespace carom::test
