// Jams found by a scan of crowded scenes (support/crowded_scenes.h, lab/notes/2026-11-jams.md): they end, and
// keep the laws.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"

#include "support/crowded_scenes.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

// A shot into a touching pack: a cluster separated what three contacts had held, and they were held again,
// 700 times at one instant.
TEST(Jams, ClustersThatRepeatEnd) {
    for (const std::uint64_t seed : {7328u, 15806u})
        settles_within(*family_scene("touching_pack", seed), 10000);
}

// Two balls in a lane as wide as both: a slip that went began
// again at once, in 126 000 intervals of 1e-18 s, until an error.
TEST(Jams, TwoBallsInALaneOfTwoDiameters) {
    Scene scene = empty_scene();
    scene.table.cushions = {
        {"", {4.0 * scene.balls.R, 0.0}, {4.0 * scene.balls.R, 20.0 * scene.balls.R}, 0.03},
        {"", {0.0, 20.0 * scene.balls.R}, {0.0, 0.0}, 0.03}};
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.physics.cushion = &kSmooth;
    scene.physics.clusters = ClusterModel::kSequential;
    scene.balls.mu_sp = 0.01;
    scene.balls.e_b = 0.9;
    scene.balls.e_c = 0.8;
    const double R = scene.balls.R;
    add_ball(scene, "0", R, 10.0 * R, 0.0, 0.006, Vec3(2.0, 1.0, 0.0));
    add_ball(scene, "1", 3.0 * R, 10.0 * R);
    settles_within(scene, 2000);
    EXPECT_EQ(what_breaks(scene), "");
}

// Balls that fill a tray or a zigzag: bounces within a group became ten times slower again and again, down to
// 1e-14 m/s, contacts that had opened were met again within 1e-11 s, and each slip that went had an interval
// of its own. They took 93 000 segments and more (9, 61 and 80 of the trays did not end in 2.5 s), and seed
// 61 of the trays ended in an error for some time.
TEST(Jams, TraysAndZigzagsComeToRest) {
    for (const std::uint64_t seed : {9u, 19u, 56u, 61u, 80u})
        settles_within(*family_scene("tray", seed), 40000);
    settles_within(*family_scene("zigzag", 61), 30000);
}

// Two balls between two walls keep any impulse of the step that friction left without a solution: it loaded
// the cloth 2000 times, and each interval of 1e-5 s began with it again.
TEST(Jams, NoImpulseIsLeftBetweenTwoWalls) {
    settles_within(*family_scene("row_between_walls", 82), 2000);
}

// The impulses that remove closing speeds took balls at rest for immovable;
// without a solution the balls went on into each other by 1e-9 m.
TEST(Jams, BallsAtRestAreStruck) {
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box", 240)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/wide", 238)), "");
    EXPECT_EQ(what_breaks(*family_scene("tray", 113)), "");
}

// Racks and trays that jam: closing speeds had no solution, so balls went into each other or a cushion by up
// to 1.4e-7 m, and steps without friction let the energy rise.
TEST(Jams, JamsHaveASolution) {
    for (const std::uint64_t seed : {27u, 42u, 128u, 227u})
        EXPECT_EQ(what_breaks(*family_scene("rack_in_box/wide", seed)), "") << seed;
    for (const std::uint64_t seed : {68u, 178u})
        EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", seed)), "") << seed;
    EXPECT_EQ(what_breaks(*family_scene("tray/extreme", 130)), "");
}

// Friction in the direction of the middle of the interval drove on a ball whose slip had reversed: the energy
// rose sixfold.
TEST(Jams, GuidedFrictionDrivesNothing) {
    EXPECT_EQ(what_breaks(*family_scene("rings/extreme", 37)), "");
}

// An impact ended the only contact of a ball that it did not strike: that ball must not continue as if it
// were pushed.
TEST(Jams, WhatAnImpactLeavesIsFree) {
    EXPECT_EQ(what_breaks(RandomScene(115203).make()), "");
}

// Friction at which balls lock each other: where their forces were 1e5 times what
// drove them, a friction that was right to 1e-3 set a ball spinning with 0.13 m/s
// (7918, where the energy rose by 0.7 %), or balls went into each other.
TEST(Jams, LockedBallsAreNotDriven) {
    for (const std::uint64_t seed : {5685u, 6229u, 7918u, 11778u})
        EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", seed)), "") << seed;
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/wide", 5342)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box", 9409)), "");
}

