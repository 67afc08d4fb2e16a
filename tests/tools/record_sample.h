// A record with a distinct value in every field, and the reader's message about a changed one.
#pragma once

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "carom/engine/record.h"
#include "reference/random_impacts.h"
#include "support/process.h"

namespace carom::test {
using reference::Generator;

using Json = nlohmann::json;

/// Any double allowed in a record, all exponents equally likely, including signed zeros and subnormals.
inline double any_double(Generator& rng) {
    for (;;) {
        const double value = std::bit_cast<double>(rng.next());
        if (std::abs(value) <= 1e25) return value;
    }
}

inline Segment any_segment(Generator& rng, double start) {
    Segment s;
    s.start = start;
    for (int i = 0; i < 3; ++i) {
        s.r[i] = any_double(rng);
        s.v[i] = any_double(rng);
        s.w[i] = any_double(rng);
    }
    for (int i = 0; i < 2; ++i) {
        s.a[i] = any_double(rng);
        s.dw[i] = any_double(rng);
    }
    s.spin_decay = std::abs(any_double(rng));
    s.duration = rng.next() % 3 == 0 ? std::numeric_limits<double>::infinity() : std::abs(any_double(rng));
    s.state = static_cast<MotionState>(rng.next() % 5);
    s.held = rng.next() % 2 == 0;
    s.ends = rng.next() % 2 == 0;
    return s;
}

inline Record sample_record() {
    Generator rng(7);
    Record record;
    record.table.preset = "nine_foot";
    record.table.width = 1.27;
    record.table.length = 2.54;
    record.table.corner = {-1.0 / 3.0, 1e-3};
    record.table.measures = {.cushion_height = 0.0361,
                             .rail_width = 0.0521,
                             .corner_pockets = {0.1131, 0.0911, 141.5, 0.0421, 0.0041, 0.0631},
                             .side_pockets = {.mouth = 0.1271},
                             .size = Vec2(1.2611, 2.5311)};
    record.table.bed = Rectangle(-0.5, 1e-2, 1.5, 2.75);
    record.table.cushions = {{"left", {0.0, -0.0}, {0.1, 2.54}, 0.037, "left rail"}};
    record.table.jaws = {{"jaw \"1\"", {1e-300, 0.1}, 0.04, 0.037, "a jaw\n", "outside", -30.0, 200.0}};
    record.table.pockets = {{"p,1", {1.0 / 3.0, 0.1}, 0.06, 0.08, "Tasche \xc3\xa4"}};
    record.balls = {0.028575, 0.170097, 0.21,  0.011, 0.0127, 0.05, 0.95, 0.85, 0.23, 0.108, 1.0 / 3.0,
                    0.07,     0.41,     0.031, 0.62,  0.51,   0.13, 0.8,  0.17, true, true};
    record.gravity = 9.80665;
    record.render = {59.94,    1920, 1080, "follow", true, Vec3(0.1, -1.0 / 3.0, 2.0), Vec3(0.5, 1.0, 0.0),
                     "#1d6a54"};
    record.duration = 7.0 / 3.0;
    record.stopped = StopReason::kEvents;
    record.setup_detect_ns = 1234.5;
    for (int ball = 0; ball < 3; ++ball) {
        BallTrack track;
        track.id = "ball " + std::to_string(ball);
        for (int i = 0; i < 200; ++i) track.segments.push_back(any_segment(rng, 0.001 + i / 300.0));
        track.pocket = ball == 1 ? 0 : -1;
        if (ball == 2) track.own = BallSize{0.03 / 7.0, 0.2 / 7.0};
        record.tracks.push_back(track);
    }
    record.tracks[0].segments[0].v = Vec3(-0.0, 5e-324, 1e25);
    record.events = {{0.0, EventType::kCueStrike, 0, -1},     {0.1, EventType::kBallBall, 0, 2},
                     {0.1, EventType::kBallCushion, 1, 0},    {0.2, EventType::kBallJaw, 1, 0},
                     {0.3, EventType::kBallPocket, 1, 0},     {1.0 / 3.0, EventType::kSlideRoll, 0, -1},
                     {7.0 / 3.0, EventType::kRollStop, 2, -1}};
    record.events.insert(record.events.begin() + 2, {0.1, EventType::kBallCluster, 0, 1, 0});
    record.clusters = {{{0, 1, 2}, {{0.25, 0, Partner::kBall, 1, 0.125}}}};
    record.events[4].detail = 1;  // a jaw is a round nose
    record.events[4].slow = true;
    record.start_time = 1e6 / 3.0;
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        record.costs.push_back(
            {0.1 * static_cast<double>(i), 2.5, 1.25, static_cast<long>(i), i == 1 ? "march" : "", 0.7});
    }
    return record;
}

/// Reads `text` as a record; returns the message of its error without the file name in it.
inline std::string record_error(const std::string& text) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.json", text);
    try {
        read_record(path);
    } catch (const SceneError& error) {
        const std::string what = error.what();
        if (what.substr(0, path.size() + 1) != path + ":") return "another file is named: " + what;
        return what.substr(path.size() + 1);
    }
    return "no error";
}

/// The sample as JSON with one value replaced.
inline std::string changed(const std::string& pointer, const Json& value) {
    static const std::string text = [] {
        const TemporaryFolder folder;
        write_record(sample_record(), folder.file("r.json"));
        return read_file(folder.file("r.json"));
    }();
    Json json = Json::parse(text);
    if (!pointer.empty()) json[Json::json_pointer(pointer)] = value;
    return json.dump();
}

}  // namespace carom::test
