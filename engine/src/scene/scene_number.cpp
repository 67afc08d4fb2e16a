#include "carom/engine/scene_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/nearest.h"
#include "scene/distribution.h"
#include "scene/keys.h"
#include "scene/sections.h"

namespace carom {
namespace {

using detail::element_index;
using detail::fail;
using detail::Section;
using detail::take;
using detail::take_part;

// [-] Larger integers are not all exact as doubles.
constexpr double kMostWhole = 0x1p53;

/// Reads a number as an integer, as a scene file does.
std::int64_t whole(const Scene& scene, const Key& row, const char* section, double value) {
    const Section place(scene.file, section);
    if (value != std::floor(value))
        place.fail(SourceLocation{}, "{} must be an integer, not a number with a decimal point",
                   place.full(row.key));
    place.check(row, value);
    if (std::abs(value) > kMostWhole)
        place.fail(SourceLocation{}, "{} = {} is out of range; it must be at most {}", place.full(row.key),
                   value, kMostWhole);
    return static_cast<std::int64_t>(value);
}

struct Found {
    const Key* row;
    std::function<Change(Scene&, double)> put;
    std::function<double(Scene&)> get;  // NaN: the scene does not set it
};

/// The number that `key` names in the rows of a section.
/// @param at  returns the object with the rows, given a scene
/// @param change  what must be checked after a change within the range
template <class T, std::size_t kRows, class At>
Found find(const Field<T> (&fields)[kRows], const char* section, std::string_view key, Change change, At at) {
    const std::size_t dot = key.find('.');
    for (const Field<T>& f : fields) {
        if (!f.in(Files::kScene) || key.substr(0, dot) != f.key) continue;
        if (dot != key.npos) {
            const std::size_t k = element_index(key.substr(dot + 1));
            if (f.element == nullptr || k >= f.count()) break;
            return {&f,
                    // The numbers of a fit have limits together, too.
                    [&f, at, k, change](Scene& scene, double value) {
                        *f.element(at(scene), k) = value;
                        const bool alone = f.options.instead_of == nullptr;
                        return alone && contains(f.range, value) ? change : Change::kAnything;
                    },
                    [&f, at, k](Scene& scene) {
                        const double* number = f.element(at(scene), k);
                        if (number == nullptr) fail("the numbers of this list cannot be named one by one");
                        return *number;
                    }};
        }
        if (f.kind == Key::Kind::kNumber)
            return {&f,
                    [&f, at, change](Scene& scene, double value) {
                        f.set(at(scene), value);
                        return contains(f.range, value) ? change : Change::kAnything;
                    },
                    [&f, at](Scene& scene) {
                        const FieldValue value = f.get(at(scene));
                        const double* number = std::get_if<double>(&value);
                        return number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN();
                    }};
        if (f.kind == Key::Kind::kInteger)
            return {&f,
                    [&f, at, change, section](Scene& scene, double value) {
                        f.set(at(scene), whole(scene, f, section, value));
                        return change;
                    },
                    [](Scene&) { return std::numeric_limits<double>::quiet_NaN(); }};
        break;
    }
    fail("there is no such number in [{}]{}", section,
         did_you_mean(key.substr(0, dot), keys_of(fields, Files::kScene)));
}

Found find_in_ball(const Scene& scene, std::string_view key) {
    std::string ids;
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const std::string& id = scene.ball[i].id;
        ids += (ids.empty() ? "" : ", ") + id;
        if (!take(key, id)) continue;
        const auto ball = [i](Scene& s) -> BallStart& { return s.ball[i]; };
        if (key != "radius" && key != "mass") {
            const bool place = key.substr(0, key.find('.')) == "position";
            Found found = find(kBallStartFields, "ball", key,
                               place || key == "height" ? Change::kPlaces : Change::kNumbers, ball);
            if (key == "height")
                found.put = [put = std::move(found.put), i](Scene& s, double value) {
                    const Change change = put(s, value);
                    s.ball[i].position.z() = s.size_of(s.ball[i]).R + value;
                    return change;
                };
            return found;
        }
        if (!scene.ball[i].own) fail("the ball has no size of its own; give it one, then vary it");
        Found found = find(kSizeFields, "ball", key, Change::kTable,
                           [i](Scene& s) -> BallSize& { return *s.ball[i].own; });
        found.put = [put = std::move(found.put), i](Scene& s, double value) {
            const Change change = put(s, value);
            s.ball[i].position.z() = s.ball[i].own->R + s.ball[i].height;
            return change;
        };
        return found;
    }
    fail("there is no such ball; write ball.ID.position.x with one of these ids: {}", ids);
}

Found find_in_balls(std::string_view key) {
    Found found = find(kBallFields, "balls", key, key == "radius" ? Change::kTable : Change::kNumbers,
                       [](Scene& s) -> BallParams& { return s.balls; });
    if (key == "radius")
        found.put = [put = std::move(found.put)](Scene& s, double value) {
            const Change change = put(s, value);
            for (BallStart& ball : s.ball) ball.position.z() = s.size_of(ball).R + ball.height;
            return change;
        };
    return found;
}

template <class Part, std::size_t kRows>
Found find_in_parts(const Field<Part> (&fields)[kRows], const char* section, const char* list,
                    std::vector<Part> Table::*parts, const Scene& scene, std::string_view key) {
    const std::size_t i = take_part(key, list);
    if (i >= (scene.table.*parts).size()) fail("the table has no such part");
    return find(fields, section, key, Change::kTable,
                [parts, i](Scene& s) -> Part& { return (s.table.*parts)[i]; });
}

/// A measure of the table: changing it makes the parts anew.
Found rebuilding(Found found) {
    found.put = [put = std::move(found.put)](Scene& s, double value) {
        const Change change = put(s, value);
        if (s.table.preset.empty()) return change;  // which validate() refuses
        Table table = make_table(s.table.preset, s.table.measures);
        table.cloth = s.table.cloth;
        table.bed = s.table.bed;
        s.table = std::move(table);
        return change;
    };
    return found;
}

Found find_number(const Scene& scene, std::string_view key) {
    if (take(key, "balls")) return find_in_balls(key);
    if (take(key, "ball")) return find_in_ball(scene, key);
    if (take(key, "cue")) {
        if (!scene.cue) fail("the scene has no cue; give it one, then vary it");
        return find(kCueFields, "cue", key, Change::kNumbers, [](Scene& s) -> Cue& { return *s.cue; });
    }
    if (take(key, "physics"))
        return find(kPhysicsFields, "physics", key, Change::kNumbers,
                    [](Scene& s) -> Physics& { return s.physics; });
    if (take(key, "stop"))
        return find(kStopFields, "stop", key, Change::kNumbers, [](Scene& s) -> Stop& { return s.stop; });
    if (take(key, "table")) {
        for (const PocketSection& section : kPocketSections)
            if (take(key, section.key))
                return rebuilding(find(kPocketMeasureFields, section.path, key, Change::kAnything,
                                       [pockets = section.pockets](Scene& s) -> PocketMeasures& {
                                           return s.table.measures.*pockets;
                                       }));
        if (take(key, "cushion"))
            return find_in_parts(kCushionFields, "table.cushion", "cushion", &Table::cushions, scene, key);
        if (take(key, "jaw")) return find_in_parts(kJawFields, "table.jaw", "jaw", &Table::jaws, scene, key);
        if (take(key, "arc")) {
            const auto first = std::find_if(scene.table.jaws.begin(), scene.table.jaws.end(),
                                            [](const Jaw& jaw) { return jaw.is_arc(); });
            const std::size_t i = (first - scene.table.jaws.begin()) + take_part(key, "arc");
            if (i >= scene.table.jaws.size()) fail("the table has no such part");
            return find(kJawFields, "table.arc", key, Change::kTable,
                        [i](Scene& s) -> Jaw& { return s.table.jaws[i]; });
        }
        if (take(key, "pocket"))
            return find_in_parts(kPocketFields, "table.pocket", "pocket", &Table::pockets, scene, key);
        return rebuilding(find(kMeasureFields, "table", key, Change::kAnything,
                               [](Scene& s) -> Measures& { return s.table.measures; }));
    }
    fail(
        "name a number in its section, such as cue.speed; sections are balls, ball, cue, physics, stop and "
        "table{}",
        did_you_mean(key.substr(0, key.find('.')), {"balls", "ball", "cue", "physics", "stop", "table"}));
}

}  // namespace

SceneNumber::SceneNumber(const Scene& scene, std::string_view key) {
    try {
        Found found = find_number(scene, key);
        row_ = found.row;
        put_ = std::move(found.put);
        get_ = std::move(found.get);
        if (row_->optional) value(scene);  // which may refuse a part of a list
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("{}: {}", key, error.what()));
    }
}

}  // namespace carom
