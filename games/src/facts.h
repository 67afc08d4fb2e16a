// Shared by the rules of all games.
#pragma once

#include <cstdint>
#include <span>
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
    double radius(std::string_view ball) const {
        const int index = index_of(record, ball);
        return index < 0 ? record.balls.R : record.size(index).R;
    }
    /// Where a ball rests.
    Vec2 rest(int ball) const { return planar(record.state_at(ball, record.duration).position); }
    Vec2 rest(std::string_view ball) const { return rest(index_of(record, ball)); }
    bool fell(std::string_view ball) const;
    bool left(std::string_view ball) const;
    bool gone(std::string_view ball) const { return fell(ball) || left(ball); }
    bool any_object_fell() const;  ///< any ball except the struck one
    int objects_off() const;       ///< balls that left the table, except the struck one
    int objects_fallen() const;    ///< balls that fell, except the struck one
    int objects_driven() const;    ///< balls driven to a cushion, except the struck one
    /// Whether the call names this ball and the pocket that holds it.
    bool fell_as_called() const;
    bool struck(std::string_view ball) const { return id(shot.struck) == ball; }
    /// Whether one of the balls hit first is in the list: of two hit at once, the better one counts for the
    /// shooter.
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
    /// Adds the fouls of a cue ball in hand: placed outside, a ball behind the head string first.
    void add_placement_fouls(std::vector<Foul>& fouls) const;
};

bool is_in(std::string_view ball, const std::vector<std::string>& list);
/// Whether a ball at y may only be hit after the cue ball has crossed the head string. @param string  its y
inline bool is_behind_string(const State& state, double string, double y) {
    return state.in_hand == InHand::kHeadString && y < string;
}
/// The rules of the next shot. @param behind  ids of the balls behind the head string, by is_behind_string():
/// none may be hit first, unless no other ball may be
Legal legal(const State& state, const std::vector<std::string>& balls,
            const std::vector<std::string>& behind);
bool is_in(std::string_view ball, const std::vector<Respot>& respots);
/// Whether a ball that fell was driven to a rail far from the pocket, not only to a rail, facing or jaw at
/// its mouth.
bool is_bank(const Record& record, const Shot& shot, const Shot::Fallen& fallen);
/// The number of a numbered ball, or 0.
int number_of(std::string_view ball);
/// [-] Object balls that a break must drive to a cushion if nothing falls (WPA 2.3, 3.3).
inline constexpr int kDrivenOnBreak = 4;

/// A player's cue ball in carom games: player 0 has the white one.
inline const char* own_ball(int player) {
    return player == 0 ? "white" : "yellow";
}

/// The chosen value of an option that the state's game has.
std::string_view rule(const State& state, std::string_view key);

/// The state for the other player's turn, with the cue ball in hand as given.
State other_players(const State& state, InHand in_hand);
/// Ends a game.
State won_by(State state, int winner);
/// Gives points to a player, and ends the game at its target.
State scored(State state, int player, int points);
/// The state of a new break in the same game, by its rules.
State broken_by(const State& state, int breaker);
/// The fouls of a verdict; judge() adds their rules.
std::vector<CalledFoul> called(const std::vector<Foul>& fouls);
/// The verdict with a single option.
Verdict one_way(const std::vector<Foul>& fouls, const Option& option);
/// These balls, each spotted on the long string from the foot spot (WPA 1.4).
std::vector<Respot> on_foot_spot(const Facts& facts, const std::vector<std::string>& balls);

// Rotation games: nine-ball, ten-ball.
/// The ball with the lowest number; none on an empty table.
std::vector<std::string> lowest(const std::vector<std::string>& balls);
/// The state after a shot that is no foul and passes no turn.
State after_break(const State& state);
/// The last ball, spotted if it is gone.
std::vector<Respot> last_ball_back(const Facts& facts, const std::string& last);
/// A foul: the cue ball is in hand, and the third in a row loses (WPA 6.14).
Verdict rotation_foul(const Facts& facts, std::vector<Foul> fouls, State next, const std::string& last);
/// The fouls of a shot that is not a push out, and of a break.
std::vector<Foul> rotation_fouls(const Facts& facts, bool push);
/// The other player's choice after a push out (WPA 2.4, 9.4), or after a ball that does not count (9.7).
Verdict shoot_or_pass_back(const State& next, const std::vector<Respot>& respots);

/// A ball of a start, by fractions of the table's width and length.
struct Placed {
    const char* id;
    double x, y;
};
/// A start as in GameInfo: a rack, unless it is empty, placed balls, and a strike.
std::string start_of(std::string_view rack, const std::vector<Placed>& balls, std::string_view struck,
                     double speed, double aim_deg);

}  // namespace carom::games::detail

namespace carom::games {

/// The rule that a foul breaks.
struct FoulRule {
    Foul foul;
    const char* rule;
};

/// A game's row: its description and its rules.
struct GameRules {
    enum class Struck : std::uint8_t { kCueBall, kOwn, kAny };
    GameInfo info;
    Legal (*legal)(const State& state, const std::vector<std::string>& balls);
    Verdict (*judge)(const detail::Facts& facts);
    InHand start = InHand::kNo;             ///< where the cue ball starts
    std::vector<std::string_view> balls{};  ///< required balls
    std::span<const FoulRule> fouls{};
    Struck struck = Struck::kCueBall;
    bool below_zero = false;                             ///< whether points may be
    const char* break_rule = "";                         ///< of Foul::kFewCushionsOnBreak
    std::string (*words)(const State& state) = nullptr;  ///< more about the next shot
};

/// The rules that all games of pool share.
extern const std::span<const FoulRule> kPoolFouls;

}  // namespace carom::games
