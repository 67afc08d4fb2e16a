// carom compare: the differences of two shots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "commands/compare/difference.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

struct CompareArgs {
    std::string a, b;
    /// [m] Larger than the error of the default impact tolerance (3.3e-5 in the snooker break, measured
    /// against 1e-12; less in carom's other scenes), and too small to see or measure on a table.
    double tolerance = 1e-4;
    bool json = false;
};

/// The report about one shot alone.
struct ComparedShot {
    const std::string& file;
    const Record& record;
    const std::string hash = record.hash();
};

Json vector_json(const Vec3& v) {
    return Json::array({v.x(), v.y(), v.z()});
}

Json shot_head_json(const ComparedShot& shot) {
    return {{"file", shot.file},
            {"hash", shot.hash},
            {"balls", shot.record.tracks.size()},
            {"events", shot.record.events.size()},
            {"duration", shot.record.duration},
            {"stopped", name(shot.record.stopped)}};
}

Json end_json(const BallEnd& end) {
    return {{"state", name(end.state)},
            {"pocket", end.pocket.empty() ? Json() : Json(end.pocket)},
            {"position", vector_json(end.position)}};
}

/// An event of both shots; null if a shot has fewer.
Json two_events_json(const EventDifference& events, std::size_t number) {
    const auto one = [number](const std::vector<NamedEvent>& list) {
        return number < list.size() ? Json({{"time", list[number].time},
                                            {"type", list[number].type},
                                            {"who", list[number].who}})
                                    : Json();
    };
    return {{"number", number + 1}, {"a", one(events.a)}, {"b", one(events.b)}};
}

Json events_json(const EventDifference& events) {
    Json first_apart, first_other;
    if (events.first_apart) first_apart = two_events_json(events, *events.first_apart);
    if (!events.ends_alike()) first_other = two_events_json(events, events.alike);
    return {{"alike", events.alike},
            {"farthest_apart", events.farthest_apart},
            {"first_apart", first_apart},
            {"first_other", first_other}};
}

