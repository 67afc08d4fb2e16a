// carom advise: the best shots of a position, in words and as a scene.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "base/game_state.h"
#include "base/hand.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/batch.h"
#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/games/player.h"
#include "carom/interface/shape.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using games::Advice;
using games::State;

struct AdviseArgs {
    std::string scene, game, state, group, in_hand, on, skill = "professional", hand, output;
    int best = 3, jobs = 0;
    std::uint64_t seed = 1;
    bool json = false;
};

/// Whether the balls are a full rack that nobody has broken: each touches another one, or nearly so.
bool is_racked(games::Game game, const Scene& scene) {
    // [m] The widest gap of a rack.
    constexpr double kGap = 2e-3;
    std::vector<Vec2> places;
    for (const BallStart& ball : scene.ball)
        if (ball.id != "cue") places.push_back(planar(ball.position));
    return places.size() == static_cast<std::size_t>(games::info_of(game).balls) &&
           std::all_of(places.begin(), places.end(), [&](const Vec2& place) {
               return std::any_of(places.begin(), places.end(), [&](const Vec2& other) {
                   const double apart = length(other - place);
                   return apart > 0.0 && apart < 2.0 * scene.balls.R + kGap;
               });
           });
}

/// The state in the file; otherwise a break if the balls are racked, else the middle of a turn, as the
/// options say.
State state_of(const AdviseArgs& args, const Scene& scene) {
    if (!args.state.empty()) {
        State state = read_state(args.state);
        if (!args.game.empty() && game_of(args.game) != state.game)
            throw UsageError(fmt::format("--game {}: the state in {} is of {}", args.game,
                                         harmless(args.state), name(state.game)));
        return state;
    }
    State state = games::new_game(game_of(args.game.empty() ? "eight_ball" : args.game));
    if (!args.group.empty() && !games::info_of(state.game).has_groups)
        throw UsageError(
            fmt::format("--group {}: {} has no groups; leave it out", args.group, name(state.game)));
    if (args.group.empty() && args.in_hand.empty() && is_racked(state.game, scene)) return state;
    state.opening = false;
    state.in_hand = args.in_hand.empty()         ? games::InHand::kNo
                    : args.in_hand == "anywhere" ? games::InHand::kAnywhere
                                                 : games::InHand::kHeadString;
    if (args.group == "solids") state.group = {games::Group::kSolids, games::Group::kStripes};
    if (args.group == "stripes") state.group = {games::Group::kStripes, games::Group::kSolids};
    return state;
}

/// @throws UsageError if the rules put another ball on
void check_on(const AdviseArgs& args, const State& state, const Scene& scene) {
    if (args.on.empty()) return;
    const std::vector<std::string> first = games::legal(state, scene).first;
    if (std::find(first.begin(), first.end(), args.on) == first.end())
        throw UsageError(
            fmt::format("--on {}: the rules let the cue ball hit {} first; correct the balls or the state",
                        harmless(args.on), fmt::join(first, ", ")));
}

games::Skill skill_of(const AdviseArgs& args, const Scene& scene) {
    games::Skill skill = games::skill_by_name(args.skill, scene.balls.R);
    if (args.hand.empty()) return skill;
    const games::Hand hand = read_hand(args.hand, &skill.unknown);
    skill.noise = {0.0, hand.aim_deg, hand.elevation_deg, hand.tip, hand.tip};
    skill.of_speed = hand.speed;
    return skill;
}

std::string advice_text(const std::vector<Advice>& advice) {
    std::string text;
    for (std::size_t i = 0; i < advice.size(); ++i) {
        const Advice& a = advice[i];
        text += fmt::format("{}  {}", i + 1, a.words);
        if (a.place) text += fmt::format("; cue ball from {:.3f}, {:.3f} m", a.place->x(), a.place->y());
        text += "\n   " + a.result + "\n";
    }
    return text;
}

int run_advise(const AdviseArgs& args) {
    const Plan plan = plan_scene(args.scene);
    const State state = state_of(args, plan.scene);
    games::AdviceOptions options;
    options.seed = args.seed;
    options.threads = args.jobs;
    options.best = static_cast<std::size_t>(args.best);
    options.stop = [] { return interrupted(); };
    if (plan.scene.stop != Stop{})
        message("note: [stop] is ignored; every shot is played until all balls rest");
    const auto advice = [&] {
        try {
            check_on(args, state, plan.scene);
            return games::advise(state, plan.scene, skill_of(args, plan.scene), chosen_isa(), options);
        } catch (const BatchStopped&) {
            throw Interrupted();
        } catch (const std::invalid_argument& refused) {
            throw UsageError(fmt::format("{}: {}", harmless(args.scene), refused.what()));
        }
    }();
    if (!args.output.empty()) {
        const std::string said = fmt::format("# {}: {}.\n", next_text(state), advice.front().words);
        write_report(args.output, said + scene_text(games::scene_with(plan.scene, advice.front())));
    }
    if (args.json)
        print(interface::value_of(advice).dump() + "\n");
    else
        print(next_text(state) + "\n" + advice_text(advice));
    return kOk;
}

}  // namespace

void add_advise(Options& program) {
    auto [command, args] = program.command<AdviseArgs>(
        "advise", "Recommend shots of different kinds, with their success rates", run_advise);
    command.argument("SCENE", args.scene, "Scene file (TOML) with the balls at rest").required = true;
    command.option("--game", &args.game, "GAME", "The game, unless --state names it (default: eight_ball)")
        .one_of(game_names());
    command.option(
        "--state", &args.state, "FILE.json",
        "The state of the game, from carom judge or next (default: a break if the balls are racked, else "
        "the middle of a turn)");
    command.option("--group", &args.group, "GROUP", "Eight-ball: the shooter's group (default: open)")
        .one_of({"solids", "stripes"})
        .excludes = "--state";
    command
        .option("--in-hand", &args.in_hand, "AREA",
                "The cue ball is in hand there; line: behind the head string (default: it is not in hand)")
        .one_of({"anywhere", "line"})
        .excludes = "--state";
    command.option("--on", &args.on, "ID", "Refuse unless this ball may be hit first (default: not checked)");
    command
        .option("--skill", &args.skill, "LEVEL",
                "Level of the player: size of the errors and depth of the search")
        .one_of({games::kSkills.begin(), games::kSkills.end()});
    command.option(
        "--hand", &args.hand, "ERRORS",
        "Errors of the player, as in carom solve, and unknown properties of the table, as in --unknown: "
        "aim=0.2,cloth=5%,places=0.2 (default: the level's)");
    command.option("--best", &args.best, "N", "Number of shots to print").in(1, 20);
    command.option("--seed", &args.seed, "S", "Seed of the player's errors");
    command.option("--jobs", &args.jobs, "J", "Threads, 0 for one per core; the result is always the same")
        .in(0, 256);
    command.option("-o,--output", &args.output, "FILE.toml",
                   "Write the best shot as a scene (default: not written)");
    command.flag("--json", args.json, "Print the advice as JSON (default: off)");
}

}  // namespace carom::tools
