// The contact phase of a cluster: every instruction set gives the same bits; the order of the method against
// a reference with exact events; laws; the end of the phase.
#include "carom/kernel/contact_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "reference/contact_phase.h"
#include "reference/random_impacts.h"

namespace carom::kernel {
namespace {

using reference::Cluster;
using reference::ContactReference;
using reference::Generator;

constexpr double kLookAhead = 2.0, kTimeLimit = 2000.0;

HertzLaw pool_law(double epsilon = 2e-3) {
    const double b = (1.0 - 0.95 * 0.95) * 0.4 / (0.4 - 1.0 / 3.5);
    return {1.0 - b, b, 1, 0.05, 0.2, epsilon, false};
}

struct Outcome {
    std::int64_t evaluations = 0;
    std::vector<double> motion, moved;
    double time = 0.0;
    std::vector<HertzHistory> history;
};

Outcome run(Isa isa, const Cluster& c, const HertzLaw& law, double tolerance, double look_ahead = kLookAhead,
            double time_limit = kTimeLimit, std::int64_t most = kMostEvaluations) {
    Outcome out;
    out.motion = c.motion;
    out.moved.resize(3 * c.balls());
    out.history.resize(c.contacts.size());
    const int balls = static_cast<int>(c.balls()), contacts = static_cast<int>(c.contacts.size());
    // Guards behind the scratch memory.
    std::vector<double> numbers(contact_phase_numbers(balls, contacts) + 1, 7.0);
    std::vector<int> places(contact_phase_places(balls, contacts) + 1, 7);
    const ContactPhase phase{.balls = balls,
                             .contacts = contacts,
                             .motion = out.motion.data(),
                             .contact = c.contacts.data(),
                             .numbers = numbers.data(),
                             .places = places.data(),
                             .held = c.held,
                             .inverse_mass = c.inverse_mass.empty() ? nullptr : c.inverse_mass.data(),
                             .moved = out.moved.data(),
                             .time = &out.time,
                             .history = out.history.data(),
                             .most = most};
    out.evaluations = contact_phase_function(isa)(phase, law, tolerance, look_ahead, time_limit);
    EXPECT_EQ(numbers.back(), 7.0);
    EXPECT_EQ(places.back(), 7);
    return out;
}

// Some balls of a triangular lattice with small gaps, some of them 0; one runs into the others.
Cluster random_cluster(Generator& rng) {
    Cluster c;
    std::vector<std::array<double, 3>> places;
    const double density = rng.uniform(0.3, 1.0);
    const bool in_space = rng.uniform() < 0.4, unlike = rng.uniform() < 0.3;
    c.held = !in_space;
    for (int row = 0; row < 5; ++row) {
        for (int k = 0; k < 4; ++k) {
            if (rng.uniform() < density)
                places.push_back(
                    {2.0 * k + row % 2, std::sqrt(3.0) * row, in_space ? rng.uniform(0.0, 0.3) : 0.0});
        }
    }
    const double most = rng.uniform() < 0.3 ? 0.0 : rng.uniform(0.0, 0.5), touch = rng.uniform(30.0, 300.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = i + 1; j < places.size(); ++j) {
            double n[3], square = 0.0;
            for (int k = 0; k < 3; ++k) square += (n[k] = places[j][k] - places[i][k]) * n[k];
            const double distance = std::sqrt(square);
            if (!(distance < 2.1)) continue;
            for (double& x : n) x /= distance;
            c.contacts.push_back({static_cast<int>(i),
                                  static_cast<int>(j),
                                  {n[0], n[1], n[2]},
                                  -rng.uniform(0.0, most),
                                  touch,
                                  unlike ? rng.uniform(0.5, 2.0) : 1.0});
        }
    }
    for (std::size_t b = 0; b < places.size(); ++b) {
        const double speed = b == 0 ? 1.0 : rng.uniform(0.0, 0.3);
        for (int n = 0; n < 6; ++n)
            c.motion.push_back(n == 2 && !in_space ? 0.0 : speed * rng.uniform(b == 0 ? 0.0 : -1.0, 1.0));
        if (unlike) c.inverse_mass.push_back(rng.uniform(0.3, 3.0));
    }
    return c;
}

HertzLaw random_law(Generator& rng) {
    const int p = 1 << static_cast<int>(rng.uniform(0.0, rng.uniform() < 0.8 ? 4.0 : 11.0));
    const double b = rng.uniform();
    HertzLaw law{1.0 - b,
                 b,
                 p,
                 rng.uniform() < 0.2 ? 0.0 : rng.uniform(0.0, 0.2),
                 rng.uniform() < 0.3 ? 0.0 : rng.uniform(0.0, 0.5),
                 rng.uniform(1e-3, 1e-2),
                 rng.uniform() < 0.3,
                 rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.0, 0.2),
                 rng.uniform(0.0, 20.0)};
    if (rng.uniform() < 0.5) law.slide = std::pow(10.0, rng.uniform(-6.0, -1.0));
    return law;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, std::abs(a[n] - b[n]));
    return most;
}

