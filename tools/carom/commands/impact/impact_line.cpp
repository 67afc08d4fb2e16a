// Reads one line of carom impact (JSON) and computes its answer (JSON). "id" is copied to the answer.
#include "commands/impact/impact_line.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/cushion.h"
#include "carom/kernel/closed_forms.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The JSON of an impact nests three deep; anything deeper than this is rejected.
constexpr int kDeepest = 8;
/// A normal written with four digits is accepted as a unit vector; a larger difference from 1 is an error.
constexpr double kUnitSlack = 1e-3;

/// The fault of a line.
class LineError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

const Json& need(const Json& object, const char* key) {
    const auto it = object.find(key);
    if (it == object.end()) throw LineError(fmt::format("the key \"{}\" is missing", key));
    return *it;
}

/// The keys of one kind of line besides "kind", "id" and "params", separated by spaces.
struct LineKind {
    const char* kind;
    bool airborne;  ///< the line says "airborne": true
    const char *meaning, *keys, *params;
    const char* optional;  ///< params that may be left out
    const char* answer;
};
constexpr const char *kTwoStates = "r1 v1 w1 r2 v2 w2", *kTwoAnswers = "v1 w1 v2 w2 steps ns";
constexpr LineKind kBallBall = {
    "ball_ball", false,      "two balls on the cloth", kTwoStates, "R m mu_s1 mu_s2 mu_b e_b",
    "m2 R2",     kTwoAnswers};
constexpr LineKind kBallBallInAir = {
    "ball_ball", true,       "two balls, at least one in the air", kTwoStates, "R1 R2 m1 m2 mu_b e_b",
    "",          kTwoAnswers};
constexpr LineKind kCushion = {
    "cushion", false, "a ball on the cloth and a cushion", "model normal v w", "R m mu_s e_c f_c height",
    "",        "v w"};
constexpr LineKind kCushionInAir = {
    "cushion", true, "a ball in the air and a cushion nose", "model normal offset v w", "R e_c f_c",
    "",        "v w"};
constexpr LineKind kCloth = {"cloth", false, "a ball landing on the cloth", "v w", "R mu_s mu_sp e_t gravity",
                             "",      "v w"};

constexpr struct {
    const char *keys, *meaning;
} kMeanings[] = {
    {"r, v, w", "centre, velocity and angular velocity [x, y, z] before the impact; in the answer, after it"},
    {"R, m", "radius and mass; m2 and R2 are for ball 2 if it differs"},
    {"mu_s, mu_b, e_b, ...", "as in [balls] of a scene file; mu_s1 and mu_s2 are mu_s under each ball"},
    {"model", "a cushion model, as in [physics] of a scene file"},
    {"normal", "horizontal, from the cushion into the table, [x, y] of length 1"},
    {"offset", "from the nose line to the ball's centre, [along the normal, up]"},
    {"height", "height of the nose above the cloth"},
    {"id", "any value; the answer repeats it"},
    {"steps, ns", "kernel steps, and kernel time in nanoseconds"},
    {"error", "the mistake in a line, in place of an answer"}};

std::vector<std::string> words_of(std::string text) {
    std::istringstream in(std::move(text));
    return {std::istream_iterator<std::string>(in), {}};
}

/// Rejects unknown keys: a misspelt key would silently change the result.
void refuse_unknown(const Json& object, const std::string& known) {
    const std::vector<std::string> names = words_of(known);
    for (const auto& item : object.items())
        if (std::find(names.begin(), names.end(), item.key()) == names.end())
            throw LineError(fmt::format("unknown key \"{}\"", item.key().substr(0, 40)));
}

void refuse_unknown(const Json& line, const Json& params, const LineKind& kind) {
    const bool may_fly = kind.airborne || kind.kind != std::string_view(kCloth.kind);
    refuse_unknown(line, fmt::format("kind id params {} {}", may_fly ? "airborne" : "", kind.keys));
    refuse_unknown(params, fmt::format("{} {}", kind.params, kind.optional));
}

double number(const Json& json, const char* key) {
    if (!json.is_number()) throw LineError(fmt::format("\"{}\": expected a number", key));
    return json.get<double>();
}

template <int kSize>
void read_vector(const Json& line, const char* key, double (&out)[kSize]) {
    const Json& json = need(line, key);
    if (!json.is_array() || json.size() != kSize) {
        throw LineError(fmt::format("\"{}\": expected a list of {} numbers", key, kSize));
    }
    for (int i = 0; i < kSize; ++i) out[i] = number(json[i], key);
}

