// read_record: what write_record wrote, checked item by item. A file comes from anywhere: nothing in it is
// trusted.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/tolerances.h"
#include "record/format.h"

namespace carom {
namespace {

using Json = nlohmann::json;

/// Long enough for any id or method name, short enough that a hostile file cannot fill messages.
constexpr std::size_t kLongestName = 256;
/// Pixels per side; the largest that OpenGL implementations draw.
constexpr int kLargestSide = 16384;

/// One value of the file and the way to it ("tracks[3].segments[2].duration"), for messages.
class Node {
  public:
    Node(const Json& json, const std::string& file, std::string where)
        : json_(json), file_(file), where_(std::move(where)) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw SceneError(file_, {}, (where_.empty() ? "" : where_ + ": ") + message);
    }

    bool has(const char* key) const { return json_.is_object() && json_.contains(key); }

    Node at(const char* key) const {
        if (!json_.is_object()) fail("expected an object");
        const auto it = json_.find(key);
        if (it == json_.end()) fail("the key \"" + std::string(key) + "\" is missing");
        return {*it, file_, where_.empty() ? key : where_ + "." + key};
    }

    std::size_t size() const {
        if (!json_.is_array()) fail("expected a list");
        return json_.size();
    }

    Node item(std::size_t i) const { return {json_[i], file_, where_ + "[" + std::to_string(i) + "]"}; }

    bool is_null() const { return json_.is_null(); }

    double number() const {
        if (!json_.is_number()) fail("expected a number");
        const double value = json_.get<double>();
        if (!std::isfinite(value)) fail("expected a finite number");
        return value;
    }

    double non_negative() const {
        const double value = number();
        if (value < 0.0) fail("expected a number of at least 0");
        return value;
    }

    double positive() const {
        const double value = number();
        if (!(value > 0.0)) fail("expected a number greater than 0");
        return value;
    }

    std::int64_t integer(std::int64_t least, std::int64_t most) const {
        const std::string range = std::to_string(least) + " to " + std::to_string(most);
        if (most < least) fail("there is nothing that this index could stand for");
        if (!json_.is_number_integer()) fail("expected an integer from " + range);
        // An unsigned number above the signed range would wrap around.
        if (json_.is_number_unsigned() &&
            json_.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) {
            fail("expected an integer from " + range);
        }
        const std::int64_t value = json_.get<std::int64_t>();
        if (value < least || value > most) fail("expected an integer from " + range);
        return value;
    }

    bool boolean() const {
        if (!json_.is_boolean()) fail("expected true or false");
        return json_.get<bool>();
    }

    std::string text() const {
        if (!json_.is_string()) fail("expected a string");
        const std::string& value = json_.get_ref<const std::string&>();
        if (value.size() > kLongestName)
            fail("the string is longer than " + std::to_string(kLongestName) + " bytes");
        return value;
    }

    template <int kSize>
    Eigen::Matrix<double, kSize, 1> vector() const {
        if (!json_.is_array() || json_.size() != kSize)
            fail("expected a list of " + std::to_string(kSize) + " numbers");
        Eigen::Matrix<double, kSize, 1> v;
        for (int i = 0; i < kSize; ++i) v[i] = item(static_cast<std::size_t>(i)).number();
        return v;
    }

    /// One of an enumeration whose values 0..count-1 all have a name().
    template <class Enum>
    Enum one_of(int count) const {
        const std::string value = text();
        for (int i = 0; i < count; ++i) {
            if (value == name(static_cast<Enum>(i))) return static_cast<Enum>(i);
        }
        fail("unknown name \"" + value + "\"");
    }

