// Nine-ball: the sentences of the WPA's Rules of Play (15 March 2016) as shots. Each test name has its rule's
// number.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/games/rules.h"
#include "made_record.h"

namespace carom::test {
namespace {

using games::Call;
using games::Decision;
using games::Foul;
using games::Game;
using games::InHand;
using games::judge;
using games::State;
using games::Verdict;

using Fouls = std::vector<Foul>;
using Decisions = std::vector<Decision>;

const Call kPush = {"", "", false, true};

Told nine_table(int lowest, double y = 0.3) {
    Told told;
    told.ball("cue", 0.6, y).balls(numbered(lowest, 9));
    return told.strike("cue");
}

State nine_break() {
    return games::new_game(&games::kNineBall);
}

State playing() {
    State state = nine_break();
    state.opening = false;
    state.in_hand = InHand::kNo;
    return state;
}

State second_shot() {
    State state = playing();
    state.may_push_out = true;
    return state;
}

TEST(NineBall, Rule23TheBreakHitsTheOneFirstAndABallFallsOrFourReachACushion) {
    EXPECT_EQ(judge(nine_break(), nine_table(1).hit("cue", "2").pocket("3").record()).fouls,
              (Fouls{Foul::kWrongBallFirst}));
    const Told few = nine_table(1).hit("cue", "1").cushion("1").cushion("2").cushion("3").cushion("cue");
    const Verdict three = judge(nine_break(), few.record());
    EXPECT_EQ(three.fouls, (Fouls{Foul::kFewCushionsOnBreak}));
    EXPECT_EQ(three.next().in_hand, InHand::kAnywhere);
    const Verdict four = judge(nine_break(), Told(few).cushion("4").record());
    EXPECT_TRUE(four.fouls.empty());
    EXPECT_EQ(four.next().turn, 1);
    EXPECT_TRUE(four.next().may_push_out);
    EXPECT_EQ(judge(nine_break(), nine_table(1, 0.7).hit("cue", "1").pocket("3").record()).fouls,
              (Fouls{Foul::kPlacedOutside}));
}

TEST(NineBall, Rule24AfterAFairBreakAPushOutNeedsNeitherBallNorCushion) {
    const Verdict broke = judge(nine_break(), nine_table(1).hit("cue", "1").pocket("5").record());
    EXPECT_EQ(broke.next().turn, 0);
    EXPECT_TRUE(broke.next().may_push_out);
    EXPECT_TRUE(games::legal(broke.next(), numbered(1, 9)).may_push_out);
    const Verdict push = judge(second_shot(), nine_table(1).hit("cue", "4").record(), kPush);
    EXPECT_TRUE(push.fouls.empty());
    EXPECT_EQ(push.chooser, 1);
    EXPECT_EQ(decisions(push), (Decisions{Decision::kPlayOn, Decision::kPassBack}));
    EXPECT_EQ(push.options[0].state.turn, 1);
    EXPECT_EQ(push.options[1].state.turn, 0);
    EXPECT_FALSE(push.options[0].state.may_push_out);
    EXPECT_TRUE(judge(second_shot(), nine_table(1).record(), kPush).fouls.empty());
    // Unannounced, it is an ordinary shot; later in the rack there is none.
    EXPECT_EQ(judge(second_shot(), nine_table(1).hit("cue", "4").record()).fouls,
              (Fouls{Foul::kWrongBallFirst, Foul::kNoCushion}));
    EXPECT_EQ(judge(playing(), nine_table(1).record(), kPush).fouls, (Fouls{Foul::kNoBallHit}));
}

TEST(NineBall, Rule24AFoulOnAPushOutIsAFoul) {
    const Verdict v = judge(second_shot(), nine_table(1).hit("cue", "4").pocket("cue").record(), kPush);
    EXPECT_EQ(v.fouls, (Fouls{Foul::kCueBallPocketed}));
    EXPECT_EQ(v.next().in_hand, InHand::kAnywhere);
}

TEST(NineBall, Rule25AFairPotContinuesTheTurn) {
    EXPECT_EQ(games::legal(playing(), std::vector<std::string>{"cue", "7", "3", "9"}).first,
              (std::vector<std::string>{"3"}));
    EXPECT_EQ(judge(playing(), nine_table(3).hit("cue", "3").pocket("7").record()).next().turn, 0);
    EXPECT_EQ(judge(playing(), nine_table(3).hit("cue", "3").cushion("3").record()).next().turn, 1);
}

TEST(NineBall, Rule25TheNineWinsWheneverItFallsFairly) {
    const Verdict v = judge(playing(), nine_table(3).hit("cue", "3").pocket("9").record());
    EXPECT_TRUE(v.next().over);
    EXPECT_EQ(v.next().winner, 0);
    EXPECT_TRUE(judge(nine_break(), nine_table(1).hit("cue", "1").pocket("9").record()).next().over);
}

TEST(NineBall, Rule26TheNineReturnsAfterAFoulAPushOutOrOffTheTable) {
    const Vec2 spot = foot_spot(make_table("nine_foot"));
    for (const Verdict& v : {judge(playing(), nine_table(3).hit("cue", "4").pocket("9").record()),
                             judge(second_shot(), nine_table(1).hit("cue", "4").pocket("9").record(), kPush),
                             judge(playing(), nine_table(3).hit("cue", "3").out("9").record())}) {
        EXPECT_FALSE(v.next().over);
        ASSERT_EQ(v.respots().size(), 1u);
        EXPECT_EQ(v.respots()[0].ball, "9");
        EXPECT_EQ(v.respots()[0].place, spot);
    }
    // No other ball returns.
    EXPECT_TRUE(
        judge(playing(), nine_table(3).hit("cue", "4").pocket("5").out("6").record()).respots().empty());
}

TEST(NineBall, Rule27AFoulGivesTheCueBallInHandAnywhere) {
    const Verdict v = judge(playing(), nine_table(3).hit("cue", "4").pocket("3").record());
    EXPECT_EQ(v.fouls, (Fouls{Foul::kWrongBallFirst}));
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().in_hand, InHand::kAnywhere);
}

TEST(NineBall, Rule614ThreeFoulsInARowLoseTheRack) {
    const Record foul = nine_table(3).hit("cue", "4").record(),
                 fair = nine_table(3).hit("cue", "3").cushion("3").record();
    State state = playing();
    for (int k = 1; k <= 2; ++k) {
        const Verdict v = judge(state, foul);
        EXPECT_FALSE(v.next().over);
        EXPECT_EQ(v.next().fouls[0], k);
        // A fair shot of the other player in between does not count.
        state = judge(v.next(), fair).next();
        EXPECT_EQ(state.turn, 0);
    }
    const Verdict third = judge(state, foul);
    EXPECT_TRUE(third.next().over);
    EXPECT_EQ(third.next().winner, 1);
    EXPECT_EQ(third.fouls.back().foul, Foul::kThirdFoul);
    // A player's own fair shot ends the series.
    EXPECT_EQ(judge(state, fair).next().fouls[0], 0);
}

TEST(NineBall, NumbersThatWouldOverflowAreRefused) {
    const Record record = nine_table(1).hit("cue", "2").record();
    for (std::array<int, 2> State::*const numbers : {&State::points, &State::fouls})
        for (const int value : {INT_MIN, -1, games::kMostPoints + 1, INT_MAX}) {
            State state = playing();
            (state.*numbers)[1] = value;
            EXPECT_THROW(judge(state, record), std::invalid_argument);
        }
}

// The nearest free place of a lattice with steps of a quarter of a radius, by trying all of it.
TEST(NineBall, TheFreePlaceIsTheNearestOne) {
    const Record record = nine_table(1).hit("cue", "2").record();
    const games::Option option = judge(playing(), record).options.front();
    ASSERT_EQ(option.state.in_hand, games::InHand::kAnywhere);
    const double step = record.size(games::index_of(record, "cue")).R / 4.0;
    const Vec2 taken = planar(record.state_at(games::index_of(record, "1"), 0.0).position);
    for (const Vec2& wanted :
         {taken, Vec2(taken + Vec2(0.3 * step, 0.0)), Vec2(0.4, 0.4), Vec2(-0.05, 0.1)}) {
        double least = HUGE_VAL;
        for (int x = -30; x <= 30; ++x)
            for (int y = -30; y <= 30; ++y)
                if (games::may_place(record, option, wanted + step * Vec2(x, y)))
                    least = std::min(least, step * std::hypot(x, y));
        const Vec2 place = games::free_place(record, option, wanted);
        EXPECT_TRUE(games::may_place(record, option, place));
        EXPECT_NEAR((place - wanted).norm(), least, 1e-12);
    }
}

// An option that respots a ball, with a record or scene without that ball, must not read out of bounds.
TEST(NineBall, AnOptionOfAnotherRecordIsRefused) {
    const Record record = nine_table(1).hit("cue", "2").pocket("9").record();
    const Record other = Told().ball("cue", 0.6, 0.3).ball("1", 0.6, 1.0).strike("cue").record();
    const games::Option option = judge(playing(), record).options.front();
    ASSERT_EQ(option.respots.size(), 1u);
    EXPECT_TRUE(games::may_place(record, option, {0.4, 0.4}));
    EXPECT_THROW(games::may_place(other, option, {0.4, 0.4}), std::invalid_argument);
    Scene scene;
    scene.ball.resize(2);
    scene.ball[1].id = "1";
    EXPECT_THROW(games::table_after(scene, other, option), std::invalid_argument);
    EXPECT_THROW(games::table_after(scene, record, option), std::invalid_argument);
    EXPECT_EQ(games::table_after(scene, other, {}).ball.size(), 2u);
}

}  // namespace
}  // namespace carom::test
