// libcarom.so: values, rules, aiming aids, noise and advice are the library's.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "carom/games/noise.h"
#include "owned.h"

namespace carom::test {
namespace {

/// The one falls, followed by the cue ball.
const char* const kScratch =
    "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n[[ball]]\nid = \"1\"\nposition = [0.2, 0.2]\n"
    "[[ball]]\nid = \"9\"\nposition = [0.7, 1.0]\n[cue]\nspeed = 4.0\naim_deg = 225.0\noffset = [0.0, 0.4]\n";

/// In the middle of a turn.
ValuePtr state_of(const char* game, const char* options = R"({"opening": false, "in_hand": "no"})") {
    return made(carom_game_new, game, options);
}

carom_cue soft_cue() {
    carom_cue cue;
    carom_cue_init(&cue);
    cue.speed = 2.0;
    cue.height = 0.0;
    return cue;
}

TEST(CApiValues, APathLeadsToAPart) {
    const ValuePtr value =
        made(carom_value_parse, R"({"list": [{"a": 1.5}, {"a": null}], "yes": true, "text": "héllo"})");
    EXPECT_EQ(number(value, "list[0].a"), 1.5);
    EXPECT_TRUE(std::isnan(number(value, "list[1].a")));
    EXPECT_EQ(number(value, "yes"), 1.0);
    EXPECT_EQ(text(value, "text"), "héllo");
    EXPECT_EQ(carom_value_count(value.get(), "list"), 2u);
    for (const char* path : {"yes", "", "nothing"})
        EXPECT_EQ(carom_value_count(value.get(), path), 0u) << path;
    EXPECT_EQ(json(made(carom_value_part, value.get(), "list[0]")), R"({"a":1.5})");
    EXPECT_EQ(json(made(carom_value_parse, json(value).c_str())), json(value));
    const auto none = [&](const char* path) { return refused(carom_value_part, value.get(), path); };
    EXPECT_EQ(none("lists"), "lists: there is no lists; here is an object with list, yes, text");
    EXPECT_EQ(none("list[2]"), "list[2]: there is no [2]; here is a list of 2");
    EXPECT_EQ(none("list[0].b"), "list[0].b: there is no b; here is an object with a");
    for (const char* path :
         {"list[", "list[]", "list[-1]", "list[0", "list[00]", "list[99999999999999999999]", "list.0",
          "yes.a", "list[0]a", "list[0].", ".", ".text", "[0]", "text[0]"})
        none(path);
    double found = 0.0;
    const char* words = nullptr;
    EXPECT_EQ(carom_value_number(value.get(), "text", &found), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "text: expected a number; here is string");
    EXPECT_EQ(carom_value_text(value.get(), "", &words), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "the value: expected a text; here is an object with list, yes, text");
    EXPECT_EQ(refused(carom_value_parse, "{"), "the value: expected JSON");
    const std::string deep(1000000, '[');
    EXPECT_EQ(refused(carom_value_parse, deep.c_str()), "the value: nested too deep");
    EXPECT_EQ(carom_value_number(nullptr, "", &found), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_value_json(nullptr, nullptr, 0), static_cast<std::size_t>(-1));
    carom_value_free(nullptr);
}

TEST(CApiGames, RuleOptionsAreKept) {
    const ValuePtr games = made(carom_games);
    EXPECT_EQ(text(games, "[1].name"), "nine_ball");
    EXPECT_EQ(text(games, "[1].options[2].key"), "nine_on_break");
    EXPECT_EQ(refused(carom_game_new, "nine_ball", R"({"rules": ["call=all"]})"),
              "options.rules: nine_ball has no option \"call\"; it has push_out, three_fouls, nine_on_break");
    const ValuePtr state =
        state_of("nine_ball", R"({"opening": false, "in_hand": "no", "rules": ["nine_on_break=respot"]})");
    const ValuePtr verdict = made(carom_judge, state.get(), played(parsed(kScratch).get()).get(), nullptr);
    EXPECT_EQ(text(verdict, "options[0].state.rules[0]"), "nine_on_break=respot");
    const ValuePtr pyramid = made(carom_game_new, "free_pyramid", R"({"turn": 1})");
    EXPECT_EQ(number(pyramid, "turn"), 1.0);
    EXPECT_EQ(number(pyramid, "target"), 8.0);
}

TEST(CApiGames, AdviceIsAStrikeThatPots) {
    const ValuePtr state = state_of("nine_ball");
    const ScenePtr table = parsed(
        "[[ball]]\nid = \"cue\"\nposition = [0.6, 0.6]\n[[ball]]\nid = \"1\"\nposition = [0.3, 0.3]\n"
        "[[ball]]\nid = \"9\"\nposition = [0.7, 2.0]\n[cue]\nmass = 0.5\n");
    const ValuePtr advice =
        made(carom_advise, state.get(), table.get(), "club", std::uint64_t{1}, std::size_t{2});
    ASSERT_GE(carom_value_count(advice.get(), ""), 1u);
    EXPECT_EQ(text(advice, "[0].kind"), "pot");
    EXPECT_EQ(text(advice, "[0].words").substr(0, 7), "1 into ");
    EXPECT_TRUE(std::isnan(number(advice, "[0].place")));
    EXPECT_GT(number(advice, "[0].makes.value"), 0.8);
    carom_cue cue, strike;
    ASSERT_EQ(carom_value_cue(advice.get(), "[0].cue", &cue), CAROM_OK) << carom_last_error();
    ASSERT_EQ(carom_value_cue(advice.get(), "[0].strike", &strike), CAROM_OK);
    EXPECT_EQ(cue.speed, number(advice, "[0].cue.speed"));
    EXPECT_EQ(cue.height, number(advice, "[0].cue.offset[1]"));
    EXPECT_EQ(cue.mass, 0.5);
    EXPECT_NE(cue.aim_deg, strike.aim_deg);
    EXPECT_EQ(carom_value_cue(advice.get(), "[0].call", &cue), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(std::string(carom_last_error()).substr(0, 47),
              "[0].call: unknown key \"pocket\"; expected one of");
    EXPECT_EQ(refused(carom_advise, state.get(), table.get(), "wizard", std::uint64_t{1}, std::size_t{2}),
              "unknown level \"wizard\"; use beginner, club, league, professional, machine");
}

TEST(CApiGames, AShotIsJudgedAndTheNextOneFollows) {
    // With the cue ball in hand behind the head string, the 1 there may not be hit first, but the 9 may.
    const auto scene = parsed(
        "[table]\npreset = \"nine_foot\"\n[[ball]]\nid = \"1\"\nposition = [0.5, 0.3]\n"
        "[[ball]]\nid = \"9\"\nposition = [0.5, 1.9]\n"
        "[[ball]]\nid = \"cue\"\nposition = [0.8, 0.3]\n");
    const ValuePtr eight = state_of("eight_ball", R"({"opening": false})");
    const ValuePtr legal = made(carom_legal, eight.get(), scene.get());
    EXPECT_EQ(json(legal).substr(0, 49), R"({"cue_balls":["cue"],"first":["9"],"callable":["1)");
    EXPECT_EQ(text(legal, "in_hand"), "head string");

    const RecordPtr record = played(parsed(kScratch).get());
    const ValuePtr verdict = made(carom_judge, state_of("nine_ball").get(), record.get(), nullptr);
    ASSERT_EQ(carom_value_count(verdict.get(), "fouls"), 1u);
    EXPECT_EQ(text(verdict, "fouls[0].foul"), "cue ball pocketed");
    EXPECT_EQ(text(verdict, "fouls[0].rule"), "WPA 6.1");
    EXPECT_EQ(text(verdict, "options[0].decision"), "take in hand");
    EXPECT_EQ(text(verdict, "options[0].state.in_hand"), "anywhere");
    EXPECT_EQ(number(verdict, "options[0].state.fouls[0]"), 1.0);

    const carom_cue cue = soft_cue();
    carom_scene* next = nullptr;
    EXPECT_EQ(carom_next_shot(record.get(), verdict.get(), 0, &cue, nullptr, &next), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "the cue ball is in hand; give its place");
    EXPECT_EQ(carom_next_shot(record.get(), verdict.get(), 1, &cue, nullptr, &next), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "options[1]: there is no [1]; here is a list of 1");
    EXPECT_EQ(next, nullptr);
    const double place[2] = {0.7, 0.5}, taken[2] = {0.7, 1.0};
    std::int32_t allowed = -1;
    ASSERT_EQ(carom_may_place(record.get(), verdict.get(), 0, place, &allowed), CAROM_OK)
        << carom_last_error();
    EXPECT_EQ(allowed, 1);
    ASSERT_EQ(carom_may_place(record.get(), verdict.get(), 0, taken, &allowed), CAROM_OK);
    EXPECT_EQ(allowed, 0);
    ASSERT_EQ(carom_next_shot(record.get(), verdict.get(), 0, &cue, place, &next), CAROM_OK)
        << carom_last_error();
    const ScenePtr owner(next, carom_scene_free);
    const ValuePtr plan = made(carom_scene_plan, next);
    EXPECT_EQ(carom_value_count(plan.get(), "balls"), 2u);
    EXPECT_EQ(number(plan, "balls[0].position[0]"), 0.7);
    EXPECT_EQ(number(plan, "balls[0].position[1]"), 0.5);
}

TEST(CApiGames, AVerdictBelongsToOneRecord) {
    const RecordPtr record = played(parsed(kScratch).get()), other = played(parsed(kPot).get());
    const ValuePtr verdict = made(carom_judge, state_of("nine_ball").get(), record.get(), nullptr);
    // Also one that was kept in a file.
    const ValuePtr kept = made(carom_value_parse, json(verdict).c_str());
    const carom_cue cue = soft_cue();
    const double place[2] = {0.7, 0.5};
    carom_scene* next = nullptr;
    std::int32_t allowed = -1;
    EXPECT_EQ(carom_next_shot(other.get(), kept.get(), 0, &cue, place, &next), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(),
                 "the verdict belongs to another record; give the record that was judged");
    EXPECT_EQ(carom_may_place(other.get(), kept.get(), 0, place, &allowed), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_may_place(record.get(), kept.get(), 0, place, &allowed), CAROM_OK);
}

TEST(CApiGames, ABallReturnsToItsSpot) {
    const std::string scene =
        "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n[[ball]]\nid = \"cue\"\nposition = "
        "[1.5, 3.3]\n"
        "[[ball]]\nid = \"black\"\nposition = [1.65, 3.45]\n[[ball]]\nid = \"1\"\nposition = [0.5, 2.0]\n"
        "[cue]\nspeed = 1.5\naim_deg = 45.0\noffset = [0.0, -0.2]\n";
    const ValuePtr state =
        state_of("snooker", R"({"turn": 1, "opening": false, "in_hand": "no", "on": "colour"})");
    const ValuePtr verdict =
        made(carom_judge, state.get(), played(parsed(scene).get()).get(), R"({"ball": "black"})");
    EXPECT_EQ(number(verdict, "points"), 7.0);
    EXPECT_EQ(number(verdict, "options[0].state.points[1]"), 7.0);
    EXPECT_EQ(text(verdict, "options[0].state.on"), "red");
    EXPECT_EQ(text(verdict, "options[0].respots[0].ball"), "black");
    EXPECT_EQ(number(verdict, "options[0].respots[0].place[0]"), 0.889);
    EXPECT_NEAR(number(verdict, "options[0].respots[0].place[1]"), 3.569 - 0.324, 1e-15);
}

TEST(CApiGames, AimsPotTheBall) {
    const ScenePtr scene = parsed(kPot);
    const ValuePtr lines = made(carom_pocket_lines, scene.get(), "1", "cue");
    EXPECT_EQ(text(lines, "[2].pocket"), "p3");
    EXPECT_EQ(number(lines, "[2].open"), 1.0);
    EXPECT_NEAR(std::hypot(number(lines, "[2].ghost[0]") - 0.30, number(lines, "[2].ghost[1]") - 2.24),
                2 * 0.028575, 1e-12);
    const carom_cue how = soft_cue();
    EXPECT_NEAR(number(made(carom_aim_pot, scene.get(), "cue", &how, "1", "p3"), "aim_deg"), 135.0, 1.0);
    const ValuePtr none = made(carom_aim_pot, scene.get(), "cue", &how, "1", "p6");
    EXPECT_TRUE(std::isnan(number(none, "aim_deg")));
    EXPECT_NE(text(none, "why"), "");
    EXPECT_EQ(refused(carom_aim_pot, scene.get(), "cue", &how, "7", "p3"),
              "there is no ball \"7\" in the scene");
    const ValuePtr routes = made(carom_bank_routes, scene.get(), "cue", &how, "1", "p1");
    EXPECT_LE(carom_value_count(routes.get(), ""), 6u);
}

TEST(CApiGames, NoiseMatchesTheLibrary) {
    const ValuePtr sd = made(carom_noise, "fastfiz", 0.025);
    EXPECT_EQ(number(sd, "speed"), 0.075);
    EXPECT_EQ(number(sd, "side"), 0.5e-3 / 0.025);
    refused(carom_noise, "human", 0.025);
    carom_cue cue, struck;
    carom_cue_init(&cue);
    ASSERT_EQ(carom_noisy_cue(&cue, sd.get(), 7, 3, &struck), CAROM_OK);
    const Cue here = games::with_noise(Cue(), games::noise_by_name("fastfiz", 0.025), 7, 3);
    EXPECT_EQ(struck.speed, here.speed);
    EXPECT_EQ(struck.aim_deg, here.aim_deg);
    EXPECT_EQ(struck.elevation_deg, here.elevation_deg);
    EXPECT_EQ(struck.side, here.side);
    EXPECT_EQ(struck.height, here.height);
    EXPECT_EQ(struck.mass, cue.mass);
    ASSERT_EQ(carom_noisy_cue(&cue, sd.get(), 7, 3, &cue), CAROM_OK);
    EXPECT_EQ(cue.speed, struck.speed);
    const ValuePtr negative = made(carom_value_parse, R"({"speed": -1})");
    EXPECT_EQ(carom_noisy_cue(&cue, negative.get(), 7, 3, &struck), CAROM_BAD_ARGUMENT);
}

TEST(CApiGames, BadArgumentsAreNamed) {
    EXPECT_EQ(refused(carom_game_new, "pool", nullptr).substr(0, 35),
              "no game \"pool\"; expected one of eig");
    EXPECT_EQ(refused(carom_game_new, "snooker", R"({"turn": 2})"),
              "options.turn: expected a whole number from 0 to 1");
    EXPECT_EQ(refused(carom_game_new, "snooker", "[1]").substr(0, 27), "options: expected an object");
    EXPECT_EQ(refused(carom_game_new, "snooker", "turn"), "options: expected JSON");
    EXPECT_EQ(carom_game_new("snooker", nullptr, nullptr), CAROM_BAD_ARGUMENT);
    const RecordPtr record = played(parsed(kScratch).get());
    const auto judging = [&](const char* state, const char* call) {
        return refused(carom_judge, made(carom_value_parse, state).get(), record.get(), call);
    };
    EXPECT_EQ(judging(R"({"game": "nine_ball", "over": true})", nullptr),
              "the game is over; begin a new one");
    EXPECT_EQ(judging(R"({"game": "nine_ball", "fouls": [2147483647, 0]})", nullptr),
              "state.fouls[0]: expected a whole number from 0 to 1000000000");
    EXPECT_EQ(judging(R"({"game": "nine_ball"})", R"({"safety": 1})"), "call.safety: expected true or false");
    EXPECT_EQ(refused(carom_judge, nullptr, record.get(), nullptr), "a required pointer is NULL");
}

}  // namespace
}  // namespace carom::test
