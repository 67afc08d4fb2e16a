// Options of the games' rules: values accepted and refused, and those that survive a new rack.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/games/rules.h"
#include "made_record.h"
#include "support/engine_cases.h"
#include "support/files.h"

namespace carom::test {
namespace {

using games::Game;
using games::set_rule;
using games::State;

std::string refused(Game game, const std::string& option) {
    State state = games::new_game(game);
    try {
        set_rule(state, option);
    } catch (const std::invalid_argument& error) {
        EXPECT_EQ(state, games::new_game(game));
        return error.what();
    }
    return "";
}

TEST(RuleOptions, EveryValueOfEveryOptionReadsBack) {
    for (const games::GameInfo& game : games::all_games())
        for (const games::RuleOption& option : game.options) {
            SCOPED_TRACE(option.key);
            ASSERT_GE(option.values.size(), 2u);
            for (const std::string& value : option.values) {
                State state = games::new_game(option.game);
                const std::string text = option.key + "=" + value;
                set_rule(state, text);
                const bool standard = value == option.values[0];
                EXPECT_EQ(state.rules, standard ? std::vector<std::string>() : std::vector{text});
                set_rule(state, option.key + "=" + option.values[0]);
                EXPECT_EQ(state, games::new_game(option.game));
            }
        }
}

TEST(RuleOptions, AForeignOptionIsRefusedWithTheGamesOwn) {
    EXPECT_EQ(refused(&games::kEightBall, "push_out=true"),
              "eight_ball has no option \"push_out\"; it has call, eight_on_break, in_hand, jump");
    EXPECT_EQ(refused(&games::kThreeCushion, "call=all"), "three_cushion has no options; leave out \"call\"");
    EXPECT_EQ(refused(&games::kEightBall, "call=maybe"), "call=maybe: expected call=all|eight|none");
    EXPECT_EQ(refused(&games::kEightBall, "call"), "call: expected call=all|eight|none");
    EXPECT_EQ(refused(&games::kSnooker, ""), "snooker has no option \"\"; it has miss");
    State other = games::new_game(&games::kEightBall);
    set_rule(other, "call=none");
    other.game = &games::kThreeCushion;
    EXPECT_THROW(games::legal(other, std::vector<std::string>{"white", "red"}), std::invalid_argument);
}

TEST(RuleOptions, SurviveANewRack) {
    State state = games::new_game(&games::kEightBall);
    set_rule(state, "call=none");
    const Record record =
        Told().ball("cue", 0.6, 0.3).balls(numbered(1, 15)).strike("cue").hit("cue", "1").record();
    const games::Verdict verdict = games::judge(state, record);
    ASSERT_EQ(verdict.options.size(), 4u);
    for (const games::Option& option : verdict.options)
        EXPECT_EQ(option.state.rules, std::vector<std::string>{"call=none"});
}

// The light cue ball of scenes/jump.toml passes over the eight and hits the one.
TEST(RuleOptions, AJumpIsAFoulIfTheRulesForbidIt) {
    std::string text = read_file(std::string(CAROM_SOURCE_DIR) + "/scenes/jump.toml");
    for (const auto& [from, to] :
         {std::pair{"\"white\"", "\"cue\""}, {"\"red\"", "\"8\""}, {"\"yellow\"", "\"1\""}})
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;)
            text.replace(at, std::string(from).size(), to);
    const Record record = simulate(plan_of(parse_scene(text, "jump.toml")));
    State state = games::new_game(&games::kEightBall);
    state.opening = false;
    const auto jumps = [&] {
        const std::vector<games::CalledFoul> fouls = games::judge(state, record).fouls;
        return std::count(fouls.begin(), fouls.end(),
                          games::CalledFoul{games::Foul::kJumpShot, "option jump"});
    };
    EXPECT_EQ(jumps(), 0);
    set_rule(state, "jump=foul");
    EXPECT_EQ(jumps(), 1);
}

// As play/tables.js writes it.
std::string start_scene(const games::GameInfo& info) {
    const Table table = make_table(info.table);
    std::string text = "[table]\npreset = \"" + info.table + "\"\n[balls]\npreset = \"" +
                       (info.table == "nine_foot" ? "pool" : info.table) + "\"\n",
                rest = info.start;
    rest.replace(std::min(rest.find("SEED"), rest.size()), 4, rest.find("SEED") == rest.npos ? "" : "7");
    const std::regex part("([0-9.]+)([wl])\\b");
    for (std::smatch found; std::regex_search(rest, found, part); rest = found.suffix())
        text += found.prefix().str() +
                std::to_string(std::stod(found[1]) * (found[2] == "w" ? table.width : table.length));
    return text + rest;
}

TEST(Games, StartWithAShotByTheirRules) {
    for (const Game game : games::all_of(Game{})) {
        SCOPED_TRACE(name(game));
        const games::GameInfo& info = games::info_of(game);
        EXPECT_TRUE(!info.title.empty() && !info.book.empty());
        const Scene scene = parse_scene(start_scene(info), name(game));
        EXPECT_NO_THROW(games::judge(games::new_game(game), simulate(plan_of(scene))));
        EXPECT_EQ(scene.ball.size(), static_cast<std::size_t>(info.balls) + 1);
    }
}

TEST(RuleOptions, EveryGameHasABook) {
    std::set<std::string> books;
    for (const Game game : games::all_of(Game{})) books.insert(games::info_of(game).book);
    EXPECT_EQ(books.size(), games::all_of(Game{}).size());
}

}  // namespace
}  // namespace carom::test