/// A parameter within [least, most], without its ends if `open`.
double parameter(const Json& params, const char* key, double least, double most, bool open = false) {
    const double value = number(need(params, key), key);
    const bool inside = open ? value > least && value < most : value >= least && value <= most;
    if (!(inside && std::isfinite(value))) {
        const std::string range = std::isinf(most)
                                      ? fmt::format("{} {}", open ? "greater than" : "at least", least)
                                      : fmt::format("{} {} to {}", open ? "inside" : "from", least, most);
        throw LineError(fmt::format("\"{}\": expected a number {}", key, range));
    }
    return value;
}

/// @throws LineError if a number of the input is beyond what doubles can compute with (R = 1e-321 m)
Json list(const double (&v)[3]) {
    for (const double x : v) {
        if (!std::isfinite(x))
            throw LineError("the result is not finite: a number in the line is too large or too small");
    }
    return Json::array({v[0], v[1], v[2]});
}

double nanoseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

const Json& params_of(const Json& line) {
    const Json& params = need(line, "params");
    if (!params.is_object()) throw LineError("\"params\": expected an object");
    return params;
}

/// Whether the line is an impact of balls in the air.
bool is_airborne(const Json& line) {
    const auto it = line.find("airborne");
    if (it == line.end()) return false;
    if (!it->is_boolean()) throw LineError("\"airborne\": expected true or false");
    return it->get<bool>();
}

Vec3 vector_of(const Json& line, const char* key) {
    double x[3];
    read_vector(line, key, x);
    return {x[0], x[1], x[2]};
}

