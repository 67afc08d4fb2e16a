#include "support/natural_shots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "carom/engine/ball_ball.h"
#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/engine/table.h"
#include "reference/random_impacts.h"
#include "scene/rack.h"
#include "support/families.h"

namespace carom::test {
namespace {

/// A table with balls and one shot.
class Shot {
  public:
    Shot(std::uint64_t seed, const char* table, const char* balls) : rng_(seed) {
        scene_.file = "(shot)";
        scene_.table = make_table(table);
        use_balls(scene_, balls);
    }

    Scene take() { return std::move(scene_); }
    double R() const { return scene_.balls.R; }
    double uniform(double lo, double hi) { return rng_.uniform(lo, hi); }
    bool chance(double p) { return uniform(0.0, 1.0) < p; }
    int whole(int from, int to) {
        return std::min(to, from + static_cast<int>(uniform(0.0, static_cast<double>(to - from + 1))));
    }

    bool fits(const Vec2& r) const {
        const Table& t = scene_.table;
        if (r.x() < R() || r.y() < R() || r.x() > t.width - R() || r.y() > t.length - R()) return false;
        for (const BallStart& b : scene_.ball)
            if ((planar(b.position) - r).norm() < 2.0 * R() - 1e-14) return false;
        for (const Cushion& c : t.cushions)
            if (distance_to_segment(r, c.from, c.to) < R() - 1e-14) return false;
        for (const Jaw& j : t.jaws)
            if ((j.center - r).norm() < R() + j.radius - 1e-14) return false;
        return std::none_of(t.pockets.begin(), t.pockets.end(),
                            [&](const Pocket& p) { return (p.center - r).norm() < p.radius; });
    }
    bool place(const std::string& id, const Vec2& r) {
        if (!fits(r)) return false;
        BallStart ball;
        ball.id = id;
        ball.position = {r.x(), r.y(), R()};
        scene_.ball.push_back(ball);
        return true;
    }
    Vec2 anywhere() {
        const double x = uniform(R(), scene_.table.width - R());
        const double y = uniform(R(), scene_.table.length - R());
        return {x, y};
    }
    void scatter(const std::string& id) {
        for (int tries = 0; tries < 200; ++tries)
            if (place(id, anywhere())) return;
    }
    /// Places the ball against a rail, a ball, or both, at random.
    void freeze(const std::string& id) {
        for (int tries = 0; tries < 200; ++tries) {
            Vec2 r = anywhere();
            const int kind = whole(0, 4);
            if (kind == 0) r.x() = R();
            if (kind == 1) r.x() = scene_.table.width - R();
            if (kind == 2) r.y() = R();
            if (kind >= 3 && !scene_.ball.empty()) {
                const int to = whole(0, static_cast<int>(scene_.ball.size()) - 1);
                const SinCos a = sin_cos(uniform(0.0, 2.0 * std::numbers::pi));
                r = planar(scene_.ball[static_cast<std::size_t>(to)].position) +
                    2.0 * R() * Vec2(a.cos, a.sin);
            }
            if (place(id, r)) return;
        }
    }
    /// A rack in which each ball stays with probability `stays`; the others are scattered.
    void rack(RackGame game, double gap, double stays) {
        Rack rack;
        rack.game = game;
        rack.gap = gap;
        for (const RackedBall& b : make_rack(rack, scene_.table, R())) {
            if (chance(stays))
                place(b.id, b.position);
            else
                scatter(b.id);
        }
    }
    /// Strikes the cue ball roughly at a ball.
    void strike(int target, double fastest) {
        const Vec2 cue = planar(scene_.ball.back().position);
        const Vec2 way = planar(scene_.ball[static_cast<std::size_t>(target)].position) - cue;
        const double off = std::min(1.0, 2.2 * R() / way.norm());
        Cue c;
        c.ball = scene_.ball.back().id;
        c.aim_deg = std::atan2(way.y(), way.x()) * 180.0 / std::numbers::pi + uniform(-off, off) * 57.0;
        c.speed = 0.5 + (fastest - 0.5) * uniform(0.0, 1.0) * uniform(0.0, 1.0);
        c.side = uniform(-0.3, 0.3);
        c.height = uniform(-0.3, 0.3);
        scene_.cue = c;
    }
    /// The cue of the last strike(), and the physics, for changes.
    Cue& cue() { return *scene_.cue; }
    Physics& physics() { return scene_.physics; }
    int balls() const { return static_cast<int>(scene_.ball.size()); }
    bool touch_with_cue(int ball) {
        const SinCos a = sin_cos(uniform(0.0, 2.0 * std::numbers::pi));
        return place("cue", planar(scene_.ball[static_cast<std::size_t>(ball)].position) +
                                2.0 * R() * Vec2(a.cos, a.sin));
    }

