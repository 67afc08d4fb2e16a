// write_record and record_json: a record as JSON, one segment or event per line. The reader is read.cpp.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/output_file.h"
#include "carom/engine/record.h"
#include "record/record_json.h"

namespace carom {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class Vector>
OrderedJson numbers(const Vector& v) {
    return std::vector<double>(v.begin(), v.end());
}

OrderedJson json_of(const Key& key, const FieldValue& value) {
    const auto* list = std::get_if<std::vector<double>>(&value);
    if (list != nullptr && key.kind == Key::Kind::kIntegers)
        return std::vector<std::int64_t>(list->begin(), list->end());
    if (list != nullptr) return *list;
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    return std::get<double>(value);
}

/// Writes the values that are set, under the keys of record files.
template <class T, std::size_t kRows>
OrderedJson json_of(const Field<T> (&fields)[kRows], const T& object) {
    OrderedJson json;
    for (const Field<T>& f : fields) {
        const FieldValue value = f.value(object);
        if (f.in(Files::kRecord) && value.index() != 0) json[f.record_key()] = json_of(f, value);
    }
    return json;
}

template <class T, std::size_t kRows>
OrderedJson json_of(const Field<T> (&fields)[kRows], const std::vector<T>& list) {
    OrderedJson json = OrderedJson::array();
    for (const T& item : list) json.push_back(json_of(fields, item));
    return json;
}

}  // namespace

OrderedJson table_json(const Table& table) {
    OrderedJson json = json_of(kTableFields, table);
    if (const OrderedJson changed = json_of(kMeasureFields, table.measures); !changed.is_null())
        json.update(changed);
    for (const PocketSection& of : kPocketSections)
        if (table.measures.*of.pockets != PocketMeasures{})
            json[of.key] = json_of(kPocketMeasureFields, table.measures.*of.pockets);
    json["cushions"] = json_of(kCushionFields, table.cushions);
    json["jaws"] = json_of(kJawFields, table.jaws);
    json["pockets"] = json_of(kPocketFields, table.pockets);
    return json;
}

OrderedJson balls_json(const BallParams& balls) {
    return json_of(kBallFields, balls);
}

namespace {

OrderedJson segment_json(const Segment& s) {
    return {{"start", s.start},
            {"state", name(s.state)},
            {"r", numbers(s.r)},
            {"v", numbers(s.v)},
            {"w", numbers(s.w)},
            {"a", numbers(s.a)},
            {"dw", numbers(s.dw)},
            {"spin_decay", s.spin_decay},
            // JSON has no infinity: null means "never ends".
            {"duration", std::isinf(s.duration) ? OrderedJson(nullptr) : OrderedJson(s.duration)},
            {"held", s.held},
            {"ends", s.ends}};
}

OrderedJson event_json(const Record& record, const Event& event, const EventCost* cost) {
    OrderedJson out = {{"time", event.time}, {"type", name(event.type)}, {"a", event.a}, {"b", event.b}};
    if (event.type == EventType::kBallCluster) {
        out["balls"] = record.clusters[event.detail].balls;
        out["hits"] = OrderedJson::array();
        for (const Hit& hit : record.hits(event))
            out["hits"].push_back({{"time", hit.time},
                                   {"a", hit.a},
                                   {"with", name(hit.partner)},
                                   {"b", hit.b},
                                   {"impulse", hit.impulse}});
    } else if (event.detail >= 0)
        out["nose"] = event.detail;
    if (event.slow) out["slow"] = true;
    if (cost != nullptr) {
        out["detect_ns"] = cost->detect_ns;
        out["resolve_ns"] = cost->resolve_ns;
        out["kernel_ns"] = cost->kernel_ns;
        out["steps"] = cost->steps;
        out["method"] = cost->method;
        out["queue_ns"] = cost->queue_ns;
    }
    return out;
}

/// Output of the writer if not an OutputFile.
struct Text {
    std::string all{};
    void write(std::string_view text) { all += text; }
};

/// Writes a list with one item per line; `write_item(item)` writes an item.
template <class Sink, class Item, class Write>
void write_lines(Sink& file, const std::vector<Item>& list, const char* indent, Write&& write_item) {
    const char* separator = "[\n";
    file.write(list.empty() ? "[" : "");
    for (const Item& item : list) {
        file.write(std::exchange(separator, ",\n"));
        file.write(indent);
        write_item(item);
    }
    file.write("]");
}

std::string dump(const OrderedJson& json) {
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

template <class Sink>
void write_track(const BallTrack& track, Sink& file) {
    file.write("{\"id\": " + dump(track.id) + ", \"pocket\": " + std::to_string(track.pocket));
    if (track.own) file.write(", \"radius\": " + dump(track.own->R) + ", \"mass\": " + dump(track.own->m));
    file.write(", \"segments\": ");
    write_lines(file, track.segments, "  ", [&](const Segment& s) { file.write(dump(segment_json(s))); });
    file.write("}");
}

template <class Sink>
void write_all(const Record& record, Sink& file) {
    file.write("{\"format\": \"" + std::string(kRecordFormat) +
               "\", \"version\": " + std::to_string(kRecordVersion));
    file.write(",\n\"duration\": " + dump(record.duration) + ", \"stopped\": " + dump(name(record.stopped)) +
               ", \"start_time\": " + dump(record.start_time) + ", \"gravity\": " + dump(record.gravity) +
               ", \"profiled\": " + (record.costs.empty() ? "false" : "true") +
               ", \"setup_detect_ns\": " + dump(record.setup_detect_ns));
    file.write(",\n\"render\": " + dump(json_of(kRenderFields, record.render)));
    file.write(",\n\"table\": " + dump(table_json(record.table)));
    file.write(",\n\"balls\": " + dump(balls_json(record.balls)));
    file.write(",\n\"tracks\": ");
    write_lines(file, record.tracks, " ", [&](const BallTrack& track) { write_track(track, file); });
    file.write(",\n\"events\": ");
    write_lines(file, record.events, " ", [&](const Event& event) {
        const EventCost* cost = record.costs.empty() ? nullptr : &record.costs[&event - record.events.data()];
        file.write(dump(event_json(record, event, cost)));
    });
    file.write("}\n");
}

/// @param name  start of the message
void check_costs(const Record& record, const std::string& name) {
    if (!record.costs.empty() && record.costs.size() != record.events.size()) {
        throw std::runtime_error(name + ": the record has costs for " + std::to_string(record.costs.size()) +
                                 " of " + std::to_string(record.events.size()) + " events");
    }
}

}  // namespace

void write_record(const Record& record, const std::string& path) {
    check_costs(record, path);
    OutputFile file(path);
    write_all(record, file);
    file.commit();
}

std::string record_json(const Record& record) {
    check_costs(record, "record");
    Text text;
    write_all(record, text);
    return std::move(text.all);
}

}  // namespace carom
