// carom sensitivity: the effect of small errors on a shot.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/hand.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/statistics.h"
#include "carom/engine/batch.h"
#include "carom/engine/derivatives.h"
#include "carom/engine/printable.h"
#include "carom/games/noise.h"
#include "report/diagram.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

// [degrees] Steps and ends of the search for the aims at which a pot still falls; a step is then halved.
constexpr double kAimStep = 0.02, kAimMost = 10.0;
constexpr int kHalvings = 20;
// [nudges] The smallest and largest change that is tried for a margin.
constexpr double kLeastChange = 1e-3, kMostChange = 1e3;

struct SensitivityArgs {
    std::string scene, hand = kHand, plot;
    int shots = 1000;
    std::uint64_t seed = 1;
    bool json = false;
};

/// A small change of an input, and its standard deviation for a hand.
struct Nudge {
    std::string key, words;
    double size, hand;  ///< in the unit of the input
    std::string unit;   ///< of `scale`, for the margin
    double scale;       ///< of the input's unit to that one
};

std::vector<Nudge> nudges_of(const Scene& scene, int ball, const games::Hand& hand) {
    const Cue& cue = *scene.cue;
    const double R = scene.size_of(scene.ball[static_cast<std::size_t>(ball)]).R;
    const auto place = [&](const char* axis) { return "ball." + cue.ball + ".position." + axis; };
    std::vector<Nudge> nudges = {
        {"cue.aim_deg", "aim 0.1 degrees to the left", 0.1, hand.aim_deg, "degrees", 1.0},
        {"cue.speed", "1 % faster", 0.01 * cue.speed, hand.speed * cue.speed, "%", 100.0 / cue.speed},
        {"cue.offset.side", "tip 1 mm to the left", 1e-3 / R, hand.tip, "mm", 1e3 * R},
        {"cue.offset.height", "tip 1 mm higher", 1e-3 / R, hand.tip, "mm", 1e3 * R},
        {place("x"), cue.ball + " 1 mm along x", 1e-3, 0.0, "mm", 1e3},
        {place("y"), cue.ball + " 1 mm along y", 1e-3, 0.0, "mm", 1e3}};
    if (cue.elevation_deg > 0.0)
        nudges.push_back(
            {"cue.elevation_deg", "butt 1 degree higher", 1.0, hand.elevation_deg, "degrees", 1.0});
    return nudges;
}

/// Half axes of one standard deviation [m], and the direction of the longer one [degrees].
struct Ellipse {
    double along, across, direction_deg;
};
Ellipse ellipse_of(const Eigen::Matrix2d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
    const Vec2 longer = axes.eigenvectors().col(1);
    const double angle = std::atan2(longer.y(), longer.x()) * 180.0 / std::numbers::pi;
    const auto half = [&axes](int k) { return std::sqrt(std::max(0.0, axes.eigenvalues()[k])); };
    return {half(1), half(0), angle < 0.0 ? angle + 180.0 : angle};
}

/// One ball: its final position, or its fall.
struct BallResult {
    int ball;
    std::optional<std::size_t> fall;                  ///< the event in which it crosses its pocket
    std::vector<Vec2> moves;                          ///< [m] for each nudge
    Ellipse expected;                                 ///< to first order
    std::vector<Vec2> ends;                           ///< [m] of the sweep, unless it is gone
    std::optional<Ellipse> played;                    ///< of these; empty if it stays too rarely
    std::optional<std::pair<double, double>> window;  ///< [degrees] of the aim, in which it still falls
    std::size_t fell = 0;  ///< shots of the sweep in which it falls into the same pocket
};

/// The first event of a ball with its pocket.
std::optional<std::size_t> fall_of(const Record& record, int ball) {
    std::optional<std::size_t> found;
    for (std::size_t e = 0; e < record.events.size(); ++e) {
        const Event& event = record.events[e];
        if (event.a != ball || kind(event.type).partner != Partner::kPocket) continue;
        if (event.type == EventType::kBallEdge || !found) found = e;
    }
    return record.tracks[static_cast<std::size_t>(ball)].pocket >= 0 ? found : std::nullopt;
}

/// A change of an input, and the difference that it makes; "" for none.
struct Bound {
    double change;
    std::string why;
};

