// Rules on shots that the engine plays: facts read from a record, and whole games of random players.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"
#include "carom/kernel/splitmix64.h"
#include "made_record.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Game;
using games::InHand;
using games::judge;
using games::Option;
using games::Shot;
using games::shot_of;
using games::State;
using games::Verdict;

Scene carom_scene(const Vec2& white, double aim_deg, double speed) {
    Scene scene;
    scene.file = "carom";
    scene.table = make_table("carom");
    use_balls(scene, "carom");
    add_ball(scene, "white", white.x(), white.y());
    add_ball(scene, "yellow", 1.2, 2.6);
    add_ball(scene, "red", 1.2, 0.3);
    Cue cue;
    cue.ball = "white";
    cue.aim_deg = aim_deg;
    cue.speed = speed;
    cue.height = 0.0;
    scene.cue = cue;
    validate(scene);
    return scene;
}

TEST(RealShots, AFrozenCushionCountsWhenTheBallReturns) {
    const double R = make_ball_params("carom").R;
    for (const double aim : {180.0, 150.0, 120.0}) {
        // Into the cushion that it touches, across the table, and back.
        const Plan plan = plan_of(carom_scene({R, 1.42}, aim, 5.0));
        const Record record = simulate(plan);
        const Shot shot = shot_of(record);
        std::vector<bool> driven;
        for (const games::BallContact& t : shot.touches)
            if (t.cushion() && t.ball == shot.struck) driven.push_back(t.driven);
        ASSERT_GE(driven.size(), 3u) << aim;
        EXPECT_FALSE(driven[0]) << aim;
        EXPECT_TRUE(std::all_of(driven.begin() + 1, driven.end(), [](bool d) { return d; })) << aim;
        // A sweep counts as the game does, whatever part of the shot it keeps.
        int before = 0;
        std::set<int> met;
        for (const games::BallContact& t : shot.touches) {
            if (t.ball != shot.struck) continue;
            if (t.cushion() && met.size() < 2) before += t.driven ? 1 : 0;
            if (!t.cushion()) met.insert(t.other);
        }
        RunBuffers buffers;
        for (const bool hash : {false, true}) {
            SimulateOptions options;
            options.hash = hash;
            Outcome outcome;
            simulate(plan, buffers, outcome, options);
            EXPECT_EQ(outcome.approach_cushions, before) << aim;
        }
    }
    // A hair's breadth away, it is not frozen.
    EXPECT_TRUE(shot_of(simulate(plan_of(carom_scene({R + 1e-5, 1.42}, 180.0, 5.0)))).touches[0].driven);
}

TEST(RealShots, TheFirstBallHitMatchesTheOutcome) {
    for (const char* file : {"eight_ball_break", "nine_ball_break", "ten_ball_break", "snooker_break", "draw",
                             "three_cushion", "side_bank"}) {
        Scene scene = read_scene(std::string(CAROM_SOURCE_DIR "/scenes/") + file + ".toml");
        for (int k = 0; k < 20; ++k) {
            scene.cue->aim_deg += 0.37 * k;
            const Plan plan = plan_of(scene);
            const Record record = simulate(plan);
            if (record.stopped != StopReason::kAtRest) continue;
            RunBuffers buffers;
            Outcome outcome;
            simulate(plan, buffers, outcome);
            const Shot shot = shot_of(record);
            EXPECT_EQ(shot.struck, outcome.struck);
            EXPECT_EQ(shot.first_hits.empty() ? -1 : shot.first_hits.front(), outcome.first_hit)
                << file << " " << k;
            for (int ball = 0; ball < static_cast<int>(outcome.balls.size()); ++ball) {
                const int cushions = static_cast<int>(std::count_if(
                    shot.touches.begin(), shot.touches.end(),
                    [ball](const games::BallContact& t) { return t.cushion() && t.ball == ball; }));
                EXPECT_EQ(cushions, outcome.balls[static_cast<std::size_t>(ball)].cushions);
                EXPECT_EQ(shot.fell(ball), outcome.balls[static_cast<std::size_t>(ball)].pocket >= 0);
                EXPECT_EQ(shot.left(ball), outcome.balls[static_cast<std::size_t>(ball)].pocket == kOffTable);
            }
        }
    }
}

