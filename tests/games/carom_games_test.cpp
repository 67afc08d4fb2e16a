// Three-cushion by the rules of the Union Mondiale de Billard, and sum to three.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "carom/games/rules.h"
#include "made_record.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Decision;
using games::Foul;
using games::Game;
using games::judge;
using games::State;
using games::Verdict;

using Fouls = std::vector<Foul>;

Told carom_table() {
    Told told("carom");
    return told.ball("white", 0.5, 0.7).ball("yellow", 0.71, 1.0).ball("red", 0.9, 2.0);
}

Told whites_shot() {
    return carom_table().strike("white");
}

/// A ball, three cushions, the other one.
Record three_between(const std::string& first, const std::string& second) {
    Told told = whites_shot().hit("white", first);
    for (const int part : {0, 1, 2}) told.cushion("white", part);
    return told.hit("white", second).record();
}

State inning(int turn = 0, int target = 0) {
    State state = games::new_game(&games::kThreeCushion, turn, target);
    state.opening = false;
    return state;
}

TEST(ThreeCushion, APointIsThreeCushionsBeforeTheSecondBall) {
    const Record after_first = three_between("red", "yellow");
    const Record before_both = whites_shot()
                                   .cushion("white", 0)
                                   .cushion("white", 1)
                                   .cushion("white", 2)
                                   .hit("white", "yellow")
                                   .hit("white", "red")
                                   .record();
    const Record between = whites_shot()
                               .cushion("white", 0)
                               .hit("white", "red")
                               .cushion("white", 1)
                               .cushion("white", 0)
                               .hit("white", "yellow")
                               .record();
    for (const Record& record : {after_first, before_both, between}) {
        const Verdict v = judge(inning(), record);
        EXPECT_EQ(v.points, 1);
        EXPECT_EQ(v.next().points[0], 1);
        EXPECT_EQ(v.next().turn, 0);
    }
}

TEST(ThreeCushion, TwoCushionsOrOneBallScoreNothing) {
    const Record two = whites_shot()
                           .hit("white", "red")
                           .cushion("white", 0)
                           .cushion("white", 1)
                           .hit("white", "yellow")
                           .cushion("white", 2)
                           .record();
    const Record one_ball = three_between("red", "red");
    // The other balls' cushions do not count.
    const Record others = whites_shot()
                              .hit("white", "red")
                              .cushion("red", 0)
                              .cushion("red", 1)
                              .cushion("red", 2)
                              .hit("white", "yellow")
                              .record();
    for (const Record& record : {two, one_ball, others}) {
        const Verdict v = judge(inning(), record);
        EXPECT_EQ(v.points, 0);
        EXPECT_TRUE(v.fouls.empty());
        EXPECT_EQ(v.next().turn, 1);
    }
}

TEST(ThreeCushion, TheSameCushionCountsAgain) {
    const Record record = whites_shot()
                              .hit("white", "red")
                              .cushion("white", 1)
                              .passes("white", 0.7, 1.0)
                              .cushion("white", 1)
                              .passes("white", 0.7, 1.0)
                              .cushion("white", 1)
                              .hit("white", "yellow")
                              .record();
    EXPECT_EQ(judge(inning(), record).points, 1);
}

TEST(ThreeCushion, EachPlayerHasABall) {
    EXPECT_EQ(games::legal(inning(0), std::vector<std::string>{"white", "yellow", "red"}).cue_balls,
              (std::vector<std::string>{"white"}));
    EXPECT_EQ(games::legal(inning(1), std::vector<std::string>{"white", "yellow", "red"}).first,
              (std::vector<std::string>{"white", "red"}));
    const Record record = three_between("red", "yellow");
    const Verdict v = judge(inning(1), record);
    EXPECT_EQ(v.fouls, (Fouls{Foul::kWrongCueBall}));
    EXPECT_EQ(v.points, 0);
    EXPECT_EQ(v.next().turn, 0);
}

TEST(ThreeCushion, TheOpeningShotIsAtTheRed) {
    const State opening = games::new_game(&games::kThreeCushion);
    EXPECT_EQ(games::legal(opening, std::vector<std::string>{"white", "yellow", "red"}).first,
              (std::vector<std::string>{"red"}));
    const Record yellow = three_between("yellow", "red");
    const Verdict v = judge(opening, yellow);
    EXPECT_EQ(v.fouls, (Fouls{Foul::kOpeningNotRed}));
    EXPECT_EQ(v.points, 0);
    EXPECT_EQ(judge(inning(), yellow).points, 1);
}

TEST(ThreeCushion, BallsOffTheTableReturnToTheirSpots) {
    const Table carom = make_table("carom");
    const Verdict red = judge(inning(), whites_shot().hit("white", "red").out("red").record());
    EXPECT_EQ(red.fouls, (Fouls{Foul::kBallOff}));
    EXPECT_EQ(red.next().turn, 1);
    ASSERT_EQ(red.respots().size(), 1u);
    EXPECT_EQ(red.respots()[0].place, foot_spot(carom));
    // Yellow is the next player's cue ball.
    const Verdict all =
        judge(inning(), whites_shot().hit("white", "red").out("red").out("white").out("yellow").record());
    ASSERT_EQ(all.respots().size(), 3u);
    EXPECT_EQ(all.respots()[0], (games::Respot{"red", foot_spot(carom)}));
    EXPECT_EQ(all.respots()[1], (games::Respot{"white", games::center_spot(carom)}));
    EXPECT_EQ(all.respots()[2], (games::Respot{"yellow", games::head_spot(carom)}));
}

