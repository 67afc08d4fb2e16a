// Golden hashes of eleven scenes: every bit of events and segments, on every compiler, build type and
// instruction set. Constants: tests/data/engine/golden_hashes.json. After a change that is meant to change
// bits (say which and why in CHANGELOG.md), renew them, without the test runner's lines:
//   CAROM_GOLDEN_PRINT=1 build/release/tests/engine/engine_test --gtest_filter='Golden.*'
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "scene/rack.h"
#include "support/hard_scenes.h"
#include "support/scenes.h"

namespace carom {
namespace {

using namespace test;

Scene chaotic_break(ClusterModel clusters) {
    Scene scene = empty_scene();
    scene.table = make_table("seven_foot");
    scene.physics.clusters = clusters;
    for (const RackedBall& b : make_rack(Rack{}, scene.table, scene.balls.R))
        add_ball(scene, b.id, b.position.x(), b.position.y());
    add_ball(scene, "cue", 0.5, 0.5, 0.0, 9.0, Vec3(-40.0, 0.0, 25.0));
    return scene;
}

std::vector<std::pair<std::string, Scene>> golden_scenes() {
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const char* file : {"draw", "eight_ball_break", "follow", "half_ball_throw", "hello",
                             "nine_ball_break", "snooker_break", "stop", "three_cushion"})
        scenes.emplace_back(file, shipped(file));
    scenes.emplace_back("chaotic break, compliant", chaotic_break(ClusterModel::kCompliant));
    scenes.emplace_back("chaotic break, sequential", chaotic_break(ClusterModel::kSequential));
    return scenes;
}

TEST(Golden, ElevenScenes) {
    if (std::getenv("CAROM_GOLDEN_PRINT") != nullptr) {
        nlohmann::ordered_json all;
        for (const auto& [label, scene] : golden_scenes()) all[label] = simulate(plan_of(scene)).hash();
        std::printf("%s\n", all.dump(1).c_str());
        GTEST_SKIP() << "printed, and nothing compared; run again without CAROM_GOLDEN_PRINT";
    }
    const auto golden = read_json("golden_hashes.json");
    const auto scenes = golden_scenes();
    ASSERT_EQ(golden.size(), scenes.size());
    for (const auto& [label, scene] : scenes) {
        for (const kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4}) {
            if (!kernel::available(isa)) continue;
            const Record record = simulate(make_plan(scene, isa));
            EXPECT_EQ(record.hash(), golden.at(label).get<std::string>())
                << label << " " << kernel::name(isa);
        }
    }
}

}  // namespace
}  // namespace carom
