// Eight-ball: the sentences of the WPA's Rules of Play (15 March 2016) as shots. Each test name has its
// rule's number.
#include <gtest/gtest.h>

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
using games::Group;
using games::InHand;
using games::judge;
using games::State;
using games::Verdict;

using Fouls = std::vector<Foul>;
using Decisions = std::vector<Decision>;

/// A table with the cue ball at the head, the eight, and these balls.
Told table(const std::vector<std::string>& ids) {
    Told told;
    told.ball("cue", 0.6, 0.6).ball("8", 1.0, 1.9).balls(ids);
    return told;
}

Told full_rack() {
    Told told;
    told.ball("cue", 0.6, 0.3).ball("8", 1.0, 1.9).balls(numbered(1, 7)).balls(numbered(9, 15));
    return told.strike("cue");
}

State break_shot() {
    return games::new_game(&games::kEightBall);
}

/// A state after the break in which player 0 has `own`.
State playing(Group own) {
    State state = games::new_game(&games::kEightBall);
    state.opening = false;
    state.in_hand = InHand::kNo;
    if (own != Group::kOpen) state.group = {own, own == Group::kSolids ? Group::kStripes : Group::kSolids};
    return state;
}

/// A shot in which the cue ball hits `first`, and `potted` falls into p1.
Record potted(const std::vector<std::string>& ids, const std::string& first,
              const std::vector<std::string>& down) {
    Told told = table(ids);
    told.strike("cue").hit("cue", first);
    for (const std::string& ball : down) told.pocket(ball);
    return told.record();
}

TEST(EightBall, Rule33aTheBreakIsPlayedFromBehindTheHeadString) {
    EXPECT_EQ(break_shot().in_hand, InHand::kHeadString);
    Told told;
    told.ball("cue", 0.6, 0.7).ball("8", 1.0, 1.9).balls(numbered(1, 7));
    told.strike("cue").hit("cue", "1").pocket("1");
    EXPECT_EQ(judge(break_shot(), told.record()).fouls, (Fouls{Foul::kPlacedOutside}));
}

TEST(EightBall, Rule33bNoBallIsCalledAndAnyMayBeMetFirst) {
    const games::Legal legal = games::legal(break_shot(), numbered(1, 15));
    EXPECT_EQ(legal.first, numbered(1, 15));
    EXPECT_TRUE(legal.callable.empty());
    EXPECT_TRUE(judge(break_shot(), full_rack().hit("cue", "8").pocket("3").record()).fouls.empty());
}

TEST(EightBall, Rule33cABallOnTheBreakContinuesWithAnOpenTable) {
    const Verdict v = judge(break_shot(), full_rack().hit("cue", "1").pocket("3").record());
    EXPECT_EQ(v.next().turn, 0);
    EXPECT_FALSE(v.next().opening);
    EXPECT_EQ(v.next().group[0], Group::kOpen);
    EXPECT_EQ(v.next().in_hand, InHand::kNo);
}

TEST(EightBall, Rule33dFourBallsToACushionAreALegalBreak) {
    Told told =
        full_rack().hit("cue", "1").cushion("1").cushion("2").cushion("9").cushion("9").cushion("cue");
    const Verdict three = judge(break_shot(), told.record());
    EXPECT_TRUE(three.fouls.empty());
    EXPECT_EQ(three.chooser, 1);
    EXPECT_EQ(decisions(three), (Decisions{Decision::kPlayOn, Decision::kRerack, Decision::kRerackForOther}));
    EXPECT_EQ(three.options[0].state.turn, 1);
    EXPECT_EQ(three.options[1].state, games::new_game(&games::kEightBall, 1));
    EXPECT_EQ(three.options[2].state, games::new_game(&games::kEightBall, 0));
    const Verdict four = judge(break_shot(), told.cushion("12").record());
    EXPECT_EQ(decisions(four), (Decisions{Decision::kPlayOn}));
    EXPECT_EQ(four.chooser, -1);
    EXPECT_EQ(four.next().turn, 1);
}

