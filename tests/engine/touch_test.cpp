// Contacts with every kind of part: gap and normal in closed form; speed and acceleration against differences
// of the gap along a motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "contact/touch.h"
#include "reference/random_impacts.h"

namespace carom {
namespace {

using Ball = BallAt;

constexpr double kTouchR = 0.03, kHeight = 0.04, kInset = 0.001;
// Along (0.6, 0.8), from (0.1, 0.2): its left is (-0.8, 0.6).
const CushionLine kLine{{0.1, 0.2}, {0.6, 0.8}, 0.5, kHeight, kInset};

Nose nose(double radius, double inset = kInset, const ArcSpan& span = {}) {
    return {{0.3, -0.1}, radius, kHeight, Partner::kJaw, 0, inset, span};
}

Ball ball_at(const Vec3& r, bool flies = false, double R = kTouchR) {
    return {r, Vec3::Zero(), R, flies};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-15) {
    EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

TEST(Touch, BallsInSpaceAndOnTheCloth) {
    const Touch space = touch_ball(ball_at({0.1, 0.2, 0.3}), ball_at({0.3, 0.3, 0.5}, true, 0.02));
    expect_near(space.n, Vec3(2.0, 1.0, 2.0) / 3.0);
    EXPECT_NEAR(space.gap, 0.3 - 0.05, 1e-15);
    // On the cloth unlike balls touch at 2 sqrt(R1 R2), discs at R1 + R2; heights are not read.
    const Ball small = ball_at({0.1, 0.2, 0.7}, false, 0.01), large = ball_at({0.4, 0.6, 0.1}, false, 0.04);
    for (const bool discs : {false, true}) {
        const Touch level = touch_level(small, large, discs);
        expect_near(level.n, {0.6, 0.8, 0.0});
        EXPECT_NEAR(level.gap, 0.5 - (discs ? 0.05 : 0.04), 1e-15);
    }
}

TEST(Touch, StraightNoses) {
    for (const double side : {1.0, -1.0}) {
        const Vec2 place = kLine.from + 0.2 * kLine.direction + side * 0.05 * Vec2(-0.8, 0.6);
        const Touch level = touch_part(kLine, ball_at({place.x(), place.y(), 9.0}));
        expect_near(level.n, side * Vec3(0.8, -0.6, 0.0));
        EXPECT_NEAR(level.gap, 0.05 - (kTouchR - kInset), 1e-15);
        EXPECT_EQ(level.bend, 0.0);
        // From above: 0.05 aside and 0.12 up, 0.13 away.
        const Touch space = touch_part(kLine, ball_at({place.x(), place.y(), kHeight + 0.12}, true));
        expect_near(space.n, Vec3(side * 0.8 * 5.0, side * -0.6 * 5.0, -12.0) / 13.0);
        EXPECT_NEAR(space.gap, 0.13 - std::hypot(kTouchR - kInset, kHeight - kTouchR), 1e-15);
    }
}

TEST(Touch, RoundNosesFromOutsideAndInside) {
    const Vec2 place = nose(0.0).center + 0.1 * Vec2(0.6, 0.8);
    const auto at = [&](double z, bool flies) { return ball_at({place.x(), place.y(), z}, flies); };
    for (const double radius : {0.02, 0.0, -0.3}) {
        const double sign = radius < 0.0 ? -1.0 : 1.0;
        const Touch level = touch_part(nose(radius), at(0.0, false));
        expect_near(level.n, -sign * Vec3(0.6, 0.8, 0.0));
        EXPECT_NEAR(level.gap, sign * 0.1 - radius - (kTouchR - kInset), 1e-15) << radius;
    }
    // 0.05 outside the circle and 0.12 above it, 0.13 away.
    const Touch space = touch_part(nose(0.05), at(kHeight + 0.12, true));
    expect_near(space.n, Vec3(-0.6 * 5.0, -0.8 * 5.0, -12.0) / 13.0);
    EXPECT_NEAR(space.gap, 0.13 - std::hypot(kTouchR - kInset, kHeight - kTouchR), 1e-15);
}

TEST(Touch, TheCloth) {
    const Touch touch = touch_cloth(Ball{{1.0, 2.0, 0.05}, {0.3, 0.0, -0.7}, kTouchR, true});
    expect_near(touch.n, -Vec3::UnitZ());
    EXPECT_NEAR(touch.gap, 0.02, 1e-16);
    EXPECT_EQ(touch.closing, 0.7);
}

struct Kind {
    std::string name;
    bool flies;
    std::function<Touch(const Ball&)> touch;
};

std::vector<Kind> kinds() {
    const auto at = [](bool flies, const auto& touch) {
        return [=](Ball b) {
            b.flies = flies;
            return touch(b);
        };
    };
    std::vector<Kind> kinds{{"cloth", true, [](const Ball& b) { return touch_cloth(b); }}};
    for (const bool flies : {false, true}) {
        const std::string where = flies ? " in space" : " on the cloth";
        // The other ball rests.
        const Ball other = ball_at({0.0, 0.0, kTouchR}, false, 0.02);
        kinds.push_back({"ball" + where, flies, [=](const Ball& b) {
                             return flies ? touch_ball(b, other) : touch_level(b, other, false);
                         }});
        kinds.push_back(
            {"line" + where, flies, at(flies, [](const Ball& b) { return touch_part(kLine, b); })});
        if (!flies)
            kinds.push_back({"edge", flies, [](const Ball& b) {
                                 return touch_part(Pocket{"p", {0.3, -0.1}, 0.06, 0.1}, b);
                             }});
        for (const double radius : {0.02, 0.0, -0.3})
            if (!flies || radius >= 0.0)
                kinds.push_back({"round " + std::to_string(radius) + where, flies,
                                 at(flies, [=](const Ball& b) { return touch_part(nose(radius), b); })});
    }
    return kinds;
}

TEST(Touch, SpeedAndAccelerationMatchTheGap) {
    reference::Generator random(5);
    const auto vec = [&random](double size) {
        Vec3 v;
        for (double& x : v) x = random.uniform(-size, size);
        return v;
    };
    constexpr double kStep = 1e-4;
    for (const Kind& kind : kinds()) {
        for (int k = 0; k < 200; ++k) {
            Ball ball{vec(0.15) + Vec3(0.3, 0.0, 0.3), vec(0.1), kTouchR};
            Vec3 a = vec(1.0);
            if (!kind.flies) ball.v.z() = a.z() = 0.0;
            // On the cloth the second derivative is for a touching ball, so move it there.
            for (int i = 0; i < 100; ++i) {
                const Touch touch = kind.touch(ball);
                ball.r += touch.gap * touch.n;
            }
            const Touch touch = kind.touch(ball);
            ASSERT_NEAR(touch.gap, 0.0, 1e-14) << kind.name << " " << k;
            ASSERT_NEAR(touch.n.norm(), 1.0, 1e-15) << kind.name;
            const auto gap = [&](double t) {
                Ball later = ball;
                later.r += t * (ball.v + 0.5 * t * a);
                return kind.touch(later).gap;
            };
            const double rate = (gap(kStep) - gap(-kStep)) / (2.0 * kStep),
                         bend = (gap(kStep) - 2.0 * gap(0.0) + gap(-kStep)) / (kStep * kStep);
            // The error of the speed: step^2 / 6 times the third derivative, up to 3 v a / R + 3 v^3 / R^2.
            // The error of the acceleration: step^2 / 12 times the fourth, and rounding over step^2.
            EXPECT_NEAR(touch.closing, -rate, 1e-7) << kind.name << " " << k;
            EXPECT_NEAR(touch.pressing(planar(a)) + touch.n.z() * a.z(), -bend, 1e-6)
                << kind.name << " " << k;
        }
    }
}

TEST(Touch, ABallIsBesideAPartBetweenItsEnds) {
    const CushionLine line{{0.0, 0.0}, {1.0, 0.0}, 0.5, kHeight};
    for (const double x : {-0.1, 0.0, 0.2, 0.5, 0.6})
        EXPECT_EQ(beside(line, ball_at({x, 0.1, kTouchR})), x >= 0.0 && x <= 0.5) << x;
    Geometry table;
    table.cushions = {line};
    const Contact cushion{0, With::kCushion, 0};
    // Exactly at an end, the direction of motion decides.
    for (const double speed : {-1.0, 1.0})
        for (const double end : {0.0, 0.5})
            EXPECT_EQ(touches_part(table, cushion, {{end, kTouchR, kTouchR}, {speed, 0.0, 0.0}, kTouchR}),
                      end == 0.0 ? speed > 0.0 : speed < 0.0);
    EXPECT_FALSE(touches_part(table, cushion, ball_at({0.2, kTouchR + 1e-9, kTouchR})));
}

TEST(Touch, ABallIsBesideAnArcOnItsOwnSide) {
    const ArcSpan quarter{{1.0, 0.0}, {0.0, 1.0}, false, false};
    Geometry table;
    table.noses = {nose(0.2, 0.0, quarter), nose(-0.2, 0.0, quarter), nose(0.2, 0.0)};
    const auto ball = [](double x, double y, bool flies = false) {
        return ball_at({0.3 + x, -0.1 + y, kTouchR}, flies);
    };
    for (const int wall : {0, 1}) {
        const Nose& arc = table.noses[wall];
        const double there = wall == 0 ? 0.23 : 0.17, behind_it = wall == 0 ? 0.1 : 0.3;
        EXPECT_TRUE(beside(arc, ball(0.6 * there, 0.8 * there))) << wall;
        EXPECT_FALSE(beside(arc, ball(0.6 * there, -0.8 * there))) << wall << ": past its end";
        EXPECT_FALSE(beside(arc, ball(0.6 * behind_it, 0.8 * behind_it))) << wall << ": behind it";
        // Behind it the gap is negative, and nothing touches there.
        const Contact contact{0, With::kNose, wall};
        EXPECT_LT(touch_part(table, contact, ball(0.6 * behind_it, 0.8 * behind_it)).gap, 0.0);
        EXPECT_FALSE(touches_part(table, contact, ball(0.6 * behind_it, 0.8 * behind_it)));
        EXPECT_TRUE(touches_part(table, contact, ball(0.6 * there, 0.8 * there)));
    }
    // Above the disc of a jaw a ball touches nothing; on the cloth it would be deep inside.
    EXPECT_FALSE(beside(table.noses[2], ball(0.1, 0.0, true)));
    EXPECT_TRUE(beside(table.noses[2], ball(0.1, 0.0)));
}

TEST(Touch, NearestPoints) {
    const auto expect = [](const Vec2& point, const Vec2& wanted) {
        EXPECT_LE(length(point - wanted), 1e-15) << point.transpose();
    };
    expect(nearest_point(kLine, kLine.from + Vec2(-0.8, 0.6)), kLine.from);
    expect(nearest_point(kLine, kLine.from + 2.0 * kLine.direction), kLine.from + 0.5 * kLine.direction);
    expect(nearest_point(nose(0.2), {1.0, 1.0}), {0.3, -0.1});
    const Nose wall = nose(-0.2, 0.0, {{1.0, 0.0}, {0.0, 1.0}, false, false});
    expect(nearest_point(wall, {0.6, 0.3}), {0.3 + 0.12, -0.1 + 0.16});
    expect(nearest_point(wall, {0.5, -0.4}), {0.5, -0.1});
}

}  // namespace
}  // namespace carom
