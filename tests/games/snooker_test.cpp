// Snooker: the sentences of section 3 of the WPBSA's rules as strokes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/games/rules.h"
#include "made_record.h"

namespace carom::test {
namespace {

using games::BallOn;
using games::Decision;
using games::Foul;
using games::Game;
using games::InHand;
using games::judge;
using games::snooker_spot;
using games::State;
using games::Verdict;

using Fouls = std::vector<Foul>;

const Table kTable = make_table("snooker");
const std::vector<std::string> kAllColours = {"yellow", "green", "brown", "blue", "pink", "black"};

/// The cue ball in the D, colours on their spots, reds in a row; struck.
Told snooker_table(int reds, const std::vector<std::string>& colours = kAllColours) {
    Told told("snooker");
    told.ball("cue", 0.8, 0.6);
    for (const std::string& colour : colours) {
        const Vec2 spot = snooker_spot(kTable, colour);
        told.ball(colour, spot.x(), spot.y());
    }
    for (int k = 1; k <= reds; ++k) told.ball(std::to_string(k), 0.2 + 0.1 * k, 2.3);
    return told.strike("cue");
}

State on(BallOn ball) {
    State state = games::new_game(&games::kSnooker);
    state.opening = false;
    state.in_hand = InHand::kNo;
    state.on = ball;
    return state;
}

TEST(Snooker, ARedScoresOneAndStaysDownAndAColourIsOn) {
    const Verdict v = judge(on(BallOn::kRed), snooker_table(5).hit("cue", "1").pocket("1").record());
    EXPECT_EQ(v.points, 1);
    EXPECT_EQ(v.next().points[0], 1);
    EXPECT_EQ(v.next().turn, 0);
    EXPECT_EQ(v.next().on, BallOn::kColour);
    EXPECT_TRUE(v.respots().empty());
    EXPECT_EQ(
        judge(on(BallOn::kRed), snooker_table(5).hit("cue", "1").pocket("1").pocket("2").record()).points, 2);
}

TEST(Snooker, AColourScoresItsValueAndReturnsWhileRedsRemain) {
    const int values[] = {2, 3, 4, 5, 6, 7};
    for (std::size_t k = 0; k < 6; ++k) {
        const std::string& colour = kAllColours[k];
        const Verdict v = judge(on(BallOn::kColour),
                                snooker_table(5).hit("cue", colour).pocket(colour).record(), {colour, ""});
        EXPECT_EQ(v.points, values[k]);
        EXPECT_EQ(v.next().on, BallOn::kRed);
        ASSERT_EQ(v.respots().size(), 1u);
        EXPECT_EQ(v.respots()[0], (games::Respot{colour, snooker_spot(kTable, colour)}));
    }
}

TEST(Snooker, AfterTheLastRedAColourReturnsOnceAndThenTheyFallInOrder) {
    const Verdict last_red = judge(on(BallOn::kRed), snooker_table(1).hit("cue", "1").pocket("1").record());
    EXPECT_EQ(last_red.next().on, BallOn::kColour);
    const Verdict colour =
        judge(on(BallOn::kColour), snooker_table(0).hit("cue", "black").pocket("black").record());
    EXPECT_EQ(colour.points, 7);
    EXPECT_EQ(colour.respots().size(), 1u);
    EXPECT_EQ(colour.next().on, BallOn::kYellow);
    const Verdict yellow =
        judge(on(BallOn::kYellow), snooker_table(0).hit("cue", "yellow").pocket("yellow").record());
    EXPECT_EQ(yellow.points, 2);
    EXPECT_TRUE(yellow.respots().empty());
    EXPECT_EQ(yellow.next().on, BallOn::kGreen);
    // Missed after the last red: the colours follow in order.
    EXPECT_EQ(
        judge(on(BallOn::kColour), snooker_table(0).hit("cue", "black").record(), {"black", ""}).next().on,
        BallOn::kYellow);
}

TEST(Snooker, AMissWithoutAFoulPassesTheTurn) {
    const Verdict v = judge(on(BallOn::kColour), snooker_table(3).hit("cue", "blue").record());
    EXPECT_TRUE(v.fouls.empty());
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().on, BallOn::kRed);
    EXPECT_EQ(v.next().in_hand, InHand::kNo);
}

TEST(Snooker, APenaltyIsFourOrTheValueOfTheBallOnOrConcerned) {
    const auto penalty = [](BallOn ball, const Record& record, const std::string& call = "") {
        const Verdict v = judge(on(ball), record, {call, ""});
        EXPECT_EQ(v.points, 0);
        EXPECT_EQ(v.next().points[1], v.penalty);
        EXPECT_EQ(v.next().points[0], 0);
        return v.penalty;
    };
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).record()), 4);  // no ball hit
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "1").pocket("cue").record()), 4);  // in-off
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "yellow").record()), 4);
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "black").record()), 7);
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "1").pocket("pink").record()), 6);
    EXPECT_EQ(penalty(BallOn::kBlue, snooker_table(0).record()), 5);
    EXPECT_EQ(penalty(BallOn::kColour, snooker_table(3).hit("cue", "1").record(), "pink"), 6);
    EXPECT_EQ(penalty(BallOn::kColour, snooker_table(3).hit("cue", "pink").pocket("1").record(), "pink"), 6);
    EXPECT_EQ(penalty(BallOn::kColour, snooker_table(3).hit("cue", "yellow").record(), "black"), 7);
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "1").out("black").record()), 7);
    EXPECT_EQ(penalty(BallOn::kRed, snooker_table(3).hit("cue", "1").out("2").record()), 4);
}

