// libcarom.so: rules and noise match the library's.
#include <gtest/gtest.h>
#include <climits>

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "carom/games/noise.h"
#include "owned.h"

namespace carom::test {
namespace {

using VerdictPtr = std::unique_ptr<carom_verdict, void (*)(carom_verdict*)>;

VerdictPtr judged(const carom_game_state& state, const carom_record* record,
                  const carom_call* call = nullptr) {
    carom_verdict* verdict = nullptr;
    EXPECT_EQ(carom_judge(&state, record, call, &verdict), CAROM_OK) << carom_last_error();
    return {verdict, carom_verdict_free};
}

/// The one falls, followed by the cue ball.
const char* const kScratch =
    "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n[[ball]]\nid = \"1\"\nposition = [0.2, 0.2]\n"
    "[[ball]]\nid = \"9\"\nposition = [0.7, 1.0]\n[cue]\nspeed = 4.0\naim_deg = 225.0\noffset = [0.0, 0.4]\n";

carom_game_state nine_ball() {
    carom_game_state state;
    EXPECT_EQ(carom_game_new(CAROM_NINE_BALL, 0, 0, &state), CAROM_OK);
    EXPECT_EQ(state.in_hand, CAROM_HEAD_STRING);
    EXPECT_EQ(state.opening, 1);
    state.opening = 0;
    state.in_hand = CAROM_NOT_IN_HAND;
    return state;
}

TEST(CApiGames, RuleOptionsAreKept) {
    carom_game_state state = nine_ball();
    state.may_push_out = 1;
    EXPECT_EQ(carom_game_rule(&state, "nine_on_break=respot"), CAROM_OK);
    EXPECT_EQ(state.game % 256, CAROM_NINE_BALL);
    EXPECT_EQ(carom_game_rule(&state, "call=all"), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(),
                 "nine_ball has no option \"call\"; it has push_out, three_fouls, nine_on_break");
    const RecordPtr record = played(parsed(kScratch).get());
    carom_option option;
    ASSERT_EQ(carom_verdict_option(judged(state, record.get()).get(), 0, &option), CAROM_OK);
    EXPECT_EQ(option.state.game, state.game);
    EXPECT_EQ(carom_game_rule(&state, "nine_on_break=wins"), CAROM_OK);
    EXPECT_EQ(state.game, CAROM_NINE_BALL);
    state.game = 3 << 8 | CAROM_THREE_CUSHION;
    carom_verdict* none = nullptr;
    EXPECT_EQ(carom_judge(&state, record.get(), nullptr, &none), CAROM_BAD_ARGUMENT);
}

TEST(CApiGames, AdviceIsAStrikeThatPots) {
    carom_game_state state = nine_ball();
    const ScenePtr table = parsed(
        "[[ball]]\nid = \"cue\"\nposition = [0.6, 0.6]\n[[ball]]\nid = \"1\"\nposition = [0.3, 0.3]\n"
        "[[ball]]\nid = \"9\"\nposition = [0.7, 2.0]\n");
    carom_advice* advice = nullptr;
    ASSERT_EQ(carom_advise(&state, table.get(), "club", 1, 2, &advice), CAROM_OK) << carom_last_error();
    ASSERT_GE(carom_advice_count(advice), 1u);
    carom_advised shot;
    ASSERT_EQ(carom_advice_shot(advice, 0, &shot), CAROM_OK);
    EXPECT_STREQ(shot.kind, "pot");
    EXPECT_EQ(std::string(shot.words).substr(0, 7), "1 into ");
    EXPECT_EQ(shot.placed, 0);
    EXPECT_GT(shot.makes[0], 0.8);
    EXPECT_GT(shot.cue.mass, 0.1);
    EXPECT_EQ(carom_advice_shot(advice, 9, &shot), CAROM_BAD_ARGUMENT);
    carom_advice_free(advice);
    EXPECT_EQ(carom_advise(&state, table.get(), "wizard", 1, 2, &advice), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(advice, nullptr);
    EXPECT_STREQ(carom_last_error(),
                 "unknown level \"wizard\"; use beginner, club, league, professional, machine");
    carom_advice_free(nullptr);
}

TEST(CApiGames, AShotIsJudgedAndTheNextOneFollows) {
    const carom_game_state state = nine_ball();
    const char* ids[] = {"cue", "9", "1"};
    std::uint8_t strike[3], first[3], callable[3];
    ASSERT_EQ(carom_legal(&state, 3, ids, strike, first, callable), CAROM_OK);
    EXPECT_EQ(std::vector<int>(strike, strike + 3), (std::vector<int>{1, 0, 0}));
    EXPECT_EQ(std::vector<int>(first, first + 3), (std::vector<int>{0, 0, 1}));
    EXPECT_EQ(std::vector<int>(callable, callable + 3), (std::vector<int>{0, 0, 0}));
    // With the cue ball in hand behind the head string, the 1 there may not be hit first, but the 9 may.
    carom_game_state eight = state;
    ASSERT_EQ(carom_game_new(CAROM_EIGHT_BALL, 0, 0, &eight), CAROM_OK);
    eight.opening = 0;
    eight.in_hand = CAROM_HEAD_STRING;
    const auto scene = parsed(
        "[table]\npreset = \"nine_foot\"\n[[ball]]\nid = \"1\"\nposition = [0.5, 0.3]\n"
        "[[ball]]\nid = \"9\"\nposition = [0.5, 1.9]\n"
        "[[ball]]\nid = \"cue\"\nposition = [0.8, 0.3]\n");
    ASSERT_EQ(carom_legal_on(&eight, scene.get(), strike, first, nullptr), CAROM_OK);
    EXPECT_EQ(std::vector<int>(strike, strike + 3), (std::vector<int>{0, 0, 1}));
    EXPECT_EQ(std::vector<int>(first, first + 3), (std::vector<int>{0, 1, 0}));

    const RecordPtr record = played(parsed(kScratch).get());
    const VerdictPtr verdict = judged(state, record.get());
    ASSERT_EQ(carom_verdict_foul_count(verdict.get()), 1u);
    EXPECT_STREQ(carom_verdict_foul(verdict.get(), 0), "cue ball pocketed");
    EXPECT_STREQ(carom_verdict_rule(verdict.get(), 0), "WPA 6.1");
    EXPECT_EQ(carom_verdict_foul(verdict.get(), 1), nullptr);
    EXPECT_EQ(carom_verdict_rule(verdict.get(), 1), nullptr);
    EXPECT_EQ(carom_verdict_points(verdict.get()), 0);
    EXPECT_EQ(carom_verdict_penalty(verdict.get()), 0);
    EXPECT_EQ(carom_verdict_chooser(verdict.get()), -1);
    ASSERT_EQ(carom_verdict_option_count(verdict.get()), 1u);
    carom_option option;
    ASSERT_EQ(carom_verdict_option(verdict.get(), 0, &option), CAROM_OK);
    EXPECT_STREQ(option.decision, "take in hand");
    EXPECT_EQ(option.state.turn, 1);
    EXPECT_EQ(option.state.in_hand, CAROM_ANYWHERE);
    EXPECT_EQ(option.state.fouls[0], 1);
    EXPECT_EQ(option.rerack, 0);
    EXPECT_EQ(option.respots, 0u);
    EXPECT_EQ(carom_verdict_option(verdict.get(), 1, &option), CAROM_BAD_ARGUMENT);

    carom_cue cue;
    carom_cue_init(&cue);
    cue.speed = 2.0;
    carom_scene* next = nullptr;
    EXPECT_EQ(carom_next_shot(record.get(), verdict.get(), 0, &cue, nullptr, &next), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "the cue ball is in hand; give its place");
    EXPECT_EQ(next, nullptr);
    const double place[2] = {0.7, 0.5};
    ASSERT_EQ(carom_next_shot(record.get(), verdict.get(), 0, &cue, place, &next), CAROM_OK)
        << carom_last_error();
    const ScenePtr owner(next, carom_scene_free);
    const RecordPtr again = played(next);
    EXPECT_EQ(carom_record_ball_count(again.get()), 2u);
    double rvw[9];
    ASSERT_EQ(carom_record_state(again.get(), 0, 0.0, rvw, nullptr), CAROM_OK);
    EXPECT_EQ(rvw[0], 0.7);
    EXPECT_EQ(rvw[1], 0.5);
}

TEST(CApiGames, AVerdictBelongsToOneRecord) {
    const RecordPtr record = played(parsed(kScratch).get());
    std::string slower = kScratch;
    slower.replace(slower.find("4.0"), 3, "3.9");
    const RecordPtr other = played(parsed(slower).get());
    const VerdictPtr verdict = judged(nine_ball(), record.get());
    carom_cue cue;
    carom_cue_init(&cue);
    const double place[2] = {0.7, 0.5};
    carom_scene* next = nullptr;
    EXPECT_EQ(carom_next_shot(other.get(), verdict.get(), 0, &cue, place, &next), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(),
                 "the verdict belongs to another record; give the record that was judged");
}

TEST(CApiGames, ABallReturnsToItsSpot) {
    const std::string text =
        "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n[[ball]]\nid = \"cue\"\nposition = "
        "[1.5, 3.3]\n"
        "[[ball]]\nid = \"black\"\nposition = [1.65, 3.45]\n[[ball]]\nid = \"1\"\nposition = [0.5, 2.0]\n"
        "[cue]\nspeed = 1.5\naim_deg = 45.0\noffset = [0.0, -0.2]\n";
    carom_game_state state;
    ASSERT_EQ(carom_game_new(CAROM_SNOOKER, 1, 0, &state), CAROM_OK);
    state.opening = 0;
    state.in_hand = CAROM_NOT_IN_HAND;
    state.on = 0;
    const carom_call call = {"black", nullptr, 0, 0};
    const VerdictPtr verdict = judged(state, played(parsed(text).get()).get(), &call);
    EXPECT_EQ(carom_verdict_points(verdict.get()), 7);
    carom_option option;
    ASSERT_EQ(carom_verdict_option(verdict.get(), 0, &option), CAROM_OK);
    EXPECT_EQ(option.state.points[1], 7);
    EXPECT_EQ(option.state.on, 1);
    ASSERT_EQ(option.respots, 1u);
    const char* ball = nullptr;
    double place[2];
    ASSERT_EQ(carom_verdict_respot(verdict.get(), 0, 0, &ball, place), CAROM_OK);
    EXPECT_STREQ(ball, "black");
    EXPECT_EQ(place[0], 0.889);
    EXPECT_NEAR(place[1], 3.569 - 0.324, 1e-15);
    EXPECT_EQ(carom_verdict_respot(verdict.get(), 0, 1, &ball, place), CAROM_BAD_ARGUMENT);
}

TEST(CApiGames, NoiseMatchesTheLibrary) {
    double sd[5];
    ASSERT_EQ(carom_noise("fastfiz", 0.025, sd), CAROM_OK);
    EXPECT_EQ(sd[0], 0.075);
    EXPECT_EQ(sd[3], 0.5e-3 / 0.025);
    EXPECT_EQ(carom_noise("human", 0.025, sd), CAROM_BAD_ARGUMENT);
    carom_cue cue, struck;
    carom_cue_init(&cue);
    ASSERT_EQ(carom_noisy_cue(&cue, sd, 7, 3, &struck), CAROM_OK);
    const Cue here = games::with_noise(Cue(), games::noise_by_name("fastfiz", 0.025), 7, 3);
    EXPECT_EQ(struck.speed, here.speed);
    EXPECT_EQ(struck.aim_deg, here.aim_deg);
    EXPECT_EQ(struck.elevation_deg, here.elevation_deg);
    EXPECT_EQ(struck.side, here.side);
    EXPECT_EQ(struck.height, here.height);
    EXPECT_EQ(struck.mass, cue.mass);
    ASSERT_EQ(carom_noisy_cue(&cue, sd, 7, 3, &cue), CAROM_OK);
    EXPECT_EQ(cue.speed, struck.speed);
    sd[0] = -1.0;
    EXPECT_EQ(carom_noisy_cue(&cue, sd, 7, 3, &struck), CAROM_BAD_ARGUMENT);
}

TEST(CApiGames, BadArgumentsAreNamed) {
    carom_game_state state;
    EXPECT_EQ(carom_game_new(static_cast<carom_game>(15), 0, 0, &state), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "game is 15; expected 0 to 10");
    EXPECT_EQ(carom_game_new(CAROM_SNOOKER, 2, 0, &state), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_game_new(CAROM_SNOOKER, 0, 0, nullptr), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_game_new(CAROM_THREE_CUSHION, 0, INT_MAX, &state), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "state.target: expected a whole number from 0 to 1000000000");
    state = nine_ball();
    EXPECT_EQ(carom_legal(&state, 0, nullptr, nullptr, nullptr, nullptr), CAROM_BAD_ARGUMENT);
    const RecordPtr record = played(parsed(kScratch).get());
    carom_verdict* verdict = nullptr;
    state.over = 1;
    EXPECT_EQ(carom_judge(&state, record.get(), nullptr, &verdict), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "the game is over; begin a new one");
    state.over = 0;
    state.fouls[0] = INT_MAX;
    EXPECT_EQ(carom_judge(&state, record.get(), nullptr, &verdict), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "state.fouls[0]: expected a whole number from 0 to 1000000000");
    state.fouls[0] = 0;
    state.group[1] = 3;
    EXPECT_EQ(carom_judge(&state, record.get(), nullptr, &verdict), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_judge(nullptr, record.get(), nullptr, &verdict), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(verdict, nullptr);
    EXPECT_EQ(carom_verdict_foul_count(nullptr), 0u);
    EXPECT_EQ(carom_verdict_option_count(nullptr), 0u);
    EXPECT_EQ(carom_verdict_points(nullptr), 0);
    EXPECT_EQ(carom_verdict_penalty(nullptr), 0);
    EXPECT_EQ(carom_verdict_chooser(nullptr), -1);
    carom_verdict_free(nullptr);
}

}  // namespace
}  // namespace carom::test