  private:
    const Json& json_;
    const std::string& file_;
    std::string where_;
};

Table read_table(const Node& node) {
    Table table;
    table.preset = node.at("preset").text();
    table.width = node.at("width").non_negative();
    table.length = node.at("length").non_negative();
    table.corner = node.at("corner").vector<2>();
    const Node cushions = node.at("cushions"), jaws = node.at("jaws"), pockets = node.at("pockets");
    for (std::size_t i = 0; i < cushions.size(); ++i) {
        const Node c = cushions.item(i);
        table.cushions.push_back(
            {c.at("id").text(), c.at("from").vector<2>(), c.at("to").vector<2>(), c.at("height").number()});
    }
    for (std::size_t i = 0; i < jaws.size(); ++i) {
        const Node j = jaws.item(i);
        table.jaws.push_back({j.at("id").text(), j.at("center").vector<2>(), j.at("radius").non_negative(),
                              j.at("height").number()});
    }
    for (std::size_t i = 0; i < pockets.size(); ++i) {
        const Node p = pockets.item(i);
        table.pockets.push_back({p.at("id").text(), p.at("center").vector<2>(), p.at("radius").positive(),
                                 p.at("depth").number()});
    }
    return table;
}

BallParams read_balls(const Node& node) {
    BallParams p{};
    p.R = node.at("R").positive();
    p.m = node.at("m").positive();
    p.mu_s = node.at("mu_s").non_negative();
    p.mu_r = node.at("mu_r").non_negative();
    p.mu_sp = node.at("mu_sp").non_negative();
    p.mu_b = node.at("mu_b").non_negative();
    p.e_b = node.at("e_b").non_negative();
    p.e_c = node.at("e_c").non_negative();
    p.f_c = node.at("f_c").non_negative();
    return p;
}

RenderSettings read_render(const Node& node) {
    RenderSettings render;
    render.fps = node.at("fps").positive();
    const Node size = node.at("size");
    if (size.size() != 2) size.fail("expected [width, height]");
    render.width = static_cast<int>(size.item(0).integer(1, kLargestSide));
    render.height = static_cast<int>(size.item(1).integer(1, kLargestSide));
    render.camera = node.at("camera").text();
    if (node.has("eye")) {
        render.eye = node.at("eye").vector<3>();
        render.target = node.at("target").vector<3>();
    }
    return render;
}

Segment read_segment(const Node& node) {
    Segment s;
    s.start = node.at("start").non_negative();
    s.state = node.at("state").one_of<MotionState>(5);
    s.r = node.at("r").vector<3>();
    s.v = node.at("v").vector<3>();
    s.w = node.at("w").vector<3>();
    s.a = node.at("a").vector<2>();
    s.dw = node.at("dw").vector<2>();
    s.spin_decay = node.at("spin_decay").non_negative();
    const Node duration = node.at("duration");
    s.duration = duration.is_null() ? std::numeric_limits<double>::infinity() : duration.non_negative();
    s.held = node.at("held").boolean();
    s.ends = node.at("ends").boolean();
    return s;
}

BallTrack read_track(const Node& node, const Table& table) {
    BallTrack track;
    track.id = node.at("id").text();
    track.pocket =
        static_cast<int>(node.at("pocket").integer(-1, static_cast<std::int64_t>(table.pockets.size()) - 1));
    if (node.has("radius") || node.has("mass"))
        track.own = BallSize{node.at("radius").positive(), node.at("mass").positive()};
    const Node segments = node.at("segments");
    if (segments.size() == 0) segments.fail("a ball needs at least one segment");
    track.segments.reserve(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        track.segments.push_back(read_segment(segments.item(i)));
        if (i > 0 && track.segments[i].start < track.segments[i - 1].start) {
            segments.item(i).fail("starts before the segment in front of it");
        }
    }
    return track;
}

/// What an event's b may be: the index of a ball, cushion, jaw or pocket, or -1 for none.
std::int64_t partners(EventType type, const Record& record) {
    switch (type) {
        case EventType::kBallBall:
        case EventType::kBallCluster:
        case EventType::kBallBallHold:
        case EventType::kBallBallRelease:
            return static_cast<std::int64_t>(record.tracks.size());
        case EventType::kBallCushion:
        case EventType::kBallCushionHold:
        case EventType::kBallCushionRelease:
            return static_cast<std::int64_t>(record.table.cushions.size());
        case EventType::kBallJaw:
        case EventType::kBallJawHold:
        case EventType::kBallJawRelease:
            return static_cast<std::int64_t>(record.table.jaws.size());
        case EventType::kBallPocket:
            return static_cast<std::int64_t>(record.table.pockets.size());
        case EventType::kCueStrike:
        case EventType::kSlideRoll:
        case EventType::kRollSpin:
        case EventType::kRollStop:
        case EventType::kSpinStop:
            break;
    }
    return 0;
}

Event read_event(const Node& node, Record& record) {
    Event event;
    event.time = node.at("time").non_negative();
    event.type = node.at("type").one_of<EventType>(kEventTypes);
    event.a = static_cast<int>(node.at("a").integer(0, static_cast<std::int64_t>(record.tracks.size()) - 1));
    const std::int64_t count = partners(event.type, record);
    event.b = static_cast<int>(node.at("b").integer(count > 0 ? 0 : -1, count > 0 ? count - 1 : -1));
    if (event.type == EventType::kBallCluster) {
        std::vector<int> balls;
        const Node list = node.at("balls");
        for (std::size_t i = 0; i < list.size(); ++i)
            balls.push_back(static_cast<int>(
                list.item(i).integer(0, static_cast<std::int64_t>(record.tracks.size()) - 1)));
        event.detail = static_cast<int>(record.clusters.size());
        record.clusters.push_back(std::move(balls));
    } else if (node.has("nose")) {
        const auto noses = 2 * record.table.cushions.size() + record.table.jaws.size();
        event.detail = static_cast<int>(node.at("nose").integer(0, static_cast<std::int64_t>(noses) - 1));
    }
    return event;
}

/// EventCost::method points at text that lives as long as the program; so does what a file names.
const char* lasting(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> texts;
    const std::lock_guard<std::mutex> lock(mutex);
    return texts.insert(text).first->c_str();
}

EventCost read_cost(const Node& node) {
    EventCost cost;
    cost.detect_ns = node.at("detect_ns").non_negative();
    cost.resolve_ns = node.at("resolve_ns").non_negative();
    cost.kernel_ns = node.at("kernel_ns").non_negative();
    cost.steps = static_cast<long>(node.at("steps").integer(0, std::numeric_limits<std::int64_t>::max()));
    cost.method = lasting(node.at("method").text());
    return cost;
}

void read_events(const Node& node, bool profiled, Record& record) {
    record.events.reserve(node.size());
    for (std::size_t i = 0; i < node.size(); ++i) {
        record.events.push_back(read_event(node.item(i), record));
        if (i > 0 && record.events[i].time < record.events[i - 1].time) {
            node.item(i).fail("happens before the event in front of it");
        }
        if (profiled) record.costs.push_back(read_cost(node.item(i)));
    }
}

/// Where in the text a byte stands. A NUL or a newline more or less does not matter: this is for a person's
/// editor.
SourceLocation location(std::string_view text, std::size_t byte) {
    SourceLocation where{1, 1};
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
        if (text[i] == '\n') {
            ++where.line;
            where.column = 1;
        } else {
            ++where.column;
        }
    }
    return where;
}

