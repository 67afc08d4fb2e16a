// The section [table]: a preset or a custom outline.
#include <fmt/format.h>

#include <limits>
#include <string_view>
#include <vector>

#include "carom/engine/tolerances.h"
#include "scene/sections.h"

namespace carom::detail {
namespace {

/// Nose height over ball radius of pool tables (physics.md: 1.28 R), the default of a custom outline.
constexpr double kNoseShare = 1.28;

/// Reads every item of a list into a part of the table, and calls `check(section, part)`.
template <class Part, std::size_t kRows, class Check>
void read_parts(const Section& outline, const char* key, const Field<Part> (&fields)[kRows],
                const Part& standard, std::vector<Part>& parts, Check&& check) {
    const auto tables = outline.tables(key);
    if (!tables) return;
    if (tables->size() > kMaxTableParts)
        outline.fail(key, "{} has {} entries; at most {} are allowed", outline.full(key), tables->size(),
                     kMaxTableParts);
    const auto keys = keys_of(fields, Files::kScene);
    for (const toml::table* table : *tables) {
        const Section s(*table, outline.file(), outline.full(key), keys);
        Part& part = parts.emplace_back(standard);
        s.read(fields, part);
        check(s, part);
    }
}

/// Box around the cushions, or around jaws and pockets if there are none.
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

void number_parts(Table& table) {
    const auto number = [](char letter, auto& parts) {
        for (std::size_t i = 0; i < parts.size(); ++i) parts[i].id = fmt::format("{}{}", letter, i + 1);
    };
    number('c', table.cushions);
    number('j', table.jaws);
    number('p', table.pockets);
}

void read_table(const Section& top, Scene& scene) {
    std::vector<std::string_view> keys = keys_of(kTableFields, Files::kScene);
    keys.insert(keys.end(), {"cushion", "jaw", "pocket"});
    const auto s = top.section("table", keys);
    const bool custom = s && (s->has("cushion") || s->has("jaw") || s->has("pocket"));
    if (custom && s->has("preset")) {
        s->fail(
            "preset",
            "a table has a preset or cushions, jaws and pockets of its own, not both; remove one of the two");
    }
    Table named;
    if (!custom) named.preset = kStandardTable;
    if (s) s->read(kTableFields, named);
    if (!custom) scene.table = make_table(named.preset);
    scene.table.cloth = named.cloth;
    scene.table.bed = named.bed;
    if (named.cloth && !top.has("balls", "mu_r")) scene.balls.mu_r = cloth_mu_r(*named.cloth);
    if (!custom) return;
    const double height = kNoseShare * scene.balls.R;
    const auto any = [](const Section&, const auto&) {};
    read_parts(*s, "cushion", kCushionFields, Cushion{"", {}, {}, height}, scene.table.cushions,
               check_cushion);
    read_parts(*s, "jaw", kJawFields, Jaw{"", {}, 0.0, height}, scene.table.jaws, any);
    read_parts(*s, "pocket", kPocketFields, Pocket{"", {}, 0.0, kPocketDepth}, scene.table.pockets, any);
    number_parts(scene.table);
    set_surface(scene.table);
}

}  // namespace carom::detail