TEST(EightBall, Rule33eTheEightOnALegalBreakMaySpotOrBreakAgain) {
    const Verdict v = judge(break_shot(), full_rack().hit("cue", "1").pocket("8").record());
    EXPECT_TRUE(v.fouls.empty());
    EXPECT_EQ(v.chooser, 0);
    EXPECT_EQ(decisions(v), (Decisions{Decision::kSpotEight, Decision::kRerack}));
    ASSERT_EQ(v.respots().size(), 1u);
    EXPECT_EQ(v.respots()[0].ball, "8");
    EXPECT_EQ(v.respots()[0].place, foot_spot(make_table("nine_foot")));
    EXPECT_EQ(v.next().turn, 0);
    EXPECT_FALSE(v.next().over);
    EXPECT_EQ(v.options[1].state, games::new_game(&games::kEightBall, 0));
}

TEST(EightBall, Rule33fTheEightWithAScratchOnTheBreakGivesTheOtherTheChoice) {
    const Verdict v = judge(break_shot(), full_rack().hit("cue", "1").pocket("8").pocket("cue").record());
    EXPECT_EQ(v.fouls, (Fouls{Foul::kCueBallPocketed}));
    EXPECT_EQ(v.chooser, 1);
    EXPECT_EQ(decisions(v), (Decisions{Decision::kSpotEight, Decision::kRerack}));
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().in_hand, InHand::kHeadString);
    EXPECT_FALSE(v.next().over);
}

TEST(EightBall, Rule33gABallOffTheTableOnTheBreakStaysOut) {
    const Verdict v = judge(break_shot(), full_rack().hit("cue", "1").out("4").pocket("3").record());
    EXPECT_EQ(v.fouls, (Fouls{Foul::kBallOff}));
    EXPECT_EQ(decisions(v), (Decisions{Decision::kPlayOn, Decision::kTakeInHand}));
    EXPECT_EQ(v.options[1].state.in_hand, InHand::kHeadString);
    EXPECT_TRUE(v.respots().empty());
    // Except the eight.
    const Verdict eight = judge(break_shot(), full_rack().hit("cue", "1").out("8").pocket("3").record());
    EXPECT_FALSE(eight.next().over);
    EXPECT_EQ(eight.respots().size(), 1u);
}

TEST(EightBall, Rule33hAnotherFoulOnTheBreakGivesBallInHandBehindTheHeadString) {
    const Verdict v = judge(break_shot(), full_rack().hit("cue", "1").pocket("3").pocket("cue").record());
    EXPECT_EQ(decisions(v), (Decisions{Decision::kTakeInHand}));
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().in_hand, InHand::kHeadString);
}

TEST(EightBall, Rule34TheFirstCalledBallDecidesTheGroups) {
    const Verdict v = judge(playing(Group::kOpen), potted({"1", "9"}, "1", {"1"}), {"1", "p1"});
    EXPECT_EQ(v.next().turn, 0);
    EXPECT_EQ(v.next().group, (std::array{Group::kSolids, Group::kStripes}));
    // A ball of the other group may be hit first while the table is open.
    const Verdict w = judge(playing(Group::kOpen), potted({"1", "9"}, "1", {"9"}), {"9", "p1"});
    EXPECT_EQ(w.next().group, (std::array{Group::kStripes, Group::kSolids}));
}

TEST(EightBall, Rule34WithoutTheCalledBallTheTableStaysOpen) {
    const Verdict v = judge(playing(Group::kOpen), potted({"1", "9"}, "1", {"9"}), {"1", "p1"});
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().group[0], Group::kOpen);
    // A foul decides no groups, whatever falls.
    const Verdict w = judge(playing(Group::kOpen), potted({"1", "9"}, "1", {"1", "cue"}), {"1", "p1"});
    EXPECT_EQ(w.next().group[0], Group::kOpen);
    EXPECT_EQ(w.next().in_hand, InHand::kAnywhere);
}

TEST(EightBall, Rule34TheEightMayNotBeMetFirstOnAnOpenTable) {
    const Verdict v = judge(playing(Group::kOpen), potted({"1", "9"}, "8", {"1"}), {"1", "p1"});
    EXPECT_EQ(v.fouls, (Fouls{Foul::kWrongBallFirst}));
    const std::vector<std::string> balls = {"cue", "1", "8", "9"};
    EXPECT_EQ(games::legal(playing(Group::kOpen), balls).first, (std::vector<std::string>{"1", "9"}));
}

