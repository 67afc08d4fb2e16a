// read_record: reads the output of write_record and checks every item, because files may be untrusted.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/tolerances.h"
#include "record/json_text.h"
#include "record/record_json.h"

namespace carom {
namespace {

using detail::JsonObject;
using detail::JsonText;
using detail::JsonValue;

int index_below(const JsonValue& value, std::int64_t least, std::size_t count) {
    return static_cast<int>(value.integer(least, static_cast<std::int64_t>(count) - 1));
}

/// Reads a value that the row allows. Of its range, checks only the sign, because nobody types a record.
FieldValue read_value(const Key& key, const JsonValue& value) {
    const Interval& range = key.range;
    const bool positive = range.low > 0.0 || (range.low == 0.0 && range.low_open);
    switch (key.kind) {
        case Key::Kind::kNumber:
            return positive ? value.positive() : range.low == 0.0 ? value.non_negative() : value.number();
        case Key::Kind::kText:
            return value.text();
        case Key::Kind::kInteger:
        case Key::Kind::kNumbers:
        case Key::Kind::kIntegers:
            break;
    }
    const bool whole = key.kind == Key::Kind::kIntegers;
    if (value.size() != key.count())
        value.fail(whole ? std::string("expected ") + key.options.shape
                         : "expected a list of " + std::to_string(key.count()) + " numbers");
    std::vector<double> list;
    value.each([&](const JsonValue& item, std::size_t) {
        list.push_back(whole ? static_cast<double>(item.integer(static_cast<std::int64_t>(range.low),
                                                                static_cast<std::int64_t>(range.high)))
                             : item.number());
    });
    return list;
}

template <class T, std::size_t kRows>
void read_fields(const JsonObject& all, const Field<T> (&fields)[kRows], T& object) {
    for (const Field<T>& f : fields) {
        if (!f.in(Files::kRecord)) continue;
        const bool may_lack = f.optional || f.options.later;
        if (may_lack && !all.has(f.record_key())) continue;
        f.set(object, read_value(f, all.at(f.record_key())));
    }
}

template <class T, std::size_t kRows>
T read_object(const JsonValue& value, const Field<T> (&fields)[kRows]) {
    const JsonObject all(value, keys_of(fields, Files::kRecord));
    T object{};
    read_fields(all, fields, object);
    return object;
}

template <class T, std::size_t kRows>
std::vector<T> read_list(const JsonValue& value, const Field<T> (&fields)[kRows]) {
    std::vector<T> list;
    value.each([&](const JsonValue& item, std::size_t) { list.push_back(read_object(item, fields)); });
    return list;
}

Table read_table(const JsonValue& value) {
    std::vector<std::string_view> keys = keys_of(kTableFields, Files::kRecord);
    for (const std::string_view key : keys_of(kMeasureFields, Files::kRecord)) keys.push_back(key);
    for (const PocketSection& pockets : kPocketSections) keys.emplace_back(pockets.key);
    keys.insert(keys.end(), {"cushions", "jaws", "pockets"});
    const JsonObject all(value, keys);
    Table table;
    read_fields(all, kTableFields, table);
    read_fields(all, kMeasureFields, table.measures);
    for (const PocketSection& of : kPocketSections)
        if (all.has(of.key)) table.measures.*of.pockets = read_object(all.at(of.key), kPocketMeasureFields);
    table.cushions = read_list(all.at("cushions"), kCushionFields);
    table.jaws = read_list(all.at("jaws"), kJawFields);
    table.pockets = read_list(all.at("pockets"), kPocketFields);
    return table;
}

RenderSettings read_render(const JsonValue& value) {
    RenderSettings render = read_object(value, kRenderFields);
    if (render.eye.has_value() != render.target.has_value())
        value.fail(std::string("the key \"") + (render.eye ? "target" : "eye") + "\" is missing");
    if (render.cloth && !color_of(*render.cloth)) value.fail("cloth: expected a colour such as \"#1d6a54\"");
    return render;
}

Segment read_segment(const JsonValue& value) {
    const JsonObject all(
        value, {"start", "state", "r", "v", "w", "a", "dw", "spin_decay", "duration", "held", "ends"});
    Segment s;
    s.start = all.at("start").non_negative();
    s.state = all.at("state").one_of<MotionState>(names_of(MotionState()).size());
    s.r = all.at("r").vector<3>();
    s.v = all.at("v").vector<3>();
    s.w = all.at("w").vector<3>();
    s.a = all.at("a").vector<2>();
    s.dw = all.at("dw").vector<2>();
    s.spin_decay = all.at("spin_decay").non_negative();
    const JsonValue duration = all.at("duration");
    s.duration = duration.is_null() ? std::numeric_limits<double>::infinity() : duration.non_negative();
    s.held = all.at("held").boolean();
    s.ends = all.at("ends").boolean();
    return s;
}

BallTrack read_track(const JsonValue& value, const Table& table) {
    const JsonObject all(value, {"id", "pocket", "radius", "mass", "segments"});
    BallTrack track;
    track.id = all.at("id").text();
    track.pocket = index_below(all.at("pocket"), -1, table.pockets.size());
    if (all.has("radius") || all.has("mass"))
        track.own = BallSize{all.at("radius").positive(), all.at("mass").positive()};
    const JsonValue segments = all.at("segments");
    const std::size_t count = segments.size();
    if (count == 0) segments.fail("a ball needs at least one segment");
    track.segments.reserve(count);
    segments.each([&](const JsonValue& item, std::size_t i) {
        track.segments.push_back(read_segment(item));
        if (i > 0 && track.segments[i].start < track.segments[i - 1].start) {
            item.fail("starts before the previous segment");
        }
    });
    for (const Segment& s : {track.segments.front(), track.segments.back()})
        if (s.state == MotionState::kColliding)
            segments.fail("the motion of a colliding ball before or after its cluster is missing");
    return track;
}

/// Number of possible values of an event's b: the index of a ball, cushion, jaw or pocket; 0 if it has none.
std::int64_t partners(Partner partner, const Record& record) {
    if (partner == Partner::kNone) return 0;
    if (partner == Partner::kBall) return std::ssize(record.tracks);
    return with_parts(record.table, partner,
                      [](const auto& parts) -> std::int64_t { return std::ssize(parts); });
}

Hit read_hit(const JsonValue& value, const Record& record) {
    const JsonObject all(value, {"time", "a", "with", "b", "impulse"});
    Hit hit;
    hit.time = all.at("time").non_negative();
    hit.a = index_below(all.at("a"), 0, record.tracks.size());
    hit.partner = all.at("with").one_of<Partner>(std::size(names_of(Partner())));
    const std::int64_t count = partners(hit.partner, record);
    hit.b = static_cast<int>(all.at("b").integer(count > 0 ? 0 : -1, count > 0 ? count - 1 : -1));
    hit.impulse = all.at("impulse").non_negative();
    return hit;
}

Event read_event(const JsonObject& all, Record& record) {
    Event event;
    event.time = all.at("time").non_negative();
    event.type = all.at("type").one_of<EventType>(std::size(kEventKinds));
    event.a = index_below(all.at("a"), 0, record.tracks.size());
    const std::int64_t count = partners(kind(event.type).partner, record);
    event.b = static_cast<int>(all.at("b").integer(count > 0 ? 0 : -1, count > 0 ? count - 1 : -1));
    if (event.type == EventType::kBallCluster) {
        Cluster cluster;
        const JsonValue list = all.at("balls");
        cluster.balls.reserve(list.size());
        list.each([&](const JsonValue& ball, std::size_t) {
            cluster.balls.push_back(index_below(ball, 0, record.tracks.size()));
        });
        // Records before version 4 tell only which pair met first.
        if (all.has("hits"))
            all.at("hits").each(
                [&](const JsonValue& hit, std::size_t) { cluster.hits.push_back(read_hit(hit, record)); });
        else
            cluster.hits.push_back({event.time, event.a, Partner::kBall, event.b});
        event.detail = static_cast<int>(record.clusters.size());
        record.clusters.push_back(std::move(cluster));
    } else if (all.has("nose")) {
        event.detail =
            index_below(all.at("nose"), 0, 2 * record.table.cushions.size() + 3 * record.table.jaws.size());
    }
    event.slow = all.has("slow") && all.at("slow").boolean();
    return event;
}

EventCost read_cost(const JsonObject& all) {
    EventCost cost;
    cost.detect_ns = all.at("detect_ns").non_negative();
    cost.resolve_ns = all.at("resolve_ns").non_negative();
    cost.kernel_ns = all.at("kernel_ns").non_negative();
    cost.steps = all.at("steps").integer(0, std::numeric_limits<std::int64_t>::max());
    cost.method = all.at("method").text();
    cost.queue_ns = all.at("queue_ns").non_negative();
    return cost;
}

void read_events(const JsonValue& list, bool profiled, Record& record) {
    const std::size_t count = list.size();
    record.events.reserve(count);
    if (profiled) record.costs.reserve(count);
    list.each([&](const JsonValue& item, std::size_t i) {
        const JsonObject all(item, {"time", "type", "a", "b", "balls", "hits", "nose", "slow", "detect_ns",
                                    "resolve_ns", "kernel_ns", "steps", "method", "queue_ns"});
        record.events.push_back(read_event(all, record));
        if (i > 0 && record.events[i].time < record.events[i - 1].time) {
            item.fail("happens before the previous event");
        }
        if (profiled) record.costs.push_back(read_cost(all));
    });
}

std::string text_of_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw SceneError(path, {}, error ? error.message() : "there is no such file");
    // Reading a device or a pipe might never end.
    if (!std::filesystem::is_regular_file(path, error))
        throw SceneError(path, {}, "this is not a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > kMaxRecordSize) {
        throw SceneError(path, {},
                         "is larger than " + std::to_string(kMaxRecordSize >> 20) +
                             " MiB; stop the shot earlier ([stop]) and write it in parts");
    }
    // One byte more than allowed, to detect a file that grows meanwhile.
    std::string text(std::min<std::uintmax_t>(error ? kMaxRecordSize : size, kMaxRecordSize) + 1, '\0');
    std::ifstream stream(path, std::ios::binary);
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream.is_open() || stream.bad()) throw SceneError(path, {}, "cannot be read");
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

void check_version(const JsonValue& version) {
    const std::int64_t found = version.integer(1, 1000000);
    if (found >= kOldestVersion && found <= kRecordVersion) return;
    version.fail("this program reads versions " + std::to_string(kOldestVersion) + " to " +
                 std::to_string(kRecordVersion) +
                 "; use the carom that wrote it, or write it again: carom simulate SCENE -o shot.json");
}

void add_notes(const JsonText& source, std::vector<std::string>& notes) {
    if (source.unknown_keys == 0) return;
    notes.push_back(source.unknown_keys == 1
                        ? "the key " + source.first_unknown + " is unknown to this program and was left out"
                        : std::to_string(source.unknown_keys) +
                              " keys are unknown to this program and were left out, the first of them " +
                              source.first_unknown);
}

}  // namespace

