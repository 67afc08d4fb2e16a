// Batches have the bits of single shots for any number of threads, report failures as statuses, and vary the
// keys that are numbers.
#include "carom/engine/batch.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/kernel/splitmix64.h"
#include "support/engine_cases.h"
#include "support/pages.h"
#include "support/random_scenes.h"
#include "support/scenes.h"

namespace carom::test {
namespace {

constexpr kernel::Isa kIsa = kernel::Isa::kScalar;

/// Columns of a batch with their values.
struct Columns {
    std::vector<std::string> keys;
    std::vector<std::vector<double>> values;
    std::size_t shots = 0;

    Columns(std::size_t n) : shots(n) {}
    Columns& add(const std::string& key, SplitMix64& random, double low, double high) {
        keys.push_back(key);
        std::vector<double>& column = values.emplace_back();
        for (std::size_t i = 0; i < shots; ++i) column.push_back(low + (high - low) * random.uniform());
        return *this;
    }
    Batch play(const Scene& scene, int threads, bool hash = true) const {
        std::vector<BatchColumn> columns;
        for (std::size_t k = 0; k < keys.size(); ++k) columns.push_back({keys[k], values[k]});
        BatchOptions options;
        options.threads = threads;
        options.hash = hash;
        return simulate_many(scene, shots, columns, kIsa, options);
    }
    Scene shot(Scene scene, std::size_t i) const {
        for (std::size_t k = 0; k < keys.size(); ++k) SceneNumber(scene, keys[k]).put(scene, values[k][i]);
        return scene;
    }
};

/// The balls that a ball meets, in order, and its cushion contacts before the second of them.
struct Contacts {
    std::vector<int> balls;
    int cushions = 0;
};
Contacts contacts_of(const Record& record, int ball) {
    Contacts found;
    for (const Event& e : record.events) {
        each_hit(e, record.hits(e), [&](const Hit& hit) {
            if (hit.partner != Partner::kBall) {
                const bool wall = hit.partner == Partner::kCushion || hit.partner == Partner::kJaw;
                if (wall && hit.a == ball && found.balls.size() < 2) ++found.cushions;
                return;
            }
            if (hit.a != ball && hit.b != ball) return;
            const int met = hit.a == ball ? hit.b : hit.a;
            if (std::find(found.balls.begin(), found.balls.end(), met) == found.balls.end())
                found.balls.push_back(met);
        });
    }
    return found;
}

int first_hit(const Record& record, int ball) {
    const Contacts found = contacts_of(record, ball);
    return found.balls.empty() ? -1 : found.balls.front();
}

int struck(const Scene& scene) {
    for (std::size_t i = 0; i < scene.ball.size(); ++i)
        if (scene.cue ? scene.ball[i].id == scene.cue->ball
                      : scene.ball[i].velocity != Vec3::Zero() || scene.ball[i].spin != Vec3::Zero())
            return static_cast<int>(i);
    return -1;
}

void expect_same(const Batch& batch, std::size_t shot, const Scene& scene, const Record& record) {
    ASSERT_EQ(static_cast<int>(batch.status[shot]), static_cast<int>(record.stopped));
    EXPECT_EQ(fmt::format("{:016x}", batch.hash[shot]), record.hash());
    EXPECT_EQ(batch.duration[shot], record.duration);
    EXPECT_EQ(batch.events[shot], static_cast<std::int64_t>(record.events.size()));
    EXPECT_EQ(batch.first_hit[shot], first_hit(record, struck(scene)));
    const Contacts contacts = contacts_of(record, struck(scene));
    EXPECT_EQ(batch.contacts[shot], static_cast<int>(contacts.balls.size()));
    EXPECT_EQ(batch.approach_cushions[shot], contacts.cushions);
    std::vector<int> cushions(batch.balls), fell(batch.balls, -1);
    int fallen = 0;
    for (const Event& e : record.events) {
        each_hit(e, record.hits(e), [&](const Hit& hit) {
            cushions[hit.a] += hit.partner == Partner::kCushion || hit.partner == Partner::kJaw;
        });
        if (e.type == EventType::kBallPocket) fell[e.a] = fallen++;
    }
    for (std::size_t b = 0; b < batch.balls; ++b) {
        const BallState end = record.state_at(static_cast<int>(b), record.duration);
        const std::size_t at = shot * batch.balls + b;
        EXPECT_EQ(batch.xy[2 * at], end.position.x());
        EXPECT_EQ(batch.xy[2 * at + 1], end.position.y());
        EXPECT_EQ(batch.pocket[at], end.pocket);
        EXPECT_EQ(batch.fell[at], fell[b]);
        EXPECT_EQ(batch.cushions[at], cushions[b]);
    }
}

/// Compares all bits of all columns.
void expect_equal(const Batch& a, const Batch& b) {
    for (const OutcomeColumn& column : kOutcomeColumns) {
        if (column.array(a) == nullptr || column.array(b) == nullptr) {
            EXPECT_EQ(column.array(a), column.array(b)) << column.name;
            continue;
        }
        const std::size_t size = a.shots * column.each(a.balls) * column.size;
        EXPECT_EQ(std::memcmp(column.array(a), column.array(b), size), 0) << column.name;
    }
}

/// Plays a batch on 1, 2 and 3 threads, and every shot by itself.
void expect_batch(const Scene& scene, const Columns& columns, std::size_t least_valid) {
    const Batch batch = columns.play(scene, 1);
    std::size_t valid = 0, message = 0;
    for (std::size_t i = 0; i < columns.shots; ++i) {
        const Scene shot = columns.shot(scene, i);
        std::string why;
        try {
            validate(shot);
            expect_same(batch, i, shot, simulate(make_plan(shot, kIsa)));
            ++valid;
            continue;
        } catch (const SceneError& error) {
            why = error.message();
            EXPECT_EQ(batch.status[i], ShotStatus::kInvalid);
        } catch (const SimulationError& error) {
            why = error.what();
            EXPECT_EQ(batch.status[i], ShotStatus::kFailed);
        }
        ASSERT_LT(message, batch.messages.size());
        EXPECT_EQ(batch.messages[message].shot, i);
        EXPECT_EQ(batch.messages[message++].text, why);
        EXPECT_TRUE(std::isnan(batch.duration[i]));
        EXPECT_EQ(batch.first_hit[i], -1);
    }
    EXPECT_EQ(message, batch.messages.size());
    EXPECT_GE(valid, least_valid);
    for (const int threads : {2, 3}) {
        const Batch again = columns.play(scene, threads);
        expect_equal(again, batch);
        ASSERT_EQ(again.messages.size(), batch.messages.size());
        for (std::size_t k = 0; k < batch.messages.size(); ++k) {
            EXPECT_EQ(again.messages[k].shot, batch.messages[k].shot);
            EXPECT_EQ(again.messages[k].text, batch.messages[k].text);
        }
    }
    EXPECT_EQ(columns.play(scene, 1, false).hash, nullptr);
}

TEST(Batch, HasTheBitsOfSingleShots) {
    SplitMix64 random(3);
    for (const char* name : {"three_cushion", "draw", "side_bank", "eight_ball_break"}) {
        const Scene scene = shipped(name);
        Columns columns(name == std::string("eight_ball_break") ? 25 : 100);
        columns.add("cue.aim_deg", random, 0.0, 360.0).add("cue.speed", random, 0.5, 6.0);
        columns.add("cue.offset.side", random, -0.3, 0.3).add("cue.offset.1", random, -0.3, 0.3);
        columns.add("balls.mu_r", random, 0.005, 0.02).add("balls.mu_b", random, 0.0, 0.1);
        columns.add("physics.gravity", random, 9.7, 9.9);
        SCOPED_TRACE(name);
        expect_batch(scene, columns, columns.shots);
    }
}

// Positions that overlap or lie in a cushion, values out of range, speeds of a struck ball.
TEST(Batch, InvalidShotsAreStatuses) {
    SplitMix64 random(4);
    const Scene scene = shipped("side_bank");
    const std::string other = scene.ball[1].id;
    Columns columns(150);
    columns.add("ball.cue.position.x", random, 0.0, 1.27).add("ball.cue.position.y", random, -0.05, 2.6);
    columns.add("ball." + other + ".position.x", random, 0.2, 1.0)
        .add("ball." + other + ".position.y", random, 0.2, 1.0);
    columns.add("cue.speed", random, -0.3, 3.0)
        .add("balls.f_c", random, 0.0, 0.4)
        .add("balls.e_c", random, 0.5, 1.05);
    columns.add("balls.mu_sp", random, -0.0005, 0.01);
    expect_batch(scene, columns, 50);
    Columns sizes(60);
    sizes.add("balls.radius", random, 0.02, 0.04)
        .add("balls.mass", random, 0.1, 0.2)
        .add("table.pocket.p2.radius", random, 0.04, 0.08);
    sizes.add("table.cushion.c1.height", random, 0.02, 0.05)
        .add("table.jaw.j1.radius", random, -0.001, 0.02)
        .add("stop.time", random, 0.0, 3.0);
    expect_batch(scene, sizes, 20);
}

TEST(Batch, RandomScenesOfEveryKind) {
    SplitMix64 random(5);
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Scene scene = RandomScene(seed).make();
        Columns columns(6);
        for (std::size_t i = 0; i < std::min<std::size_t>(3, scene.ball.size()); ++i) {
            const BallStart& ball = scene.ball[i];
            columns.add("ball." + ball.id + ".position.x", random, ball.position.x() - 0.01,
                        ball.position.x() + 0.01);
            if (!scene.cue) columns.add("ball." + ball.id + ".velocity.y", random, -2.0, 2.0);
        }
        columns.add("balls.e_b", random, 0.8, 1.0);
        SCOPED_TRACE(seed);
        expect_batch(scene, columns, 0);
    }
}

TEST(Batch, ARefusedEffectIsAStatusWithAReason) {
    Scene scene = shipped("draw");
    scene.effects = {{"squirt", false, {}}};
    scene.cue->side = 0.0;
    Columns columns(2);
    columns.keys = {"cue.offset.side"};
    columns.values = {{0.0, 0.1}};
    const Batch batch = columns.play(scene, 1);
    EXPECT_EQ(batch.status[0], ShotStatus::kAtRest);
    EXPECT_EQ(batch.status[1], ShotStatus::kInvalid);
    ASSERT_EQ(batch.messages.size(), 1u);
    EXPECT_EQ(batch.messages[0].text,
              "effects.squirt = false, but the scene needs it: the cue strikes off centre; remove the line");
}

TEST(Batch, AFailedRunIsAStatusAndTheOthersArePlayed) {
    // A ball that lands exactly on top of another balances for ever.
    Scene scene = empty_scene();
    add_ball(scene, "a", Vec3(0.0, 0.0, scene.balls.R + 0.1));
    scene.ball[0].height = 0.1;
    add_ball(scene, "b", 0.0, 0.0);
    Columns columns(3);
    columns.keys = {"ball.a.position.x"};
    columns.values = {{-0.5, 0.0, -0.4}};
    const Batch batch = columns.play(scene, 2);
    EXPECT_EQ(batch.status[0], ShotStatus::kAtRest);
    EXPECT_EQ(batch.status[2], ShotStatus::kAtRest);
    EXPECT_EQ(batch.status[1], ShotStatus::kFailed);
    ASSERT_EQ(batch.messages.size(), 1u);
    EXPECT_EQ(batch.messages[0].shot, 1u);
    EXPECT_NE(batch.messages[0].text.find("simulation stopped at t = "), std::string::npos);
    // A single run also provides the record up to there.
    try {
        simulate(make_plan(scene, kIsa));
        ADD_FAILURE() << "the run went on";
    } catch (const SimulationError& error) {
        EXPECT_EQ(error.what(), batch.messages[0].text);
        ASSERT_NE(error.so_far(), nullptr);
        EXPECT_EQ(error.so_far()->tracks.size(), 2u);
        EXPECT_GT(error.so_far()->duration, 0.1);
        EXPECT_GT(error.so_far()->tracks[0].segments.size(), 0u);
    }
}

TEST(Batch, FillsOnlyTheCallersArrays) {
    const Scene scene = shipped("draw");
    const std::vector<double> speeds = {2.0, -1.0, 3.0};
    const BatchColumn column{"cue.speed", speeds};
    BatchOptions options;
    options.hash = true;
    const Batch whole = simulate_many(scene, speeds.size(), {&column, 1}, kIsa, options);
    const std::size_t balls = scene.ball.size();
    std::vector<double> xy(2 * speeds.size() * balls, 7.0);
    std::vector<std::int32_t> pocket(speeds.size() * balls, 7);
    std::vector<std::uint64_t> hash(speeds.size(), 7);
    BatchArrays out;
    out.xy = xy.data();
    out.pocket = pocket.data();
    out.hash = hash.data();
    const auto messages = simulate_many(scene, speeds.size(), {&column, 1}, kIsa, options, out);
    for (std::size_t i = 0; i < xy.size(); ++i)
        EXPECT_TRUE(i / (2 * balls) == 1 ? std::isnan(xy[i]) : xy[i] == whole.xy[i]) << i;
    EXPECT_TRUE(std::equal(pocket.begin(), pocket.end(), whole.pocket));
    EXPECT_TRUE(std::equal(hash.begin(), hash.end(), whole.hash));
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].shot, 1u);
    EXPECT_EQ(messages[0].text, whole.messages.at(0).text);
}

