#include "support/crowded_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/kernel/tolerance.h"
#include "reference/random_impacts.h"
#include "scene/rack.h"
#include "support/natural_shots.h"

namespace carom::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A scene under construction. Every number is drawn in a statement of its own: in which order a call's arguments are drawn is the
/// compiler's choice.
class Crowd {
  public:
    Crowd(std::uint64_t seed, Level level) : rng_(seed), level_(level) {
        scene_.file = "(crowd)";
        choose_balls();
        choose_models();
        if (level_ == Level::kNatural) return;
        scene_.stop.time = 60.0;
        scene_.stop.events = 20000;
    }

    Scene take() { return std::move(scene_); }
    double R() const { return scene_.balls.R; }

    double uniform(double lo, double hi) { return rng_.uniform(lo, hi); }
    bool chance(double p) { return uniform(0.0, 1.0) < p; }
    int whole(int from, int to) {
        return std::min(to, from + static_cast<int>(uniform(0.0, static_cast<double>(to - from + 1))));
    }
    double logarithmic(double lo, double hi) { return lo * exp(uniform(0.0, 1.0) * std::log(hi / lo)); }
    template <std::size_t kCount>
    double one_of(const double (&list)[kCount]) {
        return list[whole(0, static_cast<int>(kCount) - 1)];
    }
    Vec2 direction() {
        const SinCos a = sin_cos(uniform(0.0, 2.0 * kPi));
        return {a.cos, a.sin};
    }
    /// [m/s]
    double speed() { return level_ == Level::kExtreme ? logarithmic(1e-5, 10.0) : logarithmic(0.01, 8.0); }
    /// [rad/s]
    Vec3 spin(double surface) {
        const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), z = uniform(-1.0, 1.0);
        return Vec3(x, y, z) * (surface / R());
    }

    double nose() { return nose_; }
    void wall(const Vec2& from, const Vec2& to) { scene_.table.cushions.push_back({"", from, to, nose_}); }
    /// Closed, with its corner at the origin.
    void box(double w, double l) {
        wall({0.0, 0.0}, {w, 0.0});
        wall({w, 0.0}, {w, l});
        wall({w, l}, {0.0, l});
        wall({0.0, l}, {0.0, 0.0});
    }
    void jaw(const Vec2& center, double radius) { scene_.table.jaws.push_back({"", center, radius, nose_}); }

    int balls() const { return static_cast<int>(scene_.ball.size()); }
    Vec2 place_of(int ball) const { return planar(scene_.ball[static_cast<std::size_t>(ball)].position); }
    void ball(const Vec2& r) {
        BallStart start;
        start.id = "b" + std::to_string(balls());
        start.position = {r.x(), r.y(), R()};
        scene_.ball.push_back(start);
    }
    void move(int ball, const Vec2& v, const Vec3& w) {
        BallStart& start = scene_.ball[static_cast<std::size_t>(ball)];
        start.velocity = {v.x(), v.y(), 0.0};
        start.spin = w;
    }
    /// With a spin of its own, rolling, or with none.
    void shoot(int ball, const Vec2& v) {
        const int kind = whole(0, 2);
        Vec3 w = Vec3::Zero();
        if (kind == 0) w = Vec3(-v.y() / R(), v.x() / R(), 0.0);
        if (kind == 1) w = spin(2.0 * v.norm());
        move(ball, v, w);
    }
    /// Whether a ball has room there, without a wall nearer than it may be.
    bool fits(const Vec2& r, double slack = 1e-14) const {
        for (const BallStart& b : scene_.ball)
            if ((planar(b.position) - r).norm() < 2.0 * R() - slack) return false;
        for (const Cushion& c : scene_.table.cushions)
            if (distance_to_segment(r, c.from, c.to) < R() - slack) return false;
        for (const Jaw& j : scene_.table.jaws)
            if ((j.center - r).norm() < R() + j.radius - slack) return false;
        return true;
    }
    /// A ball that touches another one, or nearly; false if there was no room.
    bool attach(int to) {
        constexpr double kGaps[] = {0.0, 0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6};
        const double gap = one_of(kGaps) * R();
        const bool lattice = chance(0.5);
        const Vec2 any = direction();
        const SinCos turn = sin_cos(kPi / 3.0 * whole(0, 5));
        const Vec2 r = place_of(to) + (2.0 * R() + gap) * (lattice ? Vec2(turn.cos, turn.sin) : any);
        if (!fits(r)) return false;
        ball(r);
        return true;
    }
    /// A gap between things that nearly touch [m].
    double small_gap() {
        constexpr double kGaps[] = {0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
        return one_of(kGaps) * R();
    }
    /// One ball from outside onto the others, from a distance of a few balls.
    void strike(int target, const Vec2& from) {
        const double away = 2.0 * R() + (chance(0.3) ? 0.0 : uniform(0.0, 4.0)) * R();
        const double off = uniform(-0.9, 0.9) * R() * (chance(0.4) ? 0.0 : 1.0);
        const Vec2 r = place_of(target) + away * from + off * Vec2(-from.y(), from.x());
        const double v = speed();
        if (!fits(r)) return;
        ball(r);
        shoot(balls() - 1, -v * from);
    }
    /// The spins of some balls; at least of the first.
    void spin_some(double share) {
        for (int i = 0; i < balls(); ++i) {
            const bool turns = i == 0 || chance(share);
            const double surface = 3.0 * speed();
            const Vec3 w = spin(surface);
            if (turns) move(i, planar(scene_.ball[static_cast<std::size_t>(i)].velocity), w);
        }
    }

  private:
    void choose_balls() {
        use_balls(scene_, "pool_classic");
        BallParams& b = scene_.balls;
        constexpr double kRestitutions[] = {0.95, 0.95, 0.8, 0.6, 0.0};
        b.e_b = one_of(kRestitutions);
        constexpr double kCushions[] = {0.85, 0.85, 0.7, 0.5, 0.0};
        b.e_c = one_of(kCushions);
        scene_.table.cushions.clear();
        if (level_ == Level::kNatural) return;
        const bool extreme = level_ == Level::kExtreme;
        b.R = extreme ? logarithmic(1e-3, 1.0) : logarithmic(0.01, 0.1);
        b.m = 7100.0 * b.R * b.R * b.R;
        b.mu_s = extreme ? logarithmic(1e-6, 5.0) : logarithmic(0.01, 1.0);
        b.mu_r = b.mu_s * logarithmic(1e-3, 0.3);
        b.mu_sp = b.mu_s * logarithmic(1e-2, 0.3);
        b.mu_b = chance(0.2) ? 0.0 : uniform(0.0, 0.95);
        b.e_b = uniform(0.0, 1.0);
        b.e_c = uniform(0.0, 1.0);
        b.f_c = uniform(0.0, 1.0);
        scene_.physics.gravity = extreme ? logarithmic(0.01, 100.0) : logarithmic(1.0, 20.0);
    }

    void choose_models() {
        Physics& p = scene_.physics;
        const char* const kPairs[] = {"mathavan", "inelastic", "inelastic", "elastic"};
        p.ball_ball = ball_ball_model(kPairs[whole(0, 3)]);
        if (p.ball_ball->reads_tolerance && scene_.balls.mu_s > kernel::kLargestFriction)
            p.ball_ball = ball_ball_model("inelastic");
        const char* const kRails[] = {"han_2005", "han_2005", "smooth", "impulse"};
        p.cushion = cushion_model(kRails[whole(0, 3)]);
        constexpr ClusterModel kClusters[] = {ClusterModel::kCompliant, ClusterModel::kCompliant,
                                              ClusterModel::kSequential, ClusterModel::kRigid};
        p.clusters = kClusters[whole(0, 3)];
        nose_ = R() * uniform(1.1, 1.5);
    }

    reference::Generator rng_;
    Level level_;
    Scene scene_;
    double nose_ = 0.0;
};

