// The section [table]: a preset, or an outline of its own.
#include <fmt/format.h>

#include <limits>
#include <string_view>

#include "carom/engine/tolerances.h"
#include "scene/sections.h"

namespace carom::detail {
namespace {

constexpr Choice<bool> kTablePresets[] = {
    {"seven_foot", true}, {"eight_foot", true}, {"nine_foot", true}, {"snooker", true}, {"carom", true}};

/// Nose height over ball radius of pool tables (physics.md: 1.28 R), the default of a custom outline.
constexpr double kNoseHeight = 1.28;

void check_count(const Section& s, std::string_view key, std::size_t count) {
    if (count > kMaxTableParts) {
        s.fail(key,
               fmt::format("{} has {} entries; at most {} are allowed", s.full(key), count, kMaxTableParts));
    }
}

void read_cushions(const Section& outline, Scene& scene) {
    const auto tables = outline.tables("cushion");
    if (!tables) return;
    check_count(outline, "cushion", tables->size());
    for (const toml::table* table : *tables) {
        const Section s(*table, outline.file(), "table.cushion", {"from", "to", "height"});
        Cushion c{fmt::format("c{}", scene.table.cushions.size() + 1), {}, {}, 0.0, {}};
        c.from = s.need_vec2("from", "[x, y]", kCoordinate);
        c.to = s.need_vec2("to", "[x, y]", kCoordinate);
        c.height = s.number("height", kNoseHeight * scene.balls.R, more_than(0.0, kMaxLength, "m"));
        if (c.from == c.to) {
            s.fail("to",
                   "a cushion ends where it begins; move one end, or use a [[table.jaw]] of radius 0 for a "
                   "post");
        }
        scene.table.cushions.push_back(c);
    }
}

void read_jaws(const Section& outline, Scene& scene) {
    const auto tables = outline.tables("jaw");
    if (!tables) return;
    check_count(outline, "jaw", tables->size());
    for (const toml::table* table : *tables) {
        const Section s(*table, outline.file(), "table.jaw", {"center", "radius", "height"});
        Jaw j{fmt::format("j{}", scene.table.jaws.size() + 1), {}, 0.0, 0.0, {}};
        j.center = s.need_vec2("center", "[x, y]", kCoordinate);
        j.radius = s.need_number("radius", at_least(0.0, kMaxLength, "m"));
        j.height = s.number("height", kNoseHeight * scene.balls.R, more_than(0.0, kMaxLength, "m"));
        scene.table.jaws.push_back(j);
    }
}

void read_pockets(const Section& outline, Scene& scene) {
    const auto tables = outline.tables("pocket");
    if (!tables) return;
    check_count(outline, "pocket", tables->size());
    for (const toml::table* table : *tables) {
        const Section s(*table, outline.file(), "table.pocket", {"center", "radius"});
        Pocket p{fmt::format("p{}", scene.table.pockets.size() + 1), {}, 0.0, kPocketDepth, {}};
        p.center = s.need_vec2("center", "[x, y]", kCoordinate);
        p.radius = s.need_number("radius", more_than(0.0, kMaxLength, "m"));
        scene.table.pockets.push_back(p);
    }
}

/// Box around the cushions; around jaws and pockets where there are none.
void set_surface(Table& table) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec2 low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
    const auto include = [&](const Vec2& p, double r) {
        low = low.cwiseMin(p - Vec2(r, r));
        high = high.cwiseMax(p + Vec2(r, r));
    };
    for (const Cushion& c : table.cushions) {
        include(c.from, 0.0);
        include(c.to, 0.0);
    }
    if (table.cushions.empty()) {
        for (const Jaw& j : table.jaws) include(j.center, j.radius);
        for (const Pocket& p : table.pockets) include(p.center, p.radius);
    }
    if (!(low.x() <= high.x())) return;  // endless cloth
    table.corner = low;
    table.width = high.x() - low.x();
    table.length = high.y() - low.y();
}

}  // namespace

void read_table(const Section& top, Scene& scene) {
    const toml::table* table = top.table("table");
    if (!table) {
        scene.table = make_table("nine_foot");
        return;
    }
    const Section s(*table, top.file(), "table", {"preset", "cushion", "jaw", "pocket"});
    const bool custom = s.has("cushion") || s.has("jaw") || s.has("pocket");
    if (s.has("preset") && custom) {
        s.fail(
            "preset",
            "a table has a preset or cushions, jaws and pockets of its own, not both; remove one of the two");
    }
    if (!custom) {
        s.choice("preset", true, kTablePresets);
        scene.table = make_table(s.text("preset", "nine_foot"));
        return;
    }
    read_cushions(s, scene);
    read_jaws(s, scene);
    read_pockets(s, scene);
    set_surface(scene.table);
}

}  // namespace carom::detail
