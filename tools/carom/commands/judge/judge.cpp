// carom judge: the verdict on a shot in a game. carom next: the final table, as the scene of the next shot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/game_state.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/verdict.h"
#include "carom/engine/event_details.h"
#include "carom/engine/printable.h"
#include "carom/games/rules.h"
#include "carom/interface/shape.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using games::Decision;
using games::InHand;
using games::State;
using games::Verdict;

/// The game options of both commands.
struct GameArgs {
    std::string game, state, state_out, ball, pocket;
    std::vector<std::string> rules;
    bool safety = false, push_out = false;
    int option = 1;
};

struct JudgeArgs {
    std::string shot;
    GameArgs game;
    bool json = false;
};

struct NextArgs {
    std::string scene, output = "next.toml", place;
    GameArgs game;
};

/// The outcome of a shot: the verdict, and the chosen option.
struct Judged {
    Verdict verdict;
    games::Option option;
};

/// Calls a function of the games, and turns its errors into messages about the shot.
template <class F>
auto asked(const std::string& shot, F&& f) {
    try {
        return f();
    } catch (const std::invalid_argument& refused) {
        throw UsageError(fmt::format("{}: {}", harmless(shot), refused.what()));
    }
}

Judged judged(const std::string& shot, const Record& record, const GameArgs& args) {
    State before;
    if (!args.state.empty()) {
        before = read_state(args.state);
        if (!args.game.empty() && game_of(args.game) != before.game)
            throw UsageError(fmt::format("--game {}: the state in {} is of {}", args.game,
                                         harmless(args.state), name(before.game)));
    } else {
        before = games::new_game(game_of(args.game));
    }
    for (const std::string& option : args.rules) {
        try {
            games::set_rule(before, option);
        } catch (const std::invalid_argument& refused) {
            throw UsageError(fmt::format("--rules {}", refused.what()));
        }
    }
    const games::Call call{args.ball, args.pocket, args.safety, args.push_out};
    if (call.safety && !games::info_of(before.game).has_safety)
        throw UsageError(fmt::format("--safety: {} has no called safety; leave it out", name(before.game)));
    Verdict verdict = asked(shot, [&] { return games::judge(before, record, call); });
    name_record(verdict, record);
    const auto options = static_cast<int>(verdict.options.size());
    if (args.option > options)
        throw UsageError(fmt::format("--option {}: there {} {}", args.option, options == 1 ? "is" : "are",
                                     counted(verdict.options.size(), "option")));
    games::Option option = verdict.options[static_cast<std::size_t>(args.option) - 1];
    if (args.state.empty())
        message("note: judged as the first shot of a game; for a later one, give --state");
    return {std::move(verdict), std::move(option)};
}

std::string verdict_text(const Judged& judged) {
    const Verdict& verdict = judged.verdict;
    std::string text = verdict.fouls.empty() ? "fair" : "foul";
    for (const games::CalledFoul& called : verdict.fouls)
        text += fmt::format("{}{}{}", text == "foul" ? ": " : ", ", name(called.foul),
                            called.rule.empty() ? "" : " (" + called.rule + ")");
    text += "\n";
    // In a game that is not scored, a point says that the player continues.
    if (verdict.points != 0 && games::info_of(judged.option.state.game).is_scored)
        text += counted(static_cast<std::size_t>(std::abs(verdict.points)), "point") +
                (verdict.points > 0 ? " scored\n" : " lost\n");
    if (verdict.penalty != 0)
        text += counted(static_cast<std::size_t>(verdict.penalty), "point") + " for the other player\n";
    if (verdict.options.size() > 1) text += fmt::format("player {} chooses one of\n", verdict.chooser + 1);
    for (std::size_t i = 0; i < verdict.options.size(); ++i) {
        const games::Option& option = verdict.options[i];
        if (verdict.options.size() > 1)
            text += fmt::format("  {}  {}: ", i + 1, carom::name(option.decision));
        text += option.text() + "\n";
        const char* const indent = verdict.options.size() > 1 ? "     " : "";
        if (option.decision == Decision::kReplace) {
            text += fmt::format("{}every ball returns to its place before the shot\n", indent);
            continue;
        }
        for (const games::Respot& back : option.respots)
            text += fmt::format("{}{} is respotted at {:.4f}, {:.4f} m\n", indent, back.ball, back.place.x(),
                                back.place.y());
    }
    return text;
}

int run_judge(const JudgeArgs& args) {
    if (args.game.game.empty() && args.game.state.empty())
        throw UsageError("no game is named; give --game or --state");
    const Record record = read_shot(args.shot, {});
    const Judged verdict = judged(args.shot, record, args.game);
    write_report(args.game.state_out, interface::value_of(verdict.option.state).dump(2) + "\n");
    print(args.json ? interface::value_of(verdict.verdict).dump() + "\n" : verdict_text(verdict));
    return kOk;
}

