// Finds the ball whose next event is first: a tournament over all balls with the winner at the root. A ball whose
// event changed replays only its own log2 n matches. All memory is allocated by set_up().
#pragma once

#include <vector>

namespace carom {

class EventQueue {
  public:
    /// Starts with `count` players; update() must be called once for each of them before first() is valid.
    void set_up(int count) {
        leaves_ = 1;
        while (leaves_ < count) leaves_ *= 2;
        winner_.assign(2 * static_cast<std::size_t>(leaves_), -1);
        for (int i = 0; i < count; ++i)
            winner_[static_cast<std::size_t>(leaves_) + static_cast<std::size_t>(i)] = i;
    }

    /// Replays the matches of player i. earlier(x, y): whether x is before y; a strict weak order.
    template <class Earlier>
    void update(int i, Earlier earlier) {
        for (std::size_t node = static_cast<std::size_t>(leaves_ + i) / 2; node > 0; node /= 2) {
            const int left = winner_[2 * node], right = winner_[2 * node + 1];
            const int winner = left < 0 || (right >= 0 && earlier(right, left)) ? right : left;
            // The result of this match, and hence of all matches above, is unchanged.
            if (winner == winner_[node] && winner != i) return;
            winner_[node] = winner;
        }
    }

    /// The winner; -1 if there are no players.
    int first() const { return winner_[1]; }

    /// Calls found(player) for the winner and all players for whom as_early(player) holds, if that order agrees with the one
    /// of the matches: a player who is later than another one has lost to him.
    template <class AsEarly, class Found>
    void first_ones(AsEarly as_early, Found found) const {
        ties_below(1, as_early, found);
    }

  private:
    template <class AsEarly, class Found>
    void ties_below(std::size_t node, AsEarly as_early, Found found) const {
        const int winner = winner_[node];
        if (winner < 0 || !as_early(winner)) return;
        if (node >= static_cast<std::size_t>(leaves_)) {
            found(winner);
            return;
        }
        ties_below(2 * node, as_early, found);
        ties_below(2 * node + 1, as_early, found);
    }

    int leaves_ = 1;
    std::vector<int> winner_;  // of the match at each node; the leaves follow the inner nodes
};

}  // namespace carom
