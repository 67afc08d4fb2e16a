// Who touched whom when several balls meet at once: points and fouls that depend on it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

Record played(const std::string& scene) {
    return run_verified(parse_scene(scene, "s.toml"));
}

std::string met(const Record& record) {
    std::string ids;
    for (const games::BallContact& touch : games::shot_of(record).touches)
        if (!touch.cushion() && touch.time < 1.0)
            ids += record.tracks[static_cast<std::size_t>(touch.other)].id + " ";
    return ids;
}

constexpr const char* kCarom =
    "[table]\npreset = \"carom\"\n[balls]\npreset = \"carom\"\n[cue]\nball = \"white\"\n";

// The second ball lies 10 um to 0.3 mm farther along the path than the first.
TEST(WhoHitWhom, TwoBallsAlmostAtOnce) {
    for (const double later : {0.0, 1e-7, 1e-5, 1e-4, 3e-4, 1e-3}) {
        const Record record = played(std::string(kCarom) +
                                     "ball_speed = 1.0\naim_deg = 90\noffset = [0, 0]\n[[ball]]\nid = "
                                     "\"white\"\nposition = [0.6, 0.7]\n"
                                     "[[ball]]\nid = \"red\"\nposition = [0.56915, 0.953260562332743]\n"
                                     "[[ball]]\nid = \"yellow\"\nposition = [0.63085, " +
                                     std::to_string(0.953260562332743 + later) + "]\n");
        EXPECT_EQ(met(record), "red yellow ") << later;
        games::State state = games::new_game(&games::kStraightRail);
        state.opening = false;
        EXPECT_EQ(games::judge(state, record, {}).points, 1) << later;
    }
}

constexpr const char* kFrozen =
    "[table]\npreset = \"nine_foot\"\n[balls]\npreset = \"pool\"\n"
    "[[ball]]\nid = \"cue\"\nposition = [0.6, 1.0]\n[[ball]]\nid = \"9\"\nposition = [0.6, 1.05715]\n"
    "[[ball]]\nid = \"1\"\nposition = [0.5437182369153523, 0.9900760066463349]\n"
    "[[ball]]\nid = \"5\"\nposition = [0.3, 2.0]\n[cue]\nball = \"cue\"\nball_speed = 2.0\noffset = [0, 0]\n";

// The cue ball is frozen to the 1 and the 9, and is played into the 9, away from the 1.
TEST(WhoHitWhom, AFrozenBallThatIsNotPushedIsNotHit) {
    const Record record = played(std::string(kFrozen) + "aim_deg = 50\n");
    EXPECT_EQ(met(record), "9 ");
    games::State state = games::new_game(&games::kNineBall);
    state.opening = false;
    EXPECT_FALSE(games::judge(state, record, {}).fouls.empty());
    EXPECT_EQ(met(played(std::string(kFrozen) + "aim_deg = 130\n")), "1 9 ");
}

TEST(WhoHitWhom, OutcomesAgreeWithRecords) {
    for (const char* aim : {"40", "50", "90", "130", "170"}) {
        const Scene scene = parse_scene(std::string(kFrozen) + "aim_deg = " + aim + "\n", "s.toml");
        const Plan plan = plan_of(scene);
        RunBuffers buffers;
        Outcome outcome;
        simulate(plan, buffers, outcome);
        const games::Shot shot = games::shot_of(simulate(plan));
        EXPECT_EQ(outcome.first_hit, shot.first_hits.empty() ? -1 : shot.first_hits.front()) << aim;
    }
}

}  // namespace
}  // namespace carom::test
