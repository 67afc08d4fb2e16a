// Random matches: every verdict is consistent, and the next scene is valid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/draws.h"
#include "carom/engine/scene.h"
#include "carom/games/judge_many.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"
#include "carom/kernel/splitmix64.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Game;
using games::InHand;
using games::Option;
using games::State;
using games::Verdict;

struct Start {
    Game game;
    const char* scene;
};
const Start kStarts[] = {
    {&games::kEightBall, "[table]\npreset = \"nine_foot\"\n[rack]\ngame = \"eight_ball\"\n"},
    {&games::kNineBall, "[table]\npreset = \"nine_foot\"\n[rack]\ngame = \"nine_ball\"\n"},
    {&games::kThreeCushion, "[table]\npreset = \"carom\"\n[rack]\ngame = \"three_cushion\"\n"},
    {&games::kSnooker, "[table]\npreset = \"snooker\"\n[rack]\ngame = \"snooker\"\n"},
    {&games::kTenBall, "[table]\npreset = \"nine_foot\"\n[rack]\ngame = \"ten_ball\"\n"},
    {&games::kStraightPool, "[table]\npreset = \"seven_foot\"\n[rack]\ngame = \"triangle\"\n"},
    {&games::kFreePyramid, "[table]\npreset = \"pyramid\"\n[rack]\ngame = \"pyramid\"\n"},
    {&games::kStraightRail, "[table]\npreset = \"carom\"\n[rack]\ngame = \"three_cushion\"\n"},
    {&games::kOneCushion, "[table]\npreset = \"carom_small\"\n[rack]\ngame = \"three_cushion\"\n"},
    {&games::kFourBall, "[table]\npreset = \"carom\"\n[rack]\ngame = \"four_ball\"\n"},
};

/// A match of random players.
class Match {
  public:
    Match(const Start& start, std::uint64_t seed) : start_(start), random_(seed) {
        state_ = games::new_game(start.game, random_.below(2), random_.below(2) * 5);
        for (const games::RuleOption& option : games::info_of(start.game).options)
            games::set_rule(state_, option.key + "=" + option.values[pick(option.values.size())]);
        rack();
    }

    /// Plays until the game is over. @return the number of shots
    int play(int most) {
        for (int shot = 1; shot <= most; ++shot) {
            SCOPED_TRACE("shot " + std::to_string(shot));
            play_one();
            if (state_.over || testing::Test::HasFailure()) return shot;
        }
        return most;
    }

  private:
    std::size_t pick(std::size_t count) {
        return static_cast<std::size_t>(random_.below(static_cast<int>(count)));
    }
    template <class T>
    const T& one_of(const std::vector<T>& list) {
        return list[pick(list.size())];
    }
    double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
    bool chance(double p) { return random_.uniform() < p; }

    void rack() {
        std::string text =
            std::string(start_.scene) + "seed = " + std::to_string(1 + random_.below(1000000)) + "\n";
        if (start_.game == &games::kFourBall || state_.in_hand == InHand::kNo) return begin(text);
        begin(text + "[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n");
    }
    void begin(const std::string& text) {
        scene_ = parse_scene(text, "start.toml");
        Table& table = scene_.table;
        for (BallStart& ball : scene_.ball)
            while (ball.id == "cue" && !games::in_area(table, state_.in_hand, planar(ball.position))) {
                ball.position.x() = table.corner.x() + uniform(0.2, 0.8) * table.width;
                ball.position.y() = table.corner.y() + uniform(0.05, 0.24) * table.length;
            }
    }

    Cue strike(const std::vector<std::string>& balls, const Scene& table) {
        const games::Legal legal = games::legal(state_, balls);
        Cue cue;
        cue.ball = one_of(legal.cue_balls);
        cue.speed = chance(0.2) || state_.opening ? uniform(5.0, 10.0) : uniform(0.3, 4.0);
        cue.side = chance(0.5) ? uniform(-0.4, 0.4) : 0.0;
        cue.height = uniform(-0.3, 0.3);
        if (chance(0.05)) cue.elevation_deg = uniform(10.0, 45.0);
        cue.aim_deg = uniform(0.0, 360.0);
        const int from = index_of(table.ball, cue.ball), to = index_of(table.ball, one_of(legal.first));
        if (chance(0.85) && from != to) {
            const Vec2 way = planar(table.ball[to].position - table.ball[from].position);
            cue.aim_deg = std::atan2(way.y(), way.x()) * 180.0 / std::numbers::pi + uniform(-4.0, 4.0);
        }
        return cue;
    }

    games::Call call(const Record& record) {
        games::Call call;
        if (chance(0.6)) call = games::lucky_call(state_, record);
        const std::vector<std::string> callable = games::legal(state_, ids_of(record.tracks)).callable;
        if (call.ball.empty() && !callable.empty() && chance(0.5)) {
            call.ball = one_of(callable);
            if (!record.table.pockets.empty()) call.pocket = one_of(record.table.pockets).id;
        }
        call.safety = chance(0.1);
        call.push_out = state_.may_push_out && chance(0.3);
        return call;
    }

