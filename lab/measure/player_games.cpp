// Lets the player of carom/games/player.h play racks of eight-ball or nine-ball, and prints what it reaches.
//
//     player_games alone LEVEL [RACKS [GAME]]           from the break until the turn is lost
//     player_games match LEVEL LEVEL [RACKS [GAME]]     the break alternates
//     player_games positions LEVEL LEVEL [RACKS [GAME]]  the same; prints the features of every position, and
//                                                       whether the player to shoot wins, for player_fit.py
//
// LEVEL is one of kSkills, or NOISE:LOOK, such as 1:quick (in units of "fastfiz").
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/draws.h"
#include "carom/engine/record.h"
#include "carom/engine/simulate.h"
#include "carom/games/player.h"
#include "player/lie.h"

using namespace carom;
using namespace carom::games;

namespace {

constexpr double kR = 0.028575;

struct Count {
    int racks = 0, breaks = 0, cleared = 0, tried = 0, made = 0, safeties = 0, fouls = 0, decisions = 0,
        shots = 0;
    double foretold = 0.0, seconds = 0.0;
    std::array<int, 2> wins{};
};

double cpu() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Skill skill_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return skill_by_name(text, kR);
    Skill skill{noise_by_name("fastfiz", kR), Look::kWhole};
    const double factor = std::stod(text.substr(0, colon));
    for (double* e : {&skill.noise.speed, &skill.noise.aim_deg, &skill.noise.elevation_deg, &skill.noise.side,
                      &skill.noise.height})
        *e *= factor;
    const std::string look = text.substr(colon + 1);
    skill.look = look == "pot" ? Look::kPot : look == "quick" ? Look::kQuick : Look::kWhole;
    return skill;
}

Scene rack(const std::string& game, std::uint64_t seed) {
    return parse_scene(
        fmt::format("[table]\npreset = \"nine_foot\"\n[balls]\npreset = \"pool\"\n[rack]\ngame = "
                    "\"{}\"\nseed = {}\n{}[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n[cue]\n",
                    game, seed % 1000000007 + 1, game == "nine_ball" ? "spot_ball = 9\n" : ""),
        "rack");
}

/// One rack. @param alone  it ends when the breaker's turn does
void play(const std::array<Skill, 2>& skills, const std::string& game, std::uint64_t seed, int breaker,
          bool alone, bool positions, Count& count) {
    std::vector<std::pair<int, std::string>> told;
    State state = new_game(game == "nine_ball" ? Game::kNineBall : Game::kEightBall, breaker);
    const kernel::Isa isa = kernel::best_isa();
    SplitMix64 random = draws_of(seed, 0, "rack");
    Scene scene = rack(game, random.next());
    for (int shot = 0; shot < 300; ++shot) {
        const Skill& skill = skills[static_cast<std::size_t>(state.turn)];
        AdviceOptions options;
        options.seed = seed * 1000 + static_cast<std::uint64_t>(shot);
        options.best = 1;
        options.fresh = state.opening ? 1 : 0;
        const double start = cpu();
        const Advice advice = advise(state, scene, skill, isa, options).front();
        count.seconds += cpu() - start;
        ++count.decisions;
        if (positions && !state.opening) {
            games::detail::Lie lie = games::detail::lie_of(scene);
            const auto features =
                games::detail::Potting(scene, skill.noise.aim_deg / 57.3).features(state, lie);
            told.emplace_back(state.turn, fmt::format("{} {}", seed, fmt::join(features, " ")));
        }
        scene = scene_with(scene, advice);
        scene.cue = with_noise(advice.cue, skill.noise, seed ^ 0x5eed, static_cast<std::uint64_t>(shot));
        validate(scene);
        const Record record = simulate(make_plan(scene, isa));
        const Verdict verdict = judge(state, record, advice.call);
        ++count.shots;
        const int me = state.turn;
        const bool opening = state.opening;
        std::size_t option = 0;
        if (verdict.options.size() > 1)
            option = choose(verdict, record, skills[static_cast<std::size_t>(verdict.chooser)]);
        const Option& taken = verdict.options[option];
        const State& next = taken.state;
        const bool made = next.over ? next.winner == me : next.turn == me && verdict.fouls.empty();
        if (!opening) {
            if (advice.ball.empty()) {
                ++count.safeties;
            } else {
                ++count.tried;
                count.made += made;
                count.foretold += advice.makes.value;
            }
            count.fouls += !verdict.fouls.empty();
        }
        if (std::getenv("TELL") != nullptr)
            fmt::print("{} player {} {} v {:.2f} worth {:.2f} makes {:.2f} -> {}{}\n", shot, me,
                       words_of(advice, scene.table), advice.cue.speed, advice.worth, advice.makes.value,
                       made ? "made" : "missed",
                       verdict.fouls.empty() ? "" : std::string(" foul: ") + name(verdict.fouls[0]));
        if (opening && shot == 0) count.breaks += next.turn == breaker && !taken.rerack() && !next.over;
        if (next.over) {
            ++count.racks;
            ++count.wins[static_cast<std::size_t>(next.winner)];
            for (const auto& [player, text] : told) fmt::print("{} {:d}\n", text, player == next.winner);
            count.cleared += alone && next.winner == breaker;
            return;
        }
        if (alone && (next.turn != breaker || taken.rerack())) {
            ++count.racks;
            return;
        }
        state = next;
        std::optional<Vec2> place;
        if (state.in_hand != InHand::kNo && !taken.rerack())
            place = free_place(record, taken, head_spot(scene.table));
        scene = taken.rerack() ? rack(game, random.next()) : table_after(scene, record, taken, place);
    }
    ++count.racks;  // nobody has won
}

std::string share(int part, int whole) {
    const Share s = share_of(static_cast<std::size_t>(part), static_cast<std::size_t>(whole > 0 ? whole : 1));
    return fmt::format("{:.1f} % ({:.0f} to {:.0f}) of {}", 100.0 * s.value, 100.0 * s.low, 100.0 * s.high,
                       whole);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const std::vector<std::string> words(argv + 1, argv + argc);
    const bool alone = words[0] == "alone";
    const std::size_t levels = alone ? 1 : 2;
    const std::array<Skill, 2> skills = {skill_of(words[1]), skill_of(words[levels])};
    const int racks = words.size() > levels + 1 ? std::stoi(words[levels + 1]) : 20;
    const std::string game = words.size() > levels + 2 ? words[levels + 2] : "eight_ball";
    Count count;
    for (int k = 0; k < racks; ++k)
        play(skills, game, static_cast<std::uint64_t>(alone ? k : k / 2) + 1, alone ? 0 : k % 2, alone,
             words[0] == "positions", count);
    if (words[0] == "positions") return 0;
    fmt::print("{} racks, {} shots; {:.3f} CPU s a decision\n", count.racks, count.shots,
               count.seconds / count.decisions);
    fmt::print("break pots and keeps the turn  {}\n", share(count.breaks, racks));
    fmt::print("pots made                      {}; foretold {:.1f} %\n", share(count.made, count.tried),
               100.0 * count.foretold / count.tried);
    fmt::print("safeties {}, fouls {}\n", count.safeties, count.fouls);
    if (alone)
        fmt::print("cleared after a good break     {}\n", share(count.cleared, count.breaks));
    else
        fmt::print("won by the first               {}\n",
                   share(count.wins[0], count.wins[0] + count.wins[1]));
}
