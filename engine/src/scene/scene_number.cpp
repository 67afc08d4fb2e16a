#include "carom/engine/scene_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

using detail::fail;
using detail::KeyPath;
using detail::Section;

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

/// The number that a key names in the rows of its section.
/// @param at  scene -> the object with the rows
/// @param change  the checks after a change within the range
template <class T, std::size_t kRows, class At>
Found find(const Field<T> (&fields)[kRows], const char* section, const KeyPath& path, Change change, At at) {
    for (const Field<T>& f : fields) {
        if (!f.in(Files::kScene) || path.name != f.key) continue;
        if (path.element) {
            const std::size_t k = *path.element;
            if (f.element == nullptr || k >= f.count()) break;
            return {&f,
                    // The numbers of a fit also have joint limits.
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
         did_you_mean(path.name, keys_of(fields, Files::kScene)));
}

/// Lifts balls on the cloth to the height of their size, after `found` has changed it.
template <class Balls>
Found lifting(Found found, Balls balls) {
    found.put = [put = std::move(found.put), balls](Scene& s, double value) {
        const Change change = put(s, value);
        for (BallStart& ball : balls(s)) ball.position.z() = s.size_of(ball).R + ball.height;
        return change;
    };
    return found;
}

Found find_in_ball(const Scene& scene, const KeyPath& path) {
    const std::size_t i = *path.index;
    const auto alone = [i](Scene& s) { return std::span(s.ball).subspan(i, 1); };
    if (path.name == "radius" || path.name == "mass") {
        if (!scene.ball[i].own) fail("the ball has no radius or mass of its own; add one, then vary it");
        return lifting(find(kSizeFields, "ball", path, Change::kTable,
                            [i](Scene& s) -> BallSize& { return *s.ball[i].own; }),
                       alone);
    }
    const bool place = path.name == "position" || path.name == "height";
    Found found = find(kBallStartFields, "ball", path, place ? Change::kPlaces : Change::kNumbers,
                       [i](Scene& s) -> BallStart& { return s.ball[i]; });
    return path.name == "height" ? lifting(std::move(found), alone) : found;
}

Found find_in_balls(const KeyPath& path) {
    const bool size = path.name == "radius";
    Found found = find(kBallFields, "balls", path, size ? Change::kTable : Change::kNumbers,
                       [](Scene& s) -> BallParams& { return s.balls; });
    return size ? lifting(std::move(found), [](Scene& s) { return std::span(s.ball); }) : found;
}

/// @param first  number of leading parts that the file has in another list
template <class Part, std::size_t kRows>
Found find_in_parts(const Field<Part> (&fields)[kRows], const char* section, std::vector<Part> Table::*parts,
                    const Scene& scene, const KeyPath& path, std::size_t first = 0) {
    const std::size_t i = first + *path.index;
    if (i >= (scene.table.*parts).size()) fail("the table has no such part");
    return find(fields, section, path, Change::kTable,
                [parts, i](Scene& s) -> Part& { return (s.table.*parts)[i]; });
}

/// A measure of the table: changing it rebuilds the parts.
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

Found find_in_table(const Scene& scene, const KeyPath& path) {
    if (path.list == "cushion")
        return find_in_parts(kCushionFields, "table.cushion", &Table::cushions, scene, path);
    if (path.list == "jaw") return find_in_parts(kJawFields, "table.jaw", &Table::jaws, scene, path);
    if (path.list == "arc") {
        const std::vector<Jaw>& jaws = scene.table.jaws;
        const auto arc = std::find_if(jaws.begin(), jaws.end(), [](const Jaw& jaw) { return jaw.is_arc(); });
        const auto first = static_cast<std::size_t>(arc - jaws.begin());
        return find_in_parts(kJawFields, "table.arc", &Table::jaws, scene, path, first);
    }
    if (path.list == "pocket")
        return find_in_parts(kPocketFields, "table.pocket", &Table::pockets, scene, path);
    for (const PocketSection& section : kPocketSections)
        if (path.list == section.key)
            return rebuilding(find(kPocketMeasureFields, section.path, path, Change::kAnything,
                                   [pockets = section.pockets](Scene& s) -> PocketMeasures& {
                                       return s.table.measures.*pockets;
                                   }));
    return rebuilding(find(kMeasureFields, "table", path, Change::kAnything,
                           [](Scene& s) -> Measures& { return s.table.measures; }));
}

Found find_number(const Scene& scene, const KeyPath& path) {
    if (path.section == "balls") return find_in_balls(path);
    if (path.section == "ball") return find_in_ball(scene, path);
    if (path.section == "cue") {
        if (!scene.cue) fail("the scene has no [cue]; add one, then vary it");
        return find(kCueFields, "cue", path, Change::kNumbers, [](Scene& s) -> Cue& { return *s.cue; });
    }
    if (path.section == "physics")
        return find(kPhysicsFields, "physics", path, Change::kNumbers,
                    [](Scene& s) -> Physics& { return s.physics; });
    if (path.section == "stop")
        return find(kStopFields, "stop", path, Change::kNumbers, [](Scene& s) -> Stop& { return s.stop; });
    if (path.section == "table") return find_in_table(scene, path);
    fail(
        "name a number in its section, such as cue.speed; sections are balls, ball, cue, physics, stop and "
        "table{}",
        did_you_mean(path.section, {"balls", "ball", "cue", "physics", "stop", "table"}));
}

}  // namespace

SceneNumber::SceneNumber(const Scene& scene, std::string_view key) {
    try {
        std::vector<std::string> ids;
        for (const BallStart& ball : scene.ball) ids.push_back(ball.id);
        Found found = find_number(scene, detail::parse_key(key, ids));
        row_ = found.row;
        put_ = std::move(found.put);
        get_ = std::move(found.get);
        if (row_->optional) value(scene);  // may refuse a part of a list
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("{}: {}", key, error.what()));
    }
}

void check_replaces_no_fit(const Scene& scene, std::string_view key) {
    constexpr std::string_view kSection = "balls.";
    if (!key.starts_with(kSection)) return;
    const std::string_view name = key.substr(kSection.size());
    for (const Field<BallParams>& f : kBallFields) {
        const char* replaced = f.options.instead_of;
        if (replaced == nullptr || name != replaced ||
            std::holds_alternative<std::monostate>(f.get(scene.balls)))
            continue;
        throw std::invalid_argument(
            fmt::format("{}: balls.{}, {}, is in force and would be replaced by one number; vary balls.{}.0, "
                        "balls.{}.1 or balls.{}.2",
                        key, f.key, f.options.shape, f.key, f.key, f.key));
    }
}

SceneNumber check_varies(const Scene& scene, std::string_view key) {
    SceneNumber number(scene, key);
    check_replaces_no_fit(scene, key);
    return number;
}

}  // namespace carom
