// Whole shots against reference vectors: event lists and final positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

Table table_from(const nlohmann::json& t) {
    Table table;
    table.width = t.at("w").get<double>();
    table.length = t.at("l").get<double>();
    const auto vec2 = [](const nlohmann::json& j) {
        return Vec2(j.at(0).get<double>(), j.at(1).get<double>());
    };
    for (const auto& c : t.at("linear_cushions"))
        table.cushions.push_back({c.at("id").get<std::string>(), vec2(c.at("p1")), vec2(c.at("p2")),
                                  c.at("height").get<double>()});
    for (const auto& c : t.at("circular_cushions"))
        table.jaws.push_back({c.at("id").get<std::string>(), vec2(c.at("center")),
                              c.at("radius").get<double>(), c.at("height").get<double>()});
    for (const auto& c : t.at("pockets"))
        table.pockets.push_back({c.at("id").get<std::string>(), vec2(c.at("center")),
                                 c.at("radius").get<double>(), c.at("depth").get<double>()});
    return table;
}

std::string describe(const Record& record, const Event& e) {
    const auto id = [&](int ball) { return record.tracks[ball].id; };
    return std::string(name(e.type)) + " " + id(e.a) + " " + record.partner_id(e);
}

std::string describe(const nlohmann::json& e) {
    static const std::map<std::string, std::string> names{{"stick_ball", "cue_strike"},
                                                          {"ball_ball", "ball_ball"},
                                                          {"ball_linear_cushion", "ball_cushion"},
                                                          {"ball_circular_cushion", "ball_jaw"},
                                                          {"ball_pocket", "ball_pocket"},
                                                          {"sliding_rolling", "slide_roll"},
                                                          {"rolling_spinning", "roll_spin"},
                                                          {"rolling_stationary", "roll_stop"},
                                                          {"spinning_stationary", "spin_stop"}};
    const std::string type = names.at(e.at("type").get<std::string>());
    std::vector<std::string> agents = e.at("agents").get<std::vector<std::string>>();
    if (type == "cue_strike") return type + " " + agents.back() + " ";
    return type + " " + agents[0] + " " + (agents.size() > 1 ? agents[1] : "");
}

// Swapped, for a pair named in the other order.
std::string swapped(const nlohmann::json& e) {
    nlohmann::json copy = e;
    if (copy.at("agents").size() == 2) std::swap(copy["agents"][0], copy["agents"][1]);
    return describe(copy);
}

TEST(Shots, EventListsAndFinalPositions) {
    const auto data = read_json("shots.json");
    int checked = 0;
    for (const auto& c : data.at("cases")) {
        if (c.at("cushion_model") != "han_2005") continue;
        const std::string label = "shot " + c.at("id").dump();
        Scene scene;
        scene.table = table_from(data.at("tables").at(c.at("table").get<std::string>()));
        scene.balls = balls_from(c.at("params"));
        scene.physics.gravity = c.at("params").at("g").get<double>();
        scene.physics.cloth_slip = kernel::ClothSlip::kAsPublished;
        scene.physics.substeps = 20000;
        scene.physics.clusters = ClusterModel::kSequential;
        scene.physics.pocket = PocketModel::kAtOnce;
        std::vector<std::string> ids;
        for (const auto& [id, state] : c.at("initial").items()) {
            add_ball(scene, id, vec3(state.at("r")), vec3(state.at("v")), vec3(state.at("w")));
            ids.push_back(id);
        }
        if (c.at("cue_strike").get<bool>()) {
            const auto& q = c.at("cue");
            Cue cue;
            cue.ball = "cue";
            use_cue(cue, "lossless");
            cue.speed = q.at("V0").get<double>();
            cue.aim_deg = q.at("phi_deg").get<double>();
            cue.elevation_deg = q.at("theta_deg").get<double>();
            cue.side = q.at("a").get<double>();
            cue.height = q.at("b").get<double>();
            scene.cue = cue;
            scene.physics.vertical = Vertical::kDrop;  // the references are planar
        }
        const Plan plan = plan_of(scene);
        const Record record = simulate(plan);
        const auto violation = verify(record, plan);
        EXPECT_FALSE(violation) << label << " " << violation->law << ": " << violation->message;
        std::vector<nlohmann::json> expected;
        for (const auto& e : c.at("events"))
            if (e.at("type") != "none") expected.push_back(e);
        ASSERT_EQ(record.events.size(), expected.size()) << label;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const std::string got = describe(record, record.events[i]);
            EXPECT_TRUE(got == describe(expected[i]) || got == swapped(expected[i]))
                << label << " event " << i << ": " << got << " for " << describe(expected[i]);
        }
        const double tolerance = std::max(2e-4, 1e-3 * c.at("sensitivity").at("amplification").get<double>());
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Vec3 want = vec3(c.at("final").at(ids[i]).at("r"));
            const Vec3 got = record.state_at(static_cast<int>(i), record.duration).position;
            EXPECT_LT((want - got).norm(), tolerance) << label << " ball " << ids[i];
        }
        ++checked;
    }
    EXPECT_EQ(checked, 8);
}

}  // namespace
}  // namespace carom