TEST(Batch, AbsentBallsTakeNoPart) {
    SplitMix64 random(11);
    const Scene scene = shipped("eight_ball_break");
    const std::size_t balls = scene.ball.size();
    Columns columns(30);
    columns.add("cue.aim_deg", random, 80.0, 100.0).add("ball.1.position.y", random, 1.85, 1.9);
    // All balls, some, only the cue ball, and none at all.
    std::vector<std::uint8_t> absent(columns.shots * balls);
    for (std::size_t i = 0; i < columns.shots; ++i)
        for (std::size_t b = 0; b < balls; ++b)
            absent[i * balls + b] = i % 5 == 0   ? 0
                                    : i % 5 == 1 ? b > 0
                                    : i == 2     ? 1
                                                 : b > 0 && random.below(2) == 0;
    BatchOptions options;
    options.hash = true;
    options.absent = absent;
    for (const int threads : {1, 2}) {
        options.threads = threads;
        std::vector<BatchColumn> list;
        for (std::size_t k = 0; k < columns.keys.size(); ++k)
            list.push_back({columns.keys[k], columns.values[k]});
        const Batch batch = simulate_many(scene, columns.shots, list, kIsa, options);
        for (std::size_t i = 0; i < columns.shots; ++i) {
            Scene shot = columns.shot(scene, i);
            std::vector<BallStart> left;
            for (std::size_t b = 0; b < balls; ++b)
                if (absent[i * balls + b] == 0) left.push_back(shot.ball[b]);
            shot.ball = left;
            if (i == 2) {
                EXPECT_EQ(batch.status[i], ShotStatus::kInvalid);
                EXPECT_TRUE(std::isnan(batch.xy[2 * i * balls]));
                continue;
            }
            const Record record = simulate(make_plan(shot, kIsa));
            EXPECT_EQ(fmt::format("{:016x}", batch.hash[i]), record.hash());
            EXPECT_EQ(batch.duration[i], record.duration);
            int ball = 0;
            for (std::size_t b = 0; b < balls; ++b) {
                const std::size_t at = i * balls + b;
                if (absent[at] != 0) {
                    EXPECT_TRUE(std::isnan(batch.xy[2 * at]) && std::isnan(batch.xy[2 * at + 1]));
                    EXPECT_EQ(batch.pocket[at], -1);
                    EXPECT_EQ(batch.fell[at], -1);
                    EXPECT_EQ(batch.cushions[at], 0);
                    EXPECT_NE(batch.first_hit[i], static_cast<int>(b));
                    continue;
                }
                const BallState end = record.state_at(ball, record.duration);
                EXPECT_EQ(batch.xy[2 * at], end.position.x());
                EXPECT_EQ(batch.pocket[at], end.pocket);
                if (ball == first_hit(record, 0)) {
                    EXPECT_EQ(batch.first_hit[i], static_cast<int>(b));
                }
                ++ball;
            }
        }
    }
    options.absent = std::span(absent).first(3);
    EXPECT_THROW(simulate_many(scene, 1, {}, kIsa, options), std::invalid_argument);
}

