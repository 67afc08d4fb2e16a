// The search for a shot: candidates by geometry and by blindly played aims, then successive halving with
// common random numbers.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/games/player.h"
#include "player/lie.h"

namespace carom::games::detail {

/// The results of a candidate's shots so far.
struct Tally {
    std::size_t shots = 0, made = 0, fouls = 0;
    std::size_t passed = 0;              ///< shots after which the opponent shoots
    double worth = 0.0, opponent = 0.0;  ///< sums of the chances to win, and of the opponent's surest pots
    std::array<int, kNumbers> leaves{};  ///< how often each ball was left as the surest pot
    double mean_opponent() const { return passed > 0 ? opponent / static_cast<double>(passed) : 0.0; }
    double mean() const { return shots > 0 ? worth / static_cast<double>(shots) : 0.0; }
};

struct Attempt {
    Cue cue;
    Vec2 place = Vec2::Zero();  ///< of the cue ball
    Call call;
    ShotKind kind = ShotKind::kPot;
    int ball = 0, pocket = -1;  ///< number of the potted ball, index of its pocket; 0, -1: none
    double cut_deg = 0.0;
    /// Of the shot without errors, in words: the spin at the first contact; the rails of a bank or kick; the
    /// place where the cue ball rests, and its next ball.
    std::string spin, rails, rest;
    Tally tally;
    /// Whether more than half of its shots are fouls.
    bool fouls() const { return 2 * tally.fouls > tally.shots; }
};

class Search {
  public:
    /// @param scene  with the cue ball, and a cue
    Search(const State& state, Scene scene, const Skill& skill, kernel::Isa isa,
           const AdviceOptions& options);

    /// The candidates that reached the last round, the best first; at least one.
    std::vector<Attempt> best();
    /// Plays more shots of some candidates. @param first  number of the first draw of errors
    /// @param closer  as in result()
    void rate(std::span<Attempt* const> candidates, std::size_t shots, std::size_t first,
              bool closer = false) const;
    /// Plays the shots without errors, and describes them.
    void describe(std::span<Attempt* const> candidates) const;
    /// Number of draws that best() may use; later ones are fresh.
    static constexpr std::size_t kFresh = 1000;

  private:
    /// The worth of one shot to the player.
    struct Result {
        double worth = 0.0;
        bool made = false, foul = true, passed = false;
        int leaves = 0;         ///< number of a ball, or 0
        double opponent = 0.0;  ///< chance of the opponent's surest pot
    };
    /// A direct pot with one tip and speed, whose aim is corrected by playing it.
    struct Line;

    using Judge = std::function<void(std::size_t, const Record&)>;
    /// @param tables  shot i is played on table i modulo their number; empty: on the scene's
    void play(std::span<const Cue> cues, std::span<const Vec2> places, const Judge& judge,
              const std::vector<Scene>& tables = {}) const;
    /// The option that is best for the player who chooses, and the chance to win of the one who shoots.
    std::pair<const Option*, double> chosen(const Verdict& verdict, const Record& record) const;
    /// @param closer  whether to also find Result::leaves, and the chance to win instead of the measure of
    /// the skill
    Result result(const Record& record, const Call& call, bool closer = false) const;
    std::vector<Attempt> candidates() const;
    void lift(Attempt& candidate) const;
    std::vector<Attempt> pots(std::span<const Vec2> places) const;
    void correct(std::vector<Line>& lines) const;
    std::vector<Attempt> sweep(const Vec2& place) const;
    std::vector<Vec2> places() const;
    bool may_lie(const Vec2& place) const;
    std::vector<Attempt*> kept(std::vector<Attempt*> alive, std::size_t keep) const;

    State state_;
    Scene scene_;
    Skill skill_;
    kernel::Isa isa_;
    const AdviceOptions& options_;
    Potting potting_;
    Lie lie_;
    Numbers targets_, first_;
    std::size_t cue_ball_;
    bool in_hand_;
    bool calls_ = false;  ///< whether the game has calls
};

}  // namespace carom::games::detail