void narrow_channel(Crowd& c) {
    const double w = 2.0 * c.R() * (c.chance(0.2) ? 1.0 + c.small_gap() : c.uniform(1.0, 1.2));
    const int count = c.whole(2, 10);
    c.box(w, 2.2 * c.R() * (count + 2));
    double y = c.R() + c.small_gap();
    for (int i = 0; i < count; ++i) {
        const double x = c.chance(0.4) ? c.R() : c.uniform(c.R(), w - c.R());
        if (c.fits({x, y})) c.ball({x, y});
        y += 2.0 * c.R() + c.small_gap() + (c.chance(0.3) ? 0.3 * c.R() : 0.0);
    }
    const double v = c.speed();
    const Vec2 along = c.chance(0.5) ? Vec2(0.0, 1.0) : c.direction();
    c.shoot(c.whole(0, c.balls() - 1), v * along);
    if (c.chance(0.5)) c.spin_some(0.3);
}

void row_between_walls(Crowd& c) {
    const int count = c.whole(2, 7);
    const double w = 2.0 * c.R() * count + c.small_gap(), l = 12.0 * c.R();
    c.box(w, l);
    const double y = 5.0 * c.R();
    for (int i = 0; i < count; ++i) c.ball({c.R() * (2 * i + 1), y});
    const int target = c.whole(0, count - 1);
    const double from = c.uniform(0.2, kPi - 0.2);
    const SinCos a = sin_cos(from);
    c.strike(target, {a.cos, a.sin});
    if (c.chance(0.5)) c.spin_some(0.4);
}