/// The last change on one side, going outwards, that makes no difference.
/// @param step  the first change; the next ones are twice as large, or this much larger, up to `most`
template <class Difference>
Bound last_change(const Plan& plan, const std::string& input, double step, bool doubles, double most,
                  const Difference& difference) {
    Simulator simulator(plan.scene, plan.isa);
    const SceneNumber number(plan.scene, input);
    const double value = number.value(plan.scene);
    Bound inside{0.0, ""};
    double outside = 0.0;
    const auto holds = [&](double by) {
        const Change checks = number.put(simulator.scene(), value + by);
        const bool played = has_result(simulator.play(checks, interruptible()));
        const std::string differs = played ? difference(simulator.outcome()) : simulator.message();
        (differs.empty() ? inside.change : outside) = by;
        if (!differs.empty()) inside.why = differs;
        return differs.empty();
    };
    for (double by = step; std::abs(by) <= most && holds(by);) by += doubles ? by : step;
    for (int k = 0; k < kHalvings && !inside.why.empty(); ++k) holds(0.5 * (inside.change + outside));
    return inside;
}

struct Sensitivity {
    std::vector<Nudge> nudges;
    std::vector<double> errors;                 ///< relative, of the derivatives by each
    std::vector<std::array<Bound, 2>> margins;  ///< of each, downwards and upwards
    std::vector<BallResult> balls;
    std::size_t shots = 0, same = 0;  ///< of the sweep; of them, with the same events
};

/// The first difference between the events of two shots: the pocket or the cushions of a ball, or the number
/// of events; "" if there is none.
std::string difference(const Scene& scene, const Outcome& one, const Outcome& two) {
    for (std::size_t i = 0; i < one.balls.size(); ++i) {
        const BallOutcome &before = one.balls[i], &after = two.balls[i];
        const std::string& id = scene.ball[i].id;
        if (before.pocket != after.pocket)
            return id + (after.pocket == kOffTable ? " leaves the table"
                         : after.pocket < 0        ? " does not fall"
                                                   : " falls into " + scene.table.pockets[after.pocket].id);
        if (before.cushions != after.cushions)
            return fmt::format("{} meets {} cushions instead of {}", id, after.cushions, before.cushions);
    }
    if (one.events == two.events) return "";
    return fmt::format("{} events instead of {}", two.events, one.events);
}

/// Plays the shot with the errors of the hand.
void play(const Plan& plan, const Record& record, const games::Hand& hand, const SensitivityArgs& args,
          Sensitivity& result) {
    Planner planner(plan.scene, plan.isa);
    RunBuffers buffers;
    Outcome meant, outcome;
    simulate(plan, buffers, meant, interruptible());
    const Cue cue = *plan.scene.cue;
    const games::Noise noise{hand.speed * cue.speed, hand.aim_deg, hand.elevation_deg, hand.tip, hand.tip};
    for (result.shots = 0; result.shots < static_cast<std::size_t>(args.shots); ++result.shots) {
        planner.scene().cue = games::with_noise(cue, noise, args.seed, result.shots);
        simulate(planner.plan(true), buffers, outcome, interruptible());
        result.same += difference(plan.scene, meant, outcome).empty() ? 1 : 0;
        for (BallResult& row : result.balls) {
            const auto ball = static_cast<std::size_t>(row.ball);
            const BallOutcome& end = outcome.balls[ball];
            if (end.pocket == -1) row.ends.push_back(planar(end.position));
            if (row.fall) row.fell += end.pocket == record.tracks[ball].pocket ? 1 : 0;
        }
    }
    for (BallResult& row : result.balls) {
        if (row.fall || row.ends.size() < 10) continue;
        const auto count = static_cast<double>(row.ends.size());
        Vec2 mean = Vec2::Zero();
        for (const Vec2& end : row.ends) mean += end / count;
        Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
        for (const Vec2& end : row.ends) covariance += (end - mean) * (end - mean).transpose() / count;
        row.played = ellipse_of(covariance);
    }
}

