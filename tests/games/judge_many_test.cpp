// Judged batches: the rules' verdict on every single shot, for any number of threads.
#include "carom/games/judge_many.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "carom/games/shot.h"
#include "carom/kernel/splitmix64.h"
#include "made_record.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Game;
using games::Group;

constexpr kernel::Isa kSet = kernel::Isa::kScalar;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct GameScene {
    Game game;
    std::string text;
};
const std::vector<GameScene>& game_scenes() {
    static const std::string cue = "[cue]\nspeed = 4.0\naim_deg = 90.0\n",
                             ball = "[[ball]]\nid = \"cue\"\nposition = [0.6, 0.5]\n";
    static const std::vector<GameScene> list = {
        {&games::kEightBall, "[rack]\ngame = \"eight_ball\"\n" + ball + cue},
        {&games::kNineBall, "[rack]\ngame = \"nine_ball\"\n" + ball + cue},
        {&games::kThreeCushion,
         "[table]\npreset = \"carom\"\n[balls]\npreset = \"carom\"\n[rack]\ngame = \"three_cushion\"\n"
         "[cue]\nball = \"white\"\nspeed = 4.0\naim_deg = 90.0\n"},
        {&games::kSumToThree, "[table]\npreset = \"carom\"\n[balls]\npreset = \"carom\"\n" + ball +
                                  "[[ball]]\nid = \"1\"\nposition = [0.7, 2.0]\n" + cue}};
    return list;
}

/// Tables with balls anywhere, some missing, and random strikes; occasionally a jump or an illegal strike.
struct RandomTables {
    Scene base;
    std::vector<std::string> keys = {"cue.aim_deg", "cue.speed", "cue.elevation_deg"};
    std::vector<std::vector<double>> values;
    std::vector<std::uint8_t> absent;
    std::vector<std::int32_t> groups;
    std::size_t shots;

    RandomTables(const GameScene& of, std::size_t n) : base(parse_scene(of.text, "game")), shots(n) {
        for (const BallStart& ball : base.ball)
            for (const char* axis : {".position.x", ".position.y"}) keys.push_back("ball." + ball.id + axis);
        values.assign(keys.size(), std::vector<double>(n));
        absent.resize(n * base.ball.size());
        SplitMix64 random(7 + number_of(of.game));
        for (std::size_t i = 0; i < n; ++i) draw(of.game, i, random);
    }

    void draw(Game game, std::size_t i, SplitMix64& random) {
        values[0][i] = 360.0 * random.uniform();
        values[1][i] = i % 20 == 7 ? -1.0 : 2.0 + 5.0 * random.uniform();
        values[2][i] = random.below(6) == 0 ? 30.0 : 0.0;
        groups.push_back(game == &games::kEightBall ? random.below(3) : 0);
        std::vector<Vec2> places;
        while (places.size() < base.ball.size()) {
            const double R = base.balls.R;
            const Vec2 at(R + (base.table.width - 2.0 * R) * random.uniform(),
                          R + (base.table.length - 2.0 * R) * random.uniform());
            const bool free = std::all_of(places.begin(), places.end(),
                                          [&](const Vec2& other) { return length(other - at) > 2.1 * R; });
            if (free) places.push_back(at);
        }
        for (std::size_t b = 0; b < places.size(); ++b) {
            values[3 + 2 * b][i] = places[b].x();
            values[4 + 2 * b][i] = places[b].y();
            const std::string& id = base.ball[b].id;
            const bool needed = base.ball.size() < 4 || id == "cue" || id == "8" || id == "9";
            absent[i * places.size() + b] = !needed && i % 2 == 1 && random.below(2) == 0;
        }
    }

    Scene shot(std::size_t i) const {
        Scene scene = base;
        for (std::size_t k = 0; k < keys.size(); ++k) SceneNumber(scene, keys[k]).put(scene, values[k][i]);
        for (std::size_t b = base.ball.size(); b-- > 0;)
            if (absent[i * base.ball.size() + b] != 0)
                scene.ball.erase(scene.ball.begin() + static_cast<std::ptrdiff_t>(b));
        return scene;
    }
};

struct Judgements {
    std::vector<double> xy;
    std::vector<std::int32_t> group, foul, points;
    std::vector<std::uint8_t> goes_on;
    std::vector<ShotStatus> status;
    std::vector<Batch::Message> messages;
};

Judgements judged(const RandomTables& tables, Game game, int threads) {
    const std::size_t n = tables.shots;
    Judgements j{std::vector<double>(2 * n * tables.base.ball.size(), 7.0),
                 tables.groups,
                 std::vector<std::int32_t>(n, 77),
                 std::vector<std::int32_t>(n, 77),
                 std::vector<std::uint8_t>(n, 77),
                 std::vector<ShotStatus>(n),
                 {}};
    std::vector<BatchColumn> columns;
    for (std::size_t k = 0; k < tables.keys.size(); ++k)
        columns.push_back({tables.keys[k], tables.values[k]});
    BatchOptions options;
    options.threads = threads;
    options.absent = tables.absent;
    BatchArrays out;
    out.status = j.status.data();
    j.messages =
        games::judge_many(game, tables.base, n, columns, kSet, options, out,
                          {j.xy.data(), j.group.data(), j.foul.data(), j.points.data(), j.goes_on.data()});
    return j;
}

