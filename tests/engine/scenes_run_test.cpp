// Every scene of the repository, and seeded breaks, run to rest under the checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

std::vector<std::string> scene_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(CAROM_SOURCE_DIR) + "/scenes"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(ShippedScenes, RunToRestUnderTheChecker) {
    ASSERT_GE(scene_files().size(), 8u);
    for (const std::string& file : scene_files()) {
        SCOPED_TRACE(file);
        Scene scene = read_scene(file);
        scene.stop = {};
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
        EXPECT_FALSE(record.events.empty());
    }
}

TEST(ShippedScenes, SameBitsOnEveryInstructionSetAndEveryRun) {
    for (const std::string& file : scene_files()) {
        SCOPED_TRACE(file);
        const Scene scene = read_scene(file);
        const std::string hash = simulate(make_plan(scene, kernel::Isa::kScalar)).hash();
        for (const kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4}) {
            if (!kernel::available(isa)) continue;
            EXPECT_EQ(simulate(make_plan(scene, isa)).hash(), hash) << kernel::name(isa);
        }
        SimulateOptions profiled;
        profiled.profile = true;
        const Record record = simulate(make_plan(scene, kernel::best_isa()), profiled);
        EXPECT_EQ(record.hash(), hash);
        EXPECT_EQ(record.costs.size(), record.events.size());
    }
}

// Breaks of random speed, line and gap: none reaches the event limit or breaks a law.
TEST(ShippedScenes, SeededBreaks) {
    reference::Generator rng(20261121);
    std::size_t most = 0;
    for (int i = 0; i < 100; ++i) {
        const double gaps[] = {0.0, 1e-12, 1e-6, 1e-4};
        const double gap = gaps[i % 4], speed = rng.uniform(5.0, 12.0), x = 0.635 + rng.uniform(-0.01, 0.01);
        const std::string text = "[rack]\ngame = \"eight_ball\"\ngap = " + std::to_string(gap) +
                                 "\nseed = " + std::to_string(i) + "\n[[ball]]\nid = \"cue\"\nposition = [" +
                                 std::to_string(x) + ", 0.5]\nvelocity = [0, " + std::to_string(speed) +
                                 "]\n";
        SCOPED_TRACE(text);
        const Record record = run_verified(parse_scene(text, "break.toml"));
        most = std::max(most, record.events.size());
    }
    EXPECT_LE(most, 400u);
}

}  // namespace
}  // namespace carom