// A judge receives the record of every shot that has a result, with and without all balls; its exceptions end
// the batch.
TEST(Batch, AJudgeReadsTheRecordsOfSingleShots) {
    SplitMix64 random(17);
    const Scene scene = shipped("side_bank");
    const std::size_t balls = scene.ball.size();
    Columns columns(80);
    columns.add("cue.aim_deg", random, 0.0, 360.0).add("cue.speed", random, -0.5, 6.0);
    std::vector<std::uint8_t> absent(columns.shots * balls);
    for (std::size_t i = 0; i < columns.shots; i += 3) absent[i * balls + 1] = 1;
    std::vector<BatchColumn> list;
    for (std::size_t k = 0; k < columns.keys.size(); ++k)
        list.push_back({columns.keys[k], columns.values[k]});
    BatchOptions options;
    options.absent = absent;
    for (const bool hash : {false, true}) {
        options.hash = hash;
        options.judge = nullptr;
        const Batch unjudged = simulate_many(scene, columns.shots, list, kIsa, options);
        for (const int threads : {1, 3}) {
            options.threads = threads;
            std::vector<Record> records(columns.shots);
            std::vector<int> judged(columns.shots);
            options.judge = [&](std::size_t shot, const Outcome& outcome, const Record& record) {
                records[shot] = record;
                ++judged[shot];
                EXPECT_EQ(outcome.duration, record.duration);
                EXPECT_EQ(outcome.balls.size(), record.tracks.size());
            };
            const Batch batch = simulate_many(scene, columns.shots, list, kIsa, options);
            expect_equal(batch, unjudged);
            int refused = 0;
            for (std::size_t i = 0; i < columns.shots; ++i) {
                refused += !has_result(batch.status[i]);
                ASSERT_EQ(judged[i], has_result(batch.status[i])) << i;
                if (judged[i] == 0) continue;
                Scene shot = columns.shot(scene, i);
                if (absent[i * balls + 1] != 0) shot.ball.erase(shot.ball.begin() + 1);
                EXPECT_EQ(records[i], simulate(make_plan(shot, kIsa))) << i;
            }
            EXPECT_GT(refused, 0);
        }
    }
    options.judge = [](std::size_t shot, const Outcome&, const Record&) {
        if (shot > 20) throw std::domain_error("no such shot");
    };
    EXPECT_THROW(simulate_many(scene, columns.shots, list, kIsa, options), std::domain_error);
}