  private:
    reference::Generator rng_;
    Scene scene_;
};

Scene pool(std::uint64_t seed, bool frozen) {
    Shot shot(seed, seed % 2 == 0 ? "nine_foot" : "seven_foot", "pool");
    const int balls = shot.whole(3, 15), fixed = frozen ? shot.whole(1, 5) : 0;
    for (int i = 1; i <= balls; ++i) {
        if (i > balls - fixed)
            shot.freeze(std::to_string(i));
        else
            shot.scatter(std::to_string(i));
    }
    shot.scatter("cue");
    shot.strike(shot.whole(0, shot.balls() - 2), 6.0);
    return shot.take();
}

Scene snooker(std::uint64_t seed, bool frozen) {
    Shot shot(seed, "snooker", "snooker");
    shot.rack(RackGame::kSnooker, frozen ? 0.0 : 1e-4, 0.6);
    for (int i = 0; frozen && i < 3; ++i) shot.freeze("f" + std::to_string(i));
    shot.scatter("cue");
    shot.strike(shot.whole(0, 14), 5.0);
    return shot.take();
}

// The cue ball touches a ball of the pack, is in a hole of it, or comes from outside.
Scene touching_pack(std::uint64_t seed) {
    Shot shot(seed, "snooker", "snooker");
    shot.rack(RackGame::kSnooker, 0.0, 0.85);
    const bool touches = shot.chance(0.6);
    bool placed = false;
    for (int tries = 0; touches && !placed && tries < 100; ++tries)
        placed = shot.touch_with_cue(shot.whole(0, 14));
    if (!placed) shot.scatter("cue");
    shot.strike(shot.whole(0, 14), 6.0);
    return shot.take();
}

Scene eight_ball_break(std::uint64_t seed) {
    Shot shot(seed, "nine_foot", "pool");
    constexpr double kGaps[] = {0.0, 1e-6, 5e-5, 1e-4};
    shot.rack(RackGame::kEightBall, kGaps[shot.whole(0, 3)], 1.0);
    shot.place("cue", {0.635 + shot.uniform(-0.3, 0.3), 0.5});
    shot.strike(0, 10.0);
    return shot.take();
}

// A break struck slightly from above, as people do: the cue ball hops before it reaches the rack.
Scene raised_break(std::uint64_t seed) {
    constexpr RackGame kGames[] = {RackGame::kEightBall, RackGame::kNineBall, RackGame::kTenBall,
                                   RackGame::kSnooker};
    const RackGame game = kGames[seed % 4];
    const bool snooker = game == RackGame::kSnooker;
    Shot shot(seed, snooker ? "snooker" : "nine_foot", snooker ? "snooker" : "pool");
    const double gap = shot.chance(0.3) ? 0.0 : shot.chance(0.5) ? 1e-4 : shot.uniform(0.0, 1e-3);
    shot.rack(game, gap, 1.0);
    const double middle = snooker ? 0.889 : 0.635;
    for (bool placed = false; !placed;)
        placed = shot.place("cue", {middle + shot.uniform(-0.3, 0.3), shot.uniform(0.4, 0.7)});
    shot.strike(0, 10.0);
    shot.cue().speed = shot.uniform(6.0, 13.0);
    shot.cue().elevation_deg = shot.chance(0.5) ? shot.uniform(2.0, 7.0) : shot.uniform(0.5, 25.0);
    if (shot.chance(0.2)) shot.physics().ball_ball = ball_ball_model("two_step");
    return shot.take();
}

struct ShotFamily {
    const char* name;
    Scene (*make)(std::uint64_t seed);
};
constexpr ShotFamily kShots[] = {
    {"pool_after_break", [](std::uint64_t seed) { return pool(seed, false); }},
    {"pool_frozen", [](std::uint64_t seed) { return pool(seed, true); }},
    {"snooker_half_open", [](std::uint64_t seed) { return snooker(seed, false); }},
    {"snooker_frozen", [](std::uint64_t seed) { return snooker(seed, true); }},
    {"touching_pack", touching_pack},
    {"eight_ball_break", eight_ball_break},
    {"raised_break", raised_break},
};

}  // namespace

std::span<const char* const> natural_families() {
    return names_of<kShots>();
}

std::optional<Scene> natural_shot(std::string_view family, std::uint64_t seed) {
    const ShotFamily* row = row_of(kShots, family);
    if (row == nullptr) return std::nullopt;
    reference::Generator stream(seed + 0x51ull * static_cast<std::uint64_t>(row - std::begin(kShots)));
    return row->make(stream.next());
}

}  // namespace carom::test
