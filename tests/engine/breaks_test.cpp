// The reference break (tests/data/engine/breaks.json): an eight-ball break with pair-by-pair impacts and
// mathavan_2010 cushions. The reference simulator moves balls apart by 1e-6 m at every contact; with 1e-9 m
// its event list changes from event 9 on. Up to there the order is comparable, and times to about 1e-6 s;
// nothing is after that.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "carom/engine/cushion.h"

#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

TEST(BreakEvents, FirstEventsAgreeUntilTheReferenceDiverges) {
    const auto data = read_json("breaks.json");
    int checked = 0;
    for (const auto& c : data.at("cases")) {
        Scene scene = empty_scene();
        const auto& t = data.at("tables").begin().value();
        scene.table.width = t.at("w").get<double>();
        scene.table.length = t.at("l").get<double>();
        const auto vec2 = [](const nlohmann::json& j) {
            return Vec2(j.at(0).get<double>(), j.at(1).get<double>());
        };
        for (const auto& k : t.at("linear_cushions"))
            scene.table.cushions.push_back(
                {k.at("id"), vec2(k.at("p1")), vec2(k.at("p2")), k.at("height").get<double>()});
        for (const auto& k : t.at("circular_cushions"))
            scene.table.jaws.push_back({k.at("id"), vec2(k.at("center")), k.at("radius").get<double>(),
                                        k.at("height").get<double>()});
        for (const auto& k : t.at("pockets"))
            scene.table.pockets.push_back({k.at("id"), vec2(k.at("center")), k.at("radius").get<double>(),
                                           k.at("depth").get<double>()});
        scene.balls = balls_from(c.at("params"));
        scene.physics.cushion = cushion_model("mathavan_2010");
        scene.physics.cloth_slip = kernel::ClothSlip::kAsPublished;
        scene.physics.clusters = ClusterModel::kSequential;
        scene.physics.substeps = 1000;
        scene.stop.time = c.at("final_t").get<double>();
        for (const auto& [id, state] : c.at("initial").items())
            add_ball(scene, id, vec3(state.at("r")), vec3(state.at("v")), vec3(state.at("w")));
        const Record record = simulate(plan_of(scene));
        std::size_t until = c.at("events").size();
        for (const auto& [name, row] : c.at("comparability").items()) {
            if (name.rfind("spacer", 0) != 0 || row.at("first_different_event_index").is_null()) continue;
            until = std::min(until, row.at("first_different_event_index").get<std::size_t>());
        }
        ASSERT_GE(until, 5u);
        for (std::size_t i = 1; i < until; ++i) {  // 0 marks the start
            const auto& want = c.at("events").at(i);
            const Event& got = record.events.at(i - 1);
            ASSERT_EQ(want.at("type"), "ball_ball");
            EXPECT_EQ(got.type, EventType::kBallBall) << "event " << i;
            const std::set<std::string> pair{record.tracks.at(static_cast<std::size_t>(got.a)).id,
                                             record.tracks.at(static_cast<std::size_t>(got.b)).id};
            EXPECT_EQ(pair, want.at("agents").get<std::set<std::string>>()) << "event " << i;
            EXPECT_NEAR(got.time, want.at("t").get<double>(), 1e-6) << "event " << i;
            ++checked;
        }
        // Compare the rest statistically: the same kinds of events, in similar numbers.
        const double share =
            static_cast<double>(record.events.size()) / static_cast<double>(c.at("events").size());
        EXPECT_GT(share, 0.5);
        EXPECT_LT(share, 2.0);
    }
    EXPECT_GE(checked, 8);
}

}  // namespace
}  // namespace carom