Json list(const Vec3& v) {
    return list({v.x(), v.y(), v.z()});
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Two balls, of which one or both fly: one free impact, in closed form.
Json free_balls(const Json& line) {
    const Json& params = params_of(line);
    refuse_unknown(line, params, kBallBallInAir);
    FreePair pair{};
    pair.size1 = {parameter(params, "R1", 0.0, kUnbounded, true),
                  parameter(params, "m1", 0.0, kUnbounded, true)};
    pair.size2 = {parameter(params, "R2", 0.0, kUnbounded, true),
                  parameter(params, "m2", 0.0, kUnbounded, true)};
    pair.friction.at_rest = parameter(params, "mu_b", 0.0, kUnbounded);
    pair.e_b = parameter(params, "e_b", 0.0, 1.0);
    const Vec3 apart = vector_of(line, "r2") - vector_of(line, "r1");
    Velocities ball1{vector_of(line, "v1"), vector_of(line, "w1")},
        ball2{vector_of(line, "v2"), vector_of(line, "w2")};
    if (!(length3(apart) > 0.0)) throw LineError("the centres of the two balls coincide");
    const auto start = std::chrono::steady_clock::now();
    hit_ball(pair, apart / length3(apart), ball1, ball2);
    const double ns = nanoseconds_since(start);
    return {{"v1", list(ball1.v)}, {"w1", list(ball1.w)}, {"v2", list(ball2.v)},
            {"w2", list(ball2.w)}, {"steps", 1},          {"ns", ns}};
}

/// A ball landing on the cloth.
Json cloth(const Json& line) {
    const Json& params = params_of(line);
    refuse_unknown(line, params, kCloth);
    BallParams balls{};
    balls.R = parameter(params, "R", 0.0, kUnbounded, true);
    balls.mu_s = parameter(params, "mu_s", 0.0, kUnbounded);
    balls.mu_sp = parameter(params, "mu_sp", 0.0, kUnbounded);
    balls.e_t = parameter(params, "e_t", 0.0, 1.0);
    const MotionParams motion{.R = balls.R,
                              .slide = 0.0,
                              .roll = 0.0,
                              .spin = 0.0,
                              .gravity = parameter(params, "gravity", 0.0, kUnbounded)};
    Velocities ball{vector_of(line, "v"), vector_of(line, "w")};
    if (ball.v.z() < 0.0) hit_cloth(balls, motion, ball);
    return {{"v", list(ball.v)}, {"w", list(ball.w)}};
}

Json ball_ball(const Json& line, const ImpactSettings& settings) {
    if (is_airborne(line)) return free_balls(line);
    const Json& params = params_of(line);
    refuse_unknown(line, params, kBallBall);
    kernel::ImpactParams p{};
    p.R = parameter(params, "R", 0.0, kUnbounded, true);
    p.m = parameter(params, "m", 0.0, kUnbounded, true);
    const auto ratio = [&](const char* key, double one, double largest, const char* of_one) {
        if (!params.contains(key)) return 1.0;
        if (settings.method != ImpactSettings::Method::kMathavan)
            throw LineError(
                fmt::format("\"{}\": only --method mathavan solves different balls; leave it out", key));
        const double over = parameter(params, key, 0.0, kUnbounded, true) / one;
        if (!(over <= largest && over >= 1.0 / largest))
            throw LineError(
                fmt::format("\"{}\": expected at most a factor of {} from {}", key, largest, of_one));
        return over;
    };
    p.mass_ratio = ratio("m2", p.m, kernel::kLargestMassRatio, "m");
    p.radius_ratio = ratio("R2", p.R, kernel::kLargestRadiusRatio, "R");
    p.mu_s1 = parameter(params, "mu_s1", 0.0, kUnbounded);
    p.mu_s2 = parameter(params, "mu_s2", 0.0, kUnbounded);
    p.mu_b = parameter(params, "mu_b", 0.0, kUnbounded);
    p.e_b = parameter(params, "e_b", 0.0, 1.0);
    p.cloth_slip = settings.cloth_slip;
    kernel::Ball ball1{}, ball2{};
    read_vector(line, "r1", ball1.r);
    read_vector(line, "v1", ball1.v);
    read_vector(line, "w1", ball1.w);
    read_vector(line, "r2", ball2.r);
    read_vector(line, "v2", ball2.v);
    read_vector(line, "w2", ball2.w);

    kernel::ImpactResult result{};
    const auto start = std::chrono::steady_clock::now();
    switch (settings.method) {
        case ImpactSettings::Method::kMathavan:
            if (settings.substeps)
                settings.march(ball1, ball2, p, *settings.substeps, result);
            else
                settings.by_tolerance(ball1, ball2, p, settings.tolerance, result);
            break;
        case ImpactSettings::Method::kInelastic:
            kernel::collide_inelastic(ball1, ball2, p, result);
            break;
        case ImpactSettings::Method::kElastic:
            kernel::collide_elastic(ball1, ball2, p, result);
            break;
    }
    const double ns = nanoseconds_since(start);
    const std::string wrong = kernel::describe(result.status);
    if (!wrong.empty()) throw LineError(wrong);
    return {{"v1", list(result.v1)}, {"w1", list(result.w1)}, {"v2", list(result.v2)},
            {"w2", list(result.w2)}, {"steps", result.steps}, {"ns", ns}};
}

const CushionModelInfo& model_of(const Json& line) {
    const Json& json = need(line, "model");
    if (!json.is_string()) throw LineError("\"model\": expected a string");
    if (const CushionModelInfo* model = cushion_model(json.get_ref<const std::string&>())) return *model;
    std::string known;
    for (const CushionModelInfo* model : all_of(&kHan2005))
        known += (known.empty() ? "" : ", ") + std::string(model->name);
    throw LineError(fmt::format("\"model\": unknown cushion model; expected one of {}", known));
}

Vec2 unit_normal(const Json& line) {
    double n[2];
    read_vector(line, "normal", n);
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1]);
    if (!(std::abs(length - 1.0) <= kUnitSlack)) {
        throw LineError(
            fmt::format("\"normal\": expected a vector of length 1, this one has length {}", length));
    }
    // A vector that is a unit vector up to rounding is used as it is, so that the result has the bits the
    // caller expects.
    if (std::abs(length - 1.0) <= 4.0 * std::numeric_limits<double>::epsilon()) return {n[0], n[1]};
    return {n[0] / length, n[1] / length};
}