void frozen_rail_row(Crowd& c) {
    const int count = c.whole(2, 8);
    c.box(30.0 * c.R(), 20.0 * c.R());
    double x = c.R() * c.uniform(3.0, 8.0);
    for (int i = 0; i < count; ++i) {
        c.ball({x, c.R()});
        x += 2.0 * c.R() + c.small_gap();
    }
    const SinCos a = sin_cos(c.uniform(0.0, kPi));
    c.strike(c.chance(0.6) ? 0 : c.whole(0, count - 1), {-std::abs(a.cos), a.sin});
    if (c.chance(0.3)) c.spin_some(0.3);
}

void between_frozen(Crowd& c) {
    c.box(20.0 * c.R(), 20.0 * c.R());
    const double x = 8.0 * c.R(), half = c.R() * (c.chance(0.5) ? 1.0 : c.uniform(1.0, 1.95));
    c.ball({x - half, c.R()});
    c.ball({x + half, c.R()});
    c.ball({x, c.R() + std::sqrt(4.0 * c.R() * c.R() - half * half) + c.small_gap()});
    if (c.chance(0.5)) c.attach(c.whole(0, 2));
    if (c.chance(0.5)) c.attach(c.whole(0, 2));
    const SinCos a = sin_cos(c.uniform(0.2, kPi - 0.2));
    c.strike(2, {a.cos, a.sin});
    if (c.chance(0.4)) c.spin_some(0.4);
}

void zigzag(Crowd& c) {
    const int count = c.whole(3, 10);
    const double w = 2.0 * c.R() * c.uniform(1.05, 1.99),
                 step = std::sqrt(4.0 * c.R() * c.R() - (w - 2.0 * c.R()) * (w - 2.0 * c.R()));
    c.box(w, step * (count + 8));
    double y = c.R() + 5.0 * step;
    for (int i = 0; i < count; ++i) {
        c.ball({i % 2 == 0 ? c.R() : w - c.R(), y});
        y += step + c.small_gap();
    }
    const double v = c.speed();
    const Vec2 from(c.uniform(c.R(), w - c.R()), 1.5 * c.R());
    if (!c.fits(from)) return;
    c.ball(from);
    c.shoot(c.balls() - 1, {0.0, v});
}

void tray(Crowd& c) {
    const int side = c.whole(2, 5);
    const double fill = c.uniform(0.6, 0.785), w = 2.0 * c.R() * side * std::sqrt(0.25 * kPi / fill);
    c.box(w, w);
    const double pitch = w / side, room = 0.5 * pitch - c.R();
    for (int i = 0; i < side * side; ++i) {
        const double dx = c.uniform(-room, room), dy = c.uniform(-room, room);
        const int column = i % side, row = i / side;
        c.ball({pitch * (column + 0.5) + dx, pitch * (row + 0.5) + dy});
    }
    for (int i = 0; i < c.balls(); ++i) {
        const double v = c.speed();
        const Vec2 along = c.direction();
        if (i == 0 || c.chance(0.6)) c.shoot(i, v * along);
    }
}

void rack_in_box(Crowd& c) {
    const int rows = c.whole(2, 5);
    const double row = std::sqrt(3.0) * c.R();
    const double w = 2.0 * c.R() * rows + c.small_gap(), l = row * (rows - 1) + 2.0 * c.R() + 3.0 * c.R();
    c.box(w, l);
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i <= k; ++i)
            c.ball({0.5 * w + c.R() * (2 * i - k), l - c.R() - row * (rows - 1 - k)});
    const double v = c.speed();
    const Vec2 from(c.uniform(c.R(), w - c.R()), c.R());
    if (!c.fits(from)) return;
    c.ball(from);
    c.shoot(c.balls() - 1, Vec2(c.uniform(-0.3, 0.3), 1.0) * v);
}