TEST(Batch, ShotsOfAVariationEqualThoseOfItsScenes) {
    const std::string text = read_source("scenes/draw.toml");
    // In the second list, one value is not a number of the scene.
    for (const std::vector<std::string>& rules :
         {std::vector<std::string>{"cue.aim_deg=normal(2)", "cue.speed=uniform(-0.1,4)"},
          std::vector<std::string>{"cue.aim_deg=normal(2)",
                                   "physics.cushion=list(\"smooth\",\"stronge\",\"none\")"}}) {
        const Variation variation = Variation::from_text(text, "draw", rules, 5);
        constexpr std::size_t kShots = 40, kFirst = 7;
        std::vector<double> duration(kShots);
        std::vector<ShotStatus> status(kShots);
        std::vector<std::uint64_t> hash(kShots);
        BatchArrays out;
        out.duration = duration.data();
        out.status = status.data();
        out.hash = hash.data();
        for (const int threads : {1, 3}) {
            BatchOptions options;
            options.threads = threads;
            std::vector<DrawnValue> values;
            const auto messages = simulate_many(variation, kFirst, kShots, kIsa, options, out, values);
            ASSERT_EQ(values.size(), 2 * kShots);
            std::size_t message = 0;
            for (std::size_t i = 0; i < kShots; ++i) {
                const VariedShot shot = variation.shot(kFirst + i);
                EXPECT_EQ(values[2 * i], shot.values[0]);
                EXPECT_EQ(values[2 * i + 1], shot.values[1]);
                if (!shot.scene) {
                    EXPECT_EQ(status[i], ShotStatus::kInvalid);
                    ASSERT_LT(message, messages.size());
                    EXPECT_EQ(messages[message].shot, i);
                    EXPECT_EQ(messages[message++].text, shot.error);
                    continue;
                }
                const Record record = simulate(make_plan(*shot.scene, kIsa));
                EXPECT_EQ(fmt::format("{:016x}", hash[i]), record.hash());
                EXPECT_EQ(duration[i], record.duration);
            }
            EXPECT_EQ(message, messages.size());
            EXPECT_GT(message, 0u);
            EXPECT_LT(message, kShots);
        }
    }
}