TEST(EightBall, Rule35OnlyACalledBallContinuesTheTurn) {
    const std::vector<std::string> ids = {"1", "2", "9"};
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "1", {"1"}), {"1", "p1"}).next().turn, 0);
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "2", {"1"}), {"1", "p1"}).next().turn, 0);
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "1", {"1"}), {"1", "p2"}).next().turn, 1);
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "1", {"1"}), {"2", "p1"}).next().turn, 1);
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "1", {"1"})).next().turn, 1);
    // Balls that fall besides the called one stay down without penalty.
    const Verdict both = judge(playing(Group::kSolids), potted(ids, "1", {"9", "1"}), {"1", "p1"});
    EXPECT_EQ(both.next().turn, 0);
    EXPECT_TRUE(both.respots().empty());
    // A ball of the other group cannot be called.
    EXPECT_EQ(judge(playing(Group::kSolids), potted(ids, "1", {"9"}), {"9", "p1"}).next().turn, 1);
}

TEST(EightBall, Rule36ASafetyPassesTheTurnWhateverFalls) {
    const Call safety = {"1", "p1", true};
    const Verdict v = judge(playing(Group::kSolids), potted({"1", "2"}, "1", {"1"}), safety);
    EXPECT_TRUE(v.fouls.empty());
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().in_hand, InHand::kNo);
}

TEST(EightBall, Rule36TheEightIsCalledWhenTheGroupIsGone) {
    const std::vector<std::string> balls = {"8", "9", "10"}, with_one = {"1", "8", "9"};
    EXPECT_EQ(games::legal(playing(Group::kSolids), balls).callable, (std::vector<std::string>{"8"}));
    EXPECT_EQ(games::legal(playing(Group::kSolids), with_one).callable, (std::vector<std::string>{"1"}));
    const Verdict v = judge(playing(Group::kSolids), potted({"9"}, "8", {"8"}), {"8", "p1"});
    EXPECT_TRUE(v.next().over);
    EXPECT_EQ(v.next().winner, 0);
}

TEST(EightBall, Rule38aTheEightWithAFoulLoses) {
    const Verdict v = judge(playing(Group::kSolids), potted({"9"}, "8", {"8", "cue"}), {"8", "p1"});
    EXPECT_TRUE(v.next().over);
    EXPECT_EQ(v.next().winner, 1);
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"9"}, "9", {"8"}), {"8", "p1"}).next().winner, 1);
}

TEST(EightBall, Rule38bTheEightBeforeTheGroupLoses) {
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"1"}, "1", {"8"}), {"8", "p1"}).next().winner, 1);
    // Also if the group's last ball falls in the same shot.
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"1"}, "1", {"1", "8"}), {"8", "p1"}).next().winner, 1);
    EXPECT_EQ(judge(playing(Group::kOpen), potted({"1", "9"}, "1", {"8"}), {"8", "p1"}).next().winner, 1);
}

TEST(EightBall, Rule38cTheEightInAnotherPocketLoses) {
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"9"}, "8", {"8"}), {"8", "p2"}).next().winner, 1);
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"9"}, "8", {"8"})).next().winner, 1);
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"9"}, "8", {"8"}), {"8", "p1", true}).next().winner, 1);
}

TEST(EightBall, Rule38dTheEightOffTheTableLoses) {
    const Record record = table({"9"}).strike("cue").hit("cue", "8").out("8").record();
    EXPECT_EQ(judge(playing(Group::kSolids), record, {"8", "p1"}).next().winner, 1);
}

TEST(EightBall, Rule39AFoulGivesTheCueBallInHandAnywhere) {
    const Verdict v = judge(playing(Group::kSolids), potted({"1", "9"}, "9", {"1"}), {"1", "p1"});
    EXPECT_EQ(v.fouls, (Fouls{Foul::kWrongBallFirst}));
    EXPECT_EQ(v.next().turn, 1);
    EXPECT_EQ(v.next().in_hand, InHand::kAnywhere);
    EXPECT_TRUE(v.respots().empty());
}