void funnel(Crowd& c) {
    const SinCos a = sin_cos(c.uniform(0.02, 0.7));
    const double narrow = c.R() * c.uniform(0.2, 1.4), length = 25.0 * c.R();
    const Vec2 left(-narrow, 0.0), right(narrow, 0.0);
    c.wall(left, left + length * Vec2(-a.sin, a.cos));
    c.wall(right, right + length * Vec2(a.sin, a.cos));
    const int count = c.whole(1, 5);
    for (int i = 0; i < count; ++i) {
        const double x = c.uniform(-6.0, 6.0) * c.R(), y = c.uniform(3.0, 20.0) * c.R();
        const double v = c.speed(), side = c.uniform(-0.2, 0.2) * (c.chance(0.5) ? 1.0 : 0.0);
        if (!c.fits({x, y})) continue;
        c.ball({x, y});
        c.shoot(c.balls() - 1, v * Vec2(side, -1.0));
    }
}

void corner_wedge(Crowd& c) {
    const double angle = c.chance(0.4) ? 0.5 * kPi : c.uniform(0.3, 2.8);
    const SinCos a = sin_cos(angle), half = sin_cos(0.5 * angle);
    const double length = 40.0 * c.R();
    c.wall({0.0, 0.0}, {length, 0.0});
    c.wall({0.0, 0.0}, length * Vec2(a.cos, a.sin));
    c.ball(Vec2(half.cos, half.sin) * ((c.R() + c.small_gap()) / half.sin));
    const int more = c.whole(0, 3);
    for (int i = 0; i < more; ++i) c.attach(c.whole(0, c.balls() - 1));
    const SinCos from = sin_cos(angle * c.uniform(0.1, 0.9));
    c.strike(c.whole(0, c.balls() - 1), {from.cos, from.sin});
    if (c.chance(0.5)) c.spin_some(0.4);
}

void touching(Crowd& c) {
    c.ball({0.0, 0.0});
    const int wanted = c.whole(2, 12);
    for (int tries = 0; tries < 100 && c.balls() < wanted; ++tries) c.attach(c.whole(0, c.balls() - 1));
    if (c.chance(0.6)) c.strike(c.whole(0, c.balls() - 1), c.direction());
    if (c.chance(0.6)) c.spin_some(0.3);
}

void rings(Crowd& c) {
    const int count = c.whole(3, 8);
    const bool centre = count == 6 && c.chance(0.6);
    const double gap = c.small_gap(), radius = (c.R() + 0.5 * gap) / sin_cos(kPi / count).sin;
    for (int i = 0; i < count; ++i) {
        const SinCos a = sin_cos(2.0 * kPi * i / count);
        c.ball({radius * a.cos, radius * a.sin});
    }
    if (centre) c.ball({0.0, 0.0});
    const double surface = 2.0 * c.speed();
    const bool alike = c.chance(0.5);
    for (int i = 0; i < count; ++i) {
        const SinCos a = sin_cos(2.0 * kPi * i / count);
        const double size = (alike ? 1.0 : c.uniform(0.2, 1.0)) * surface / c.R();
        // Topspin towards the centre: the axis is at right angles to the way there.
        c.move(i, {0.0, 0.0}, Vec3(a.sin, -a.cos, 0.0) * size);
    }
}

void rail_cluster(Crowd& c) {
    c.box(24.0 * c.R(), 24.0 * c.R());
    const bool corner = c.chance(0.4);
    c.ball({corner ? c.R() + c.small_gap() : c.uniform(3.0, 20.0) * c.R(), c.R() + c.small_gap()});
    const int wanted = c.whole(2, 7);
    for (int tries = 0; tries < 100 && c.balls() < wanted; ++tries) {
        if (c.chance(0.5)) {
            c.attach(c.whole(0, c.balls() - 1));
            continue;
        }
        // Beside another one, on the rail.
        const Vec2 r(c.place_of(c.balls() - 1).x() + 2.0 * c.R() + c.small_gap(), c.R());
        if (c.fits(r)) c.ball(r);
    }
    c.spin_some(0.4);
}

void gas_of_spins(Crowd& c) {
    const double w = c.R() * c.uniform(8.0, 20.0);
    c.box(w, w);
    const int wanted = c.whole(2, 9);
    for (int tries = 0; tries < 200 && c.balls() < wanted; ++tries) {
        const double x = c.uniform(c.R(), w - c.R()), y = c.uniform(c.R(), w - c.R());
        if (c.fits({x, y})) c.ball({x, y});
    }
    for (int i = 0; i < c.balls(); ++i) {
        const double v = c.speed(), surface = v * c.logarithmic(1.0, 1000.0);
        const Vec2 along = c.direction();
        const Vec3 w_of = c.spin(surface);
        c.move(i, v * along, w_of);
    }
}