// Friction that leaves no solution is ignored for a while; what it would have changed set intervals of 3e-5
// s, and the run did not end in 2.5 s.
TEST(Jams, FrictionWithoutASolutionSetsNoInterval) {
    settles_within(*family_scene("row_between_walls", 879), 1500);
    settles_within(*family_scene("row_between_walls", 6852), 2500);
}

// Balls lock each other: friction has no solution over an interval, but has one at an instant. It was ignored
// for less than 1e-4 s at a time, and the runs did not end in 2.5 s.
TEST(Jams, BallsThatLockStopAtAnInstant) {
    settles_within(*family_scene("rings/extreme", 507), 4000);
    EXPECT_LE(segments_of(run_verified(*family_scene("rack_in_box/extreme", 406))), 6000u);
}

// An impact at one end of balls that rest on each other between two rails
// goes back and forth through them: it took 1000 events at one instant, each
// with a group or a cluster to solve (5568, 13914 and 11328 events in all).
TEST(Jams, AnImpactDoesNotGoBackAndForthForLong) {
    EXPECT_LE(run_verified(*family_scene("zigzag/extreme", 8834)).events.size(), 2000u);
    EXPECT_LE(run_verified(*family_scene("zigzag/extreme", 6809)).events.size(), 3000u);
    EXPECT_LE(run_verified(*family_scene("zigzag/wide", 5646)).events.size(), 4000u);
}

// If there is no solution, an unfinished one says nothing about an interval: the interval was cut to 1e-5 s,
// or friction was ignored for as short a time.
TEST(Jams, IntervalsWithoutASolutionAreNotCut) {
    EXPECT_LE(segments_of(run_verified(*family_scene("row_between_walls/extreme", 542))), 4000u);
    EXPECT_LE(segments_of(run_verified(*family_scene("row_between_walls/extreme", 728))), 2500u);
    EXPECT_LE(segments_of(run_verified(*family_scene("row_between_walls/wide", 4939))), 2500u);
}

// Without friction between balls, steps that were to include it had no solution 6900 times (6323 of
// tray/wide, 2.3 s), and intervals were short (27 258 and 11 794 segments).
TEST(Jams, BallsWithoutFrictionAreSolvedWithoutIt) {
    EXPECT_LE(segments_of(run_verified(*family_scene("tray/wide", 6323))), 20000u);
    EXPECT_LE(segments_of(run_verified(*family_scene("rack_in_box/extreme", 9))), 3000u);
}

// In a full tray most contacts have a gap of their own, and rates
// that it had room for had no solution (72 025 segments, 3.4 s).
TEST(Jams, GapsHaveRoomForARate) {
    EXPECT_LE(segments_of(run_verified(*family_scene("tray/wide", 6575))), 50000u);
}

// A gap is used once: the turning of the normal had closed nearly all
// of it, and a rate that was left another half (an overlap of 1e-11 m).
TEST(Jams, GapsAreUsedOnce) {
    EXPECT_EQ(what_breaks(*family_scene("frozen_rail_row/extreme", 32051)), "");
}

// Where balls lock each other, rates that close contacts by 4e-14 m
// in 1e-5 s were left every time, and summed to 1e-12 m and more.
TEST(Jams, OverlapsLeaveNoRoomForMore) {
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/wide", 30694)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", 27547)), "");
}

// Impacts at one instant took all but a thousandth of a speed each,
// to 4e-163 m/s: a million rounds without an event after 6e-163 s.
TEST(Jams, SpeedsWhoseSquaresAreNoneAreRest) {
    EXPECT_EQ(what_breaks(*family_scene("row_between_walls/wide", 45875)), "");
}

// Slips of 4e-12 m/s that a capture leaves count as zero: the ball's
// spin followed its speed, and the energy rose by 1e-10 of itself.
TEST(Jams, SlipsThatCountAsZeroAddNoEnergy) {
    EXPECT_EQ(what_breaks(*family_scene("frozen_rail_row", 40578)), "");
    EXPECT_EQ(what_breaks(*family_scene("frozen_rail_row/extreme", 40878)), "");
}

