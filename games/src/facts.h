// What the rules of all games share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "carom/games/rules.h"
#include "carom/games/shot.h"

namespace carom::games::detail {

/// A shot with the names of its balls.
class Facts {
  public:
    Facts(const State& state, const Record& record, const Call& call);

    const State& state;
    const Record& record;
    const Call& call;
    Shot shot;

    const std::string& id(int ball) const { return record.tracks[static_cast<std::size_t>(ball)].id; }
    double radius(std::string_view ball) const { return record.size(index_of(record, ball)).R; }
    /// Where a ball rests.
    Vec2 rest(int ball) const { return planar(record.state_at(ball, record.duration).position); }
    Vec2 rest(std::string_view ball) const { return rest(index_of(record, ball)); }
    bool fell(std::string_view ball) const;
    bool left(std::string_view ball) const;
    bool gone(std::string_view ball) const { return fell(ball) || left(ball); }
    bool any_object_fell() const;  ///< any ball except the struck one
    int objects_off() const;       ///< balls that left the table, except the struck one
    int objects_driven() const;    ///< balls driven to a cushion, except the struck one
    /// Whether the call names this ball and the pocket that holds it.
    bool fell_as_called() const;
    bool struck(std::string_view ball) const { return id(shot.struck) == ball; }
    /// Whether one of the balls hit first is in the list: if two are hit at once, the shooter has the
    /// benefit.
    bool first_is_one_of(const std::vector<std::string>& ids) const;
    /// Of all balls that were on the table.
    std::vector<std::string> ids() const { return ids_of(record.tracks); }
    /// The balls that touch this one at a time.
    std::vector<std::string> touching(int ball, double time) const;
    /// Whether the cue ball, before it hits a ball, flies over any part of one; or over the one that it hits,
    /// and comes down on its far side.
    bool jumps() const;
    /// The balls that lie on the table at the end, except `left_out`. The cue ball keeps `cue_gap`, the
    /// others `gap` away.
    std::vector<Lying> lying(double cue_gap, double gap, const std::vector<std::string>& left_out = {}) const;

    /// Adds the fouls that all pool games share: cue ball lost, wrong ball first, no ball hit, no cushion,
    /// ball off the table, placement.
    void add_pool_fouls(std::vector<Foul>& fouls, const std::vector<std::string>& first,
                        bool need_cushion) const;

  private:
    void add_placement_fouls(std::vector<Foul>& fouls) const;
};

bool is_in(std::string_view ball, const std::vector<std::string>& list);
bool is_in(std::string_view ball, const std::vector<Respot>& respots);
/// The number of a numbered ball, or 0.
int number_of(std::string_view ball);
/// [-] Object balls that a break must drive to a cushion if nothing falls (WPA 2.3, 3.3).
inline constexpr int kDrivenOnBreak = 4;

/// A player's cue ball in three-cushion: player 0 has the white one.
inline const char* own_ball(int player) {
    return player == 0 ? "white" : "yellow";
}

/// The call of a player who knows what will fall: the first of the balls that count. Empty if none falls.
Call lucky_call(const State& state, const Record& record);

/// The state for the other player's turn, with the cue ball in hand as given.
State other_players(const State& state, InHand in_hand);
/// Ends a game.
State won_by(State state, int winner);
/// The verdict with a single option.
Verdict one_way(std::vector<Foul> fouls, const Option& option);

Legal legal_eight_ball(const State& state, const std::vector<std::string>& balls);
Legal legal_nine_ball(const State& state, const std::vector<std::string>& balls);
Legal legal_three_cushion(const State& state, const std::vector<std::string>& balls);
Legal legal_snooker(const State& state, const std::vector<std::string>& balls);
Legal legal_sum_to_three(const State& state, const std::vector<std::string>& balls);
Verdict judge_eight_ball(const Facts& facts);
Verdict judge_nine_ball(const Facts& facts);
Verdict judge_three_cushion(const Facts& facts);
Verdict judge_snooker(const Facts& facts);
Verdict judge_sum_to_three(const Facts& facts);

}  // namespace carom::games::detail