TEST(Snooker, TwoBallsAtOnceAreAFoulUnlessTheyAreReds) {
    EXPECT_TRUE(judge(on(BallOn::kRed), snooker_table(3).hit_both("cue", "1", "2").record()).fouls.empty());
    const Verdict v = judge(on(BallOn::kRed), snooker_table(3).hit_both("cue", "1", "blue").record());
    EXPECT_EQ(v.fouls, (Fouls{Foul::kTwoBallsAtOnce}));
    EXPECT_EQ(v.penalty, 5);
}

TEST(Snooker, AfterAFoulBallsReturnAndTheOpponentMayLetTheStrikerPlayAgain) {
    const Verdict v = judge(
        on(BallOn::kRed), snooker_table(3).hit("cue", "1").pocket("1").pocket("pink").pocket("cue").record());
    EXPECT_EQ(v.fouls, (Fouls{Foul::kCueBallPocketed, Foul::kWrongBallPocketed}));
    ASSERT_EQ(v.respots().size(), 1u);
    EXPECT_EQ(v.respots()[0].ball, "pink");
    EXPECT_EQ(decisions(v), (std::vector{Decision::kPlayOn, Decision::kPassBack}));
    EXPECT_EQ(v.chooser, 1);
    EXPECT_EQ(v.options[0].state.turn, 1);
    EXPECT_EQ(v.options[0].state.in_hand, InHand::kD);
    EXPECT_EQ(v.options[1].state.turn, 0);
}

TEST(Snooker, InHandTheCueBallIsInTheD) {
    const State opening = games::new_game(&games::kSnooker);
    EXPECT_EQ(opening.in_hand, InHand::kD);
    Told told("snooker");
    told.ball("cue", 0.889, 0.75)
        .ball("black", 0.889, 3.0)
        .ball("1", 0.889, 2.7)
        .strike("cue")
        .hit("cue", "1");
    EXPECT_EQ(judge(opening, told.record()).fouls, (Fouls{Foul::kPlacedOutside}));
    const Vec2 brown = snooker_spot(kTable, "brown");
    EXPECT_TRUE(games::in_area(kTable, InHand::kD, brown));
    EXPECT_TRUE(games::in_area(kTable, InHand::kD, brown + Vec2(0.2, -0.2)));
    EXPECT_FALSE(games::in_area(kTable, InHand::kD, brown + Vec2(0.25, -0.2)));
    EXPECT_FALSE(games::in_area(kTable, InHand::kD, brown + Vec2(0.0, 1e-6)));
}

TEST(Snooker, ASnookerAfterAFoulGivesAFreeBall) {
    // From the cue ball, the black hides the only red.
    Told told("snooker");
    told.ball("cue", 0.889, 2.0)
        .ball("black", 0.889, 2.3)
        .ball("1", 0.889, 2.6)
        .ball("blue", 0.3, 0.3)
        .strike("cue");
    const Verdict v = judge(on(BallOn::kRed), Told(told).hit("cue", "blue").record());
    EXPECT_TRUE(v.next().free_ball);
    EXPECT_EQ(games::legal(v.next(), std::vector<std::string>{"cue", "black", "1", "blue"}).callable,
              (std::vector<std::string>{"black", "1", "blue"}));
    // Not if one edge is only partly covered, nor without a foul.
    const Verdict open =
        judge(on(BallOn::kRed), Told(told).hit("cue", "blue").rests("black", 1.2, 2.3).record());
    EXPECT_FALSE(open.next().free_ball);
    const Verdict edge =
        judge(on(BallOn::kRed), Told(told).hit("cue", "blue").rests("black", 0.93, 2.3).record());
    EXPECT_TRUE(edge.next().free_ball);
    EXPECT_FALSE(judge(on(BallOn::kRed), Told(told).hit("cue", "1").record()).next().free_ball);
}