/// The first fallen ball that may be called, found ball by ball.
games::Call call_of(const games::State& state, const Scene& scene, const Record& record) {
    std::vector<std::string> ids;
    for (const BallStart& ball : scene.ball) ids.push_back(ball.id);
    const std::vector<std::string> may = games::legal(state, ids).callable;
    for (const games::Shot::Fallen& fallen : games::shot_of(record).pocketed)
        for (const std::string& ball : may)
            if (ball == record.tracks[static_cast<std::size_t>(fallen.ball)].id)
                return {.ball = ball,
                        .pocket = record.table.pockets[static_cast<std::size_t>(fallen.pocket)].id};
    return {};
}

/// Counts of outcomes in a game.
struct Seen {
    int fouls = 0, fair = 0, points = 0, turns = 0, back = 0, refused = 0;
};

void expect_row(const RandomTables& tables, Game game, const Judgements& got, std::size_t i, Seen& seen) {
    const std::size_t balls = tables.base.ball.size();
    const double* const place = got.xy.data() + 2 * balls * i;
    if (got.status[i] != ShotStatus::kAtRest) {
        ++seen.refused;
        EXPECT_EQ(got.foul[i], 77);
        EXPECT_EQ(place[0], 7.0);
        return;
    }
    games::State state = games::new_game(game);
    state.opening = false;
    state.in_hand = games::InHand::kNo;
    const auto own = static_cast<Group>(tables.groups[i]);
    const Group other = own == Group::kSolids    ? Group::kStripes
                        : own == Group::kStripes ? Group::kSolids
                                                 : Group::kOpen;
    state.group = {own, other};
    const Scene scene = tables.shot(i);
    const Record record = simulate(make_plan(scene, kSet));
    const games::Verdict verdict = games::judge(state, record, call_of(state, scene, record));
    EXPECT_EQ(got.foul[i], verdict.fouls.empty() ? -1 : static_cast<int>(verdict.fouls.front().foul));
    EXPECT_EQ(got.group[i], static_cast<int>(verdict.next().group[0]));
    EXPECT_EQ(got.goes_on[i], verdict.next().turn == 0 && !verdict.next().over);
    const games::Shot shot = games::shot_of(record);
    const bool pool = game == &games::kEightBall || game == &games::kNineBall;
    const auto fallen = std::count_if(shot.pocketed.begin(), shot.pocketed.end(),
                                      [&](const games::Shot::Fallen& f) { return f.ball != shot.struck; });
    EXPECT_EQ(got.points[i], !pool ? verdict.points : verdict.fouls.empty() ? fallen : 0);
    for (std::size_t b = 0; b < balls; ++b) {
        const int track = games::index_of(record, tables.base.ball[b].id);
        Vec2 want(kNone, kNone);
        if (track >= 0 && !shot.gone(track)) want = planar(record.state_at(track, record.duration).position);
        for (const games::Respot& back : verdict.respots()) {
            if (back.ball != tables.base.ball[b].id) continue;
            want = back.place;
            ++seen.back;
        }
        for (const int axis : {0, 1}) {
            const double here = place[2 * b + static_cast<std::size_t>(axis)];
            EXPECT_TRUE(here == want[axis] || (std::isnan(here) && std::isnan(want[axis]))) << b;
        }
    }
    ++(verdict.fouls.empty() ? seen.fair : seen.fouls);
    seen.points += got.points[i];
    seen.turns += got.goes_on[i];
}

TEST(JudgeMany, GivesTheVerdictOfTheRulesForEveryShot) {
    for (const GameScene& of : game_scenes()) {
        const RandomTables tables(of, 720);  // few random shots score at three-cushion
        Seen seen;
        for (const int threads : {1, 3}) {
            SCOPED_TRACE(std::string(name(of.game)) + " on " + std::to_string(threads));
            const Judgements got = judged(tables, of.game, threads);
            for (std::size_t i = 0; i < tables.shots; ++i) {
                SCOPED_TRACE(i);
                expect_row(tables, of.game, got, i, seen);
            }
            EXPECT_EQ(got.messages.size(), tables.shots / 20);
        }
        EXPECT_GT(seen.fouls, 0);
        EXPECT_GT(seen.fair, 0);
        EXPECT_GT(seen.points, 0);
        EXPECT_GT(seen.turns, 0);
        EXPECT_EQ(seen.refused, 2 * 36);
        EXPECT_TRUE(seen.back > 0 || of.game == &games::kEightBall);
    }
}

// Like judge(): a table without a ball that the game needs is the caller's error.
TEST(JudgeMany, RefusesATableWithoutItsBalls) {
    RandomTables tables(game_scenes()[1], 40);
    for (std::size_t b = 0; b < tables.base.ball.size(); ++b)
        if (tables.base.ball[b].id == "9") tables.absent[30 * tables.base.ball.size() + b] = 1;
    EXPECT_THROW(judged(tables, &games::kNineBall, 2), std::invalid_argument);
}

}  // namespace
}  // namespace carom::test