TEST(ContactPhase, EveryInstructionSetGivesTheSameBits) {
    Generator rng(9);
    std::set<std::size_t> sizes;
    for (int k = 0; k < 300; ++k) {
        const Cluster c = random_cluster(rng);
        const HertzLaw law = random_law(rng);
        sizes.insert(c.contacts.size());
        if (c.balls() == 0) continue;
        const Outcome want = run(Isa::kScalar, c, law, 1e-5);
        EXPECT_GE(want.evaluations, 0) << k;
        for (const Isa isa : {Isa::kV3, Isa::kV4}) {
            if (!available(isa)) continue;
            const Outcome got = run(isa, c, law, 1e-5);
            EXPECT_EQ(got.evaluations, want.evaluations) << "cluster " << k << " " << name(isa);
            EXPECT_EQ(got.motion, want.motion) << "cluster " << k << " " << name(isa);
            EXPECT_EQ(got.moved, want.moved) << "cluster " << k << " " << name(isa);
            EXPECT_EQ(got.time, want.time) << "cluster " << k << " " << name(isa);
        }
    }
    EXPECT_LE(*sizes.begin(), 2u);
    EXPECT_GE(*sizes.rbegin(), 40u);
    EXPECT_GE(sizes.size(), 25u) << "all ways to fill the last register";
}

// Against an independent method: Runge-Kutta steps of order 4 in a thousandth of a contact with bisected
// events, written for one contact at a time. In the plane and in space, alike and unlike, with all kinds of
// friction.
#ifdef CAROM_SANITIZED
constexpr int kCompared = 2;
#else
constexpr int kCompared = 12;
#endif

TEST(ContactPhase, TheErrorFollowsTheTolerance) {
    Generator rng(31);
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        std::vector<double> errors, places;
        for (int k = 0; k < kCompared; ++k) {
            const Cluster c = random_cluster(rng);
            HertzLaw law = random_law(rng);
            law.p = 1 << k % 4;
            if (c.contacts.empty()) continue;
            const Outcome out = run(best_isa(), c, law, tolerance);
            ASSERT_GE(out.evaluations, 0);
            ContactReference reference(c, law);
            reference.run(out.time);
            errors.push_back(difference(out.motion, reference.motion()));
            places.push_back(difference(out.moved, reference.moved()));
        }
        std::sort(errors.begin(), errors.end());
        std::sort(places.begin(), places.end());
        EXPECT_LT(errors[(errors.size() - 1) / 2], 2.0 * tolerance) << tolerance;
        EXPECT_LT(errors.back(), 20.0 * tolerance) << tolerance;
        EXPECT_LT(places.back(), 60.0 * tolerance) << tolerance;
    }
}

// Two rows of a rack and the cue ball, with spin: slips that turn into stick.
Cluster small_rack() {
    const double h = std::sqrt(0.75), touch = 90.0;
    Cluster c;
    c.motion = {0.1, 1.0, 0, -0.6, 0.2, 0.3};
    c.motion.resize(24, 0.0);
    c.contacts = {{0, 1, {0.0, 1.0, 0}, 0.0, touch},
                  {1, 2, {-0.5, h, 0}, 0.0, touch},
                  {1, 3, {0.5, h, 0}, 0.0, touch},
                  {2, 3, {1.0, 0.0, 0}, 0.0, touch}};
    return c;
}

