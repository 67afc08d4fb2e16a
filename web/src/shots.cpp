// Shots: one with its record, or many with their outcomes.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/shown_units.h"
#include "base/verdict.h"
#include "carom/engine/batch.h"
#include "carom/engine/event_details.h"
#include "carom/engine/math.h"
#include "carom/engine/plan.h"
#include "carom/engine/verify.h"
#include "carom/games/measures.h"
#include "carom/interface/shape.h"
#include "page/event_sentence.h"
#include "web.h"

namespace carom::web {
namespace {

using Clock = std::chrono::steady_clock;

constexpr kernel::Isa kIsa = kernel::Isa::kScalar;

/// JSON has no NaN: null.
Json number(double x) {
    return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json events_json(const Record& record) {
    Json list = Json::array();
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        const Event& event = record.events[i];
        const EventDetails d = details_of(record, i);
        const BallAtEvent& a = d.balls.front();
        Json item = {{"time", event.time},
                     {"type", name(event.type)},
                     {"ball", record.tracks[static_cast<std::size_t>(event.a)].id},
                     {"other", record.partner_id(event)},
                     {"other_name", met_name(record, event)},
                     {"place", {a.after.position.x(), a.after.position.y(), a.after.position.z()}},
                     {"speed_before", number(a.before.velocity.norm())},
                     {"speed", number(a.after.velocity.norm())},
                     {"closing", number(d.closing)},
                     {"cut_deg", number(d.cut * kDegrees)},
                     {"diamond", number(d.diamond)}};
        if (event.type == EventType::kBallCluster) {
            Json balls = Json::array();
            for (const int ball : record.clusters[static_cast<std::size_t>(event.detail)].balls)
                balls.push_back(record.tracks[static_cast<std::size_t>(ball)].id);
            item["balls"] = balls;
            item["hits"] = Json::array();
            for (const Hit& hit : record.hits(event))
                item["hits"].push_back({{"time", hit.time},
                                        {"ball", record.tracks[static_cast<std::size_t>(hit.a)].id},
                                        {"other", record.partner_id(hit.partner, hit.b)},
                                        {"impulse", hit.impulse}});
        }
        list.push_back(std::move(item));
    }
    return list;
}

Json many_json(const Batch& batch) {
    Json messages = Json::array(), arrays = Json::array();
    for (const Batch::Message& message : batch.messages)
        messages.push_back({{"shot", message.shot}, {"message", message.text}});
    for (const OutcomeColumn& column : kOutcomeColumns)
        if (const void* const array = column.array(batch))
            arrays.push_back({{"name", column.name},
                              {"type", name(column.type)},
                              {"at", reinterpret_cast<std::uintptr_t>(array)},
                              {"count", batch.shots * column.each(batch.balls)}});
    return {{"shots", batch.shots}, {"balls", batch.balls}, {"messages", messages}, {"arrays", arrays}};
}

}  // namespace

/// @param until   [s] of the shot; negative: the scene's own end
/// @param seconds of computing, and most_events: beyond them the call fails
CAROM_WEB int carom_simulate(const WebScene* scene, double until, double seconds, double most_events) {
    return guarded([&] {
        const auto start = Clock::now();
        SimulateOptions options;
        if (until >= 0.0) options.until = until;
        options.progress = [&](std::size_t events, double) {
            const bool late = std::chrono::duration<double>(Clock::now() - start).count() > seconds;
            if (!late && static_cast<double>(events) <= most_events) return;
            throw TooLong("the shot has " + std::to_string(events) + " events so far, which " +
                          (late ? "takes too long" : "is too many") +
                          "; give it an end in [stop], or allow more");
        };
        auto shot = std::make_unique<WebShot>();
        shot->scene = scene->scene;
        RunBuffers buffers;
        const Plan plan = make_plan(shot->scene, kIsa);
        simulate(plan, buffers, shot->outcome, shot->record, options);
        // JSON of the outcome takes longer than a shot of two balls, so it is made only on request.
        const Json brief = {shot->record.duration, shot->record.events.size(), plan.warnings};
        give(shot.release(), brief.dump());
    });
}
/// The value of a measure: a number, a truth, null, or texts. @param game "" for none
CAROM_WEB int carom_shot_measure(const WebShot* shot, const char* text, std::size_t size, const char* game,
                                 std::size_t game_size) {
    return guarded([&] {
        std::optional<games::Game> of;
        if (game_size > 0) of = games::game_named(std::string_view(game, game_size));
        const games::Measure measure(std::string(text, size), shot->scene, of);
        give(nullptr, dumped(tools::measure_json(measure, shot->record)));
    });
}
CAROM_WEB int carom_shot_hash(const WebShot* shot) {
    return guarded([&] { give(nullptr, shot->record.hash()); });
}
CAROM_WEB int carom_shot_outcome(const WebShot* shot) {
    return guarded(
        [&] { give(nullptr, dumped(interface::value_of(shot->outcome, shot->record, shot->scene))); });
}
CAROM_WEB void carom_free_shot(WebShot* shot) {
    delete shot;
}
CAROM_WEB int carom_shot_record(const WebShot* shot) {
    return guarded([&] { give(nullptr, record_json(shot->record)); });
}
/// Data for drawing, as the bytes of numbers: duration, gravity, and for each ball its pocket, radius, mass,
/// number of segments, and 18 numbers for each segment. Numbers as text would take longer than a break.
CAROM_WEB int carom_shot_motion(const WebShot* shot) {
    return guarded([&] {
        const Record& record = shot->record;
        std::vector<double> all = {record.duration, record.gravity};
        for (const BallTrack& track : record.tracks) {
            const BallSize size = track.own.value_or(BallSize{record.balls.R, record.balls.m});
            const double count = static_cast<double>(track.segments.size());
            all.insert(all.end(), {static_cast<double>(track.pocket), size.R, size.m, count});
            for (const Segment& s : track.segments)
                all.insert(all.end(), {s.start, s.duration, static_cast<double>(s.state), s.held ? 1.0 : 0.0,
                                       s.r.x(), s.r.y(), s.r.z(), s.v.x(), s.v.y(), s.v.z(), s.w.x(), s.w.y(),
                                       s.w.z(), s.a.x(), s.a.y(), s.dw.x(), s.dw.y(), s.spin_decay});
        }
        give(nullptr, std::string(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(double)));
    });
}
/// The first law that a record of this scene breaks, or "".
CAROM_WEB int carom_verify(const WebScene* scene, const char* text, std::size_t size) {
    return guarded([&] {
        const Record record = parse_record(std::string_view(text, size), "record");
        const Plan plan = make_plan(scene->scene, kIsa);
        require_scene(record, plan, "record");
        const auto violation = verify(record, plan);
        give(nullptr, violation ? describe(*violation, record) : "");
    });
}
CAROM_WEB int carom_shot_events(const WebShot* shot) {
    return guarded([&] { give(nullptr, dumped(events_json(shot->record))); });
}
/// A sentence for each event: a list. @param inches  whether speeds are in mph
CAROM_WEB int carom_shot_story(const WebShot* shot, int inches) {
    return guarded([&] {
        Json list = Json::array();
        for (std::size_t i = 0; i < shot->record.events.size(); ++i)
            list.push_back(tools::event_sentence(shot->record, i,
                                                 inches != 0 ? tools::Units::kInch : tools::Units::kMetric));
        give(nullptr, dumped(list));
    });
}
/// States of all balls at `count` times: nine numbers for each ball, and its MotionState.
CAROM_WEB int carom_shot_states(const WebShot* shot, std::size_t count, const double* times, double* numbers,
                                std::uint8_t* states) {
    return guarded([&] {
        shot->record.states_at({times, count}, numbers, states);
        give(nullptr, "");
    });
}

/// @param keys    JSON: a list of keys
/// @param values  keys x shots numbers, all shots of the first key first
CAROM_WEB int carom_simulate_many(const WebScene* scene, const char* keys, std::size_t size,
                                  std::size_t shots, const double* values, int hash) {
    return guarded([&] {
        std::vector<BatchColumn> columns;
        for (const auto& key : Json::parse(keys, keys + size))
            columns.push_back({key.get<std::string>(), std::span(values + columns.size() * shots, shots)});
        BatchOptions options;
        options.threads = 1;
        options.hash = hash != 0;
        auto batch = std::make_unique<Batch>(simulate_many(scene->scene, shots, columns, kIsa, options));
        std::string text = dumped(many_json(*batch));
        give(batch.release(), std::move(text));
    });
}
CAROM_WEB void carom_free_batch(Batch* batch) {
    delete batch;
}

}  // namespace carom::web