Record read_record(const std::string& path, std::vector<std::string>* notes) {
    return parse_record(text_of_file(path), path, notes);
}

Record parse_record(std::string_view text, const std::string& name, std::vector<std::string>* notes) {
    constexpr const char* kNoRecord =
        "this is not a carom record; write one with carom simulate SCENE -o shot.json";
    JsonText source(text, name);
    const JsonValue root(source);
    if (!root.is_object()) root.fail(kNoRecord);
    const JsonObject all(root,
                         {"format", "version", "duration", "stopped", "start_time", "gravity", "profiled",
                          "setup_detect_ns", "render", "table", "balls", "tracks", "events"});
    if (!all.has("format") || all.at("format").text() != kRecordFormat) root.fail(kNoRecord);
    check_version(all.at("version"));
    Record record;
    record.duration = all.at("duration").non_negative();
    record.stopped = all.at("stopped").one_of<StopReason>(names_of(StopReason()).size());
    record.start_time = all.at("start_time").number();
    record.gravity = all.at("gravity").number();
    record.setup_detect_ns = all.at("setup_detect_ns").non_negative();
    record.render = read_render(all.at("render"));
    record.table = read_table(all.at("table"));
    record.balls = read_object(all.at("balls"), kBallFields);
    const JsonValue tracks = all.at("tracks");
    if (tracks.size() == 0) tracks.fail("a record needs at least one ball");
    tracks.each(
        [&](const JsonValue& item, std::size_t) { record.tracks.push_back(read_track(item, record.table)); });
    read_events(all.at("events"), all.at("profiled").boolean(), record);
    if (notes != nullptr) add_notes(source, *notes);
    return record;
}

}  // namespace carom
