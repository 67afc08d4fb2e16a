#include "carom/games/judge_many.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "facts.h"

namespace carom::games {

Call lucky_call(const State& state, const Record& record) {
    const auto falls = [](const Event& event) { return event.type == EventType::kBallPocket; };
    if (std::none_of(record.events.begin(), record.events.end(), falls)) return {};
    const std::vector<std::string> callable = legal(state, ids_of(record.tracks)).callable;
    for (const Event& event : record.events) {
        if (!falls(event)) continue;
        const std::string& ball = record.tracks[static_cast<std::size_t>(event.a)].id;
        if (detail::is_in(ball, callable))
            return {.ball = ball, .pocket = record.table.pockets[static_cast<std::size_t>(event.b)].id};
    }
    return {};
}

namespace {

/// Judges a shot into its row of the arrays. @param base the scene with all balls; the shot may lack some of
/// them
void judge_row(Game game, const Scene& base, std::size_t row, const Outcome& outcome, const Record& record,
               const JudgedArrays& to) {
    const State before = state_of_turn(game, static_cast<Group>(to.group[row]));
    const Verdict verdict = judge(before, record, lucky_call(before, record));
    const State& next = verdict.next();
    to.foul[row] = verdict.fouls.empty() ? -1 : static_cast<int>(verdict.fouls.front().foul);
    // In a game of one player, a passed turn is the end, and the other player's choices are not made.
    to.goes_on[row] = !next.over && next.turn == 0;
    to.group[row] = static_cast<int>(next.group[0]);
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    double* place = to.xy + row * base.ball.size() * 2;
    int fallen = 0;
    std::size_t track = 0;  // tracks of the record are in the order of the scene
    for (const BallStart& ball : base.ball) {
        double &x = *place++, &y = *place++;
        x = y = kNowhere;
        const bool there = track < record.tracks.size() && record.tracks[track].id == ball.id;
        const BallOutcome* end = there ? &outcome.balls[track++] : nullptr;
        if (end != nullptr && end->pocket == -1) {
            x = end->position.x();
            y = end->position.y();
        }
        fallen += end != nullptr && end->pocket >= 0 && ball.id != base.cue->ball;
        for (const Respot& back : verdict.respots()) {
            if (back.ball != ball.id) continue;
            x = back.place.x();
            y = back.place.y();
        }
    }
    to.points[row] = game->info.is_scored ? verdict.points : verdict.fouls.empty() ? fallen : 0;
}

}  // namespace

State state_of_turn(Game game, Group group) {
    State state = new_game(game);
    state.opening = false;
    state.in_hand = InHand::kNo;
    state.group[0] = group;
    if (group == Group::kSolids) state.group[1] = Group::kStripes;
    if (group == Group::kStripes) state.group[1] = Group::kSolids;
    return state;
}

std::vector<Batch::Message> judge_many(Game game, const Scene& scene, std::size_t shots,
                                       std::span<const BatchColumn> columns, kernel::Isa isa,
                                       const BatchOptions& options, const BatchArrays& out,
                                       const JudgedArrays& judged) {
    BatchOptions judging = options;
    judging.judge = [&](std::size_t row, const Outcome& outcome, const Record& record) {
        if (outcome.stopped == StopReason::kAtRest) judge_row(game, scene, row, outcome, record, judged);
    };
    return simulate_many(scene, shots, columns, isa, judging, out);
}

}  // namespace carom::games