// More stages reach further: friction that is ten times as stiff costs less than three times as much.
TEST(ContactPhase, StiffFrictionCostsLittle) {
    const std::int64_t soft = run(best_isa(), small_rack(), pool_law(2e-3), 1e-6).evaluations,
                       stiff = run(best_isa(), small_rack(), pool_law(2e-4), 1e-6).evaluations;
    EXPECT_LT(static_cast<double>(stiff), 3.0 * static_cast<double>(soft));
    EXPECT_LT(soft, 700);
}

// A cloth on which no ball slides is stiff too.
TEST(ContactPhase, StickAtTheClothCostsLittle) {
    HertzLaw smooth = pool_law(1e-2), rough = smooth;
    rough.mu_s = 20.0;
    const std::int64_t few = run(best_isa(), small_rack(), smooth, 1e-4).evaluations,
                       many = run(best_isa(), small_rack(), rough, 1e-4).evaluations;
    // 159 and 319; 589 if the step did not follow the cloth.
    EXPECT_LT(static_cast<double>(many), 2.5 * static_cast<double>(few));
}

// A constant fit is the same as one friction number.
TEST(ContactPhase, AConstantFitIsOneFriction) {
    HertzLaw one = pool_law(), fit = pool_law();
    fit.mu_b = 0.02;
    fit.mu_b_more = 0.03;
    const Outcome a = run(best_isa(), small_rack(), one, 1e-6), b = run(best_isa(), small_rack(), fit, 1e-6);
    EXPECT_LT(difference(a.motion, b.motion), 1e-14);
    EXPECT_GT(difference(a.motion, small_rack().motion), 0.1);
}

// A ball whose spin drives it into another one while a third pair collides, and later, when nothing touches.
TEST(ContactPhase, TheWeightClosesContacts) {
    Cluster c;
    c.motion = {1.0, 0, 0, 0, 0, 0};
    c.motion.resize(24, 0.0);
    c.motion[6 * 2 + 4] = 1.0;
    for (const double gap : {1e-4, 1e-2, 0.3}) {
        c.contacts = {{0, 1, {1.0, 0.0, 0}, 0.0, 90.0}, {2, 3, {1.0, 0.0, 0}, -gap, 90.0}};
        HertzLaw law = pool_law();
        law.slide = 0.05;
        const Outcome out = run(best_isa(), c, law, 1e-6);
        ASSERT_GT(out.evaluations, 0);
        EXPECT_NEAR(out.history[1].first, std::sqrt(2.0 * gap / law.slide), 2e-3) << gap;
        ContactReference reference(c, law);
        reference.run(out.time);
        EXPECT_LT(difference(out.motion, reference.motion()), 2e-5) << gap;
    }
}

struct Total {
    double momentum[3] = {}, energy = 0.0;
};

Total total(const Cluster& c, const std::vector<double>& motion) {
    Total all;
    for (std::size_t b = 0; b < c.balls(); ++b) {
        const double m = c.inverse_mass.empty() ? 1.0 : 1.0 / c.inverse_mass[b];
        for (std::size_t n = 0; n < 6; ++n) {
            const double x = motion[6 * b + n];
            if (n < (c.held ? 2 : 3)) all.momentum[n] += m * x;
            all.energy += m * (n < 3 ? 0.5 : 0.2) * x * x;
        }
    }
    return all;
}

// Momentum to rounding at any tolerance, without the cloth; energy, also with it, never above its start by
// more than the tolerance.
TEST(ContactPhase, KeepsMomentumAndGainsNoEnergy) {
    Generator rng(8);
    for (int k = 0; k < 400; ++k) {
        const Cluster c = random_cluster(rng);
        if (c.contacts.empty()) continue;
        HertzLaw law = random_law(rng);
        const bool smooth = k % 2 == 0;
        law.published_slip_sign = false;  // it drives balls
        if (smooth) law.mu_s = law.slide = 0.0;
        const Outcome out = run(best_isa(), c, law, 1e-6);
        ASSERT_GE(out.evaluations, 0) << k;
        const Total before = total(c, c.motion), after = total(c, out.motion);
        for (int n = 0; n < 3 && smooth; ++n) EXPECT_NEAR(after.momentum[n], before.momentum[n], 1e-13) << k;
        EXPECT_LE(after.energy, before.energy + 1e-5) << k;
    }
}