/// The requested place of the cue ball, else the free one nearest to the head spot, or none.
std::optional<Vec2> place_of(const NextArgs& args, const Record& record, const games::Option& option) {
    if (!args.place.empty()) {
        const auto numbers = numbers_in<double, 2>(args.place, ',');
        if (!numbers) throw UsageError(fmt::format("--place {}: expected X,Y in m", args.place));
        const Vec2 place((*numbers)[0], (*numbers)[1]);
        if (!asked(args.scene, [&] { return games::may_place(record, option, place); }))
            throw UsageError(fmt::format(
                "--place {}: the cue ball may not be placed there; choose another place", args.place));
        return place;
    }
    if (option.state.in_hand == InHand::kNo) return std::nullopt;
    return asked(args.scene, [&] { return games::free_place(record, option); });
}

int run_next(const NextArgs& args) {
    if (is_record(args.scene))
        throw UsageError(
            fmt::format("{}: expected a scene file (TOML); a record does not contain the models of physics",
                        harmless(args.scene)));
    const Plan plan = plan_scene(args.scene);
    const Record record = simulate_plan(plan, {});
    std::string said = fmt::format("# The table after {}.\n", harmless(args.scene));
    for (const Event& event : record.events) {
        if (event.type == EventType::kBallPocket)
            said += fmt::format("# {} fell into the {}.\n", harmless(record.tracks[event.a].id),
                                met_name(record, event));
        if (event.type == EventType::kBallOut)
            said += fmt::format("# {} left the table.\n", harmless(record.tracks[event.a].id));
    }
    Scene next;
    std::string ball = plan.scene.cue ? plan.scene.cue->ball : "";
    std::vector<std::string> first;
    if (args.game.game.empty() && args.game.state.empty()) {
        next = scene_after(plan.scene, record);
    } else {
        const Judged verdict = judged(args.scene, record, args.game);
        const games::Option& option = verdict.option;
        if (option.state.over) {
            print(verdict_text(verdict));
            throw UsageError(
                fmt::format("{}: the game is over; there is no next shot", harmless(args.scene)));
        }
        if (option.rerack())
            throw UsageError(fmt::format("{}: the balls are racked again; write a scene with [rack]",
                                         harmless(args.scene)));
        next = asked(args.scene, [&] {
            return games::table_after(plan.scene, record, option, place_of(args, record, option));
        });
        ball = asked(args.scene, [&] { return games::struck_next(option.state, ids_of(next.ball)); });
        first = games::legal(option.state, next).first;
        said += fmt::format("# {}: {}.\n", verdict.verdict.fouls.empty() ? "Fair" : "A foul", option.text());
        write_report(args.game.state_out, interface::value_of(option.state).dump(2) + "\n");
    }
    next.cue.reset();
    if (plan.scene.cue && index_of(next.ball, ball) >= 0)
        next.cue = next_cue(next, *plan.scene.cue, ball, first);
    else
        said += "# The struck ball is gone: place it as a [[ball]], and add a [cue].\n";
    write_report(args.output, said + scene_text(next));
    print(fmt::format("{}: {}\n", harmless(args.output), counted(next.ball.size(), "ball")));
    return kOk;
}

void add_game(Options& command, GameArgs& args) {
    command.option("--game", &args.game, "GAME", "The game, unless --state names it (default: none)")
        .one_of(game_names());
    command.option("--state", &args.state, "FILE.json",
                   "The state before the shot (default: before the break)");
    command.option("--state-out", &args.state_out, "FILE.json",
                   "Write the state after the shot (default: not written)");
    command.option("--ball", &args.ball, "ID", "The called ball (default: none)");
    command.option("--pocket", &args.pocket, "ID", "The called pocket (default: none)");
    command.option("--rules", &args.rules, "KEY=VALUE",
                   "Set an option of the game (see carom describe games); may be repeated (default: none)");
    command.flag("--safety", args.safety,
                 "Eight-ball, ten-ball, straight pool: a safety was called (default: off)");
    command.flag("--push-out", args.push_out, "Nine-ball, ten-ball: a push out was called (default: off)");
    command.option("--option", &args.option, "N", "Take this option, by its number, if there are several")
        .in(1, 9);
}

}  // namespace

void add_judge(Options& program) {
    auto [command, args] = program.command<JudgeArgs>(
        "judge", "Judge a shot by the rules of a game: fouls, points, whose turn it is, respotted balls",
        run_judge);
    command.argument("SHOT", args.shot, "Scene file (TOML) or record (.json)").required = true;
    add_game(command, args.game);
    command.flag("--json", args.json, "Print the verdict as JSON (default: off)");
}

void add_next(Options& program) {
    auto [command, args] = program.command<NextArgs>(
        "next", "Write the scene of the next shot, applying the rules of a game if one is named", run_next);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    command.option("-o,--output", &args.output, "FILE.toml", "Scene file to write");
    add_game(command, args.game);
    command.option("--place", &args.place, "X,Y",
                   "Place of the cue ball in hand, in m (default: the free place nearest to the head spot)");
}

}  // namespace carom::tools