std::string text_of_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw SceneError(path, {}, "there is no such file");
    // A device or a pipe might never end.
    if (!std::filesystem::is_regular_file(path, error))
        throw SceneError(path, {}, "this is not a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > kMaxRecordSize) {
        throw SceneError(path, {},
                         "is larger than " + std::to_string(kMaxRecordSize >> 20) +
                             " MiB; stop the shot earlier ([stop]) and write it in parts");
    }
    std::ifstream stream(path, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream) throw SceneError(path, {}, "cannot be read");
    return text;
}

Json parse(std::string_view text, const std::string& path) {
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw SceneError(path, location(text, error.byte), "this is not JSON, or the file was cut short");
    } catch (const Json::exception& error) {
        throw SceneError(path, {}, std::string("this JSON cannot be read: ") + error.what());
    }
}

}  // namespace

Record read_record(const std::string& path) {
    return parse_record(text_of_file(path), path);
}

Record parse_record(std::string_view text, const std::string& name) {
    const Json json = parse(text, name);
    const Node root(json, name, "");
    if (!json.is_object() || !root.has("format") || root.at("format").text() != kRecordFormat) {
        root.fail("this is no record of carom; carom simulate SCENE -o shot.json writes one");
    }
    if (root.at("version").integer(1, 1000000) != kRecordVersion) {
        root.at("version").fail("this program reads version " + std::to_string(kRecordVersion) + " only");
    }
    Record record;
    record.duration = root.at("duration").non_negative();
    record.stopped = root.at("stopped").one_of<StopReason>(4);
    record.start_time = root.at("start_time").number();
    record.gravity = root.at("gravity").number();
    const bool profiled = root.at("profiled").boolean();
    record.setup_detect_ns = root.at("setup_detect_ns").non_negative();
    record.render = read_render(root.at("render"));
    record.table = read_table(root.at("table"));
    record.balls = read_balls(root.at("balls"));
    const Node tracks = root.at("tracks");
    if (tracks.size() == 0) tracks.fail("a record needs at least one ball");
    for (std::size_t i = 0; i < tracks.size(); ++i)
        record.tracks.push_back(read_track(tracks.item(i), record.table));
    read_events(root.at("events"), profiled, record);
    return record;
}

}  // namespace carom
