// From a scene back to a scene file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "carom/engine/scene.h"

namespace carom {
namespace {

using Out = std::back_insert_iterator<fmt::memory_buffer>;

std::string quote(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + '"';
}

// "-0" would be an integer without a sign: a scene and its text would differ in bits.
std::string text_of(double number) {
    return number == 0.0 && std::signbit(number) ? "-0.0" : fmt::format("{}", number);
}

std::string text_of(const FieldValue& value) {
    if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        std::string out;
        for (const double number : *list) out += (out.empty() ? "" : ", ") + text_of(number);
        return "[" + out + "]";
    }
    if (const auto* text = std::get_if<std::string>(&value)) return quote(*text);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
    return text_of(std::get<double>(value));
}

/// A line for each value, under a heading that is written only with the first line.
template <class T, std::size_t kRows>
void write_fields(Out out, const char* heading, const Field<T> (&fields)[kRows], const T& object) {
    for (const Field<T>& f : fields)
        if (is_written(fields, f, object))
            fmt::format_to(out, "{}{} = {}\n", std::exchange(heading, ""), f.key, text_of(f.value(object)));
}

/// Whether a scene file would describe the parts of both tables identically.
template <class Part, std::size_t kRows>
bool same_parts(const Field<Part> (&fields)[kRows], const std::vector<Part>& a, const std::vector<Part>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const Part& x, const Part& y) {
        return std::all_of(std::begin(fields), std::end(fields), [&](const Field<Part>& f) {
            return !f.in(Files::kScene) || f.value(x) == f.value(y);
        });
    });
}

/// Whether the table is still that of its preset and its measures.
bool is_preset(const Table& table) {
    if (table.preset.empty()) return false;
    try {
        const Table preset = make_table(table.preset, table.measures);
        return same_parts(kCushionFields, table.cushions, preset.cushions) &&
               same_parts(kJawFields, table.jaws, preset.jaws) &&
               same_parts(kPocketFields, table.pockets, preset.pockets);
    } catch (const std::invalid_argument&) {
        return true;  // the reader will report the name
    }
}

void write_table(Out out, const Table& table) {
    if (is_preset(table)) {
        write_fields(out, "[table]\n", kTableFields, table);
        write_fields(out, "", kMeasureFields, table.measures);
        for (const PocketSection& of : kPocketSections)
            write_fields(out, fmt::format("[{}]\n", of.path).c_str(), kPocketMeasureFields,
                         table.measures.*of.pockets);
        return;
    }
    fmt::format_to(out, "[table]\n{}", table.cushions.empty() ? "cushion = []\n" : "");
    for (const Field<Table>& f : kTableFields)
        if (f.key != std::string_view("preset") && is_written(kTableFields, f, table))
            fmt::format_to(out, "{} = {}\n", f.key, text_of(f.value(table)));
    for (const Cushion& c : table.cushions) write_fields(out, "[[table.cushion]]\n", kCushionFields, c);
    for (const Jaw& j : table.jaws)
        write_fields(out, j.is_arc() ? "[[table.arc]]\n" : "[[table.jaw]]\n", kJawFields, j);
    for (const Pocket& p : table.pockets) write_fields(out, "[[table.pocket]]\n", kPocketFields, p);
}

}  // namespace

std::string scene_text(const Scene& scene) {
    fmt::memory_buffer buffer;
    const Out out(buffer);
    write_table(out, scene.table);
    write_fields(out, "[balls]\n", kBallPresetFields, scene);
    write_fields(out, "", kBallFields, scene.balls);
    if (scene.cue_ball) write_fields(out, "[balls.cue]\n", kSizeFields, *scene.cue_ball);
    for (const BallStart& ball : scene.ball) {
        write_fields(out, "[[ball]]\n", kBallStartFields, ball);
        const bool is_cue_ball = scene.cue_ball && ball.id == scene.cue_ball_id();
        if (ball.own || is_cue_ball) write_fields(out, "", kSizeFields, scene.size_of(ball));
    }
    if (scene.cue) write_fields(out, "[cue]\n", kCueFields, *scene.cue);
    write_fields(out, "[physics]\n", kPhysicsFields, scene.physics);
    if (!scene.effects.empty()) fmt::format_to(out, "[effects]\n");
    for (const EffectOverride& effect : scene.effects)
        fmt::format_to(out, "{} = {}\n", effect.keyword, effect.in_force);
    write_fields(out, "[stop]\n", kStopFields, scene.stop);
    write_fields(out, "[render]\n", kRenderFields, scene.render);
    return fmt::to_string(buffer);
}

}  // namespace carom