TEST(Snooker, AFreeBallHasTheValueOfTheBallOnAndReturns) {
    State state = on(BallOn::kRed);
    state.free_ball = true;
    const Verdict red =
        judge(state, snooker_table(3).hit("cue", "blue").pocket("blue").record(), {"blue", ""});
    EXPECT_EQ(red.points, 1);
    EXPECT_EQ(red.next().on, BallOn::kColour);
    EXPECT_EQ(red.respots().size(), 1u);
    EXPECT_EQ(
        judge(state, snooker_table(3).hit("cue", "blue").pocket("blue").pocket("1").record(), {"blue", ""})
            .points,
        2);
    state.on = BallOn::kYellow;
    const Verdict yellow =
        judge(state, snooker_table(0).hit("cue", "black").pocket("black").record(), {"black", ""});
    EXPECT_EQ(yellow.points, 2);
    EXPECT_EQ(yellow.next().on, BallOn::kYellow);
    EXPECT_EQ(yellow.respots().size(), 1u);
    const Verdict both = judge(
        state, snooker_table(0).hit("cue", "black").pocket("black").pocket("yellow").record(), {"black", ""});
    EXPECT_EQ(both.points, 2);
    EXPECT_EQ(both.next().on, BallOn::kGreen);
}

TEST(Snooker, TheLastBlackEndsTheFrameWithAScoreOrAFoul) {
    State state = on(BallOn::kBlack);
    state.points = {50, 52};
    const Verdict won =
        judge(state, snooker_table(0, {"black"}).hit("cue", "black").pocket("black").record());
    EXPECT_TRUE(won.next().over);
    EXPECT_EQ(won.next().winner, 0);
    const Verdict foul = judge(state, snooker_table(0, {"black"}).hit("cue", "black").pocket("cue").record());
    EXPECT_EQ(foul.next().winner, 1);
    EXPECT_EQ(foul.next().points[1], 59);
    EXPECT_FALSE(judge(state, snooker_table(0, {"black"}).hit("cue", "black").record()).next().over);
}

TEST(Snooker, WithEqualPointsTheBlackReturns) {
    State state = on(BallOn::kBlack);
    state.points = {45, 52};
    const Verdict v = judge(state, snooker_table(0, {"black"}).hit("cue", "black").pocket("black").record());
    EXPECT_FALSE(v.next().over);
    EXPECT_EQ(v.next().points[0], 52);
    EXPECT_EQ(v.next().in_hand, InHand::kD);
    EXPECT_EQ(v.options.size(), 2u);
    EXPECT_EQ(v.chooser, -1);
    ASSERT_EQ(v.respots().size(), 1u);
    EXPECT_EQ(v.respots()[0], (games::Respot{"black", snooker_spot(kTable, "black")}));
}

TEST(Snooker, AColourWhoseSpotIsTakenGoesToTheHighestFreeOne) {
    const Vec2 blue = snooker_spot(kTable, "blue"), black = snooker_spot(kTable, "black");
    Told told = snooker_table(3).hit("cue", "blue").pocket("blue").rests("cue", blue.x(), blue.y());
    // Black, pink, brown, green and yellow are on their spots, so none is free.
    const Verdict near = judge(on(BallOn::kColour), told.record());
    ASSERT_EQ(near.respots().size(), 1u);
    EXPECT_EQ(near.respots()[0].place.x(), blue.x());
    EXPECT_GT(near.respots()[0].place.y(), blue.y());
    EXPECT_NEAR(near.respots()[0].place.y() - blue.y(), 2.0 * make_ball_params("snooker").R + games::kSpotGap,
                1e-12);
    const Verdict high = judge(on(BallOn::kColour), Told(told).rests("black", 0.3, 3.0).record());
    EXPECT_EQ(high.respots()[0].place, black);
}

}  // namespace
}  // namespace carom::test
