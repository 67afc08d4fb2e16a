// The C interface: values, and their parts by path.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "cue.h"
#include "guard.h"
#include "handles.h"
#include "text.h"

using namespace carom::c;

namespace {

using carom::interface::Value;

/// The contents of a value, for messages.
std::string contents(const Value& value) {
    if (value.is_array()) return "a list of " + std::to_string(value.size());
    if (!value.is_object()) return value.type_name();
    std::string keys;
    for (const auto& item : value.items()) keys += (keys.empty() ? "" : ", ") + item.key();
    return "an object with " + keys;
}

BadArgument unlike(const char* path, const char* wanted, const Value& found) {
    return BadArgument((*path == '\0' ? "the value" : std::string(path)) + ": expected " + wanted +
                       "; here is " + contents(found));
}

}  // namespace

const Value& carom::c::part_at(const carom_value* value, const char* path) {
    need({value, path});
    const Value* at = &value->value;
    const std::string text = path;
    for (std::size_t i = 0; i < text.size();) {
        const bool item = text[i] == '[';
        const std::size_t from = i + (i > 0 && !item ? 1 : 0);
        const std::size_t end =
            std::min(item ? text.find(']', i) : text.find_first_of(".[", from), text.size());
        const std::string step = text.substr(from, end - from + (item ? 1 : 0));
        std::size_t index = 0;
        while (item && index < at->size() && step != "[" + std::to_string(index) + "]") ++index;
        if (item && at->is_array() && index < at->size())
            at = &(*at)[index];
        else if (!item && (i == 0 || text[i] == '.') && at->is_object() && at->contains(step))
            at = &at->at(step);
        else
            throw BadArgument(std::string(text)
                                  .append(": there is no ")
                                  .append(step)
                                  .append("; here is ")
                                  .append(contents(*at)));
        i = end + (item ? 1 : 0);
    }
    return *at;
}

Value carom::c::json_of(const char* json, const char* name) {
    if (json == nullptr) return Value::object();
    // Copies and texts of values are made by recursion.
    constexpr int kDeepest = 100;
    const auto check = [&](int depth, auto, const Value&) {
        if (depth > kDeepest) throw BadArgument(std::string(name) + ": nested too deep");
        return true;
    };
    Value value = Value::parse(json, check, false);
    if (value.is_discarded()) throw BadArgument(std::string(name) + ": expected JSON");
    return value;
}

carom_status carom_value_parse(const char* json, carom_value** value) {
    return made(value, [&](carom_value& v) {
        need({json});
        v.value = json_of(json, "the value");
    });
}

size_t carom_value_json(const carom_value* value, char* text, size_t size) {
    return written(text, size,
                   [&] { return part_at(value, "").dump(-1, ' ', false, Value::error_handler_t::replace); });
}

void carom_value_free(carom_value* value) {
    delete value;
}

carom_status carom_value_number(const carom_value* value, const char* path, double* number) {
    return guarded([&] {
        need({number});
        const Value& at = part_at(value, path);
        if (!at.is_number() && !at.is_boolean() && !at.is_null()) throw unlike(path, "a number", at);
        *number = at.is_null()      ? std::numeric_limits<double>::quiet_NaN()
                  : at.is_boolean() ? static_cast<double>(at.get<bool>())
                                    : at.get<double>();
    });
}

carom_status carom_value_text(const carom_value* value, const char* path, const char** text) {
    return guarded([&] {
        need({text});
        const Value& at = part_at(value, path);
        if (!at.is_string()) throw unlike(path, "a text", at);
        *text = at.get_ref<const std::string&>().c_str();
    });
}

size_t carom_value_count(const carom_value* value, const char* path) {
    size_t count = 0;
    guarded([&] {
        const Value& at = part_at(value, path);
        if (at.is_array()) count = at.size();
    });
    return count;
}

carom_status carom_value_part(const carom_value* value, const char* path, carom_value** part) {
    return made(part, [&](carom_value& v) { v.value = part_at(value, path); });
}

carom_status carom_value_cue(const carom_value* value, const char* path, carom_cue* cue) {
    return guarded([&] {
        need({cue});
        *cue = cue_of(carom::interface::read_as<carom::Cue>(part_at(value, path), path));
    });
}

carom_status carom_scene_plan(const carom_scene* scene, carom_value** plan) {
    return made(plan, [&](carom_value& v) {
        need({scene});
        const carom::Scene& s = scene->scene;
        using carom::interface::value_of;
        Value table = value_of(s.table), balls = value_of(s.ball);
        table["cushions"] = value_of(s.table.cushions);
        table["jaws"] = value_of(s.table.jaws);
        table["pockets"] = value_of(s.table.pockets);
        for (size_t i = 0; i < s.ball.size(); ++i) {
            const carom::BallSize size = s.size_of(s.ball[i]);
            balls[i].update({{"radius", size.R}, {"mass", size.m}});
        }
        v.value = {{"table", table}, {"balls", balls}, {"cue", value_of(s.cue)}};
    });
}
