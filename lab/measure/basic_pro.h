// The recipe of BasicAgentPro, the opponent of the course AI3603 (SJTU-RL2/AI3603-Billiards, commit 74e09d9,
// agents/basic_agent_pro.py), rewritten from its description: ghost ball to every pocket, four variants, 30
// of them at random, 50 noisy shots by upper confidence bounds; the resulting position is not examined.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "carom/games/shot.h"
#include "facts.h"
#include "player/lie.h"
#include "support/player_racks.h"

namespace carom::lab {

/// Its value of a shot, from -500 to 150.
inline double basic_pro_reward(const games::State& state, const Record& record, games::detail::Numbers own) {
    using games::Foul;
    const games::Shot shot = games::shot_of(record);
    const auto gone = [&](const char* id) { return shot.fell(games::index_of(record, id)); };
    const bool cue = gone("cue"), eight = gone("8"), own_eight = own == games::detail::only(8);
    double reward = cue && eight ? -500.0 : cue ? -100.0 : eight ? (own_eight ? 150.0 : -500.0) : 0.0;
    for (const games::Shot::Fallen& fallen : shot.pocketed) {
        const int number = games::detail::number_of(record.tracks[static_cast<std::size_t>(fallen.ball)].id);
        if (number == 0 || number == 8) continue;
        reward += (own & games::detail::only(number)) != 0 ? 50.0 : -20.0;
    }
    const std::vector<games::CalledFoul> fouls = games::judge(state, record).fouls;
    const auto is = [&](Foul foul) {
        return std::any_of(fouls.begin(), fouls.end(),
                           [&](const auto& called) { return called.foul == foul; });
    };
    const bool wrong = is(Foul::kWrongBallFirst) || is(Foul::kNoBallHit), no_rail = is(Foul::kNoCushion);
    if (wrong) reward -= 30.0;
    if (no_rail) reward -= 30.0;
    return reward == 0.0 && !cue && !eight && !wrong && !no_rail ? 10.0 : reward;
}

/// carom/games/player.h places its ball in hand.
inline games::Advice basic_pro(const games::State& state, const Scene& table, std::uint64_t seed) {
    constexpr games::Noise kSimulated{0.1, 0.15, 0.1, 0.005, 0.005};
    constexpr std::size_t kActions = 30, kShots = 50;
    const games::Skill looks{kSimulated, games::Look::kPot};
    games::AdviceOptions options;
    options.seed = seed;
    options.best = 1;
    options.fresh = state.opening ? 1 : 0;
    games::Advice advice = games::advise(state, table, looks, kernel::best_isa(), options).front();
    if (state.opening) return advice;
    const Scene scene = games::scene_with(table, advice);
    const games::detail::Lie lie = games::detail::lie_of(scene);
    const games::detail::Numbers own = games::detail::targets(state, lie);
    std::vector<games::Advice> actions;
    for (const games::detail::Lie::Ball& ball : lie.balls) {
        if ((own & games::detail::only(ball.number)) == 0) continue;
        for (const Pocket& pocket : scene.table.pockets) {
            const Vec2 way = pocket.center - ball.place,
                       aim = ball.place - 2.0 * scene.balls.R * way / length(way) - *lie.cue;
            const double speed = std::clamp(1.5 + 1.5 * length(aim), 1.0, 6.0);
            const std::array<std::pair<double, double>, 4> variants = {
                {{speed, 0.0}, {std::min(speed + 1.5, 7.5), 0.0}, {speed, 0.5}, {speed, -0.5}}};
            for (const auto& [fast, turned] : variants) {
                games::Advice action = advice;
                action.cue.speed = fast;
                action.cue.aim_deg = carom::direction_deg(aim.x(), aim.y()) + turned;
                action.cue.elevation_deg = action.cue.side = action.cue.height = 0.0;
                action.ball = action.call.ball = std::to_string(ball.number);
                action.pocket = action.call.pocket = pocket.id;
                action.call.safety = false;
                actions.push_back(action);
            }
        }
    }
    SplitMix64 random = draws_of(seed, 0, "basic pro");
    for (std::size_t i = actions.size(); i > 1; --i) std::swap(actions[i - 1], actions[random.below(i)]);
    if (actions.size() > kActions) actions.resize(kActions);
    std::vector<double> counts(actions.size(), 0.0), sums(actions.size(), 0.0);
    for (std::size_t n = 0; n < std::max(kShots, actions.size()); ++n) {
        std::size_t next = n;
        if (n >= actions.size()) {
            const auto bound = [&](std::size_t i) {
                return sums[i] / counts[i] +
                       1.414 * std::sqrt(std::log(static_cast<double>(n) + 1.0) / counts[i]);
            };
            next = 0;
            for (std::size_t i = 1; i < actions.size(); ++i)
                if (bound(i) > bound(next)) next = i;
        }
        Scene shot = scene;
        shot.cue = games::with_noise(actions[next].cue, kSimulated, seed, n);
        const Record record = simulate(make_plan(shot, kernel::best_isa()));
        sums[next] += std::clamp((basic_pro_reward(state, record, own) + 500.0) / 650.0, 0.0, 1.0);
        counts[next] += 1.0;
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < actions.size(); ++i)
        if (sums[i] / counts[i] > sums[best] / counts[best]) best = i;
    advice.cue = actions[best].cue;
    advice.call = actions[best].call;
    advice.ball = actions[best].ball;
    advice.pocket = actions[best].pocket;
    advice.makes = {};
    return advice;
}

}  // namespace carom::lab