Sensitivity measure(const Plan& plan, const Record& record, const SensitivityArgs& args) {
    const games::Hand hand = read_hand(args.hand);
    Sensitivity result;
    result.nudges = nudges_of(plan.scene, struck_ball(plan.scene), hand);
    std::vector<std::string> inputs;
    for (const Nudge& nudge : result.nudges) inputs.push_back(nudge.key);
    std::vector<std::size_t> falls;
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
        const BallTrack& track = record.tracks[static_cast<std::size_t>(ball)];
        if (track.segments.size() == 1 || track.segments.back().state == MotionState::kOut) continue;
        BallResult& row = result.balls.emplace_back();
        row.ball = ball;
        row.fall = fall_of(record, ball);
        if (row.fall) falls.push_back(*row.fall);
    }
    const Derivatives by(plan, record, inputs, {record.duration}, falls);
    RunBuffers buffers;
    Outcome meant;
    simulate(plan, buffers, meant, interruptible());
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        const Nudge& nudge = result.nudges[k];
        // A place may have no derivative, such as that of a ball at a rail.
        if (const std::string why = by.refusal(k, kRoughDerivativeError); !why.empty() && nudge.hand > 0.0)
            throw DerivativeError(why);
        result.errors.push_back(by.error(k));
        const auto margin = [&](double way) {
            return last_change(plan, nudge.key, way * kLeastChange * nudge.size, true,
                               kMostChange * nudge.size,
                               [&](const Outcome& other) { return difference(plan.scene, meant, other); });
        };
        result.margins.push_back({margin(-1.0), margin(1.0)});
    }
    std::size_t fallen = 0;
    for (BallResult& row : result.balls) {
        Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            const Vec2 d = row.fall ? by.event_place(fallen, k) : planar(by.state(0, row.ball, k).position);
            const bool usable = by.error(k) <= kRoughDerivativeError;
            row.moves.push_back(usable ? Vec2(d * result.nudges[k].size) : Vec2::Constant(std::nan("")));
            if (result.nudges[k].hand > 0.0)
                covariance += result.nudges[k].hand * result.nudges[k].hand * d * d.transpose();
        }
        row.expected = ellipse_of(covariance);
        const int pocket = record.tracks[static_cast<std::size_t>(row.ball)].pocket;
        const auto window_end = [&](double way) {
            return last_change(plan, "cue.aim_deg", way * kAimStep, false, kAimMost,
                               [&](const Outcome& other) {
                                   return other.balls[static_cast<std::size_t>(row.ball)].pocket == pocket
                                              ? ""
                                              : "misses";
                               })
                .change;
        };
        if (row.fall) row.window = {window_end(-1.0), window_end(1.0)};
        fallen += row.fall ? 1 : 0;
    }
    play(plan, record, hand, args, result);
    return result;
}

std::string bound_text(const Bound& bound, double scale) {
    return bound.why.empty() ? "any" : fmt::format("{:.3g}", std::abs(bound.change * scale));
}

std::string text_of(const Sensitivity& s, const Plan& plan, const Record& record, const std::string& hand) {
    Table table(Column("", "", "<28"));
    for (const BallResult& ball : s.balls) {
        const std::string& id = record.tracks[static_cast<std::size_t>(ball.ball)].id;
        table.columns.emplace_back("", (ball.fall ? id + " at its pocket" : id) + ", mm", ">22");
    }
    table.columns.emplace_back("", "same events between", ">32");
    for (std::size_t k = 0; k < s.nudges.size(); ++k) {
        const Nudge& nudge = s.nudges[k];
        std::vector<Cell> cells{nudge.words};
        for (const BallResult& ball : s.balls)
            cells.push_back(
                std::isnan(ball.moves[k].x())
                    ? "none"
                    : fmt::format("{:+.1f} {:+.1f}", 1e3 * ball.moves[k].x(), 1e3 * ball.moves[k].y()));
        cells.push_back(fmt::format("-{} and +{} {}", bound_text(s.margins[k][0], nudge.scale),
                                    bound_text(s.margins[k][1], nudge.scale), nudge.unit));
        table.add(cells);
    }
    std::string text = table_text(table);
    text += "\nx and y, to first order. ";
    text += "The events change first if\n";
    for (std::size_t k = 0; k < 2; ++k) {
        const auto& [down, up] = s.margins[k];
        const Bound& nearest = up.why.empty() || (!down.why.empty() && -down.change < up.change) ? down : up;
        if (!nearest.why.empty())
            text += fmt::format("  {} changes by {:+.3g} {}: {}\n", s.nudges[k].key,
                                nearest.change * s.nudges[k].scale, s.nudges[k].unit, nearest.why);
    }
    text += fmt::format("\nwith the hand {} (standard deviations)\n", harmless(hand));
    for (const BallResult& ball : s.balls) {
        const BallTrack& track = record.tracks[static_cast<std::size_t>(ball.ball)];
        if (ball.fall) {
            text += fmt::format("  {} falls into {} in {}", track.id,
                                plan.scene.table.pockets[static_cast<std::size_t>(track.pocket)].id,
                                share_text(share_of(ball.fell, s.shots)));
            text += fmt::format("; it falls for aims from {:+.3f} to {:+.3f} degrees\n", ball.window->first,
                                ball.window->second);
            continue;
        }
        const auto axes = [](const Ellipse& e) {
            return fmt::format("{:.0f} x {:.0f} mm, the longer at {:.0f} degrees", 1e3 * e.along,
                               1e3 * e.across, e.direction_deg);
        };
        text += fmt::format("  {} ends within {} to first order", track.id, axes(ball.expected));
        if (ball.played) text += fmt::format("; played, {}", axes(*ball.played));
        text += '\n';
    }
    text += fmt::format(
        "  {} of {} have the same events as the shot; the first-order results describe only these\n",
        counted(s.same, "shot"), s.shots);
    return text;
}

