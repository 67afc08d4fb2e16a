// Lets the player of carom/games/player.h play racks, and prints its results.
//
//     player_games alone LEVEL [RACKS [GAME [FIRST]]]            from the break until the turn is lost
//     player_games match LEVEL LEVEL [RACKS [GAME [FIRST]]]      the break alternates
//     player_games positions LEVEL LEVEL [RACKS [GAME [FIRST]]]  the same; prints the features of every
//         position, and whether the player to shoot wins, for player_fit.py; the results go to standard error
//     player_games chances LEVEL LEVEL [RACKS [GAME [FIRST]]]    the same; in place of the features prints
//         the played shot's chance to win, from fresh shots
//
//     player_games breaks TABLE [RACKS [GAME [FIRST]]]    the share of a professional's breaks that keep the
//         turn
//     player_games advice LEVEL [POSITIONS [GAME [FIRST]]]    random positions, two to fifteen balls, the cue
//         ball in hand or not: how many first advices are worth 0.05 less than another one on 2000 shots (the
//         advice has seen 400 of them), or are fouls although another one is fair
//     player_games ai3603 RACKS    against BasicAgentPro by the rules and errors of AI3603
//
// FIRST is the seed of the first rack.
// LEVEL is one of kSkills, or NOISE:LOOK, such as 1:quick (in units of "fastfiz"), or pro: BasicAgentPro with
// the errors of "fastfiz", eight-ball only.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "ai3603.h"
#include "basic_pro.h"
#include "carom/engine/math.h"
#include "carom/games/player.h"
#include "player/lie.h"
#include "support/player_racks.h"

using namespace carom;
using namespace carom::games;