TEST(Batch, CanBeCancelled) {
    SplitMix64 random(1);
    const Scene scene = shipped("draw");
    std::vector<double> speed(1000, 2.0);
    const BatchColumn column{"cue.speed", speed};
    BatchOptions options;
    options.threads = 2;
    std::atomic<int> asked{0};
    options.stop = [&asked] { return ++asked > 20; };
    EXPECT_THROW(simulate_many(scene, speed.size(), {&column, 1}, kIsa, options), BatchStopped);
    EXPECT_LT(asked, 100);
}

TEST(Batch, NoShotsAndNoColumns) {
    const Scene scene = shipped("draw");
    EXPECT_EQ(simulate_many(scene, 0, {}, kIsa).shots, 0u);
    const Batch same = simulate_many(scene, 3, {}, kIsa);
    const Record record = simulate(make_plan(scene, kIsa));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(same.duration[i], record.duration);
}

TEST(Batch, BadColumnsSayWhatToDo) {
    const Scene scene = shipped("draw");
    const auto error = [&](const std::string& key, std::size_t values = 2) -> std::string {
        const std::vector<double> list(values, 1.0);
        const BatchColumn column{key, list};
        try {
            simulate_many(scene, 2, {&column, 1}, kIsa);
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(error("cue.speed"), "");
    EXPECT_EQ(error("cue.speed", 1), "cue.speed: there are 1 values for 2 shots; give one for each");
    EXPECT_EQ(error("cue.sped"), "cue.sped: there is no such number in [cue]; did you mean speed?");
    EXPECT_EQ(error("cue.preset"), "cue.preset: there is no such number in [cue]");
    EXPECT_EQ(error("cue.offset"), "cue.offset: there is no such number in [cue]");
    EXPECT_EQ(error("cue.offset.z"), "cue.offset.z: there is no such number in [cue]");
    EXPECT_EQ(error("ball.cue.position.z"), "ball.cue.position.z: there is no such number in [ball]");
    EXPECT_EQ(
        error("ball.9.position.x"),
        "ball.9.position.x: there is no such ball; write ball.ID.position.x with one of these ids: cue, 1");
    EXPECT_EQ(error("ball.1.radius"),
              "ball.1.radius: the ball has no radius or mass of its own; add one, then vary it");
    EXPECT_EQ(error("table.pocket.p9.radius"), "table.pocket.p9.radius: the table has no such part");
    EXPECT_EQ(error("rack.seed"),
              "rack.seed: name a number in its section, such as cue.speed; sections are balls, ball, cue, "
              "physics, stop and table");
    const std::vector<double> list(2, 1.0);
    const BatchColumn twice[] = {{"cue.speed", list}, {"cue.speed", list}};
    EXPECT_THROW(simulate_many(scene, 2, twice, kIsa), std::invalid_argument);
}

// Each number may be in its range although together they are no valid restitution.
TEST(SceneNumber, OfAFitKeepsTheOthersAndIsCheckedWithThem) {
    Scene scene;
    scene.balls = make_ball_params("carom");
    const double fall = scene.balls.e_c_fall;
    const SceneNumber first(scene, "balls.e_c_fit.0");
    EXPECT_EQ(first.value(scene), scene.balls.e_c);
    EXPECT_EQ(first.put(scene, 0.8), Change::kAnything);
    EXPECT_EQ(scene.balls.e_c, 0.8);
    EXPECT_EQ(scene.balls.e_c_fall, fall);
    EXPECT_GT(fall, 0.0);
}

TEST(SceneNumber, IntegersMustBeWhole) {
    Scene scene = shipped("draw");
    const SceneNumber events(scene, "stop.events"), steps(scene, "physics.substeps");
    EXPECT_EQ(events.put(scene, 7.0), Change::kNumbers);
    EXPECT_EQ(scene.stop.events, 7);
    const auto error = [&](const SceneNumber& number, double value) -> std::string {
        try {
            number.put(scene, value);
        } catch (const SceneError& e) {
            return e.message();
        }
        return "";
    };
    EXPECT_EQ(error(events, 1.5), "stop.events must be an integer, not a number with a decimal point");
    EXPECT_EQ(error(steps, 0.0),
              "physics.substeps = 0 is out of range; it must be at least 1 and at most 10000000");
    EXPECT_EQ(error(steps, 4294967297.0),
              "physics.substeps = 4294967297 is out of range; it must be at least 1 and at most 10000000");
    EXPECT_EQ(error(events, std::nan("")),
              "stop.events must be an integer, not a number with a decimal point");
}

// Buffers of a failed run, or of another scene, change nothing.
TEST(RunBuffers, GiveTheSameBitsAfterAnyRun) {
    RunBuffers buffers;
    std::vector<Plan> plans;
    for (const char* name : {"eight_ball_break", "draw", "three_cushion", "side_bank", "hello"})
        plans.push_back(make_plan(shipped(name), kIsa));
    SimulateOptions options;
    options.hash = true;
    Record kept;
    for (int round = 0; round < 2; ++round) {
        for (const Plan& plan : plans) {
            const Record want = simulate(plan);
            EXPECT_EQ(simulate(plan, buffers), want);
            Outcome outcome, of_record;
            simulate(plan, buffers, outcome, options);
            simulate(plan, buffers, of_record, kept, options);
            EXPECT_EQ(of_record, outcome);
            EXPECT_EQ(kept, want);
            // No orientations of the previous shot remain.
            EXPECT_EQ(kept.orientation_at(0, 1.0).coeffs(), want.orientation_at(0, 1.0).coeffs());
            EXPECT_EQ(fmt::format("{:016x}", outcome.hash), want.hash());
            EXPECT_EQ(outcome.clusters, static_cast<int>(want.clusters.size()));
            SimulateOptions given_up;
            given_up.progress_rounds = 2;
            given_up.progress = [](std::size_t, double) { throw std::runtime_error("enough"); };
            EXPECT_THROW(simulate(plan, buffers, outcome, given_up), std::runtime_error);
        }
    }
}

// A reused planner decides like a new one.
TEST(Planner, DecidesAsMakePlan) {
    SplitMix64 random(8);
    Scene scene = shipped("side_bank");
    Planner planner(scene, kIsa);
    bool first = true;
    for (int i = 0; i < 200; ++i) {
        Scene& s = planner.scene();
        s.cue->speed = random.below(3) * random.uniform();
        s.cue->side = random.below(2) * 0.1;
        s.balls.mu_b = s.balls.mu_b_more = random.below(2) * 0.05;
        s.balls.f_c = random.below(2) * 0.2;
        s.balls.mu_sp = 0.01;
        const Plan& again = planner.plan(!first);
        first = false;
        const Plan fresh = make_plan(s, kIsa);
        EXPECT_EQ(again.skipped, fresh.skipped);
        for (std::size_t k = 0; k < fresh.effects.size(); ++k) {
            EXPECT_EQ(again.effects[k].keyword, fresh.effects[k].keyword);
            EXPECT_EQ(again.effects[k].in_force, fresh.effects[k].in_force);
        }
        EXPECT_EQ(simulate(again), simulate(fresh));
    }
}

}  // namespace
}  // namespace carom::test