std::string difference_json(const ComparedShot& a, const ComparedShot& b, const ShotDifference& d,
                            double tolerance) {
    Json balls = Json::array();
    for (const BallDifference& ball : d.balls)
        balls.push_back({{"id", ball.id},
                         {"a", end_json(ball.a)},
                         {"b", end_json(ball.b)},
                         {"end", ball.end},
                         {"largest", ball.largest},
                         {"largest_at", ball.largest_at},
                         {"equal", ball.within(tolerance)}});
    const Json all = {{"a", shot_head_json(a)}, {"b", shot_head_json(b)},          {"same_bits", d.same_bits},
                      {"tolerance", tolerance}, {"equal", d.within(tolerance)},    {"only_in_a", d.only_a},
                      {"only_in_b", d.only_b},  {"events", events_json(d.events)}, {"until", d.until},
                      {"balls", balls}};
    return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string what_happened(const NamedEvent& event) {
    return fmt::format("{} {}", event.type, fmt::join(event.who, " "));
}

/// The number of matching events, and the first ones that differ: in time only, and in anything else.
std::string events_text(const EventDifference& events) {
    std::string out =
        fmt::format("\nevents\n  A has {}, B has {}; matching: ", events.a.size(), events.b.size());
    if (events.alike == 0) out += "none";
    if (events.alike > 0) out += events.ends_alike() ? "all" : fmt::format("the first {}", events.alike);
    if (events.alike > 0 && !events.first_apart) out += ", at the same times";
    if (events.first_apart) {
        const std::size_t k = *events.first_apart;
        const double a = events.a[k].time, b = events.b[k].time;
        out +=
            fmt::format(", at times up to {:.3g} s apart\n  event {} is the first at a different time: {}\n",
                        events.farthest_apart, k + 1, what_happened(events.a[k]));
        out += fmt::format("    A {:.6f} s\n    B {:.6f} s, {:.3g} s {}", a, b, std::abs(b - a),
                           b > a ? "later" : "earlier");
    }
    if (events.ends_alike()) return out + "\n";
    const auto line = [&events](const char* shot, const std::vector<NamedEvent>& list) {
        if (events.alike >= list.size()) return fmt::format("    {} none\n", shot);
        const NamedEvent& event = list[events.alike];
        return fmt::format("    {} {:.6f} s {}\n", shot, event.time, what_happened(event));
    };
    return out + fmt::format("\n  event {} is the first that does not match:\n", events.alike + 1) +
           line("A", events.a) + line("B", events.b);
}

std::string end_text(const BallEnd& end) {
    if (!end.pocket.empty()) return "in " + end.pocket;
    return end.state == MotionState::kOut ? "off the table" : name(end.state);
}

/// One row per ball; a star marks a difference above the tolerance.
std::string balls_text(const ShotDifference& d, double tolerance) {
    std::size_t wide = 4, wide_a = 8, wide_b = 8;
    for (const BallDifference& ball : d.balls) {
        wide = std::max(wide, ball.id.size());
        wide_a = std::max(wide_a, end_text(ball.a).size());
        wide_b = std::max(wide_b, end_text(ball.b).size());
    }
    const auto left = [](std::size_t width) { return fmt::format("<{}", width + 2); };
    Table table(Column("", "  ball", left(wide + 2)), Column("", "end in A", left(wide_a)),
                Column("", "end in B", left(wide_b)), Column("", "at end (m)", ">11.3g"),
                Column("", "largest (m)", ">13.3g"), Column("", "at (s)", ">10.4f"));
    for (const BallDifference& ball : d.balls)
        table.add({"  " + ball.id, end_text(ball.a), end_text(ball.b), ball.end, ball.largest,
                   ball.largest > 0.0 ? Cell(ball.largest_at) : Cell()},
                  ball.within(tolerance) ? "" : "  *");
    return "\n" + table_text(table);
}

/// "; pocketed differently: 1, 5": the balls that are gone in one shot only, or into different pockets.
std::string fates(const ShotDifference& d) {
    std::vector<std::string_view> ids;
    for (const BallDifference& ball : d.balls)
        if (!ball.gone_alike()) ids.push_back(ball.id);
    return ids.empty() ? "" : fmt::format("; pocketed differently: {}", fmt::join(ids, ", "));
}

/// "cue, by 0.577 m at 3.7089 s"
std::string farthest_text(const BallDifference& ball) {
    if (ball.end > ball.largest) return fmt::format("{}, by {:.3g} m at the end", ball.id, ball.end);
    return fmt::format("{}, by {:.3g} m at {:.4f} s", ball.id, ball.largest, ball.largest_at);
}

std::string conclusion(const ShotDifference& d, double tolerance) {
    if (d.within(tolerance) && d.same_bits) return "the same, bit for bit";
    if (d.balls.empty()) return "different: no ball in common";
    const auto most = [](const BallDifference& ball) { return std::max(ball.end, ball.largest); };
    const BallDifference& worst = *std::max_element(
        d.balls.begin(), d.balls.end(),
        [&most](const BallDifference& x, const BallDifference& y) { return most(x) < most(y); });
    const auto unlike =
        std::count_if(d.balls.begin(), d.balls.end(),
                      [tolerance](const BallDifference& ball) { return !ball.within(tolerance); });
    if (d.within(tolerance) && most(worst) == 0.0)
        return "equal: all positions are the same, but not all bits";
    if (unlike == 0)
        return fmt::format(
            "{} within {:g} m; the farthest is {}",
            d.same_balls() ? "equal" : "different: not the same balls; the common ones are equal", tolerance,
            farthest_text(worst));
    return fmt::format("different: {} of {} more than {:g} m apart, the farthest {}{}{}", unlike,
                       counted(d.balls.size(), "ball"), tolerance, farthest_text(worst), fates(d),
                       d.same_balls() ? "" : "; not the same balls");
}

std::string difference_text(const ComparedShot& a, const ComparedShot& b, const ShotDifference& d,
                            double tolerance) {
    std::string out;
    for (const auto& [letter, shot] : {std::pair("A", &a), std::pair("B", &b)})
        out += fmt::format("{}  {}: {}, {:.4f} s, {}, hash {}\n", letter, shot->file,
                           counted(shot->record.tracks.size(), "ball"), shot->record.duration,
                           counted(shot->record.events.size(), "event"), shot->hash);
    if (!d.only_a.empty()) out += fmt::format("balls only in A: {}\n", fmt::join(d.only_a, ", "));
    if (!d.only_b.empty()) out += fmt::format("balls only in B: {}\n", fmt::join(d.only_b, ", "));
    if (!d.balls.empty()) out += events_text(d.events) + balls_text(d, tolerance);
    if (d.until < std::max(a.record.duration, b.record.duration))
        out += fmt::format("  largest: until {:.4f} s, when one of the shots was stopped\n", d.until);
    return out + "\n" + conclusion(d, tolerance) + "\n";
}

/// A shot that cannot be computed is bad input (exit status 2): 1 already means that the shots differ.
Record shot_to_compare(const std::string& path) {
    try {
        return read_shot(path, {});
    } catch (const SimulationError& error) {
        throw UsageError(fmt::format("{}: {}", path, error.what()));
    }
}

int run(const CompareArgs& args) {
    if (!(args.tolerance >= 0.0 && std::isfinite(args.tolerance)))
        throw UsageError("--tolerance: expected a length in m of at least 0");
    const Record a = shot_to_compare(args.a), b = shot_to_compare(args.b);
    const ShotDifference d = difference(a, b);
    const ComparedShot shot_a{harmless(args.a), a}, shot_b{harmless(args.b), b};
    print(args.json ? difference_json(shot_a, shot_b, d, args.tolerance)
                    : difference_text(shot_a, shot_b, d, args.tolerance));
    return d.within(args.tolerance) ? kOk : kFailed;
}

}  // namespace

void add_compare(Options& program) {
    auto [command, args] =
        program.command<CompareArgs>("compare", "Compare two shots: where they differ, and by how much", run);
    command.argument("A", args.a, "Scene file (TOML) or record (.json)").required = true;
    command.argument("B", args.b, "Scene file or record to compare with").required = true;
    command.option("--tolerance", &args.tolerance, "L",
                   "Count positions at most this far apart, in m, as equal");
    command.flag("--json", args.json, "Print JSON (default: off)");
    command.footer =
        "Exit status: 0 equal within the tolerance, 1 different, 2 bad usage or bad input. Example: carom "
        "compare scenes/stop.toml scenes/draw.toml; carom view A B shows both.";
}

}  // namespace carom::tools
