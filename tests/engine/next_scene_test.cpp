// The scene of the next shot: lost balls are removed, and the others lie where they stopped, bit for bit.
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/next_scene.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

Record played(const Scene& scene, std::optional<double> until = std::nullopt) {
    SimulateOptions options;
    options.until = until;
    return simulate(plan_of(scene), options);
}

Cue strike(const std::string& ball, double speed, double aim_deg) {
    Cue cue;
    cue.ball = ball;
    cue.speed = speed;
    cue.aim_deg = aim_deg;
    return cue;
}

/// Plays `shots` shots in a row; each scene has the remaining balls of the previous one, bit for bit.
TEST(NextScene, KeepsRestingBallsBitForBitOverManyShots) {
    Scene scene = read_scene(CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml");
    std::size_t gone = 0;
    int shot = 0;
    for (; shot < 40; ++shot) {
        const Record record = played(scene);
        std::vector<BallStart> rest;
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const BallState end = record.state_at(static_cast<int>(i), record.duration);
            gone += is_gone(end.state) ? 1 : 0;
            if (is_gone(end.state)) continue;
            rest.push_back({.id = record.tracks[i].id, .position = end.position, .where = {}});
            EXPECT_TRUE(end.velocity.isZero(0.0) && end.spin.isZero(0.0));
        }
        if (rest.size() < 2) break;
        // Every third cue is raised, so that some balls fly.
        Cue cue = strike(rest[0].id, 4.0 + 0.1 * shot, 37.0 * shot);
        if (shot % 3 == 0) cue.elevation_deg = 12.0;
        const Scene next = next_scene(scene, record, cue);
        EXPECT_EQ(next.ball, rest);
        EXPECT_EQ(next.cue, cue);
        EXPECT_EQ(next.table, scene.table);
        EXPECT_EQ(next.balls, scene.balls);
        EXPECT_EQ(next.physics, scene.physics);
        // Written to a file, it is the same scene and the same shot.
        EXPECT_EQ(played(next).hash(), played(parse_scene(scene_text(next), "next")).hash());
        scene = next;
    }
    EXPECT_GT(gone, 3u);
    EXPECT_GE(shot, 10);
}

TEST(NextScene, ABallThatLeftTheTableIsGone) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    add_ball(scene, "b", 0.4, 0.5);
    add_ball(scene, "a", 0.635, 2.3);
    scene.ball.back().height = 0.02;
    scene.ball.back().position.z() += 0.02;
    scene.ball.back().velocity = {0.0, 4.0, 1.5};
    const Record record = played(scene);
    ASSERT_EQ(record.state_at(1, record.duration).state, MotionState::kOut);
    const Scene next = next_scene(scene, record, strike("b", 2.0, 90.0));
    ASSERT_EQ(next.ball.size(), 1u);
    EXPECT_EQ(next.ball[0], scene.ball[0]);
    EXPECT_THROW(next_scene(scene, record, strike("a", 2.0, 90.0)), SceneError);
}

TEST(NextScene, IsRefusedIfTheBallMovesOrIsMissing) {
    const Scene scene = read_scene(CAROM_SOURCE_DIR "/scenes/side_bank.toml");
    const Record half = played(scene, 0.1);
    EXPECT_THROW(next_scene(scene, half, strike("cue", 2.0, 90.0)), SceneError);
    EXPECT_THROW(next_scene(scene, half, strike("nobody", 2.0, 90.0)), SceneError);
    EXPECT_THROW(next_scene(scene, half, strike("cue", -1.0, 90.0)), SceneError);
}

}  // namespace
}  // namespace carom::test
