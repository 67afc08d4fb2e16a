// Breaks obey physics.tolerance: their clusters against another method, their ends against a tighter
// tolerance, and the derivative of an end by differences. CAROM_RESIDUALS=1 prints the tables of
// lab/notes/2026-11-clusters_by_tolerance.md.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "reference/contact_phase.h"
#include "reference/random_impacts.h"
#include "support/drawn_breaks.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

#ifdef CAROM_SANITIZED
constexpr int kDrawn = 1;
#else
constexpr int kDrawn = 24;
#endif

Scene with_tolerance(Scene scene, double tolerance) {
    scene.physics.tolerance = tolerance;
    return scene;
}

std::vector<Vec2> ends(const Record& record) {
    std::vector<Vec2> places;
    for (const BallTrack& track : record.tracks) places.push_back(planar(track.segments.back().r));
    return places;
}

double worst(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, (a[k] - b[k]).norm());
    return most;
}

constexpr std::array kTolerances = {1e-3, 1e-4, 1e-6, 1e-8, 1e-10};

/// Errors of the first clusters [V], by tolerance.
std::array<std::vector<double>, kTolerances.size()> errors;

// Solves the cluster with every tolerance, and with the other method up to the end of the tightest.
std::int64_t compare(const kernel::ContactPhase& phase, const kernel::HertzLaw& law, double,
                     double look_ahead, double time_limit) noexcept {
    reference::Cluster cluster{{phase.motion, phase.motion + 6 * phase.balls},
                               {phase.contact, phase.contact + phase.contacts},
                               {},
                               phase.held};
    std::array<std::vector<double>, kTolerances.size()> motion;
    std::int64_t evaluations = 0;
    for (std::size_t k = 0; k < kTolerances.size(); ++k) {
        motion[k] = cluster.motion;
        kernel::ContactPhase one = phase;
        one.motion = motion[k].data();
        evaluations = kernel::contact_phase_function(kernel::best_isa())(one, law, kTolerances[k], look_ahead,
                                                                         time_limit);
    }
    std::copy(motion.back().begin(), motion.back().end(), phase.motion);
    reference::ContactReference reference(cluster, law);
    reference.run(*phase.time);
    const std::vector<double> truth = reference.motion();
    for (std::size_t k = 0; k < kTolerances.size(); ++k) {
        double most = 0.0;
        for (std::size_t n = 0; n < truth.size(); ++n)
            most = std::max(most, std::abs(motion[k][n] - truth[n]));
        errors[k].push_back(most);
    }
    return evaluations;
}

TEST(BreakTolerance, ClustersErrByAFewTolerances) {
    errors = {};
    reference::Generator rng(63);
    for (int k = 0; k < kDrawn; ++k) {
        Scene scene = drawn_break(k % 2 == 0 ? "eight_ball" : "nine_ball", rng);
        scene.stop.events = 2;  // the strike, and the cluster
        Plan plan = plan_of(scene);
        plan.contact_phase = &compare;
        simulate(plan);
    }
    for (std::size_t k = 0; k < kTolerances.size(); ++k) {
        const double t = kTolerances[k];
        for (const double share : {0.5, 0.9, 1.0})
            report(fmt::format("clusters at {:g}, error in V, share {}", t, share).c_str(),
                   share_of(errors[k], share));
        EXPECT_LT(share_of(errors[k], 0.5), 3.0 * t) << t;
        EXPECT_LT(share_of(errors[k], 1.0), 30.0 * t) << t;
    }
}

TEST(BreakTolerance, EndsConverge) {
    for (const char* game : {"eight_ball", "nine_ball"}) {
        std::array tolerances = {1e-4, 1e-6, 1e-7, 1e-8, 1e-9};
        std::array<std::vector<double>, tolerances.size()> apart;
        std::array<int, tolerances.size()> same{};
        reference::Generator rng(63);
        for (int k = 0; k < kDrawn; ++k) {
            const Scene scene = drawn_break(game, rng);
            const Record want = simulate(plan_of(with_tolerance(scene, 1e-11)));
            for (std::size_t n = 0; n < tolerances.size(); ++n) {
                const Record got = simulate(plan_of(with_tolerance(scene, tolerances[n])));
                apart[n].push_back(worst(ends(got), ends(want)));
                same[n] += potted(got) == potted(want) ? 1 : 0;
            }
        }
        for (std::size_t n = 0; n < tolerances.size(); ++n) {
            for (const double share : {0.5, 0.9, 1.0})
                report(fmt::format("{} at {:g}, m, share {}", game, tolerances[n], share).c_str(),
                       share_of(apart[n], share));
            report(fmt::format("{} at {:g}, same balls potted", game, tolerances[n]).c_str(), same[n]);
        }
        EXPECT_LE(share_of(apart[1], 0.5), 5e-3) << game;
        EXPECT_GE(same[1], kDrawn - 1) << game;
        EXPECT_LE(share_of(apart[4], 0.5), 1e-4) << game;
        EXPECT_LE(share_of(apart[4], 0.9), 1e-2) << game;
    }
}

// The difference quotients of two steps agree, so the ends are smooth in the aim.
TEST(BreakTolerance, EndsAreSmoothInTheAim) {
    constexpr int kShots = kDrawn < 10 ? kDrawn : 10;
    reference::Generator rng(63);
    int smooth = 0;
    for (int k = 0; k < kShots; ++k) {
        const Scene scene = plan_of(with_tolerance(drawn_break("nine_ball", rng), 1e-11)).scene;
        const auto quotient = [&](double step) {
            std::vector<Vec2> after, before;
            for (const double sign : {1.0, -1.0}) {
                Scene moved = scene;
                moved.cue->aim_deg += sign * step;
                (sign > 0.0 ? after : before) = ends(simulate(plan_of(moved)));
            }
            for (std::size_t ball = 0; ball < after.size(); ++ball)
                after[ball] = (after[ball] - before[ball]) / (2.0 * step);
            return after;
        };
        const std::vector<Vec2> coarse = quotient(1e-6), fine = quotient(3e-7),
                                none(coarse.size(), Vec2::Zero());
        smooth += worst(coarse, fine) <= 1e-2 * worst(fine, none) ? 1 : 0;
    }
    report("smooth nine-ball breaks", smooth);
    EXPECT_GE(10 * smooth, 8 * kShots);
}

}  // namespace
}  // namespace carom
