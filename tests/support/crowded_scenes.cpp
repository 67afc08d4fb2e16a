#include "support/crowded_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/kernel/tolerance.h"
#include "reference/random_impacts.h"
#include "support/crowd.h"
#include "support/families.h"
#include "support/natural_shots.h"

namespace carom::test {
namespace {

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
        // Topspin towards the centre: its axis is perpendicular to that direction.
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
        // Beside another ball, on the rail.
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
    return names_of<kFamilies>();
}

std::optional<Scene> family_scene(std::string_view family, std::uint64_t seed) {
    if (auto shot = natural_shot(family, seed)) return shot;
    const std::size_t slash = family.find('/');
    const std::string_view name = family.substr(0, slash);
    const std::string_view level = slash == family.npos ? "natural" : family.substr(slash + 1);
    constexpr std::string_view kLevels[] = {"natural", "wide", "extreme"};
    const auto known = std::find(std::begin(kLevels), std::end(kLevels), level);
    const Family* row = row_of(kFamilies, name);
    if (known == std::end(kLevels) || row == nullptr) return std::nullopt;
    // A separate stream for every family and level.
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
