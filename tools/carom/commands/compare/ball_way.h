// The path of one ball through a shot.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/vec.h"

namespace carom::tools {

/// The position of a ball at any time, until it leaves play. A pocketed ball is at the bottom of its pocket
/// at once.
class BallWay {
  public:
    BallWay(const Record& record, int ball) : record_(record), ball_(ball), last_(record.duration) {
        for (const Segment& s : segments())
            if (is_gone(s.state)) last_ = std::min(last_, std::nextafter(s.start, 0.0));
    }

    Vec3 at(double t) const { return record_.state_at(ball_, std::min(t, last_)).position; }
    /// [s] The position no longer changes after this.
    double last() const { return last_; }
    const std::vector<Segment>& segments() const { return record_.tracks[ball_].segments; }

  private:
    const Record& record_;
    int ball_;
    double last_;
};

}  // namespace carom::tools
