// The C interface in bulk: batches, segments, states, the next scene; each compared with the call for a
// single item.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "owned.h"

namespace carom::test {
namespace {

using BatchPtr = std::unique_ptr<carom_batch, decltype(&carom_batch_free)>;

BatchPtr many(const carom_scene* scene, const std::vector<const char*>& keys,
              const std::vector<double>& values, std::size_t shots, int threads = 1, double until = -1.0) {
    carom_batch* batch = nullptr;
    EXPECT_EQ(
        carom_simulate_many(scene, shots, keys.size(), keys.data(), values.data(), until, threads, 1, &batch),
        CAROM_OK)
        << carom_last_error();
    return {batch, carom_batch_free};
}

template <class T>
const T* column(const carom_batch* batch, const char* name, carom_type type, std::size_t each) {
    carom_type its_type{};
    std::size_t its_each = 0;
    const void* array = carom_batch_column(batch, name, &its_type, &its_each);
    EXPECT_NE(array, nullptr) << carom_last_error();
    EXPECT_EQ(its_type, type) << name;
    EXPECT_EQ(its_each, each) << name;
    return static_cast<const T*>(array);
}

TEST(CApiBatch, HasTheBitsOfCaromSimulate) {
    const ScenePtr scene = shipped_scene("side_bank");
    const std::vector<const char*> keys = {"cue.aim_deg", "cue.speed", "ball.1.position.x"};
    const std::size_t shots = 40;
    std::vector<double> values;
    for (std::size_t i = 0; i < shots; ++i) values.push_back(50.0 + 0.1 * static_cast<double>(i));
    for (std::size_t i = 0; i < shots; ++i)
        values.push_back(i == 7 ? -1.0 : 1.0 + 0.1 * static_cast<double>(i));
    for (std::size_t i = 0; i < shots; ++i) values.push_back(0.9 + 0.001 * static_cast<double>(i));
    for (const int threads : {1, 2, 3}) {
        const BatchPtr batch = many(scene.get(), keys, values, shots, threads);
        ASSERT_EQ(carom_batch_shot_count(batch.get()), shots);
        ASSERT_EQ(carom_batch_ball_count(batch.get()), 2u);
        const auto* const status = column<std::uint8_t>(batch.get(), "status", CAROM_UINT8, 1);
        const auto* const first_hit = column<std::int32_t>(batch.get(), "first_hit", CAROM_INT32, 1);
        const auto* const hashes = column<std::uint64_t>(batch.get(), "hash", CAROM_UINT64, 1);
        const auto* const duration = column<double>(batch.get(), "duration", CAROM_FLOAT64, 1);
        const auto* const events = column<std::int64_t>(batch.get(), "events", CAROM_INT64, 1);
        const auto* const xy = column<double>(batch.get(), "xy", CAROM_FLOAT64, 4);
        const auto* const pocket = column<std::int32_t>(batch.get(), "pocket", CAROM_INT32, 2);
        const auto* const fell = column<std::int32_t>(batch.get(), "fell", CAROM_INT32, 2);
        for (std::size_t i = 0; i < shots; ++i) {
            carom_cue cue;
            carom_cue_init(&cue);
            cue.aim_deg = values[i];
            cue.speed = values[shots + i];
            cue.side = cue.height = 0.0;
            const ScenePtr shot = shipped_scene("side_bank");
            ASSERT_EQ(carom_scene_set_cue(shot.get(), "cue", &cue), CAROM_OK);
            const double one[9] = {values[2 * shots + i], 0.90, 0.028575};
            ASSERT_EQ(carom_scene_set_ball(shot.get(), "1", one), CAROM_OK);
            if (i == 7) {
                EXPECT_EQ(status[i], CAROM_SHOT_INVALID);
                EXPECT_NE(
                    std::string(carom_batch_message(batch.get(), i)).find("cue.speed = -1 is out of range"),
                    std::string::npos);
                EXPECT_EQ(first_hit[i], -1);
                continue;
            }
            const RecordPtr record = played(shot.get());
            char hash[17];
            ASSERT_EQ(carom_record_hash(record.get(), hash), CAROM_OK);
            EXPECT_EQ(hashes[i], std::stoull(hash, nullptr, 16)) << i;
            EXPECT_EQ(duration[i], carom_record_duration(record.get()));
            EXPECT_EQ(static_cast<std::size_t>(events[i]), carom_record_event_count(record.get()));
            EXPECT_EQ(status[i], CAROM_SHOT_AT_REST);
            EXPECT_STREQ(carom_batch_message(batch.get(), i), "");
            for (std::size_t ball = 0; ball < 2; ++ball) {
                double rvw[9];
                const char* state = nullptr;
                ASSERT_EQ(carom_record_state(record.get(), ball, 1e9, rvw, &state), CAROM_OK);
                EXPECT_EQ(xy[4 * i + 2 * ball], rvw[0]);
                EXPECT_EQ(xy[4 * i + 2 * ball + 1], rvw[1]);
                EXPECT_EQ(pocket[2 * i + ball] >= 0, std::string(state) == "pocketed");
                EXPECT_EQ(fell[2 * i + ball] >= 0, std::string(state) == "pocketed");
            }
        }
    }
    const BatchPtr cut = many(scene.get(), {}, {}, 2, 1, 0.5);
    EXPECT_EQ(column<std::uint8_t>(cut.get(), "status", CAROM_UINT8, 1)[1], CAROM_SHOT_TIME);
    EXPECT_EQ(column<double>(cut.get(), "duration", CAROM_FLOAT64, 1)[1], 0.5);
}

TEST(CApiBatch, ShotsBeyondTheArraysAreRefused) {
    const char* const key = "cue.speed";
    const double value = 1.0;
    carom_batch* batch = nullptr;
    for (const std::size_t shots : {SIZE_MAX, SIZE_MAX / 2, (std::size_t{1} << 31) + 1})
        for (const std::size_t keys : {0, 1}) {
            EXPECT_EQ(carom_simulate_many(shipped_scene("side_bank").get(), shots, keys, &key, &value, -1.0,
                                          1, 0, &batch),
                      CAROM_BAD_ARGUMENT);
            EXPECT_EQ(std::string(carom_last_error()),
                      "shots = " + std::to_string(shots) + " is out of range; it must be at most 2147483648");
        }
}

TEST(CApiBatch, BadArgumentsAreNamed) {
    const ScenePtr scene = shipped_scene("draw");
    carom_batch* batch = nullptr;
    const char* keys[] = {"cue.sped"};
    const double values[] = {1.0};
    const double nan = std::nan("");
    EXPECT_EQ(carom_simulate_many(scene.get(), 1, 1, keys, values, -1.0, 1, 0, &batch), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "cue.sped: there is no such number in [cue]; did you mean speed?");
    EXPECT_EQ(batch, nullptr);
    EXPECT_EQ(carom_simulate_many(nullptr, 1, 0, nullptr, nullptr, -1.0, 1, 0, &batch), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_simulate_many(scene.get(), 1, 1, nullptr, values, -1.0, 1, 0, &batch),
              CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_simulate_many(scene.get(), 1, 1, keys, nullptr, -1.0, 1, 0, &batch), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_simulate_many(scene.get(), 1, 0, nullptr, nullptr, nan, 1, 0, &batch),
              CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_simulate_many(scene.get(), 1, 0, nullptr, nullptr, -1.0, -1, 0, &batch),
              CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_simulate_many(scene.get(), 0, 0, nullptr, nullptr, -1.0, 1, 0, &batch), CAROM_OK);
    EXPECT_EQ(carom_batch_shot_count(batch), 0u);
    EXPECT_EQ(carom_batch_column(batch, "hash", nullptr, nullptr), nullptr);
    EXPECT_STREQ(carom_last_error(), "hash was not requested; set `hashes` to 1");
    EXPECT_EQ(carom_batch_column(batch, "x", nullptr, nullptr), nullptr);
    EXPECT_STREQ(carom_last_error(),
                 "no column is called \"x\"; there are status, duration, events, first_hit, contacts, "
                 "approach_cushions, xy, pocket, fell, cushions, hash");
    EXPECT_NE(carom_batch_column(batch, "xy", nullptr, nullptr), nullptr);
    carom_batch_free(batch);
    EXPECT_EQ(carom_batch_column(nullptr, "xy", nullptr, nullptr), nullptr);
    EXPECT_STREQ(carom_batch_message(nullptr, 3), "");
    carom_batch_free(nullptr);
}

TEST(CApiBatch, SegmentsAndStatesMatchTheRecord) {
    const ScenePtr scene = shipped_scene("side_bank");
    const RecordPtr record = played(scene.get());
    std::vector<double> times;
    for (double t = -0.1; t < carom_record_duration(record.get()) + 0.2; t += 0.01) times.push_back(t);
    std::vector<double> rvw(times.size() * 2 * 9);
    std::vector<std::uint8_t> states(times.size() * 2);
    ASSERT_EQ(carom_record_states(record.get(), times.size(), times.data(), rvw.data(), states.data()),
              CAROM_OK);
    const char* const names[] = {"stationary", "spinning", "sliding", "rolling", "pocketed", "falling"};
    bool fell = false;
    for (std::size_t ball = 0; ball < 2; ++ball) {
        const std::size_t count = carom_record_segment_count(record.get(), ball);
        ASSERT_GT(count, 3u);
        std::vector<carom_segment> segments(count);
        ASSERT_EQ(carom_record_segments(record.get(), ball, segments.data()), CAROM_OK);
        for (std::size_t k = 0; k < times.size(); ++k) {
            double one[9];
            const char* state = nullptr;
            ASSERT_EQ(carom_record_state(record.get(), ball, times[k], one, &state), CAROM_OK);
            const double* bulk = &rvw[(2 * k + ball) * 9];
            for (int c = 0; c < 9; ++c) EXPECT_EQ(bulk[c], one[c]);
            EXPECT_STREQ(names[states[2 * k + ball]], state);
            // The closed form stated in the header.
            const double t = std::min(std::max(times[k], 0.0), carom_record_duration(record.get()));
            const carom_segment* s = &segments.front();
            for (const carom_segment& next : segments)
                if (next.start <= t) s = &next;
            const double u = std::min(t - s->start, s->duration);
            for (int c = 0; c < 2; ++c) EXPECT_EQ(s->r[c] + u * (s->v[c] + 0.5 * u * s->a[c]), one[c]);
            EXPECT_NEAR(s->r[2] + u * (s->v[2] + 0.5 * u * s->a[2]), one[2], 1e-15);
            EXPECT_STREQ(names[s->state], state);
            fell = fell || s->state == CAROM_FALLING;
        }
    }
    EXPECT_TRUE(fell);
    EXPECT_EQ(carom_record_segment_count(record.get(), 2), 0u);
    EXPECT_EQ(carom_record_segment_count(nullptr, 0), 0u);
    carom_segment segment;
    EXPECT_EQ(carom_record_segments(record.get(), 2, &segment), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "ball 2 is out of range; there are 2");
    EXPECT_EQ(carom_record_segments(record.get(), 0, nullptr), CAROM_BAD_ARGUMENT);
    const double nan = std::nan("");
    EXPECT_EQ(carom_record_states(record.get(), 1, &nan, rvw.data(), nullptr), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_record_states(record.get(), 0, nullptr, nullptr, nullptr), CAROM_OK);
}

// The next shot starts where the last ended: fallen balls are removed, and the caller sets a new cue.
TEST(CApiBatch, TheNextSceneBeginsWhereTheRecordEnds) {
    const ScenePtr scene = shipped_scene("eight_ball_break");
    const RecordPtr first = played(scene.get());
    std::size_t fallen = 0;
    for (std::size_t e = 0; e < carom_record_event_count(first.get()); ++e) {
        carom_event event;
        ASSERT_EQ(carom_record_event(first.get(), e, &event), CAROM_OK);
        fallen += std::string(event.type) == "ball_pocket";
    }
    EXPECT_GT(fallen, 0u);
    carom_scene* next = nullptr;
    ASSERT_EQ(carom_scene_from_record(first.get(), &next), CAROM_OK) << carom_last_error();
    const ScenePtr owner(next, carom_scene_free);
    const RecordPtr rest = played(next);
    EXPECT_EQ(carom_record_ball_count(rest.get()) + fallen, carom_record_ball_count(first.get()));
    EXPECT_EQ(carom_record_duration(rest.get()), 0.0);
    carom_cue cue;
    carom_cue_init(&cue);
    ASSERT_EQ(carom_scene_set_cue(next, carom_record_ball_id(rest.get(), 0), &cue), CAROM_OK);
    EXPECT_GT(carom_record_duration(played(next).get()), 0.5);

    // Stopped half-way and continued, the run ends like the whole shot, to the rounding of the times.
    const ScenePtr bank = shipped_scene("side_bank");
    const RecordPtr whole = played(bank.get()), half = played(bank.get(), 0.8);
    ASSERT_EQ(carom_scene_from_record(half.get(), &next), CAROM_OK);
    const ScenePtr other(next, carom_scene_free);
    const RecordPtr rest_of_it = played(next);
    EXPECT_NEAR(carom_record_duration(rest_of_it.get()) + 0.8, carom_record_duration(whole.get()), 1e-6);
    EXPECT_EQ(carom_scene_from_record(nullptr, &next), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(next, nullptr);
}

// One call that does what a record and a cue do together, with the same checks.
TEST(CApiBatch, TheNextSceneMayIncludeItsStrike) {
    const RecordPtr first = played(shipped_scene("eight_ball_break").get());
    carom_cue cue;
    carom_cue_init(&cue);
    cue.speed = 2.0;
    carom_scene *next = nullptr, *by_hand = nullptr;
    ASSERT_EQ(carom_next_scene(first.get(), "cue", &cue, &next), CAROM_OK) << carom_last_error();
    const ScenePtr owner(next, carom_scene_free);
    ASSERT_EQ(carom_scene_from_record(first.get(), &by_hand), CAROM_OK);
    const ScenePtr other(by_hand, carom_scene_free);
    ASSERT_EQ(carom_scene_set_cue(by_hand, "cue", &cue), CAROM_OK);
    char a[17], b[17];
    ASSERT_EQ(carom_record_hash(played(next).get(), a), CAROM_OK);
    ASSERT_EQ(carom_record_hash(played(by_hand).get(), b), CAROM_OK);
    EXPECT_STREQ(a, b);

    // A missing or moving ball cannot be struck.
    EXPECT_EQ(carom_next_scene(first.get(), "nobody", &cue, &next), CAROM_BAD_SCENE);
    EXPECT_EQ(next, nullptr);
    const RecordPtr half = played(shipped_scene("side_bank").get(), 0.1);
    EXPECT_EQ(carom_next_scene(half.get(), "cue", &cue, &next), CAROM_BAD_SCENE);
    EXPECT_EQ(carom_next_scene(half.get(), "cue", nullptr, &next), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_next_scene(half.get(), nullptr, &cue, &next), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_next_scene(nullptr, "cue", &cue, &next), CAROM_BAD_ARGUMENT);
}

}  // namespace
}  // namespace carom::test