    void play_one() {
        scene_.cue = strike(ids_of(scene_.ball), scene_);
        const Record record = simulate(plan_of(scene_));
        const Verdict verdict = games::judge(state_, record, call(record));
        check(verdict, record);
        const Option& option = one_of(verdict.options);
        const bool over = option.state.over;
        if (!over && !option.rerack()) next(record, option);
        state_ = option.state;
        if (!over && option.rerack()) rack();
    }

    void next(const Record& record, const Option& option) {
        std::optional<Vec2> place;
        const Table& table = record.table;
        if (option.state.in_hand != InHand::kNo)
            place = games::free_place(
                record, option,
                table.corner + Vec2(uniform(0.1, 0.9) * table.width, uniform(0.05, 0.2) * table.length));
        const Scene after = games::table_after(scene_, record, option, place);
        std::vector<std::string> there = ids_of(after.ball), expected;
        for (std::size_t ball = 0; ball < record.tracks.size(); ++ball) {
            const std::string& id = record.tracks[ball].id;
            const bool gone = is_gone(record.state_at(static_cast<int>(ball), record.duration).state);
            const bool placed = place && id == games::cue_ball(option.state);
            if ((!gone || placed) && !is_back(id, option)) expected.push_back(id);
        }
        for (const games::Respot& back : option.respots) expected.push_back(back.ball);
        std::sort(there.begin(), there.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(there, expected);
        state_ = option.state;
        // Valid with a strike.
        scene_ = games::next_scene(scene_, record, option, strike(ids_of(after.ball), after), place);
    }
    static bool is_back(const std::string& id, const Option& option) {
        return std::any_of(option.respots.begin(), option.respots.end(),
                           [&](const games::Respot& back) { return back.ball == id; });
    }

    void check(const Verdict& verdict, const Record& record) const {
        ASSERT_FALSE(verdict.options.empty());
        EXPECT_TRUE(verdict.chooser >= -1 && verdict.chooser <= 1);
        if (verdict.options.size() == 1) {
            EXPECT_EQ(verdict.chooser, -1);
        }
        for (const Option& option : verdict.options) {
            const State& next = option.state;
            EXPECT_EQ(next.game, state_.game);
            EXPECT_EQ(next.rules, state_.rules);
            EXPECT_EQ(next.target, state_.target);
            EXPECT_TRUE(next.turn == 0 || next.turn == 1);
            EXPECT_EQ(next.over, next.winner >= 0);
            const auto me = static_cast<std::size_t>(state_.turn);
            EXPECT_EQ(next.points[me] - state_.points[me], counts() ? verdict.points : 0);
            EXPECT_EQ(next.points[1 - me] - state_.points[1 - me], verdict.penalty);
            EXPECT_TRUE(next.fouls[0] >= 0 && next.fouls[1] >= 0);
            EXPECT_EQ(next.group[0] == games::Group::kOpen, next.group[1] == games::Group::kOpen);
            if (next.group[0] != games::Group::kOpen) {
                EXPECT_NE(next.group[0], next.group[1]);
            }
            std::vector<std::string> back;
            for (const games::Respot& r : option.respots) back.push_back(r.ball);
            std::sort(back.begin(), back.end());
            EXPECT_EQ(std::adjacent_find(back.begin(), back.end()), back.end());
            for (const games::Respot& r : option.respots) {
                const Vec2 from = r.place - record.table.corner;
                const bool on_bed = from.x() > 0.0 && from.y() > 0.0 && from.x() < record.table.width &&
                                    from.y() < record.table.length;
                // A respotted ball may have been between the jaws of a pocket.
                const int ball = games::index_of(record, r.ball);
                const bool was_there = option.decision == games::Decision::kReplace &&
                                       r.place == planar(record.state_at(ball, 0.0).position);
                EXPECT_TRUE(on_bed || was_there) << r.ball << " by " << name(option.decision);
            }
        }
        if (verdict.fouls.empty() && verdict.points > 0 && !verdict.next().over) {
            EXPECT_EQ(verdict.next().turn, state_.turn);
        }
        if (!verdict.fouls.empty()) {
            EXPECT_LE(verdict.points, 0);
        }
        if (!verdict.fouls.empty() && !verdict.next().over && !verdict.options[0].rerack() &&
            verdict.chooser != state_.turn) {
            EXPECT_EQ(verdict.next().turn, 1 - state_.turn);
        }
    }
    /// Whether the game scores its verdicts' points.
    bool counts() const {
        return state_.game != &games::kEightBall && state_.game != &games::kNineBall &&
               state_.game != &games::kTenBall;
    }

    const Start& start_;
    SplitMix64 random_;
    State state_;
    Scene scene_;
};

class Matches : public testing::TestWithParam<Start> {
  protected:
    void play(int frames, int most) {
        for (int frame = 1; frame <= frames && !HasFailure(); ++frame) {
            SCOPED_TRACE("frame " + std::to_string(frame));
            Match(GetParam(), static_cast<std::uint64_t>(frame)).play(most);
        }
    }
};

TEST_P(Matches, AFewFramesAreConsistent) {
    play(6, 40);
}

TEST_P(Matches, TenThousandFrames) {
    play(10000, 60);
}

INSTANTIATE_TEST_SUITE_P(Of, Matches, testing::ValuesIn(kStarts),
                         [](const auto& of) { return std::string(name(of.param.game)); });

}  // namespace
}  // namespace carom::test
