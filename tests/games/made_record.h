// Records made for a rule: balls at given places, and events added one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"

namespace carom::games {

/// A verdict's fouls, without their rules.
inline bool operator==(const std::vector<CalledFoul>& called, const std::vector<Foul>& fouls) {
    return std::equal(called.begin(), called.end(), fouls.begin(), fouls.end(),
                      [](const CalledFoul& one, Foul other) { return one.foul == other; });
}

}  // namespace carom::games

namespace carom::test {

/// The place of a game in the list of all games.
inline std::size_t number_of(games::Game game) {
    const auto all = games::all_of(game);
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), game) - all.begin());
}

/// A shot in a referee's words. Every call adds an event, a tenth of a second after the previous one.
class Told {
  public:
    explicit Told(const std::string& table = "nine_foot") {
        record_.table = make_table(table);
        record_.balls = make_ball_params(table == "snooker" ? "snooker"
                                         : table == "carom" ? "carom"
                                                            : "pool");
    }

    Told& ball(const std::string& id, double x, double y) {
        const Segment rest = still({x, y, record_.balls.R}, MotionState::kStationary);
        record_.tracks.push_back({.id = id, .segments = {rest}});
        return *this;
    }
    /// Balls in a row that block none.
    Told& balls(const std::vector<std::string>& ids) {
        for (const std::string& id : ids) {
            const std::div_t at_row = std::div(static_cast<int>(record_.tracks.size()), 15);
            ball(id, 0.1 + 0.07 * at_row.rem, 1.3 + 0.1 * at_row.quot);
        }
        return *this;
    }
    Told& strike(const std::string& id) { return add(EventType::kCueStrike, at(id), -1); }
    Told& hit(const std::string& a, const std::string& b) { return add(EventType::kBallBall, at(a), at(b)); }
    Told& hit_both(const std::string& a, const std::string& b, const std::string& c) {
        hit(a, b);
        record_.events.push_back(record_.events.back());
        record_.events.back().b = at(c);
        return *this;
    }
    Told& cushion(const std::string& id, int part = 2) {
        const Cushion& c = record_.table.cushions[static_cast<std::size_t>(part)];
        const Vec2 middle = (c.from + c.to) / 2.0;
        add(EventType::kBallCushion, at(id), part);
        // The ball has arrived there; its radius does not matter to the rules.
        move(at(id), {middle.x(), middle.y(), record_.balls.R}, MotionState::kStationary);
        return *this;
    }
    Told& pocket(const std::string& id, const std::string& pocket = "p1") {
        const int part = std::stoi(pocket.substr(1)) - 1;
        add(EventType::kBallPocket, at(id), part);
        const Pocket& p = record_.table.pockets[static_cast<std::size_t>(part)];
        move(at(id), {p.center.x(), p.center.y(), -p.depth}, MotionState::kPocketed);
        record_.tracks[static_cast<std::size_t>(at(id))].pocket = part;
        return *this;
    }
    Told& out(const std::string& id) {
        add(EventType::kBallOut, at(id), -1);
        move(at(id), {-1.0, -1.0, 0.5}, MotionState::kOut);
        return *this;
    }
    Told& rests(const std::string& id, double x, double y) {
        add(EventType::kRollStop, at(id), -1);
        move(at(id), {x, y, record_.balls.R}, MotionState::kStationary);
        return *this;
    }
    /// The ball's place before the next event.
    Told& passes(const std::string& id, double x, double y) {
        time_ += 0.1;
        move(at(id), {x, y, record_.balls.R}, MotionState::kStationary);
        return *this;
    }

    Record record() const {
        Record done = record_;
        done.duration = time_ + 0.1;
        done.stopped = StopReason::kAtRest;
        return done;
    }

  private:
    int at(const std::string& id) const { return games::index_of(record_, id); }
    Told& add(EventType type, int a, int b) {
        time_ += 0.1;
        record_.events.push_back({time_, type, a, b, -1});
        return *this;
    }
    Segment still(const Vec3& place, MotionState state) const {
        Segment segment;
        segment.start = time_;
        segment.r = place;
        segment.v = segment.w = Vec3::Zero();
        segment.a = segment.dw = Vec2::Zero();
        segment.state = state;
        segment.duration = std::numeric_limits<double>::infinity();
        return segment;
    }
    void move(int ball, const Vec3& to, MotionState state) {
        record_.tracks[static_cast<std::size_t>(ball)].segments.push_back(still(to, state));
    }

    Record record_;
    double time_ = 0.0;
};

/// "9", "10", ...
inline std::vector<std::string> numbered(int from, int to) {
    std::vector<std::string> ids;
    for (int n = from; n <= to; ++n) ids.push_back(std::to_string(n));
    return ids;
}

inline std::vector<games::Decision> decisions(const games::Verdict& verdict) {
    std::vector<games::Decision> list;
    for (const games::Option& option : verdict.options) list.push_back(option.decision);
    return list;
}

}  // namespace carom::test
