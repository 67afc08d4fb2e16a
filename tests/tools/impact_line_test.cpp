// carom impact, line by line: correct lines have correct results, all others an error and no crash.
#include "commands/impact/impact_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "carom/engine/cushion.h"
#include "reference/random_impacts.h"

namespace carom::tools {
namespace {

using Json = nlohmann::json;

ImpactSettings settings(ImpactSettings::Method method = ImpactSettings::Method::kMathavan) {
    ImpactSettings s;
    s.method = method;
    s.substeps = 1000;
    s.march = kernel::march_function(kernel::Isa::kScalar);
    s.by_tolerance = kernel::tolerance_function(kernel::Isa::kScalar);
    return s;
}

Json ball_ball_line() {
    return {{"kind", "ball_ball"},
            {"params",
             {{"R", 0.028575}, {"m", 0.17}, {"mu_s1", 0.2}, {"mu_s2", 0.2}, {"mu_b", 0.05}, {"e_b", 0.95}}},
            {"r1", {0.0, 0.0, 0.028575}},
            {"v1", {1, 0.25, 0}},
            {"w1", {0.0, 3.0, 4.0}},
            {"r2", {0.05715, 0.0, 0.028575}},
            {"v2", {0.0, 0.0, 0.0}},
            {"w2", {0.0, 0.0, 0.0}}};
}

Json cushion_line() {
    return {{"kind", "cushion"},
            {"model", "han_2005"},
            {"params",
             {{"R", 0.028575}, {"m", 0.17}, {"mu_s", 0.2}, {"e_c", 0.85}, {"f_c", 0.2}, {"height", 0.0365}}},
            {"normal", {-1.0, 0.0}},
            {"v", {1.0, 0.5, 0.0}},
            {"w", {0.0, 2.0, 3.0}}};
}

TEST(ImpactLine, UnequalMasses) {
    ImpactSettings by_tolerance = settings();
    by_tolerance.substeps.reset();
    by_tolerance.tolerance = 1e-9;
    Json line = ball_ball_line();
    line["params"]["m2"] = 0.34;
    const ImpactAnswer answer = answer_impact(line.dump(), by_tolerance);
    ASSERT_TRUE(answer.ok) << answer.json;
    const Json out = Json::parse(answer.json);
    // Along the line of centres the cloth matters little: (m1 - e m2)/(m1 + m2) of the approach speed
    // remains.
    EXPECT_NEAR(out["v1"][0].get<double>(), (1.0 - 2.0 * 0.95) / 3.0, 5e-3);
    EXPECT_NEAR(out["v2"][0].get<double>(), 1.95 / 3.0, 5e-3);
    const auto error_of = [](const Json& wrong, const ImpactSettings& with) {
        const ImpactAnswer refused = answer_impact(wrong.dump(), with);
        EXPECT_FALSE(refused.ok);
        return Json::parse(refused.json)["error"].get<std::string>();
    };
    const ImpactAnswer marched = answer_impact(line.dump(), settings());
    ASSERT_TRUE(marched.ok) << marched.json;
    EXPECT_NEAR(Json::parse(marched.json)["v2"][0].get<double>(), out["v2"][0].get<double>(), 2e-3);
    EXPECT_EQ(error_of(line, settings(ImpactSettings::Method::kInelastic)),
              "\"m2\": only --method mathavan solves different balls; leave it out");
    // A larger ball 2 is higher, and presses the small one onto the cloth.
    line["params"]["R2"] = 0.03;
    line["r2"] = {2.0 * std::sqrt(0.028575 * 0.03), 0.0, 0.03};
    const ImpactAnswer tilted = answer_impact(line.dump(), by_tolerance);
    ASSERT_TRUE(tilted.ok) << tilted.json;
    EXPECT_NEAR(Json::parse(tilted.json)["v2"][0].get<double>(), 1.95 / 3.0, 2e-2);
    line["params"]["R2"] = 0.115;
    EXPECT_EQ(error_of(line, by_tolerance), "\"R2\": expected at most a factor of 4 from R");
    line["params"].erase("R2");
    line["params"]["m2"] = 1.71e5;
    EXPECT_EQ(error_of(line, by_tolerance), "\"m2\": expected at most a factor of 1000000 from m");
}

TEST(ImpactLine, BallBallMatchesTheKernel) {
    const ImpactAnswer answer = answer_impact(ball_ball_line().dump(), settings());
    ASSERT_TRUE(answer.ok) << answer.json;
    const Json out = Json::parse(answer.json);
    kernel::Ball ball1{{0.0, 0.0, 0.028575}, {1.0, 0.25, 0.0}, {0.0, 3.0, 4.0}};
    kernel::Ball ball2{{0.05715, 0.0, 0.028575}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    kernel::ImpactParams p{0.028575, 0.17, 0.2, 0.2, 0.05, 0.95};
    kernel::ImpactResult expected{};
    kernel::march_function(kernel::Isa::kScalar)(ball1, ball2, p, 1000, expected);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(out["v1"][i].get<double>(), expected.v1[i]);
        EXPECT_EQ(out["w1"][i].get<double>(), expected.w1[i]);
        EXPECT_EQ(out["v2"][i].get<double>(), expected.v2[i]);
        EXPECT_EQ(out["w2"][i].get<double>(), expected.w2[i]);
    }
    EXPECT_EQ(out["steps"], expected.steps);
    EXPECT_GT(out["ns"].get<double>(), 0.0);
    EXPECT_EQ(out.size(), 6u);
}

TEST(ImpactLine, ByToleranceUnlessSubstepsAreGiven) {
    ImpactSettings by_tolerance = settings();
    by_tolerance.substeps.reset();
    const ImpactAnswer answer = answer_impact(ball_ball_line().dump(), by_tolerance);
    ASSERT_TRUE(answer.ok) << answer.json;
    const Json out = Json::parse(answer.json);
    kernel::Ball ball1{{0.0, 0.0, 0.028575}, {1.0, 0.25, 0.0}, {0.0, 3.0, 4.0}};
    kernel::Ball ball2{{0.05715, 0.0, 0.028575}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    kernel::ImpactResult expected{};
    kernel::tolerance_function(kernel::Isa::kScalar)(ball1, ball2, {0.028575, 0.17, 0.2, 0.2, 0.05, 0.95},
                                                     1e-6, expected);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(out["v1"][i].get<double>(), expected.v1[i]);
        EXPECT_EQ(out["w2"][i].get<double>(), expected.w2[i]);
    }
    EXPECT_LT(out["steps"].get<long>(), 100);
}

TEST(ImpactLine, ElasticExchangesTheNormalVelocities) {
    const Json out =
        Json::parse(answer_impact(ball_ball_line().dump(), settings(ImpactSettings::Method::kElastic)).json);
    EXPECT_EQ(out["v1"], (Json{0.0, 0.25, 0.0}));
    EXPECT_EQ(out["v2"], (Json{1.0, 0.0, 0.0}));
    EXPECT_EQ(out["w1"], (Json{0.0, 3.0, 4.0}));
}

TEST(ImpactLine, InelasticLosesEnergyByTheRestitution) {
    Json line = ball_ball_line();
    line["params"]["mu_b"] = 0.0;
    const Json out =
        Json::parse(answer_impact(line.dump(), settings(ImpactSettings::Method::kInelastic)).json);
    EXPECT_NEAR(out["v2"][0].get<double>(), 0.5 * (1.0 + 0.95), 1e-15);
    EXPECT_EQ(out["v1"][1], 0.25);
}

TEST(ImpactLine, CushionMatchesTheEngine) {
    const ImpactAnswer answer = answer_impact(cushion_line().dump(), settings());
    ASSERT_TRUE(answer.ok) << answer.json;
    Vec3 v(1.0, 0.5, 0.0), w(0.0, 2.0, 3.0);
    kHan2005.resolve({0.028575, 0.17, 0.2, 0.85, 0.2, 0.0365}, Vec2(-1.0, 0.0), v, w);
    const Json out = Json::parse(answer.json);
    ASSERT_EQ(out.size(), 2u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(out["v"][i].get<double>(), v[i]);
        EXPECT_EQ(out["w"][i].get<double>(), w[i]);
    }
    EXPECT_LT(v.x(), 0.0);
}

TEST(ImpactLine, EveryModelOfTheEngineIsAvailable) {
    Json line = cushion_line();
    line["model"] = "";
    std::string known;
    for (const CushionModelInfo* info : all_of(&kHan2005)) {
        known += (known.empty() ? "" : ", ") + std::string(info->name);
        Json of_model = cushion_line();
        of_model["model"] = info->name;
        EXPECT_TRUE(answer_impact(of_model.dump(), settings()).ok) << info->name;
    }
    const std::string error = Json::parse(answer_impact(line.dump(), settings()).json)["error"];
    EXPECT_EQ(error.substr(error.find(" han") + 1), known);
}

Json answer_of(const Json& line) {
    const ImpactAnswer answer = answer_impact(line.dump(), settings());
    EXPECT_TRUE(answer.ok) << answer.json;
    return Json::parse(answer.json);
}

void expect_list(const Json& got, std::initializer_list<double> want) {
    std::size_t k = 0;
    for (const double x : want) EXPECT_NEAR(got.at(k++).get<double>(), x, 1e-13 * std::max(1.0, std::abs(x)));
}

// The reference values of landings, airborne balls and a nose above the cloth
// (tests/engine/airborne_laws_test.cpp).
TEST(ImpactLine, Cloth) {
    const Json line = {
        {"kind", "cloth"},
        {"params", {{"R", 0.028575}, {"mu_s", 0.2}, {"mu_sp", 0.0127}, {"e_t", 0.5}, {"gravity", 9.81}}},
        {"v", {1.2, -0.7, -3.0}},
        {"w", {20.0, -35.0, 5.0}}};
    const Json out = answer_of(line);
    expect_list(out["v"], {0.571392857142857, -0.663285714285714, 1.5});
    expect_list(out["w"], {23.212098487689, 19.9962504686914, 5.0 - 5.0});
    Json up = line;
    up["v"] = {1.0, 0.0, 0.5};
    expect_list(answer_of(up)["v"], {1.0, 0.0, 0.5});
}

TEST(ImpactLine, BallsInTheAir) {
    const Json line = {
        {"kind", "ball_ball"},
        {"airborne", true},
        {"params",
         {{"R1", 0.028575}, {"R2", 0.028575}, {"m1", 0.17}, {"m2", 0.17}, {"mu_b", 0.05}, {"e_b", 0.95}}},
        {"r1", {0.0, 0.0, 0.028575}},
        {"v1", {2.0, 0.0, 0.0}},
        {"w1", {0.0, 2.0 / 0.028575, 0.0}},
        {"r2", {0.05715, 0.0, 0.028575}},
        {"v2", {0.0, 0.0, 0.0}},
        {"w2", {0.0, 0.0, 0.0}}};
    const Json out = answer_of(line);
    expect_list(out["v1"], {0.05, 0.0, 0.0975});
    expect_list(out["v2"], {1.95, 0.0, -0.0975});
}

TEST(ImpactLine, ANoseInTheAir) {
    const double R = 0.028575, rho = R * std::sqrt(1.0 + 0.28 * 0.28), q = 0.5 * R;
    const Json line = {{"kind", "cushion"},     {"airborne", true},
                       {"model", "han_2005"},   {"params", {{"R", R}, {"e_c", 0.85}, {"f_c", 0.2}}},
                       {"normal", {-1.0, 0.0}}, {"offset", {std::sqrt(rho * rho - q * q), q}},
                       {"v", {2.0, 0.3, 0.4}},  {"w", {5.0, 30.0, -12.0}}};
    const Json out = answer_of(line);
    expect_list(out["v"], {-0.592740417914752, 0.280498574654794, 1.67557743697222});
    expect_list(out["w"], {4.17851395710517, 41.4059844837882, -13.4953753931198});
}

TEST(ImpactLine, BallsThatDoNotApproachAreUnchanged) {
    Json line = ball_ball_line();
    line["v1"] = {-1.0, 0.0, 0.0};
    const ImpactAnswer answer = answer_impact(line.dump(), settings());
    ASSERT_TRUE(answer.ok) << answer.json;
    EXPECT_EQ(Json::parse(answer.json)["v1"], line["v1"]);
    EXPECT_EQ(Json::parse(answer.json)["steps"], 0);
}

TEST(ImpactLine, ReturnsTheId) {
    Json line = cushion_line();
    line["id"] = {"any", 1};
    EXPECT_EQ(Json::parse(answer_impact(line.dump(), settings()).json)["id"], line["id"]);
}

/// The error of a line, or "no error".
std::string error_of(const std::string& line) {
    const ImpactAnswer answer = answer_impact(line, settings());
    const Json json = Json::parse(answer.json);
    if (answer.ok) return "no error";
    EXPECT_EQ(json.size(), 1u);
    EXPECT_EQ(answer.json.find('\n'), std::string::npos);
    return json["error"];
}

Json changed_json(Json line, const std::string& pointer, const Json& value) {
    line[Json::json_pointer(pointer)] = value;
    return line;
}

std::string changed(const Json& line, const std::string& pointer, const Json& value) {
    return changed_json(line, pointer, value).dump();
}

// Four digits suffice for a unit vector, which is then normalised.
TEST(ImpactLine, ANormalMayBeRounded) {
    const Json line = cushion_line();
    const Json exact = Json::parse(answer_impact(changed(line, "/normal", {-0.6, 0.8}), settings()).json);
    const Json rounded =
        Json::parse(answer_impact(changed(line, "/normal", {-0.6 * 1.0005, 0.8 * 1.0005}), settings()).json);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(rounded["v"][i].get<double>(), exact["v"][i].get<double>(), 1e-15);
}

// The row of each kind lists all keys of a line, its params and its result.
TEST(ImpactLine, TheHelpListsTheKeys) {
    const std::string help = impact_keys();
    for (const Json& line : {ball_ball_line(), cushion_line()}) {
        const std::string kind = "\n  \"kind\": " + line["kind"].dump() + " (";
        const std::size_t from = help.find(kind);
        ASSERT_NE(from, help.npos) << kind;
        std::string row = help.substr(from + kind.size(), help.find('\n', from + 1) - from - kind.size());
        std::replace_if(
            row.begin(), row.end(), [](char c) { return c == ';' || c == ','; }, ' ');
        Json keys = Json::parse(answer_impact(line.dump(), settings()).json);
        keys.update(line);
        keys.update(line["params"]);
        keys.erase("kind");
        keys.erase("params");
        for (const auto& item : keys.items())
            EXPECT_NE((row + " ").find(" " + item.key() + " "), row.npos) << item.key() << " in " << row;
    }
}

TEST(ImpactLine, ExplainsErrors) {
    EXPECT_EQ(error_of(""), "not valid JSON (at byte 1)");
    EXPECT_EQ(error_of("[1, 2]"), "expected a JSON object");
    EXPECT_EQ(error_of("{}"), "the key \"kind\" is missing");
    EXPECT_EQ(error_of("{\"kind\": 3}"), "\"kind\": expected \"ball_ball\", \"cushion\" or \"cloth\"");
    const Json line = ball_ball_line();
    EXPECT_EQ(error_of(changed(line, "/params", 1)), "\"params\": expected an object");
    EXPECT_EQ(error_of(changed(line, "/params/R", 0)), "\"R\": expected a number greater than 0");
    EXPECT_EQ(error_of(changed(line, "/params/R", true)), "\"R\": expected a number");
    EXPECT_EQ(error_of(changed(line, "/params/mu_b", -0.1)), "\"mu_b\": expected a number at least 0");
    EXPECT_EQ(error_of(changed(line, "/params/e_b", 1.5)), "\"e_b\": expected a number from 0 to 1");
    EXPECT_EQ(error_of(changed(line, "/params/e_n", 1)), "unknown key \"e_n\"");
    EXPECT_EQ(error_of(changed(line, "/v1", {1, 2})), "\"v1\": expected a list of 3 numbers");
    EXPECT_EQ(error_of(changed(line, "/v1/2", nullptr)), "\"v1\": expected a number");
    EXPECT_EQ(error_of(changed(line, "/tolerance", 1)), "unknown key \"tolerance\"");
    EXPECT_EQ(error_of(changed(line, "/r2", line["r1"])), kernel::describe(kernel::ImpactStatus::kBadState));
    const Json cushion = cushion_line();
    std::string models;
    for (const CushionModelInfo* model : all_of(&kHan2005))
        models += (models.empty() ? "" : ", ") + std::string(model->name);
    EXPECT_EQ(error_of(changed(cushion, "/model", "rubber")),
              "\"model\": unknown cushion model; expected one of " + models);
    EXPECT_EQ(error_of(changed(cushion, "/normal", {2, 0})),
              "\"normal\": expected a vector of length 1, this one has length 2");
    EXPECT_EQ(error_of(changed(cushion, "/normal", {0, 0, 1})), "\"normal\": expected a list of 2 numbers");
    EXPECT_EQ(error_of(changed(cushion, "/params/height", 1)),
              "\"height\": expected a number inside 0 to 0.05715");
    Json jams = changed_json(cushion, "/model", "mathavan_2010");
    jams["params"]["f_c"] = 20.0;
    EXPECT_EQ(error_of(jams.dump()),
              "\"params\": with this f_c and mu_s the ball could jam under the nose; lower one of them");
    Json stuck = line;
    stuck["params"].update({{"mu_s1", 0.6}, {"mu_s2", 0.6}, {"mu_b", 4.0}});
    stuck.update({{"v1", {1, 0, 0}}, {"w1", {0, 1e6, 0}}});
    EXPECT_EQ(error_of(stuck.dump()), "the integration reached its limit of steps");
    for (const Json& whole : {line, cushion}) {
        for (const auto& item : whole.items()) {
            Json less = whole;
            less.erase(item.key());
            EXPECT_EQ(error_of(less.dump()), "the key \"" + item.key() + "\" is missing");
        }
        for (const auto& item : whole["params"].items()) {
            Json less = whole;
            less["params"].erase(item.key());
            EXPECT_EQ(error_of(less.dump()), "the key \"" + item.key() + "\" is missing");
        }
    }
}

TEST(ImpactLine, HostileLinesAreErrors) {
    const std::string whole = ball_ball_line().dump();
    EXPECT_EQ(error_of(std::string(500000, '[')), "more than 8 levels of nesting");
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "{\"a\":";
    EXPECT_EQ(error_of(deep), "more than 8 levels of nesting");
    EXPECT_NE(error_of("NaN").find("not valid JSON"), std::string::npos);
    EXPECT_NE(error_of("{\"kind\":\"\xff\xfe\"}").find("not valid JSON"), std::string::npos);
    EXPECT_NE(error_of(std::string("{\"kind\":\0\"x\"}", 13)).find("not valid JSON"), std::string::npos);
    EXPECT_EQ(error_of("{\"kind\":1e999}"), "a number is too large");
    std::string nan = whole;
    nan.replace(nan.find("0.95"), 4, "NaN");
    EXPECT_NE(error_of(nan).find("not valid JSON"), std::string::npos);
    EXPECT_NE(error_of(whole + whole).find("not valid JSON"), std::string::npos);
    // Finite, but its square is not: the result is an error or finite, never NaN.
    const std::string huge = changed(ball_ball_line(), "/v1/0", 1e300);
    const ImpactAnswer answer = answer_impact(huge, settings());
    EXPECT_EQ(answer.json.find("null"), std::string::npos) << answer.json;
}

TEST(ImpactLine, AnyChangedLineIsAnsweredInOneLine) {
    reference::Generator rng(21);
    const std::string wholes[] = {ball_ball_line().dump(), cushion_line().dump()};
    int refused = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string line = wholes[rng.next() % 2];
        for (std::uint64_t n = rng.next() % 3; n-- > 0;) {
            const std::size_t at = rng.next() % line.size(), length = 1 + rng.next() % 8;
            line.erase(at, length);
        }
        const std::size_t at = rng.next() % line.size();
        line[at] = static_cast<char>(rng.next());
        const ImpactAnswer answer = answer_impact(line, settings());
        const Json json = Json::parse(answer.json);  // throws if it is not JSON
        ASSERT_TRUE(json.is_object());
        ASSERT_EQ(answer.json.find('\n'), std::string::npos);
        ASSERT_EQ(answer.ok, !json.contains("error"));
        if (!answer.ok) ++refused;
    }
    EXPECT_GT(refused, 2500);
}

}  // namespace
}  // namespace carom::tools
