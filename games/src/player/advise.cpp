// The player's advice: levels, breaks, the choice among options, and words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/games/aim.h"
#include "carom/games/player.h"
#include "facts.h"
#include "lines.h"
#include "player/lie.h"
#include "player/search.h"

namespace carom::games {
namespace {

using detail::Attempt;
using detail::Lie;
using detail::Search;

/// A break found by a search on many racks: position of the cue ball as fractions of the table's width and
/// length, and its stroke.
struct BreakStroke {
    Game game;
    double length;  ///< [m] of the table; the stroke applies to tables whose length is nearest to it
    double x, y;
    double hit;  ///< [-] of the apex ball: 0 is full, 1 and -1 pass its left and right edge
    double speed, height;
};
// By carom solve and carom break for a rack with the default gaps and errors of --hand
// aim=0.125,speed=1%,tip=0.0175: 78, 77, 68, 92, 51 and 62 % of fresh shots are legal and pot a ball.
constexpr BreakStroke kBreaks[] = {
    {&kEightBall, 2.54, 0.2722, 0.2428, -0.0075, 8.414, 0.152},
    {&kNineBall, 1.9812, 0.7601, 0.1964, -0.2716, 7.060, 0.135},
    {&kNineBall, 2.3368, 0.8803, 0.2483, -0.1177, 6.971, 0.056},
    {&kNineBall, 2.54, 0.0455, 0.1881, 0.3860, 4.812, 0.109},
    {&kNineBall, 2.8448, 0.1480, 0.2335, 0.1807, 6.436, 0.013},
    {&kTenBall, 2.54, 0.0725, 0.2321, -0.0138, 5.926, 0.034},
};

std::vector<std::string> player_games() {
    std::vector<std::string> names;
    for (const BreakStroke& row : kBreaks)
        if (names.empty() || names.back() != name(row.game)) names.emplace_back(name(row.game));
    return names;
}

void check_game(Game game) {
    if (std::none_of(std::begin(kBreaks), std::end(kBreaks), [&](const auto& b) { return b.game == game; }))
        throw std::invalid_argument(
            fmt::format("carom does not play {}; it plays {}", name(game), fmt::join(player_games(), ", ")));
}

/// @throws std::invalid_argument for a scene that cannot be a position of the state's game
void check_balls(const State& state, const Scene& scene) {
    const bool rolls_on = scene.balls.rolls() && !(scene.balls.mu_r > 0.0);
    if (!(scene.physics.gravity > 0.0) || rolls_on)
        throw std::invalid_argument(
            fmt::format("no ball comes to rest with {} = 0, so that no shot can be judged; give more",
                        scene.physics.gravity > 0.0 ? "mu_r" : "gravity"));
    for (const BallStart& ball : scene.ball) {
        const int number = detail::number_of(ball.id);
        if ((number == 0 && ball.id != cue_ball(state)) || number >= detail::kNumbers)
            throw std::invalid_argument(fmt::format("ball {} is not one of {}; name its game: {}",
                                                    in_quotes(ball.id), name(state.game),
                                                    fmt::join(player_games(), ", ")));
        if (ball.velocity != Vec3::Zero() || ball.spin != Vec3::Zero() || ball.height > 0.0)
            throw std::invalid_argument(
                fmt::format("ball {} moves; give a table at rest", in_quotes(ball.id)));
    }
}

/// Places the cue ball of the scene's cue.
Scene placed(Scene scene, const Vec2& place) {
    if (index_of(scene.ball, scene.cue->ball) < 0) {
        BallStart ball;
        ball.id = scene.cue->ball;
        scene.ball.insert(scene.ball.begin(), ball);
    }
    BallStart& ball = scene.ball[static_cast<std::size_t>(index_of(scene.ball, scene.cue->ball))];
    ball.position = {place.x(), place.y(), scene.size_of(ball).R};
    return scene;
}

/// The scene with a cue and a cue ball: one in hand lies on a free place.
Scene completed(const State& state, Scene scene) {
    Cue cue = scene.cue.value_or(Cue{});
    cue.ball = cue_ball(state);
    scene.cue = cue;
    const int at = index_of(scene.ball, cue.ball);
    if (state.in_hand == InHand::kNo && at >= 0) return scene;
    if (state.in_hand == InHand::kNo)
        throw std::invalid_argument("there is no cue ball, and it is not in hand");
    const Table& table = scene.table;
    const double R = scene.balls.R, beside = R + kSpotGap;
    std::vector<Lying> others;
    for (const BallStart& ball : scene.ball)
        if (ball.id != cue.ball) others.push_back({planar(ball.position), scene.size_of(ball).R, 0.0});
    if (at >= 0) {
        const Vec2 lies = planar(scene.ball[static_cast<std::size_t>(at)].position),
                   from = lies - table.corner;
        if (in_area(table, state.in_hand, lies) && from.x() >= R && from.y() >= R &&
            from.x() <= table.width - R && from.y() <= table.length - R && is_free(lies, R, others))
            return scene;
    }
    for (Lying& other : others) other.gap = kSpotGap;
    // Behind the head string, so that it may lie there in any game.
    const Vec2 from = table.corner + Vec2(beside, 0.2 * table.length);
    const auto place = nearest_free(from, {1.0, 0.0}, table.width - 2.0 * beside, R, others);
    if (!place) throw std::invalid_argument("there is no room for the cue ball");
    return placed(std::move(scene), *place);
}

Attempt break_of(const State& state, const Scene& scene) {
    const auto unlike = [&](const BreakStroke& row) {
        return row.game == state.game ? std::abs(row.length - scene.table.length)
                                      : std::numeric_limits<double>::infinity();
    };
    const auto& b = *std::min_element(std::begin(kBreaks), std::end(kBreaks),
                                      [&](const auto& p, const auto& q) { return unlike(p) < unlike(q); });
    // The apex is the object ball nearest to the head rail; its number depends on the rack.
    const BallStart* apex = nullptr;
    for (const BallStart& ball : scene.ball)
        if (ball.id != scene.cue->ball && (apex == nullptr || ball.position.y() < apex->position.y()))
            apex = &ball;
    if (apex == nullptr) throw std::invalid_argument("there is no rack; give the scene of a break");
    const BallStart& cue = scene.ball[static_cast<std::size_t>(index_of(scene.ball, scene.cue->ball))];
    const Table& table = scene.table;
    Attempt candidate;
    candidate.place = table.corner + Vec2(b.x * table.width, b.y * table.length);
    candidate.cue = *scene.cue;
    candidate.cue.speed = b.speed;
    candidate.cue.side = 0.0;
    candidate.cue.height = b.height;
    candidate.kind = ShotKind::kBreak;
    const Vec2 way = planar(apex->position) - candidate.place;
    candidate.cue.aim_deg = detail::hit_aim_deg(way, scene.size_of(*apex).R + scene.size_of(cue).R, b.hit);
    return candidate;
}

/// By the speed of the cue; the ball is about a third faster.
const char* speed_word(double speed) {
    return speed < 0.75  ? "very soft"
           : speed < 1.4 ? "soft"
           : speed < 3.1 ? "medium"
           : speed < 5.2 ? "hard"
                         : "break speed";
}

/// The part of the object ball that a cut covers.
std::string thickness(double cut_deg) {
    constexpr double kFull = 8.0;  // degrees
    const auto [sin, cos] = sin_cos_deg(std::abs(cut_deg));
    if (std::abs(cut_deg) < kFull) return "full";
    const char* part = 1.0 - sin > 0.62   ? "three-quarter ball"
                       : 1.0 - sin > 0.38 ? "half ball"
                       : 1.0 - sin > 0.15 ? "quarter ball"
                                          : "thin";
    return fmt::format("{} to the {}", part, cut_deg > 0.0 ? "left" : "right");
}

std::string words_of(const Advice& advice, const Attempt& of, const Table& table) {
    const bool deliberate = advice.fouls.value > 0.5 && advice.kind != ShotKind::kBreak;
    std::string words = deliberate                      ? "deliberate foul: "
                        : advice.kind == ShotKind::kPot ? ""
                                                        : std::string(name(advice.kind)) + ": ";
    if (of.ball > 0) {
        const std::string& where = table.pockets[static_cast<std::size_t>(of.pocket)].name;
        words += fmt::format("{} into {}{}, ", advice.ball, advice.pocket,
                             where.empty() ? "" : " (" + where + ")");
    }
    if (!of.rails.empty()) words += of.rails + ", ";
    const bool pot = advice.kind == ShotKind::kPot;
    const std::string part = pot ? thickness(advice.cut_deg) : "";
    if (pot) words += part + ", ";
    if (!of.spin.empty()) words += (part == "full" && of.spin == "stun" ? "stop" : of.spin) + ", ";
    constexpr double kCentre = 0.05;
    if (std::abs(advice.cue.side) > kCentre) words += advice.cue.side > 0.0 ? "left side, " : "right side, ";
    return words + speed_word(advice.cue.speed);
}

std::string result_words(const Advice& advice, const Attempt& of) {
    const auto percent = [](double share) { return fmt::format("{:.0f} %", 100.0 * share); };
    const bool ends = advice.kind == ShotKind::kSafety || advice.kind == ShotKind::kPushOut;
    std::string words;
    if (!ends)
        words = fmt::format("{} {} ({:.0f} to {:.0f}), ", advice.ball.empty() ? "keeps the turn" : "pots",
                            percent(advice.makes.value), 100.0 * advice.makes.low, 100.0 * advice.makes.high);
    words += fmt::format("wins {}, fouls {}", percent(advice.worth), percent(advice.fouls.value));
    if (!of.rest.empty()) words += "; cue ball rests " + of.rest;
    if (advice.kind != ShotKind::kBreak && advice.makes.value < 1.0)
        words += fmt::format("; {} the opponent a pot of {}", ends ? "leaves" : "a miss leaves",
                             percent(of.tally.mean_opponent()));
    if (advice.fouls.value > 0.5 && advice.kind != ShotKind::kBreak)
        words += "; no shot was found that is fair more often than not";
    return words;
}

/// @param strike  the cue with errors
Advice advice_of(const Attempt& candidate, const Scene& scene, bool in_hand, const Cue& strike) {
    Advice advice;
    advice.cue = candidate.cue;
    advice.strike = strike;
    advice.call = candidate.call;
    if (in_hand) advice.place = candidate.place;
    advice.kind = candidate.kind;
    if (candidate.ball > 0) {
        advice.ball = std::to_string(candidate.ball);
        advice.pocket = scene.table.pockets[static_cast<std::size_t>(candidate.pocket)].id;
    }
    advice.cut_deg = candidate.cut_deg;
    const detail::Tally& tally = candidate.tally;
    advice.makes = share_of(tally.made, tally.shots);
    advice.fouls = share_of(tally.fouls, tally.shots);
    advice.worth = tally.mean();
    std::vector<int> balls;
    for (int n = 1; n < detail::kNumbers; ++n)
        if (tally.leaves[static_cast<std::size_t>(n)] > 0) balls.push_back(n);
    std::stable_sort(balls.begin(), balls.end(), [&](int a, int b) {
        return tally.leaves[static_cast<std::size_t>(a)] > tally.leaves[static_cast<std::size_t>(b)];
    });
    constexpr std::size_t kMostLeft = 3;
    for (std::size_t i = 0; i < std::min(kMostLeft, balls.size()); ++i)
        advice.leaves.push_back(std::to_string(balls[i]));
    advice.words = words_of(advice, candidate, scene.table);
    advice.result = result_words(advice, candidate);
    return advice;
}

}  // namespace

Skill skill_by_name(std::string_view name, double R) {
    constexpr struct {
        double errors;
        Look look;
    } kLevels[] = {{4.0, Look::kPot},
                   {2.0, Look::kQuick},
                   {1.0, Look::kQuick},
                   {1.0, Look::kWhole},
                   {0.5, Look::kWhole}};
    static_assert(std::size(kLevels) == kSkills.size());
    const auto found = std::find(kSkills.begin(), kSkills.end(), name);
    if (found == kSkills.end())
        throw std::invalid_argument(
            fmt::format("unknown level {}; use {}", in_quotes(name), fmt::join(kSkills, ", ")));
    const auto& level = kLevels[found - kSkills.begin()];
    Skill skill{noise_by_name("fastfiz", R), level.look, 0.0, {.places = 2e-4}};
    for (double* error : {&skill.noise.speed, &skill.noise.aim_deg, &skill.noise.elevation_deg,
                          &skill.noise.side, &skill.noise.height})
        *error *= level.errors;
    return skill;
}

Noise Skill::noise_at(double speed) const {
    Noise at = noise;
    // Skipped at 0, so that no bit changes.
    if (of_speed > 0.0) at.speed = length(Vec2(noise.speed, of_speed * speed));
    return at;
}

std::vector<Advice> advise(const State& state, const Scene& given, const Skill& skill, kernel::Isa isa,
                           const AdviceOptions& options) {
    check_game(state.game);
    if (state.over) throw std::invalid_argument("the game is over; there is no next shot");
    if (options.best == 0) throw std::invalid_argument("best is 0; ask for at least one shot");
    check_balls(state, given);
    Scene scene = completed(state, given);
    scene.stop = {};
    // The draws of the trials do not depend on the order of the balls in the scene.
    std::sort(scene.ball.begin(), scene.ball.end(),
              [](const BallStart& a, const BallStart& b) { return a.id < b.id; });
    Search search(state, scene, skill, isa, options);
    const bool in_hand = state.in_hand != InHand::kNo;
    std::vector<Attempt> best;
    if (state.opening)
        best.push_back(break_of(state, scene));
    else
        best = search.best();
    // A foul is advice only if there is no fair shot.
    const auto drop_fouls = [](auto& list, const auto& fouls) {
        if (!std::all_of(list.begin(), list.end(), fouls)) std::erase_if(list, fouls);
    };
    drop_fouls(best, [](const Attempt& a) { return a.fouls(); });
    std::vector<Attempt*> chosen;
    for (Attempt& candidate : best) {
        const bool like = std::any_of(chosen.begin(), chosen.end(), [&](const Attempt* other) {
            return other->kind == candidate.kind && other->ball == candidate.ball &&
                   other->pocket == candidate.pocket;
        });
        if (!like && chosen.size() < options.best) chosen.push_back(&candidate);
    }
    if (options.fresh > 0) {
        for (Attempt* candidate : chosen) candidate->tally = {};
        search.rate(chosen, options.fresh, Search::kFresh, true);
        std::stable_sort(chosen.begin(), chosen.end(), [](const Attempt* a, const Attempt* b) {
            return a->tally.mean() > b->tally.mean();
        });
        // Worths that differ less than this are alike [-]; the surest of these shots comes first.
        constexpr double kAlike = 0.025;
        const auto alike = std::find_if(chosen.begin(), chosen.end(), [&](const Attempt* a) {
            return a->tally.mean() < chosen.front()->tally.mean() - kAlike;
        });
        const auto surest = std::max_element(chosen.begin(), alike, [](const Attempt* a, const Attempt* b) {
            return a->tally.made < b->tally.made;
        });
        std::rotate(chosen.begin(), surest, surest + 1);
    }
    drop_fouls(chosen, [](const Attempt* a) { return a->fouls(); });
    if (chosen.front()->fouls()) chosen.resize(1);
    search.describe(chosen);
    std::vector<Advice> advice;
    advice.reserve(chosen.size());
    for (const Attempt* candidate : chosen)
        advice.push_back(advice_of(*candidate, scene, in_hand || state.opening,
                                   with_noise(candidate->cue, skill.noise, options.seed, advice.size())));
    return advice;
}

Scene scene_with(const Scene& scene, const Advice& advice) {
    Scene shot = scene;
    shot.cue = advice.cue;
    return advice.place ? placed(std::move(shot), *advice.place) : shot;
}

std::size_t choose(const Verdict& verdict, const Record& record, const Skill& skill) {
    std::size_t best = 0;
    double most = -1.0;
    Scene scene;
    scene.table = record.table;
    scene.balls = record.balls;
    const detail::Potting potting(scene, skill.noise.aim_deg / kDegrees);
    for (std::size_t i = 0; i < verdict.options.size(); ++i) {
        const Option& option = verdict.options[i];
        check_game(option.state.game);
        const double worth = potting.worth(option, record, verdict.chooser);
        if (worth > most) {
            most = worth;
            best = i;
        }
    }
    return best;
}

}  // namespace carom::games
