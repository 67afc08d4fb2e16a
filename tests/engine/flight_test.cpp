// Impact times of airborne balls: reference values, and 100 000 random flights against dense sampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "carom/engine/math.h"
#include "contact/detect.h"
#include "physics/reach.h"
#include "reference/random_impacts.h"

namespace carom {
namespace {

using reference::Generator;

constexpr double kFlyR = 0.028575, kFlyG = 9.81, kNoise = 1e-14;
const Vec3 kDown(0.0, 0.0, -kFlyG);

Flight flight(const Vec3& r, const Vec3& v, const Vec3& a, double horizon = 10.0) {
    return {r, v, a, horizon, kNoise};
}

Nose round_nose(const Vec2& center, double radius, double height) {
    return {center, radius, height, Partner::kJaw, 0};
}

TEST(Flight, TimesOfTheReference) {
    const double height = 1.28 * kFlyR;
    // A long straight nose at x = 0.3 m, approached from the cloth.
    const double nose = flight_to_line(flight({-0.3, 0.0, kFlyR}, {2.5, 0.0, 0.75}, kDown),
                                       {{0.0, -9.0}, {0.0, 1.0}, 18.0, height}, kFlyR);
    EXPECT_NEAR(nose, 0.109808536582193, 1e-13);
    const double jaw = flight_to_nose(flight({-0.2, 0.03, kFlyR}, {2.0, 0.0, 0.5}, kDown),
                                      round_nose({0.0, 0.0}, 0.02095, height), kFlyR);
    EXPECT_NEAR(jaw, 0.0796166938261909, 1e-13);
    const double lies =
        flight_to_ball(flight({0.4, 0.01, 0.0}, {-2.0, 0.0, -0.9}, {0.0, 0.0, kFlyG}), 2.0 * kFlyR);
    EXPECT_NEAR(lies, 0.172267943523958, 1e-13);
    const double both =
        flight_to_ball(flight({0.5, 0.02, -0.01}, {-2.5, 0.1, 0.05}, Vec3::Zero()), 2.0 * kFlyR);
    EXPECT_NEAR(both, 0.183037813612573, 1e-13);
    const double slides = flight_to_ball(
        flight({0.3, 0.01, 0.0}, {-1.5, 0.0, -1.0}, {-0.2 * kFlyG * 0.8, -0.2 * kFlyG * 0.6, kFlyG}),
        2.0 * kFlyR);
    EXPECT_NEAR(slides, 0.157496886862364, 1e-13);
    const double over = flight_to_ball(
        flight({0.3, 0.0, 0.0}, {-2.5, 0.0, -1.3653281}, {0.0, 0.0, kFlyG}, 0.27), 2.0 * kFlyR);
    EXPECT_EQ(over, kNever) << "a hop over the ball";
}

/// The first of 4000 samples at which the gap is below 0, or kNever.
double sampled(const std::function<double(double)>& gap, double horizon) {
    constexpr int kLooks = 4000;
    for (int k = 1; k <= kLooks; ++k) {
        const double t = horizon * k / kLooks;
        if (gap(t) < -1e-9) return t;
    }
    return kNever;
}

struct Found {
    int contacts = 0, missed = 0, false_ones = 0;
    double worst = 0.0;
    void judge(double t, const std::function<double(double)>& gap, double horizon) {
        const double seen = sampled(gap, horizon);
        if (t < kNever) {
            ++contacts;
            worst = std::max(worst, std::abs(gap(t)));
            // The gap is not deep before the contact, and the motion continues inwards after it.
            if (seen < t) ++missed;
            if (!(gap(t + 1e-7) < gap(t))) ++false_ones;
        } else if (seen < kNever) {
            ++missed;
        }
    }
};

TEST(Flight, RandomFlightsAgainstSampling) {
    Generator random(11);
    Found ball, line, circle, point;
    const double height = 1.28 * kFlyR, reach = nose_reach(kFlyR, height, 0.0);
    for (int k = 0; k < 25000; ++k) {
        Vec3 r, v, a = kDown;
        r.x() = random.uniform(-0.5, 0.5);
        r.y() = random.uniform(-0.5, 0.5);
        r.z() = kFlyR + random.uniform(0.0, 0.1);
        v.x() = random.uniform(-4.0, 4.0);
        v.y() = random.uniform(-4.0, 4.0);
        v.z() = random.uniform(-1.0, 2.0);
        const double root = std::sqrt(v.z() * v.z() + 2.0 * kFlyG * (r.z() - kFlyR));
        const Flight f = flight(r, v, a, (v.z() + root) / kFlyG);
        const auto at = [&](double t) { return Vec3(r + t * (v + 0.5 * t * a)); };

        // Another ball, which lies at the origin.
        if (length3(r - Vec3(0.0, 0.0, kFlyR)) > 2.0 * kFlyR) {
            Flight relative = f;
            relative.r = r - Vec3(0.0, 0.0, kFlyR);
            ball.judge(
                flight_to_ball(relative, 2.0 * kFlyR),
                [&](double t) { return length3(at(t) - Vec3(0.0, 0.0, kFlyR)) - 2.0 * kFlyR; }, f.horizon);
        }
        // A nose along y from -0.1 to 0.2.
        const Vec3 from(0.0, -0.1, height);
        const auto to_line = [&](double t) {
            const Vec3 x = at(t) - from;
            const double beyond = std::max(-x.y(), x.y() - 0.3);
            return beyond > 1e-12 ? 1.0 : length(Vec2(x.x(), x.z())) - reach;
        };
        const Vec3 to = from + Vec3(0.0, 0.3, 0.0);
        if (to_line(0.0) > 0.0 && length3(r - from) > reach && length3(r - to) > reach) {
            const double t = flight_to_line(f, {planar(from), {0.0, 1.0}, 0.3, height}, kFlyR);
            // The ends are separate points: a path that enters over one meets that end.
            const double end1 = flight_to_nose(f, round_nose(planar(from), 0.0, height), kFlyR),
                         end2 = flight_to_nose(f, round_nose(planar(to), 0.0, height), kFlyR);
            const double end = std::min(end1, end2);
            if (t < end || end == kNever) line.judge(t, to_line, std::min(f.horizon, end));
        }
        // A jaw, and a point. Over the disc there is no contact.
        const auto to_circle = [&](double t) {
            const Vec3 x = at(t);
            const double level = length(planar(x)) - 0.02;
            return level < 0.0 ? 1.0 : length(Vec2(level, x.z() - height)) - reach;
        };
        double over = f.horizon;
        for (int look = 0; look <= 4000; ++look) {
            const double t = f.horizon * look / 4000;
            if (length(planar(at(t))) < 0.02) {
                over = t;
                break;
            }
        }
        if (to_circle(0.0) > 0.0 && length(planar(r)) > 0.02) {
            const double t = flight_to_nose(f, round_nose({0.0, 0.0}, 0.02, height), kFlyR);
            if (t < over || t == kNever) circle.judge(t, to_circle, over);
        }
        const auto to_point = [&](double t) { return length3(at(t) - Vec3(0.0, 0.0, height)) - reach; };
        if (to_point(0.0) > 0.0)
            point.judge(flight_to_nose(f, round_nose({0.0, 0.0}, 0.0, height), kFlyR), to_point, f.horizon);
    }
    for (const auto& [name, found] : {std::pair{"ball", ball}, std::pair{"line", line},
                                      std::pair{"circle", circle}, std::pair{"point", point}}) {
        EXPECT_GT(found.contacts, 100) << name;
        EXPECT_EQ(found.missed, 0) << name;
        EXPECT_EQ(found.false_ones, 0) << name;
        EXPECT_LE(found.worst, 1e-14) << name;
    }
}

}  // namespace
}  // namespace carom