void jaw_wedge(Crowd& c) {
    const double radius = c.R() * (c.chance(0.2) ? 0.0 : c.logarithmic(0.05, 3.0));
    const double open = c.uniform(0.05, 0.98) * (c.R() + radius), half = std::max(open, 1.05 * radius);
    if (half >= c.R() + radius) return;
    c.jaw({-half, 0.0}, radius);
    c.jaw({half, 0.0}, radius);
    const double y = std::sqrt((c.R() + radius) * (c.R() + radius) - half * half);
    c.ball({0.0, y + (c.chance(0.7) ? c.small_gap() : c.uniform(0.0, 5.0) * c.R())});
    if (c.chance(0.4)) c.attach(0);
    const SinCos a = sin_cos(c.uniform(0.3, kPi - 0.3));
    c.strike(c.whole(0, c.balls() - 1), {a.cos, a.sin});
    if (c.chance(0.5)) c.spin_some(0.5);
}

void tiny_and_huge(Crowd& c) {
    const double w = 20.0 * c.R();
    const bool walls = c.chance(0.7);
    if (walls) c.box(w, w);
    c.ball({c.chance(0.5) ? c.R() : 0.4 * w, c.R()});
    const int wanted = c.whole(1, 6);
    for (int tries = 0; tries < 100 && c.balls() < wanted; ++tries) {
        const bool near = c.chance(0.5);
        const double x = c.uniform(c.R(), w - c.R()), y = c.uniform(c.R(), w - c.R());
        if (near)
            c.attach(c.whole(0, c.balls() - 1));
        else if (c.fits({x, y}))
            c.ball({x, y});
    }
    for (int i = 0; i < c.balls(); ++i) {
        const double v = c.logarithmic(1e-9, 1e3);
        const Vec2 along = c.direction();
        if (i == 0 || c.chance(0.5)) c.shoot(i, v * along);
    }
}

struct Family {
    const char* name;
    void (*build)(Crowd&);
};
constexpr Family kFamilies[] = {{"narrow_channel", narrow_channel},
                                {"row_between_walls", row_between_walls},
                                {"frozen_rail_row", frozen_rail_row},
                                {"between_frozen", between_frozen},
                                {"zigzag", zigzag},
                                {"tray", tray},
                                {"rack_in_box", rack_in_box},
                                {"funnel", funnel},
                                {"corner_wedge", corner_wedge},
                                {"touching", touching},
                                {"rings", rings},
                                {"rail_cluster", rail_cluster},
                                {"gas_of_spins", gas_of_spins},
                                {"jaw_wedge", jaw_wedge},
                                {"tiny_and_huge", tiny_and_huge}};

}  // namespace

std::span<const char* const> crowded_families() {
    static const auto names = [] {
        std::array<const char*, std::size(kFamilies)> list{};
        std::transform(std::begin(kFamilies), std::end(kFamilies), list.begin(),
                       [](const Family& f) { return f.name; });
        return list;
    }();
    return names;
}

std::optional<Scene> family_scene(std::string_view family, std::uint64_t seed) {
    if (auto shot = natural_shot(family, seed)) return shot;
    const std::size_t slash = family.find('/');
    const std::string_view name = family.substr(0, slash);
    const std::string_view level = slash == family.npos ? "natural" : family.substr(slash + 1);
    constexpr std::string_view kLevels[] = {"natural", "wide", "extreme"};
    const auto known = std::find(std::begin(kLevels), std::end(kLevels), level);
    const auto row = std::find_if(std::begin(kFamilies), std::end(kFamilies),
                                  [&](const Family& f) { return f.name == name; });
    if (known == std::end(kLevels) || row == std::end(kFamilies)) return std::nullopt;
    // A stream of its own for every family and level.
    reference::Generator streams(static_cast<std::uint64_t>(row - std::begin(kFamilies)) * 3 +
                                 static_cast<std::uint64_t>(known - std::begin(kLevels)));
    Crowd crowd(streams.next() + seed * 0x9E3779B97F4A7C15ull * 0x5DEECE66Dull,
                static_cast<Level>(known - std::begin(kLevels)));
    row->build(crowd);
    Scene scene = crowd.take();
    for (std::size_t k = 0; k < scene.table.cushions.size(); ++k)
        scene.table.cushions[k].id = "c" + std::to_string(k + 1);
    for (std::size_t k = 0; k < scene.table.jaws.size(); ++k)
        scene.table.jaws[k].id = "j" + std::to_string(k + 1);
    return scene;
}

}  // namespace carom::test