TEST(ThreeCushion, ABallWhoseSpotIsTakenGoesToTheBlockingBallsSpot) {
    const Table carom = make_table("carom");
    const Vec2 foot = foot_spot(carom);
    // Yellow, the next cue ball, lies on the foot spot, so the red goes to the head spot.
    const Record one =
        whites_shot().hit("white", "red").out("red").rests("yellow", foot.x(), foot.y()).record();
    EXPECT_EQ(judge(inning(), one).respots()[0].place, games::head_spot(carom));
    // White lies on it, so the red goes to the middle.
    const Record other =
        whites_shot().hit("white", "red").out("red").rests("white", foot.x() + 0.01, foot.y()).record();
    EXPECT_EQ(judge(inning(), other).respots()[0].place, games::center_spot(carom));
}

TEST(ThreeCushion, TouchingBallsMayBeSpotted) {
    const double R = make_ball_params("carom").R;
    const Record touching =
        whites_shot().hit("white", "red").rests("yellow", 0.5, 1.0).rests("red", 0.5 + 2.0 * R, 1.0).record();
    const Verdict v = judge(inning(), touching);
    EXPECT_EQ(decisions(v), (std::vector{Decision::kPlayOn, Decision::kSpotTouching}));
    EXPECT_EQ(v.chooser, 1);
    EXPECT_TRUE(v.options[0].respots.empty());
    ASSERT_EQ(v.options[1].respots.size(), 2u);
    EXPECT_EQ(v.options[1].respots[0], (games::Respot{"yellow", games::head_spot(make_table("carom"))}));
    EXPECT_EQ(v.options[1].respots[1], (games::Respot{"red", foot_spot(make_table("carom"))}));
    const Record apart = whites_shot()
                             .hit("white", "red")
                             .rests("yellow", 0.5, 1.0)
                             .rests("red", 0.501 + 2.0 * R, 1.0)
                             .record();
    EXPECT_EQ(judge(inning(), apart).options.size(), 1u);
}

TEST(ThreeCushion, TheTargetEndsTheGame) {
    State state = inning(0, 2);
    state.points = {1, 0};
    const Record point = three_between("red", "yellow");
    const Verdict v = judge(state, point);
    EXPECT_TRUE(v.next().over);
    EXPECT_EQ(v.next().winner, 0);
}

TEST(ThreeCushion, ATouchingBallMustNotBePlayedInto) {
    for (const Game game : {&games::kThreeCushion, &games::kOneCushion, &games::kStraightRail}) {
        State state = games::new_game(game);
        state.opening = false;
        // The red touches at 68.755 degrees.
        for (const auto& [aim, foul] : {std::pair(5.0, true),
                                        {68.0, true},
                                        {158.0, true},
                                        {160.0, false},
                                        {250.0, false},
                                        {338.0, false}}) {
            const Scene scene = parse_scene(
                "table.preset = \"carom\"\nball = [{id = \"white\", position = [0.5, 0.7]}, {id = \"red\", "
                "position = [0.5222850019003155, 0.7573204037869844]}, {id = \"yellow\", position = [0.95, "
                "0.71]}]\ncue = {ball = \"white\", speed = 2, offset = [0, 0], aim_deg = " +
                    std::to_string(aim) + "}",
                "touching");
            const Verdict v = judge(state, simulate(plan_of(scene)));
            EXPECT_EQ(v.fouls, foul ? Fouls{Foul::kIntoTouchingBall} : Fouls()) << aim;
            EXPECT_TRUE(!foul || v.points == 0);
        }
    }
}

TEST(SumToThree, ThreeCushionsOfBothBallsWithAHitScore) {
    const auto shot = [](int cue, int object, bool hit) {
        Told told("carom");
        told.ball("cue", 0.5, 0.7).ball("1", 0.71, 1.5).strike("cue");
        if (hit) told.hit("cue", "1");
        for (int k = 0; k < cue; ++k) told.cushion("cue", k % 4);
        for (int k = 0; k < object; ++k) told.cushion("1", k % 4);
        return told.record();
    };
    const State state = games::new_game(&games::kSumToThree, 0, 10);
    for (int cue = 0; cue <= 4; ++cue)
        for (int object = 0; object <= 4; ++object) {
            const Verdict v = judge(state, shot(cue, object, true));
            EXPECT_EQ(v.points, cue + object == 3 ? 1 : 0);
            EXPECT_EQ(v.next().turn, cue + object == 3 ? 0 : 1);
        }
    EXPECT_EQ(judge(state, shot(3, 0, false)).points, 0);
    State last = state;
    last.points[0] = 9;
    EXPECT_EQ(judge(last, shot(1, 2, true)).next().winner, 0);
}

}  // namespace
}  // namespace carom::test