TEST(EightBall, Rule61TheCueBallInAPocketOrOffTheTable) {
    EXPECT_EQ(judge(playing(Group::kSolids), potted({"1"}, "1", {"cue"})).fouls,
              (Fouls{Foul::kCueBallPocketed}));
    const Record off = table({"1"}).strike("cue").hit("cue", "1").cushion("1").out("cue").record();
    const std::vector<games::CalledFoul> fouls = judge(playing(Group::kSolids), off).fouls;
    EXPECT_EQ(fouls, (std::vector<games::CalledFoul>{{Foul::kCueBallOff, "WPA 6.1"}}));
}

TEST(EightBall, Rule62TwoBallsHitAtOnceCountForTheShooter) {
    const Record record = table({"1", "9"}).strike("cue").hit_both("cue", "9", "1").cushion("1").record();
    EXPECT_TRUE(judge(playing(Group::kSolids), record).fouls.empty());
}

TEST(EightBall, Rule63WithoutABallDownOneMustReachACushionAfterTheContact) {
    const State state = playing(Group::kSolids);
    const Told met = table({"1", "9"}).strike("cue").cushion("cue").hit("cue", "1");
    EXPECT_EQ(judge(state, met.record()).fouls, (Fouls{Foul::kNoCushion}));
    EXPECT_TRUE(judge(state, Told(met).cushion("cue").record()).fouls.empty());
    EXPECT_TRUE(judge(state, Told(met).cushion("9").record()).fouls.empty());
    EXPECT_TRUE(judge(state, Told(met).pocket("9").record()).fouls.empty());
    const Record nothing = table({"1"}).strike("cue").cushion("cue").record();
    EXPECT_EQ(judge(state, nothing).fouls, (Fouls{Foul::kNoBallHit}));
}

TEST(EightBall, Rule65ABallOffTheTableIsAFoulAndStaysOff) {
    const Record record = table({"1", "9"}).strike("cue").hit("cue", "1").out("9").cushion("1").record();
    const Verdict v = judge(playing(Group::kSolids), record);
    EXPECT_EQ(v.fouls, (Fouls{Foul::kBallOff}));
    EXPECT_TRUE(v.respots().empty());
}

TEST(EightBall, Rule611FromBehindTheHeadStringABallBehindItIsReachedOverTheString) {
    State state = playing(Group::kOpen);
    state.in_hand = InHand::kHeadString;
    Told told;
    told.ball("cue", 0.6, 0.3).ball("8", 1.0, 1.9).ball("1", 0.3, 0.3);
    told.strike("cue");
    const Told straight = Told(told).hit("cue", "1").cushion("1");
    EXPECT_EQ(judge(state, straight.record()).fouls, (Fouls{Foul::kBehindHeadString}));
    const Told around = Told(told).passes("cue", 0.6, 2.4).hit("cue", "1").cushion("1");
    EXPECT_TRUE(judge(state, around.record()).fouls.empty());
    // In hand anywhere, that line does not apply.
    state.in_hand = InHand::kAnywhere;
    EXPECT_TRUE(judge(state, straight.record()).fouls.empty());
}

TEST(EightBall, ShotsOfAnotherGameAreRefused) {
    EXPECT_THROW(judge(break_shot(), Told().ball("cue", 0.5, 0.5).strike("cue").record()),
                 std::invalid_argument);
    EXPECT_THROW(judge(break_shot(), table({"1"}).record()), std::invalid_argument);
    EXPECT_THROW(judge(break_shot(), table({"1"}).strike("1").record()), std::invalid_argument);
    Record cut = potted({"1"}, "1", {});
    cut.stopped = StopReason::kTime;
    EXPECT_THROW(judge(break_shot(), cut), std::invalid_argument);
    State over = playing(Group::kSolids);
    over.over = true;
    EXPECT_THROW(judge(over, potted({"1"}, "1", {})), std::invalid_argument);
    EXPECT_THROW(games::legal(playing(Group::kSolids), std::vector<std::string>{"cue"}),
                 std::invalid_argument);
    EXPECT_THROW(games::new_game(&games::kEightBall, 2), std::invalid_argument);
}

}  // namespace
}  // namespace carom::test