namespace {

constexpr double kR = 0.028575;

struct Count {
    int racks = 0, breaks = 0, cleared = 0, tried = 0, made = 0, safeties = 0, fouls = 0, decisions = 0;
    std::vector<int> shots{};  ///< of each rack
    double foretold = 0.0, seconds = 0.0;
    std::array<int, 2> wins{};
};

double cpu() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Skill skill_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (text == "pro") return {noise_by_name("fastfiz", kR), Look::kPot};
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

/// The printed row of a shot.
enum class Tell { kNothing, kFeatures, kWins };

/// Its chances to win come from 200 fresh shots.
test::Adviser fresh_adviser(const Skill& skill) {
    return [skill](const State& state, const Scene& scene, std::uint64_t seed) {
        AdviceOptions options;
        options.seed = seed;
        options.best = 1;
        options.fresh = 200;
        return advise(state, scene, skill, kernel::best_isa(), options).front();
    };
}

/// One rack. @param alone  it ends when the breaker's turn does
void play(const std::array<Skill, 2>& skills, const std::array<bool, 2>& is_pro, Game game,
          std::uint64_t seed, int breaker, bool alone, Tell tell, Count& count) {
    std::vector<std::pair<int, std::string>> told;
    bool first = true;
    const auto timed = [&](std::size_t player) -> test::Adviser {
        const bool pro = is_pro[player];
        return [&, ask = pro                   ? test::Adviser(lab::basic_pro)
                         : tell == Tell::kWins ? fresh_adviser(skills[player])
                                               : test::adviser(skills[player])](
                   const State& state, const Scene& scene, std::uint64_t number) {
            const double start = cpu();
            Advice advice = ask(state, scene, number);
            count.seconds += cpu() - start;
            ++count.decisions;
            return advice;
        };
    };
    const auto each = [&](const test::RackShot& shot) {
        const State& before = shot.before;
        const bool opening = before.opening, made = shot.made();
        if (tell == Tell::kWins)
            told.emplace_back(before.turn, fmt::format("{} {}", seed, shot.advice.worth));
        if (tell == Tell::kFeatures && !opening) {
            const Skill& skill = skills[static_cast<std::size_t>(before.turn)];
            const auto features = games::detail::Potting(shot.table, skill.noise.aim_deg / kDegrees)
                                      .features(before, games::detail::lie_of(shot.table));
            told.emplace_back(before.turn, fmt::format("{} {}", seed, fmt::join(features, " ")));
        }
        if (!opening && shot.advice.ball.empty()) ++count.safeties;
        if (!opening && !shot.advice.ball.empty()) {
            ++count.tried;
            count.made += made;
            count.foretold += shot.advice.makes.value;
        }
        if (!opening) count.fouls += !shot.verdict.fouls.empty();
        if (std::getenv("TELL") != nullptr)
            fmt::print(
                "player {}: {}, foretold {:.2f}: {}{}\n", before.turn + 1, shot.advice.words,
                shot.advice.makes.value, made ? "made" : "missed",
                shot.verdict.fouls.empty() ? "" : std::string(", foul: ") + name(shot.verdict.fouls[0].foul));
        if (first) count.breaks += made && !shot.taken.state.over;
        first = false;
        return !alone || made;
    };
    const int decided = count.decisions;
    const int winner = test::play_rack(game, skills, {timed(0), timed(1)}, seed, breaker, each);
    ++count.racks;
    count.shots.push_back(count.decisions - decided);
    if (winner < 0) return;
    ++count.wins[static_cast<std::size_t>(winner)];
    count.cleared += winner == breaker;
    for (const auto& [player, text] : told) fmt::print("{} {:d}\n", text, player == winner);
}

std::string share(int part, int whole) {
    const Share s = share_of(static_cast<std::size_t>(part), static_cast<std::size_t>(whole > 0 ? whole : 1));
    return fmt::format("{:.1f} % ({:.0f} to {:.0f}) of {}", 100.0 * s.value, 100.0 * s.low, 100.0 * s.high,
                       whole);
}

/// A random position of a game.
std::pair<State, Scene> position(Game game, std::uint64_t seed) {
    SplitMix64 random = draws_of(seed, 0, "position");
    const int last = game == &games::kNineBall  ? 9
                     : game == &games::kTenBall ? 10
                                                : 15,
              money = game == &games::kEightBall ? 8 : last;
    State state = new_game(game);
    state.opening = false;
    const double hand = random.uniform();
    state.in_hand = hand < 1.0 / 3.0                                 ? InHand::kNo
                    : hand < 2.0 / 3.0 || game != &games::kEightBall ? InHand::kAnywhere
                                                                     : InHand::kHeadString;
    Scene scene = parse_scene(
        "[table]\npreset = \"nine_foot\"\n[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n", "position");
    scene.ball.clear();
    const double share = random.uniform();
    std::vector<Lying> others;
    for (int n = 0; n <= last; ++n) {
        const bool needed = n == 0 || n == money || n == 1 || (game == &games::kEightBall && n == 9);
        if (!needed && random.uniform() > share) continue;
        BallStart ball;
        ball.id = n == 0 ? "cue" : std::to_string(n);
        Vec2 place;
        do {
            place = Vec2((scene.table.width - 0.1) * random.uniform() + 0.05,
                         (scene.table.length - 0.1) * random.uniform() + 0.05);
        } while (!is_free(place, kR, others));
        ball.position = {place.x(), place.y(), kR};
        others.push_back({place, kR, 1e-3});
        scene.ball.push_back(ball);
    }
    validate(scene);
    return {state, scene};
}

void advice(const Skill& skill, Game game, int positions, std::uint64_t seed) {
    int worse = 0, fouls = 0;
    for (int k = 0; k < positions; ++k) {
        const auto [state, scene] = position(game, seed + static_cast<std::uint64_t>(k));
        AdviceOptions options;
        options.seed = seed + static_cast<std::uint64_t>(k);
        const Advice first = advise(state, scene, skill, kernel::best_isa(), options).front();
        options.fresh = 2000;
        const std::vector<Advice> list = advise(state, scene, skill, kernel::best_isa(), options);
        double most = 0.0, own = 0.0;
        bool fair = false;
        for (const Advice& a : list) {
            most = std::max(most, a.worth);
            if (a.cue == first.cue) own = a.worth;
            fair = fair || a.fouls.value < 0.5;
        }
        worse += own < most - 0.05;
        fouls += fair && first.fouls.value > 0.5;
    }
    fmt::print("worse than another one         {}\n", share(worse, positions));
    fmt::print("fouls with a fair shot listed  {}\n", share(fouls, positions));
}

void ai3603(int racks) {
    const std::array<test::Adviser, 2> advisers = {test::adviser({noise_by_name("ai3603", kR), Look::kWhole}),
                                                   lab::basic_pro};
    int won = 0, drawn = 0;
    for (int k = 0; k < racks; ++k) {
        const double got =
            lab::ai3603_rack(advisers, static_cast<std::uint64_t>(k / 4) + 1, k % 2, k % 4 < 2);
        won += got == 1.0;
        drawn += got == 0.5;
    }
    fmt::print("won by the first               {}; drawn {}\n", share(won, racks), drawn);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words[0] == "ai3603") {
        ai3603(std::stoi(words[1]));
        return 0;
    }
    const bool alone = words[0] == "alone";
    const bool asks = words[0] == "advice";
    const std::size_t levels = alone || asks || words[0] == "breaks" ? 1 : 2;
    const int racks = words.size() > levels + 1 ? std::stoi(words[levels + 1]) : 20;
    const std::string named = words.size() > levels + 2 ? words[levels + 2] : "eight_ball";
    const Game game = named == "nine_ball"  ? &games::kNineBall
                      : named == "ten_ball" ? &games::kTenBall
                                            : &games::kEightBall;
    const std::uint64_t seed = words.size() > levels + 3 ? std::stoull(words[levels + 3]) : 1;
    const Tell tell = words[0] == "positions" ? Tell::kFeatures
                      : words[0] == "chances" ? Tell::kWins
                                              : Tell::kNothing;
    if (words[0] == "breaks") {
        const int kept = test::breaks_kept(words[1], game, skill_by_name("professional", kR), racks, seed);
        fmt::print("break pots and keeps the turn  {}\n", share(kept, racks));
        return 0;
    }
    if (asks) {
        advice(skill_of(words[1]), game, racks, seed);
        return 0;
    }
    const std::array<Skill, 2> skills = {skill_of(words[1]), skill_of(words[levels])};
    Count count;
    for (int k = 0; k < racks; ++k)
        play(skills, {words[1] == "pro", words[levels] == "pro"}, game,
             seed + static_cast<std::uint64_t>(alone ? k : k / 2), alone ? 0 : k % 2, alone, tell, count);
    std::FILE* const out = tell == Tell::kNothing ? stdout : stderr;
    fmt::print(out, "{} racks, {} decisions; {:.3f} CPU s a decision\n", count.racks, count.decisions,
               count.seconds / count.decisions);
    fmt::print(out, "break pots and keeps the turn  {}\n", share(count.breaks, racks));
    fmt::print(out, "pots made                      {}; foretold {:.1f} %\n", share(count.made, count.tried),
               100.0 * count.foretold / count.tried);
    std::nth_element(count.shots.begin(), count.shots.begin() + racks / 2, count.shots.end());
    fmt::print(out, "shots a rack, median           {}\n", count.shots[static_cast<std::size_t>(racks) / 2]);
    // A break is no safety, and its fouls are not counted.
    const int others = count.decisions - count.racks;
    fmt::print(out, "safeties                       {}\n", share(count.safeties, others));
    fmt::print(out, "fouls                          {}\n", share(count.fouls, others));
    if (alone)
        fmt::print(out, "cleared after a good break     {}\n", share(count.cleared, count.breaks));
    else
        fmt::print(out, "won by the first               {}\n",
                   share(count.wins[0], count.wins[0] + count.wins[1]));
}