Json number_json(double x) {
    return std::isfinite(x) ? Json(x) : Json();
}
Json ellipse_json(const Ellipse& e) {
    return {{"along_m", e.along}, {"across_m", e.across}, {"direction_deg", e.direction_deg}};
}

Json json_of(const Sensitivity& s, const Record& record, const std::string& hand) {
    Json inputs = Json::array(), balls = Json::array();
    for (std::size_t k = 0; k < s.nudges.size(); ++k) {
        const auto& [down, up] = s.margins[k];
        const auto size = [](const Bound& bound) {
            return bound.why.empty() ? Json() : Json(std::abs(bound.change));
        };
        inputs.push_back({{"input", s.nudges[k].key},
                          {"nudge", s.nudges[k].size},
                          {"error", number_json(s.errors[k])},
                          {"down", size(down)},
                          {"down_why", down.why},
                          {"up", size(up)},
                          {"up_why", up.why}});
    }
    for (const BallResult& ball : s.balls) {
        Json moves = Json::array();
        for (std::size_t k = 0; k < s.nudges.size(); ++k)
            moves.push_back({number_json(ball.moves[k].x() / s.nudges[k].size),
                             number_json(ball.moves[k].y() / s.nudges[k].size)});
        Json row{{"ball", record.tracks[static_cast<std::size_t>(ball.ball)].id},
                 {"falls", ball.fall.has_value()},
                 {"derivatives", moves},
                 {"ellipse", ellipse_json(ball.expected)}};
        if (ball.played) row["played"] = ellipse_json(*ball.played);
        if (ball.window) {
            row["aim_window_deg"] = {ball.window->first, ball.window->second};
            row["fell"] = ball.fell;
        }
        balls.push_back(row);
    }
    return {
        {"hand", hand}, {"inputs", inputs}, {"balls", balls}, {"shots", s.shots}, {"same_events", s.same}};
}

/// The shot, with the ellipse and the played ends of each ball.
DiagramShot drawing_of(const Sensitivity& s, const Plan& plan, const Record& record,
                       const std::string& hand) {
    DiagramShot shot{
        "Errors of one standard deviation: " + hand_words(read_hand(hand)), record, plan.scene.cue, {}};
    for (const BallResult& ball : s.balls) {
        const double time = ball.fall ? record.events[*ball.fall].time : record.duration;
        const double angle = ball.expected.direction_deg * std::numbers::pi / 180.0;
        const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
        shot.spreads.push_back({ball.ball, planar(record.state_at(ball.ball, time).position),
                                ball.expected.along * along, ball.expected.across * across, ball.ends});
    }
    return shot;
}

int run(const SensitivityArgs& args) {
    const std::string format = args.plot.empty() ? "" : diagram_format(args.plot);
    const Plan plan = plan_scene(args.scene);
    if (!plan.scene.cue) throw SceneError(args.scene, {}, "no ball is struck; add a [cue]");
    const Record record = simulate_plan(plan, interruptible());
    const Sensitivity result = measure(plan, record, args);
    if (!args.plot.empty())
        write_report(args.plot, draw_diagram({drawing_of(result, plan, record, args.hand)}, {}, format));
    print(args.json ? json_of(result, record, args.hand).dump() + "\n"
                    : text_of(result, plan, record, args.hand));
    return kOk;
}

}  // namespace

void add_sensitivity(Options& program) {
    auto [command, args] = program.command<SensitivityArgs>(
        "sensitivity", "Show how small errors of aim, speed, tip and position change a shot", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    command.option("--hand", &args.hand, "ERRORS",
                   "Standard deviations of the player's errors: aim in degrees, speed in percent, tip in "
                   "ball radii, elevation in degrees");
    command.option("--shots", &args.shots, "N", "Number of shots to play with these errors").in(1, 1e7);
    command.option("--seed", &args.seed, "S", "Seed of the errors");
    command.option("--plot", &args.plot, "FILE",
                   "Draw the shot and the errors of the final positions: .svg, .pdf or .png (default: not "
                   "drawn)");
    command.flag("--json", args.json, "Print everything as JSON (default: off)");
}

}  // namespace carom::tools
