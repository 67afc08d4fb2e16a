// Scenes that once failed, each with the laws that now hold: the rows of tests/data/engine/jams.toml.
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <cstdint>
#include <string>

#include "jams.h"
#include "support/random_scenes.h"
#include "support/scene_scan.h"

namespace carom::test {
namespace {

/// @param asks  a row's demands beyond the laws
void expect_laws(const Scene& scene, const toml::table& asks) {
    const Plan plan = plan_of(scene);
    const Record record = simulate(plan);
    const auto violation = verify(record, plan);
    EXPECT_FALSE(violation) << violation->law << " at event " << violation->event << ": "
                            << violation->message;
    if (asks["at_rest"].value_or(!scene.stop.time && !scene.stop.events)) {
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
    }
    constexpr std::int64_t kAny = INT64_MAX;
    EXPECT_LE(static_cast<std::int64_t>(segments_of(record)), asks["segments"].value_or(kAny));
    EXPECT_LE(static_cast<std::int64_t>(record.events.size()), asks["events"].value_or(kAny));
}

class Jam : public testing::Test {
  public:
    explicit Jam(const toml::table& row) : row_(row) {}

    void TestBody() override {
        if (const auto text = row_["toml"].value<std::string>())
            expect_laws(parse_scene(*text, "(row)"), row_);
        const toml::array* scenes = row_["scenes"].as_array();
        for (std::size_t i = 0; scenes != nullptr && i < scenes->size(); ++i) {
            const toml::table& one = *scenes->get(i)->as_table();
            const auto family = one["family"].value<std::string>().value();
            const auto seed = one["seed"].value<std::int64_t>().value();
            SCOPED_TRACE(family + " " + std::to_string(seed));
            const auto scene = seeded_scene(family, static_cast<std::uint64_t>(seed));
            ASSERT_TRUE(scene) << "there is no such family";
            expect_laws(*scene, one);
        }
        EXPECT_TRUE(scenes != nullptr || row_.contains("toml")) << "a row without a scene";
    }

  private:
    toml::table row_;
};

// A ball is moved by less than a place may differ towards another one, which a cluster left overlapping it.
TEST(OverlapLeftByACluster, MayNotGrow) {
    const Plan plan = plan_of(*seeded_scene("tray/wide", 9000262));
    Record record = simulate(plan);
    const int one = index_of(record.tracks, "b13"), other = index_of(record.tracks, "b14");
    constexpr double kWhile = 0.004, kMoved = 5e-10;  // [s] the overlap lasts, [m]
    const Vec3 apart = record.state_at(one, kWhile).position - record.state_at(other, kWhile).position;
    ASSERT_LT(apart.norm(), 2.0 * record.balls.R - 1e-6);
    for (Segment& s : record.tracks[static_cast<std::size_t>(other)].segments)
        if (s.start > kWhile) s.r += kMoved * apart.normalized();
    const auto violation = verify(record, plan);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, std::string("U3"));
    EXPECT_NE(violation->message.find("balls b13 and b14 overlap by 1.27e-06 m"), std::string::npos)
        << violation->message;
}

}  // namespace

void register_jams() {
    const toml::table table = toml::parse_file(CAROM_TEST_DATA "/engine/jams.toml");
    for (const toml::node& node : *table["row"].as_array()) {
        const toml::table row = *node.as_table();
        const std::string name = row["test"].value<std::string>().value();
        const std::size_t dot = name.find('.');
        testing::RegisterTest(name.substr(0, dot).c_str(), name.substr(dot + 1).c_str(), nullptr, nullptr,
                              __FILE__, __LINE__, [row]() -> testing::Test* { return new Jam(row); });
    }
}

}  // namespace carom::test