TEST(RealShots, TheFarthestPlaceMatchesManySamples) {
    const Record record = simulate(plan_of(read_scene(CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml")));
    SplitMix64 random(4);
    for (int k = 0; k < 40; ++k) {
        const int ball = random.below(static_cast<int>(record.tracks.size()));
        const double angle = 6.28 * random.uniform(), until = record.duration * random.uniform();
        const Vec2 along(std::cos(angle), std::sin(angle));
        double most = -1e9;
        for (int i = 0; i <= 4000; ++i)
            most = std::max(most, dot(along, planar(record.state_at(ball, until * i / 4000.0).position)));
        const double exact = games::farthest(record, ball, along, until);
        EXPECT_GE(exact, most - 1e-12);
        EXPECT_LE(exact, most + 0.01);  // samples are some mm apart
    }
}

/// Players who strike at random at a legal ball. Every game must continue to a legal scene.
class RandomPlayers {
  public:
    RandomPlayers(Game game, std::uint64_t seed) : game_(game), random_(seed) { rack(); }

    /// Plays to the end, or at most this many shots.
    void play(int shots) {
        state_ = games::new_game(game_, 0, 5);
        while (shots-- > 0 && !state_.over) shot();
    }
    const State& state() const { return state_; }
    int fouls = 0, respots = 0, choices = 0, racks = 0, points = 0;

  private:
    void rack() {
        static const char* const kScenes[] = {
            "nine_foot\"\n[rack]\ngame = \"eight_ball\"\n[balls]\npreset = \"pool\"\n",
            "nine_foot\"\n[rack]\ngame = \"nine_ball\"\n[balls]\npreset = \"pool\"\n",
            "carom\"\n[rack]\ngame = \"three_cushion\"\n[balls]\npreset = \"carom\"\n",
            "snooker\"\n[rack]\ngame = \"snooker\"\n[balls]\npreset = \"snooker\"\n",
            "carom\"\n[balls]\npreset = \"carom\"\n[[ball]]\nid = \"1\"\nposition = [0.7, 2.0]\n"};
        std::string text = "[table]\npreset = \"" + std::string(kScenes[number_of(game_)]);
        if (game_ != &games::kThreeCushion) text += "[[ball]]\nid = \"cue\"\nposition = [0.75, 0.5]\n";
        scene_ = parse_scene(text, "rack");
        ++racks;
    }

    std::vector<std::string> ids() const {
        std::vector<std::string> list;
        for (const BallStart& ball : scene_.ball) list.push_back(ball.id);
        return list;
    }
    Vec2 place(const std::string& id) const {
        for (const BallStart& ball : scene_.ball)
            if (ball.id == id) return planar(ball.position);
        return Vec2::Zero();
    }

    void shot() {
        const games::Legal legal = games::legal(state_, ids());
        const std::string target =
            legal.first[static_cast<std::size_t>(random_.below(static_cast<int>(legal.first.size())))];
        Cue cue;
        cue.ball = legal.cue_balls.at(0);
        const Vec2 way = place(target) - place(cue.ball);
        cue.aim_deg = std::atan2(way.y(), way.x()) * 57.29577951308232 + 3.0 * (random_.uniform() - 0.5);
        cue.speed = 1.0 + 7.0 * random_.uniform();
        // Occasionally a jump, so that balls leave the table.
        if (random_.below(8) == 0) cue.elevation_deg = 25.0;
        scene_.cue = cue;
        games::Call call = {target, "p" + std::to_string(1 + random_.below(6)), random_.below(10) == 0,
                            random_.below(2) == 0};
        if (scene_.table.pockets.empty()) call.pocket.clear();
        call.push_out &= game_ == &games::kNineBall || game_ == &games::kTenBall;
        const Record record = simulate(plan_of(scene_));
        const Verdict verdict = judge(state_, record, call);
        check(record, verdict);
        const Option& option =
            verdict
                .options[static_cast<std::size_t>(random_.below(static_cast<int>(verdict.options.size())))];
        state_ = option.state;
        if (state_.over) return;
        if (option.rerack()) {
            rack();
            return;
        }
        const bool gone = shot_of(record).gone(games::index_of(record, cue.ball));
        std::optional<Vec2> put;
        if (state_.in_hand != InHand::kNo && (gone || random_.below(2) == 0))
            put = free_place(record, option);
        Cue next = cue;
        next.ball = games::cue_ball(state_);
        next.elevation_deg = 0.0;
        scene_ = games::next_scene(scene_, record, option, next, put);
    }

    Vec2 free_place(const Record& record, const Option& option) {
        for (;;) {
            const Vec2 at(record.table.width * random_.uniform(), record.table.length * random_.uniform());
            if (games::may_place(record, option, at)) return at;
        }
    }

    void check(const Record& record, const Verdict& verdict) {
        ASSERT_FALSE(verdict.options.empty());
        EXPECT_EQ(verdict.options.size() > 1 && game_ != &games::kSnooker,
                  verdict.chooser >= 0 && game_ != &games::kSnooker);
        const Shot shot = shot_of(record);
        for (const Option& option : verdict.options) {
            // Only lost balls are respotted, or touching ones in three-cushion; once each.
            std::set<std::string> back;
            for (const games::Respot& r : option.respots) {
                EXPECT_TRUE(back.insert(r.ball).second);
                EXPECT_TRUE(shot.gone(games::index_of(record, r.ball)) ||
                            option.decision == games::Decision::kSpotTouching);
            }
            // After a foul the turn passes unless the opponent chooses otherwise.
            const bool final = option.state.over || verdict.chooser >= 0 || game_ == &games::kSnooker;
            EXPECT_TRUE(verdict.fouls.empty() || final || option.state.turn != state_.turn);
            respots += static_cast<int>(option.respots.size());
        }
        for (const games::CalledFoul& called : verdict.fouls) EXPECT_NE(called.rule, "") << name(called.foul);
        fouls += !verdict.fouls.empty();
        choices += verdict.options.size() > 1;
        points += verdict.points;
    }

    Game game_;
    SplitMix64 random_;
    Scene scene_;
    State state_;
};

class RandomGames : public ::testing::TestWithParam<Game> {};

TEST_P(RandomGames, ContinueToLegalScenesUntilTheyEnd) {
    const Game game = GetParam();
    int over = 0, fouls = 0, respots = 0, choices = 0, points = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        RandomPlayers players(game, seed);
        ASSERT_NO_THROW(players.play(80)) << name(game) << " " << seed;
        over += players.state().over;
        fouls += players.fouls;
        respots += players.respots;
        choices += players.choices;
        points += players.points;
    }
    EXPECT_TRUE(over > 3 || game == &games::kSnooker || game == &games::kThreeCushion) << over;
    EXPECT_GT(fouls, 5);
    EXPECT_GT(points, 5);
    EXPECT_TRUE(choices > 3 || game == &games::kSumToThree || game == &games::kThreeCushion) << choices;
    // The eight hardly ever falls on a break.
    EXPECT_TRUE(respots > 3 || game == &games::kEightBall) << respots;
}

INSTANTIATE_TEST_SUITE_P(Of, RandomGames,
                         ::testing::Values(&games::kEightBall, &games::kNineBall, &games::kThreeCushion,
                                           &games::kSnooker, &games::kSumToThree),
                         [](const auto& of) { return std::string(name(of.param)); });

}  // namespace
}  // namespace carom::test
