// The section [table]: a preset or a custom outline.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/geometry.h"
#include "carom/engine/tolerances.h"
#include "scene/pocket_table.h"
#include "scene/sections.h"

namespace carom::detail {
namespace {

/// Nose height over ball radius of pool tables (physics.md: 1.28 R): the default of a custom outline.
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

/// Directions in which an arc may extend farthest: along an axis, or to its ends.
std::vector<Vec2> farthest_of(const ArcSpan& span) {
    std::vector<Vec2> all;
    for (const Vec2& axis : {Vec2(1.0, 0.0), Vec2(0.0, 1.0), Vec2(-1.0, 0.0), Vec2(0.0, -1.0)})
        if (span.holds(axis)) all.push_back(axis);
    if (!span.whole) all.insert(all.end(), {span.from, span.to});
    return all;
}

/// Box inside the nose lines: only cushions along x and along y bound it, not facings. If they bound nothing,
/// it is the box around the cushions, or around jaws and pockets if there are none.
void set_surface(Table& table) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec2 low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
    const auto include = [&](const Vec2& p, double r) {
        low = low.cwiseMin(p - Vec2(r, r));
        high = high.cwiseMax(p + Vec2(r, r));
    };
    for (const Cushion& c : table.cushions)
        for (int k = 0; k < 2; ++k)
            if (c.from[k] == c.to[k]) {
                low[k] = std::min(low[k], c.from[k]);
                high[k] = std::max(high[k], c.from[k]);
            }
    const bool bounded = low.x() < high.x() && low.y() < high.y();
    if (!bounded) low = Vec2(kInfinity, kInfinity), high = Vec2(-kInfinity, -kInfinity);
    for (const Cushion& c : table.cushions) {
        if (bounded) break;
        include(c.from, 0.0);
        include(c.to, 0.0);
    }
    // The farthest points of a round wall bound it, too.
    for (const Jaw& j : table.jaws)
        if (j.around())
            for (const Vec2& out : farthest_of(span_of(j))) include(j.center + j.radius * out, 0.0);
    if (table.cushions.empty()) {
        for (const Jaw& j : table.jaws) include(j.center, j.is_arc() ? 0.0 : j.radius);
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
    std::size_t jaws = 0, arcs = 0;
    for (Jaw& jaw : table.jaws)
        jaw.id = jaw.is_arc() ? fmt::format("a{}", ++arcs) : fmt::format("j{}", ++jaws);
    number('p', table.pockets);
}

void check_jaw(const Section& section, const Jaw& jaw) {
    if (!jaw.is_arc()) {
        for (const auto& [key, given] :
             {std::pair{"from_deg", jaw.from_deg.has_value()}, std::pair{"to_deg", jaw.to_deg.has_value()}})
            if (given) section.fail(key, "a jaw is a full circle; write [[table.arc]] for a part of one");
        return;
    }
    if (!section.path_is("table.arc") && section.has("side"))
        section.fail("side", "balls touch a jaw from outside; write [[table.arc]] for a round wall");
    if (jaw.radius == 0.0)
        section.fail("radius", "an arc of radius 0 has no length; make it larger, or write a jaw");
    if (!jaw.from_deg || !jaw.to_deg)
        section.fail(SourceLocation{}, "an arc needs both from_deg and to_deg; set the two");
    const double turn = *jaw.to_deg - *jaw.from_deg;
    if (turn > 0.0 && turn <= 360.0) return;
    section.fail("to_deg",
                 "table.arc.to_deg = {} must exceed from_deg = {} by at most 360 degrees; an arc runs "
                 "counter-clockwise",
                 *jaw.to_deg, *jaw.from_deg);
}

void check_measures(const Section& section, const Scene& scene) {
    const Table& table = scene.table;
    if (table.measures == Measures{}) return;
    if (table.preset.empty())
        section.fail(SourceLocation{}, "table.measures change a preset, but this table has none; name one");
    const std::optional<PocketTable> preset = pocket_table(table.preset);
    for (const auto& [key, path, pockets] : kPocketSections) {
        const PocketMeasures& of = table.measures.*pockets;
        if (of == PocketMeasures{}) continue;
        if (!preset)
            section.fail(key, "the table {} has no pockets; leave out {}", in_quotes(table.preset), path);
        if (of.throat && of.angle_deg)
            section.fail(section.where(key, "throat"),
                         "{0}.throat and {0}.angle_deg are two values for one facing; remove one", path);
    }
    if (!preset) {
        if (table.measures.rail_width)
            section.fail("rail_width", "the table {} has no pockets; leave out {}", in_quotes(table.preset),
                         section.full("rail_width"));
        if (table.width > table.length)
            section.fail("size", "table.size = [{}, {}] has the long side first; swap the two", table.width,
                         table.length);
        return;
    }
    const double R = scene.balls.R, cue = scene.cue_ball.value_or(scene.balls.size()).R;
    const PocketTable whole = with_measures(*preset, table.measures);
    for (const PocketSection& of : kPocketSections) {
        // A facing at a right angle leaves the widest throat.
        const double got = *(measures_of(whole).*of.pockets).throat;
        const double wanted = (table.measures.*of.pockets).throat.value_or(got);
        if (wanted > got + 1e-9)
            section.fail(section.where(of.key, "throat"),
                         "{}.throat = {} m is wider than any facing leaves it; use at most {:.4g} m", of.path,
                         wanted, got);
    }
    const auto wrong = misfit(whole, std::min(R, cue), std::max(R, cue));
    if (!wrong) return;
    const std::string inside = *wrong->section == '\0' ? "" : fmt::format("{}.", wrong->section);
    section.fail(inside.empty() ? section.where(wrong->key) : section.where(wrong->section, wrong->key),
                 "{} {}", section.full(inside + wrong->key), wrong->message);
}

void read_table(const Section& top, Scene& scene) {
    std::vector<std::string_view> keys = keys_of(kTableFields, Files::kScene),
                                  of_preset = keys_of(kMeasureFields, Files::kScene);
    for (const PocketSection& pockets : kPocketSections) of_preset.emplace_back(pockets.key);
    keys.insert(keys.end(), of_preset.begin(), of_preset.end());
    keys.insert(keys.end(), {"cushion", "jaw", "arc", "pocket"});
    of_preset.emplace_back("preset");
    const auto s = top.section("table", keys);
    const bool custom = s && (s->has("cushion") || s->has("jaw") || s->has("arc") || s->has("pocket"));
    for (const std::string_view key : of_preset)
        if (custom && s->has(key))
            s->fail(
                key,
                "a table has either a preset or its own cushions, jaws and pockets; remove one of the two");
    Table named;
    if (!custom) named.preset = kStandardTable;
    if (s) {
        s->read(kTableFields, named);
        s->read(kMeasureFields, named.measures);
        for (const PocketSection& of : kPocketSections)
            s->read(of.key, kPocketMeasureFields, named.measures.*of.pockets);
    }
    if (!custom) {
        scene.table = make_table(named.preset, named.measures);
        if (s) check_measures(*s, scene);
    }
    scene.table.cloth = named.cloth;
    scene.table.bed = named.bed;
    if (named.cloth && !top.has("balls", "mu_r")) scene.balls.mu_r = cloth_mu_r(*named.cloth);
    if (!custom) return;
    const double height = kNoseShare * scene.balls.R;
    const auto any = [](const Section&, const auto&) {};
    read_parts(*s, "cushion", kCushionFields, Cushion{"", {}, {}, height}, scene.table.cushions,
               check_cushion);
    const Jaw jaw{"", {}, 0.0, height};
    read_parts(*s, "jaw", kJawFields, jaw, scene.table.jaws, check_jaw);
    std::vector<Jaw> arcs;
    read_parts(*s, "arc", kJawFields, jaw, arcs, [](const Section& section, Jaw& arc) {
        arc.side = arc.side.value_or(kArcSides[0]);
        arc.from_deg = arc.from_deg.value_or(0.0);
        arc.to_deg = arc.to_deg.value_or(*arc.from_deg + 360.0);
        check_jaw(section, arc);
    });
    scene.table.jaws.insert(scene.table.jaws.end(), arcs.begin(), arcs.end());
    read_parts(*s, "pocket", kPocketFields, Pocket{"", {}, 0.0, kPocketDepth}, scene.table.pockets, any);
    number_parts(scene.table);
    set_surface(scene.table);
}

}  // namespace carom::detail