// In flat wedges impulses of 37 m/s take out 4 mm/s, and rounding leaves 2e-8 m/s of that: as no solution it
// was not taken at all, and balls went into each other by 9.9e-9 m.
TEST(Jams, ClosingSpeedsAreTakenOutAsFarAsRoundingLetsThem) {
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", 24815)), "");
}

// After steps with friction that had no solution, those without it kept
// what was left of these where their normals could not be stabilised.
TEST(Jams, WithoutFrictionNothingIsLeftOfIt) {
    for (const std::uint64_t seed : {1003u, 4302u, 21173u})
        EXPECT_EQ(what_breaks(*family_scene("rack_in_box/wide", seed)), "") << seed;
}

// Attempts at an interval that were used up left the solution of a longer one.
TEST(Jams, UsedUpAttemptsKeepTheirSolution) {
    EXPECT_EQ(what_breaks(*family_scene("gas_of_spins/extreme", 5150)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", 1615)), "");
}

// Wedges so flat that their own forces are 1e4 times what drives them: an overlap of 1e-14 m was never
// removed, or removed with forces that moved balls at rest (2539), and rates that were nearly right added up
// to 1e-12 m. In 7745 a wedge beside them closed 1e-9 m/s too fast.
TEST(Jams, FlatWedgesStayTight) {
    for (const std::uint64_t seed : {5243u, 6660u})
        EXPECT_EQ(what_breaks(*family_scene("row_between_walls/extreme", seed)), "") << seed;
    EXPECT_EQ(what_breaks(*family_scene("row_between_walls/wide", 6270)), "");
    EXPECT_EQ(what_breaks(*family_scene("narrow_channel/extreme", 6264)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box", 2539)), "");
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", 7745)), "");
}

// An overlap of 3e-14 m next to a gap of 1.5e-10 m pressed their row with 1000 m/s^2, and pushed out a ball
// at its side without end: 47 000 segments in a minute, and the energy rose by 1.6e-13 J/kg.
TEST(Jams, OverlapsEndInTheGapsBesideThem) {
    settles_within(*family_scene("rack_in_box/wide", 243), 1000);
}

// Small balls that a cluster at hundreds of m/s would press into each other by more than their radius.
TEST(Jams, ClustersOfSmallBallsStayFinite) {
    for (const std::uint64_t seed : {3077u, 3824u, 6245u, 6720u})
        EXPECT_EQ(what_breaks(*family_scene("tiny_and_huge/extreme", seed)), "") << seed;
}

// A ball touches another, both at rest, and their accelerations close
// the contact by 1e-3 of themselves: they went 7e-9 m into each other.
TEST(Jams, SlowTouchesAreTouches) {
    EXPECT_EQ(what_breaks(*family_scene("jaw_wedge/extreme", 4935)), "");
}

// A closing speed below the rounding of 40 m/s (the surface of a ball) is none, and
// adds up to 1e-12 m within a minute; at 967 m/s the rounding of the time does.
TEST(Jams, WhatRoundingAddsUpToIsNoOverlap) {
    for (const std::uint64_t seed : {3341u, 9360u})
        EXPECT_EQ(what_breaks(*family_scene("tiny_and_huge/extreme", seed)), "") << seed;
    EXPECT_EQ(what_breaks(*family_scene("rack_in_box/extreme", 7687)), "");
}

// Balls that move and cannot meet: each is followed along its own segments, not along the first one forever.
TEST(Jams, SkippedPairsAreJudgedAlongTheirSegments) {
    EXPECT_EQ(what_breaks(*family_scene("funnel/extreme", 4999)), "");
    EXPECT_EQ(what_breaks(*family_scene("tray/extreme", 7225)), "");
}

// Three balls that lean on each other and roll off: a slip of 4e-9
// m/s at the start of each interval set its length, 14 000 times.
TEST(Jams, SlipsThatEndAtOnceSetNoInterval) {
    settles_within(*family_scene("rings/wide", 15), 3000);
}

// Balls of a ring that topspin drives to its centre: the energy rose by 0.6 %.
TEST(Jams, RingDrivenToItsCentre) {
    EXPECT_EQ(what_breaks(*family_scene("rings/extreme", 13)), "");
}

}  // namespace
}  // namespace carom