// The history: who touched whom, when, and how much. The impulses explain the balls' velocities.
TEST(ContactPhase, HistoryTellsWhoPushedWhom) {
    HertzLaw law = pool_law();
    law.mu_b = 0.0;
    Cluster c = small_rack();
    c.motion[0] = 0.0;  // straight
    c.contacts[1].overlap = -0.2;
    const Outcome out = run(best_isa(), c, law, 1e-6);
    EXPECT_EQ(out.history[0].first, 0.0);
    EXPECT_GT(out.history[1].first, 0.2);
    EXPECT_LT(out.history[1].first, 2.0);
    EXPECT_LT(out.history[2].first, 0.1);
    EXPECT_LT(out.history[3].first, 0.0) << "their balls are pushed apart";
    EXPECT_EQ(out.history[3].impulse, 0.0);
    EXPECT_NEAR(out.history[0].impulse, c.motion[1] - out.motion[1], 2e-3);
}

// A contact lasts about 2.5 L/V. The phase ends after the last one, and ignores contacts beyond the
// look-ahead.
TEST(ContactPhase, StopsWhenNoContactCloses) {
    HertzLaw law = pool_law();
    law.mu_b = 0.0;
    const auto three = [](double gap) {
        Cluster c;
        c.motion.resize(18, 0.0);
        c.motion[1] = 1.0;
        c.contacts = {{0, 1, {0.0, 1.0, 0}, 0.0, 1e3}, {1, 2, {0.0, 1.0, 0}, -gap, 1e3}};
        return c;
    };
    const Outcome far = run(best_isa(), three(6.0), law, 1e-6), near = run(best_isa(), three(3.0), law, 1e-6);
    EXPECT_EQ(far.motion[13], 0.0) << "comes in 4.8 L/V";
    EXPECT_NEAR(near.motion[13], 0.950625, 1e-5) << "comes in 1.7 L/V";
    EXPECT_LT(near.evaluations, 2.2 * static_cast<double>(far.evaluations))
        << "none for the flight between them";
}

// Two balls moving together close or open endlessly at the rounding of their speeds, and a contact with
// hardly any restitution opens long after its force has ended. Such phases once used all their time and then
// counted as jammed.
TEST(ContactPhase, EndsWhenNoContactIsLeft) {
    HertzLaw law = pool_law();
    law.mu_b = 0.0;
    const auto alone = [&law](double closing) {
        Cluster c;
        c.motion.resize(24, 0.0);
        c.motion[1] = 1.0;
        c.motion[12] = 0.1 + closing;
        c.motion[18] = 0.1;
        c.contacts = {{0, 1, {0.0, 1.0, 0}, 0.0, 1e3}, {2, 3, {1.0, 0.0, 0}, 0.0, 1e3}};
        const Outcome out = run(best_isa(), c, law, 1e-6);
        EXPECT_NEAR(out.motion[7], 0.975, 1e-5) << closing;
        EXPECT_NEAR(out.motion[18], 0.1, 1e-15) << closing;
        return out.evaluations;
    };
    for (const double closing : {-1e-17, 0.0, 1.4e-17, 1e-15}) {
        const std::int64_t evaluations = alone(closing);
        EXPECT_GT(evaluations, 0) << closing;
        EXPECT_LE(evaluations, 400) << closing;
    }
    HertzLaw plastic = law;
    plastic.a = 0.0;
    plastic.b = 1.0;
    plastic.p = 1024;
    Cluster pair;
    pair.motion = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    pair.contacts = {{0, 1, {0.0, 1.0, 0}, 0.0, 1e3}};
    const Outcome out = run(best_isa(), pair, plastic, 1e-4);
    EXPECT_GT(out.evaluations, 0);
    EXPECT_LE(out.evaluations, 1500) << "it opens at 1/20 of its speed";
    EXPECT_NEAR(out.motion[7], 0.5, 0.03);
}

TEST(ContactPhase, ReportsItsLimits) {
    const auto evaluations = [](double time_limit, std::int64_t most) {
        return run(best_isa(), small_rack(), pool_law(), 1e-6, kLookAhead, time_limit, most).evaluations;
    };
    const std::int64_t all = evaluations(kTimeLimit, kMostEvaluations);
    EXPECT_GT(all, 0);
    EXPECT_EQ(evaluations(1.0, all), -1);
    EXPECT_EQ(evaluations(kTimeLimit, all + 1), all);
    EXPECT_EQ(evaluations(kTimeLimit, all / 2), -1);
}

}  // namespace
}  // namespace carom::kernel
