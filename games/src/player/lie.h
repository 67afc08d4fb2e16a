// The positions of the balls, the pots they leave, and the value of a position for a player.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "carom/games/rules.h"

namespace carom::games::detail {

/// A set of numbered balls: bit n is ball n.
using Numbers = std::uint32_t;
constexpr Numbers only(int number) {
    return Numbers{1} << number;
}
inline constexpr int kNumbers = 16;

/// The balls on the table.
struct Lie {
    struct Ball {
        int number;
        Vec2 place;
    };
    std::vector<Ball> balls;  ///< except the cue ball
    std::optional<Vec2> cue;
    double string = 0.0;  ///< y of the head string [m]
};
Lie lie_of(const Scene& scene);
/// The position after a shot, with the balls that an option of its verdict respots.
Lie lie_of(const Record& record, const Option& option);

/// The balls that the player to shoot may hit first and pot directly, by the rule of legal().
Numbers targets(const State& state, const Lie& lie);

/// A direct pot: the cue ball goes straight to the ghost ball, and the object ball straight into a pocket.
struct Pot {
    int ball;  ///< number
    int pocket;
    Vec2 ghost, towards;
    double distance;  ///< [m] from the cue ball to the ghost ball
    double straight;  ///< cosine of the cut
    double chance;    ///< [-] estimated
};

/// Geometry of one table for a player with given errors.
class Potting {
  public:
    /// @param sd_aim standard deviation of the cue ball's direction [rad]
    Potting(const Scene& scene, double sd_aim);

    /// Direct pots of these balls with at least this chance; nothing without a cue ball.
    std::vector<Pot> pots(const Lie& lie, Numbers balls, double least) const;
    struct Chance {
        double now = 0.0;    ///< of the best pot from where the cue ball lies
        double ideal = 0.0;  ///< of the best pot from a good place of the cue ball
    };
    /// By number. @param now  the balls whose Chance::now is needed @param in_order  whether lower balls are
    /// potted first
    std::array<Chance, kNumbers> chances(const Lie& lie, Numbers now, bool in_order = false) const;
    /// The features of a position, for the player whose turn it is.
    static constexpr std::size_t kFeatures = 6;
    std::array<double, kFeatures> features(const State& state, const Lie& lie) const;
    /// [-] The chance of the player whose turn it is to win: a logistic function of the features.
    double value(const State& state, const Lie& lie) const;
    /// The chance of a player to win [-] after an option of a shot: 0.5 in a new rack.
    double worth(const Option& option, const Record& record, int player) const;
    /// The number of the ball with the surest pot for the player to shoot, and its chance; 0: none.
    std::pair<int, double> surest(const State& state, const Lie& lie) const;
    /// Whether the cue ball fits there between the noses.
    bool inside(const Vec2& place) const;
    /// [m] Distance of the centres of the cue ball and an object ball in contact.
    double both() const { return both_; }

  private:
    /// The paths of a ball between the jaws of a pocket.
    struct Path {
        Vec2 towards, end;
        double width = 0.0;  ///< [rad]; 0: none
    };
    Path path(int pocket, const Vec2& from) const;
    double chance(double distance, double straight, double width) const;
    bool clear(const Lie& lie, int number, const Vec2& from, const Vec2& to, double apart,
               Numbers without = 0) const;
    /// Whether the cue ball has a clear path to the ghost ball from one of three good places.
    bool reachable(const Lie& lie, int number, const Vec2& ghost, const Vec2& towards, Numbers without) const;

    struct Mouth {
        bool there = false;
        Vec2 left, right;  ///< as seen from the table
        double left_reach = 0.0, right_reach = 0.0;
    };
    std::vector<Mouth> mouths_;
    Rectangle noses_;
    double R_, both_, sd_aim_;
};

}  // namespace carom::games::detail