/// A ball in the air at a nose. Its centre is D from the nose line horizontally, and q in height.
Json nose_in_air(const Json& line) {
    const CushionModelInfo& model = model_of(line);
    const Json& params = params_of(line);
    refuse_unknown(line, params, kCushionInAir);
    BallParams balls{};
    const double R = parameter(params, "R", 0.0, kUnbounded, true);
    balls.e_c = parameter(params, "e_c", 0.0, 1.0);
    balls.f_c = parameter(params, "f_c", 0.0, kUnbounded);
    const Vec2 normal = unit_normal(line);
    double offset[2];
    read_vector(line, "offset", offset);
    const Vec3 out(offset[0] * normal.x(), offset[0] * normal.y(), offset[1]);
    if (!(length3(out) > 0.0)) throw LineError("\"offset\": the ball's centre is on the nose line");
    Velocities ball{vector_of(line, "v"), vector_of(line, "w")};
    hit_nose(balls, R, model, out / length3(out), 0.0, ball);
    return {{"v", list(ball.v)}, {"w", list(ball.w)}};
}

Json cushion(const Json& line) {
    if (is_airborne(line)) return nose_in_air(line);
    const CushionModelInfo& model = model_of(line);
    const Json& params = params_of(line);
    refuse_unknown(line, params, kCushion);
    CushionContact contact{};
    contact.R = parameter(params, "R", 0.0, kUnbounded, true);
    contact.m = parameter(params, "m", 0.0, kUnbounded, true);
    contact.mu_s = parameter(params, "mu_s", 0.0, kUnbounded);
    contact.e_c = parameter(params, "e_c", 0.0, 1.0);
    contact.f_c = parameter(params, "f_c", 0.0, kUnbounded);
    contact.height = parameter(params, "height", 0.0, 2.0 * contact.R, true);
    if (model.accepts != nullptr && !model.accepts(contact))
        throw LineError(
            "\"params\": with this f_c and mu_s the ball could jam under the nose; lower one of them");
    double v_in[3], w_in[3];
    read_vector(line, "v", v_in);
    read_vector(line, "w", w_in);
    Vec3 v(v_in[0], v_in[1], v_in[2]), w(w_in[0], w_in[1], w_in[2]);
    model.resolve(contact, unit_normal(line), v, w);
    if (!(v.allFinite() && w.allFinite())) throw LineError("the result is too large");
    return {{"v", {v.x(), v.y(), v.z()}}, {"w", {w.x(), w.y(), w.z()}}};
}

Json parse(std::string_view line) {
    const Json::parser_callback_t depth_limit = [](int depth, Json::parse_event_t, Json&) {
        if (depth > kDeepest) throw LineError(fmt::format("more than {} levels of nesting", kDeepest));
        return true;
    };
    try {
        return Json::parse(line, depth_limit);
    } catch (const Json::parse_error& error) {
        throw LineError(fmt::format("not valid JSON (at byte {})", error.byte));
    } catch (const Json::out_of_range&) {
        throw LineError("a number is too large");
    }
}

Json compute(std::string_view text, const ImpactSettings& settings) {
    const Json line = parse(text);
    if (!line.is_object()) throw LineError("expected a JSON object");
    const Json& kind = need(line, "kind");
    Json result;
    if (kind == "ball_ball")
        result = ball_ball(line, settings);
    else if (kind == "cushion")
        result = cushion(line);
    else if (kind == "cloth")
        result = cloth(line);
    else
        throw LineError("\"kind\": expected \"ball_ball\", \"cushion\" or \"cloth\"");
    if (line.contains("id")) result["id"] = line["id"];
    return result;
}

}  // namespace

std::string impact_keys() {
    std::string text = "Each line is a JSON object; the answers have the same order. Units are SI.";
    for (const LineKind& kind : {kBallBall, kBallBallInAir, kCushion, kCushionInAir, kCloth}) {
        std::string params = kind.params;
        if (*kind.optional != '\0') params += fmt::format(", optional {}", kind.optional);
        text += fmt::format("\n  \"kind\": \"{}\"{} ({}): {}; \"params\": {}; answer: {}", kind.kind,
                            kind.airborne ? ", \"airborne\": true" : "", kind.meaning, kind.keys, params,
                            kind.answer);
    }
    for (const auto& [keys, meaning] : kMeanings) text += fmt::format("\n  {}: {}", keys, meaning);
    return text;
}

ImpactAnswer impact_error(const std::string& what) {
    const Json json = {{"error", what}};
    return {json.dump(-1, ' ', false, Json::error_handler_t::replace), false};
}

ImpactAnswer answer_impact(std::string_view line, const ImpactSettings& settings) {
    try {
        return {compute(line, settings).dump(-1, ' ', false, Json::error_handler_t::replace), true};
    } catch (const std::exception& error) {
        return impact_error(error.what());
    }
}

}  // namespace carom::tools
