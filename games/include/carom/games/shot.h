// The facts of a shot that rules need: first contacts, cushions, and fallen balls. All come from the record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"

namespace carom::games {

/// A contact of a ball. The start of a lasting contact counts as one contact.
struct BallContact {
    double time = 0.0;  ///< [s]
    int ball = -1;
    int other = -1;  ///< the ball that it hit; -1 for a cushion or a jaw
    /// cushions: false if the ball was frozen to it from the start and had not left it
    bool driven = true;
    bool cushion() const { return other < 0; }
    bool operator==(const BallContact&) const = default;
};

/// Balls are indices into Record::tracks.
struct Shot {
    int struck = -1;  ///< the ball that the cue strikes
    /// the ball that it hits first; several if it hits them at once; empty for none
    std::vector<int> first_hits;
    double first_time = 0.0;  ///< [s] of that hit
    /// Every contact of a ball with a cushion or a jaw, and every contact of the struck ball with another
    /// ball
    std::vector<BallContact> touches;
    struct Fallen {
        int ball, pocket;
        bool operator==(const Fallen&) const = default;
    };
    std::vector<Fallen> pocketed;  ///< in the order in which they fell
    std::vector<int> out;          ///< balls that left the table

    bool fell(int ball) const;  ///< whether the ball fell into a pocket
    bool left(int ball) const;  ///< whether the ball left the table
    bool gone(int ball) const { return fell(ball) || left(ball); }
    /// Balls driven to a cushion after `time`: they hit one to which they were not frozen, fell, or left the
    /// table.
    std::vector<int> driven_after(double time) const;
};

/// Reads a record. @throws std::invalid_argument if it does not begin with a cue strike, or does not end at
/// rest
Shot shot_of(const Record& record);

/// Index of a ball, or -1.
inline int index_of(const Record& record, std::string_view id) {
    return carom::index_of(record.tracks, id);
}

/// The largest along * position of a ball until `time` [m]. @param along  a unit vector
double farthest(const Record& record, int ball, const Vec2& along, double time);

}  // namespace carom::games
