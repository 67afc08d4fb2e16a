// Racks: the ball at each place, its precision, and reproducible seeds.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/scene.h"

namespace {

using carom::parse_scene;
using carom::Scene;
using carom::Vec2;

constexpr double kRackR = 0.028575;

Scene rack(const std::string& keys, const std::string& table = "") {
    return parse_scene(table + "[rack]\n" + keys, "s.toml");
}

Vec2 at(const Scene& scene, std::size_t i) {
    return scene.ball[i].position.head<2>();
}

double closest_pair(const Scene& s) {
    double best = 1e9;
    for (std::size_t i = 0; i < s.ball.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) best = std::fmin(best, (at(s, i) - at(s, j)).norm());
    }
    return best;
}

int touching_pairs(const Scene& s, double pitch) {
    int n = 0;
    for (std::size_t i = 0; i < s.ball.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) n += std::abs((at(s, i) - at(s, j)).norm() - pitch) < 4e-16;
    }
    return n;
}

/// Id of the ball nearest to a point.
std::string ball_at(const Scene& s, const Vec2& p) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < s.ball.size(); ++i) {
        if ((at(s, i) - p).norm() < (at(s, best) - p).norm()) best = i;
    }
    return s.ball[best].id;
}

TEST(EightBall, TouchesExactlyAndMirrorsBitForBit) {
    for (const char* table : {"", "[table]\npreset = \"seven_foot\"\n",
                              "[table]\npreset = \"carom\"\n[balls]\npreset = \"pool\"\n"}) {
        const Scene s = rack("gap = 0\n", table);
        ASSERT_EQ(s.ball.size(), 15u);
        EXPECT_EQ(touching_pairs(s, 2 * kRackR), 30) << table;
        EXPECT_GE(closest_pair(s), 2 * kRackR - 4e-16);
        const double axis = s.table.width / 2;
        for (std::size_t i = 0; i < 15; ++i) {
            int mirrored = 0;
            for (std::size_t j = 0; j < 15; ++j) {
                mirrored += at(s, i).y() == at(s, j).y() && at(s, i).x() - axis == axis - at(s, j).x();
            }
            EXPECT_EQ(mirrored, 1) << table << s.ball[i].id;
        }
    }
}

TEST(EightBall, IsOnTheFootSpotWithRowsUpTheTable) {
    const Scene s = rack("gap = 1e-4\n");
    const Vec2 spot(1.27 / 2, 3 * 2.54 / 4);
    int at_spot = 0;
    for (std::size_t i = 0; i < 15; ++i) {
        at_spot += at(s, i) == spot;
        EXPECT_GE(at(s, i).y(), spot.y());
        EXPECT_EQ(s.ball[i].position.z(), kRackR);
        EXPECT_EQ(s.ball[i].velocity.norm(), 0.0);
    }
    EXPECT_EQ(at_spot, 1);
    EXPECT_EQ(touching_pairs(s, 2 * kRackR + 1e-4), 30);
}

TEST(EightBall, FollowsTheRulesForEverySeed) {
    const double pitch = 2 * kRackR, row = pitch * std::sqrt(0.75);
    const Vec2 spot(1.27 / 2, 3 * 2.54 / 4);
    std::set<std::string> apexes;
    int solid_left = 0;
    constexpr int kSeeds = 400;
    for (int seed = 0; seed < kSeeds; ++seed) {
        const Scene s = rack("gap = 0\nseed = " + std::to_string(seed) + "\n");
        for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(s.ball[i].id, std::to_string(i + 1));
        EXPECT_EQ(ball_at(s, spot + Vec2(0, 2 * row)), "8");
        const int left = std::stoi(ball_at(s, spot + Vec2(-2 * pitch, 4 * row)));
        const int right = std::stoi(ball_at(s, spot + Vec2(2 * pitch, 4 * row)));
        EXPECT_NE(left < 8, right < 8) << seed;
        solid_left += left < 8;
        apexes.insert(ball_at(s, spot));
    }
    EXPECT_EQ(apexes.size(), 14u) << "every ball but the 8 comes to the apex";
    EXPECT_NEAR(solid_left, 0.5 * kSeeds, 60) << "six standard deviations";
}

TEST(NineBall, FollowsTheRulesForEverySeed) {
    const double pitch = 2 * kRackR, row = pitch * std::sqrt(0.75);
    const Vec2 spot(1.27 / 2, 3 * 2.54 / 4);
    std::set<std::string> behind;
    for (int seed = 0; seed < 200; ++seed) {
        const Scene s = rack("game = \"nine_ball\"\ngap = 0\nseed = " + std::to_string(seed) + "\n");
        ASSERT_EQ(s.ball.size(), 9u);
        EXPECT_EQ(s.ball[0].id, "1");
        EXPECT_EQ(at(s, 0), spot);
        EXPECT_EQ(ball_at(s, spot + Vec2(0, 2 * row)), "9");
        EXPECT_EQ(touching_pairs(s, pitch), 16);
        behind.insert(ball_at(s, spot + Vec2(0, 4 * row)));
    }
    EXPECT_EQ(behind.size(), 7u);
}

TEST(Line, RunsUpTheTable) {
    const Scene s = rack("game = \"line\"\ncount = 4\ngap = 0.01\n");
    ASSERT_EQ(s.ball.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(s.ball[i].id, std::to_string(i + 1));
        EXPECT_EQ(at(s, i).x(), 0.635);
        EXPECT_NEAR(at(s, i).y(), 1.905 + static_cast<double>(i) * (2 * kRackR + 0.01), 1e-15);
    }
    EXPECT_EQ(rack("game = \"line\"\n").ball.size(), 5u);
}

TEST(Racks, SeedsReproduceAndDiffer) {
    const std::string keys = "jitter = 5e-5\nseed = ";
    const Scene a = rack(keys + "7\n"), b = rack(keys + "7\n"), c = rack(keys + "8\n");
    bool differs = false;
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(a.ball[i].position, b.ball[i].position);
        differs = differs || a.ball[i].position != c.ball[i].position;
    }
    EXPECT_TRUE(differs);
}

// Fixed values: changing the generator, or the order of its draws, would change all users' racks.
TEST(Racks, SeedOneIsThisRack) {
    const Scene s = rack("gap = 0\n");
    const double pitch = 2 * kRackR, row = pitch * std::sqrt(0.75);
    std::string order;
    for (int r = 0; r < 5; ++r) {
        for (int k = 0; k <= r; ++k)
            order += ball_at(s, Vec2(0.635 + (k - r / 2.0) * pitch, 1.905 + r * row)) + " ";
    }
    EXPECT_EQ(order, "1 5 9 15 8 3 11 2 13 12 14 10 6 7 4 ");
}

TEST(Racks, JitterStaysInItsBoxAndNeverOverlaps) {
    for (const char* gap : {"0", "1e-4"}) {
        const Scene still = rack(std::string("gap = ") + gap + "\n");
        double reach = 0.0;
        for (int seed = 1; seed <= 200; ++seed) {
            const Scene s =
                rack(std::string("jitter = 1e-4\ngap = ") + gap + "\nseed = " + std::to_string(seed) + "\n");
            EXPECT_GE(closest_pair(s), 2 * kRackR - 1e-15);
            for (std::size_t i = 0; i < 15; ++i) {
                // The seed decides which ball is where, so compare with the nearest place.
                double best = 1e9;
                for (std::size_t j = 0; j < 15; ++j) {
                    best = std::fmin(best, (at(s, i) - at(still, j)).cwiseAbs().maxCoeff());
                }
                EXPECT_LE(best, 1e-4 * (1 + 1e-9));
                EXPECT_GT(best, 0.0) << "a hundred rounds move every ball";
                reach = std::fmax(reach, best);
            }
        }
        EXPECT_GT(reach, 0.99e-4);
    }
}

TEST(Racks, RackedBallsFollowTheWrittenOnes) {
    const Scene s = parse_scene("[rack]\ngame = \"nine_ball\"\n[[ball]]\nid = \"cue\"\n", "s.toml");
    ASSERT_EQ(s.ball.size(), 10u);
    EXPECT_EQ(s.ball[0].id, "cue");
    EXPECT_EQ(s.ball[1].id, "1");
    EXPECT_EQ(s.ball[1].where.line, 1);
}

TEST(Racks, BallRadiusSetsThePitch) {
    const Scene s = parse_scene("[balls]\npreset = \"snooker\"\n[rack]\ngap = 0\n", "s.toml");
    EXPECT_EQ(touching_pairs(s, 2 * 0.02625), 30);
}

Vec2 of(const carom::Scene& scene, const std::string& id) {
    for (const carom::BallStart& b : scene.ball)
        if (b.id == id) return b.position.head<2>();
    ADD_FAILURE() << "no ball " << id;
    return Vec2::Zero();
}

// WPBSA rules, section 1: the spots; the reds behind the pink without touching it.
TEST(SnookerRack, IsOnItsSpots) {
    const carom::Scene s = carom::parse_scene(
        "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n[rack]\ngame = \"snooker\"\ngap = "
        "1e-3\n",
        "s.toml");
    ASSERT_EQ(s.ball.size(), 21u);
    const double R = 0.02625;
    EXPECT_LE((of(s, "pink") - Vec2(0.889, 0.75 * 3.569)).norm(), 1e-12);
    EXPECT_LE((of(s, "blue") - Vec2(0.889, 0.5 * 3.569)).norm(), 1e-12);
    EXPECT_LE((of(s, "black") - Vec2(0.889, 3.569 - 0.324)).norm(), 1e-12);
    EXPECT_LE((of(s, "brown") - Vec2(0.889, 0.737)).norm(), 1e-12);
    EXPECT_LE((of(s, "yellow") - Vec2(0.889 + 0.292, 0.737)).norm(), 1e-12);
    EXPECT_LE((of(s, "green") - Vec2(0.889 - 0.292, 0.737)).norm(), 1e-12);
    EXPECT_LE((of(s, "1") - of(s, "pink") - Vec2(0.0, 2.0 * R + 1e-3)).norm(), 1e-12);
    for (std::size_t i = 0; i < s.ball.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE((s.ball[i].position - s.ball[j].position).norm(), 2.0 * R + 1e-3 - 1e-12)
                << s.ball[i].id << " " << s.ball[j].id;
}

TEST(TriangleRack, HasItsRows) {
    for (const int rows : {1, 2, 7}) {
        const carom::Scene s = carom::parse_scene(
            "[rack]\ngame = \"triangle\"\ngap = 0\nrows = " + std::to_string(rows) + "\n", "s.toml");
        ASSERT_EQ(s.ball.size(), static_cast<std::size_t>(rows * (rows + 1) / 2));
        EXPECT_EQ(s.ball[0].id, "1");
        const double R = 0.028575;
        const Vec2 last = s.ball.back().position.head<2>(), apex = s.ball[0].position.head<2>();
        EXPECT_LE((last - apex - (rows - 1) * R * Vec2(1.0, std::sqrt(3.0))).norm(), 1e-12)
            << "right corner of the last row";
    }
}

TEST(ThreeCushionRack, IsTheOpeningPosition) {
    const carom::Scene s = carom::parse_scene(
        "[table]\npreset = \"carom\"\n[balls]\npreset = \"carom\"\n[rack]\ngame = \"three_cushion\"\njitter "
        "= 0.01\n",
        "s.toml");
    ASSERT_EQ(s.ball.size(), 3u);
    EXPECT_LE((of(s, "red") - Vec2(0.71, 2.13)).norm(), 1e-12);
    EXPECT_LE((of(s, "yellow") - Vec2(0.71, 0.71)).norm(), 1e-12);
    EXPECT_LE((of(s, "white") - Vec2(0.71 - 0.1825, 0.71)).norm(), 1e-12);
}

// The 1 at the apex, the 10 in the middle of the third row.
TEST(TenBall, TheOneAndTheTenHaveTheirPlaces) {
    std::set<std::string> second_rows;
    for (const char* seed : {"1", "2", "3", "4", "5"}) {
        const Scene s = rack(std::string("game = \"ten_ball\"\ngap = 0\nseed = ") + seed + "\n");
        ASSERT_EQ(s.ball.size(), 10u);
        EXPECT_EQ(touching_pairs(s, 2 * kRackR), 18);
        EXPECT_EQ(ball_at(s, {0.635, 1.905}), "1");
        EXPECT_EQ(ball_at(s, {0.635, 1.905 + 2 * std::sqrt(3.0) * kRackR}), "10");
        second_rows.insert(ball_at(s, {0.6, 1.96}));
    }
    EXPECT_GT(second_rows.size(), 2u);
}

TEST(Rack, NineOnTheSpot) {
    for (const char* keys : {"", "gap = 0.001\n", "jitter = 0\nangle_deg = 30\n", "angle_deg = -90\n"}) {
        const Scene s = rack(std::string("game = \"nine_ball\"\nspot_ball = 9\n") + keys);
        EXPECT_NEAR((at(s, 8) - Vec2(0.635, 1.905)).norm(), 0.0, 1e-15) << keys;
        EXPECT_EQ(s.ball[8].id, "9");
    }
    const Scene one = rack("game = \"nine_ball\"\n");
    EXPECT_EQ(at(one, 0), Vec2(0.635, 1.905));
}

// Turning a rack about its place keeps all distances; a quarter turn counter-clockwise turns the rows from +y
// to -x.
TEST(Rack, PlaceAndAngle) {
    const Scene s = rack("game = \"eight_ball\"\ngap = 0\nposition = [0.5, 0.7]\n"),
                turned = rack("game = \"eight_ball\"\ngap = 0\nposition = [0.5, 0.7]\nangle_deg = 90\n");
    EXPECT_EQ(ball_at(s, {0.5, 0.7}), ball_at(turned, {0.5, 0.7}));
    for (std::size_t i = 0; i < 15; ++i) {
        const Vec2 d = at(s, i) - Vec2(0.5, 0.7), e = at(turned, i) - Vec2(0.5, 0.7);
        EXPECT_NEAR((e - Vec2(-d.y(), d.x())).norm(), 0.0, 1e-15);
    }
    EXPECT_EQ(touching_pairs(s, 2 * kRackR), 30);
}

TEST(Rack, AScatterIsUniformAndTouchesNothing) {
    const std::string place = "[[ball]]\nid = \"cue\"\nposition = [0.635, 1.27]\n";
    const auto scatter = [&](const std::string& keys, int seed, const std::string& more = "") {
        return rack("game = \"scatter\"\nseed = " + std::to_string(seed) + "\n" + keys, more);
    };
    // Moments of a uniform distribution between the cushions: its mean, and a twelfth of the squared side.
    constexpr double kWidth = 1.27, kLength = 2.54;
    constexpr int kRacks = 4000;
    double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0;
    for (int seed = 1; seed <= kRacks; ++seed) {
        const Vec2 p = at(scatter("count = 1\ngap = 0\n", seed), 0);
        x += p.x() / kRacks;
        y += p.y() / kRacks;
        xx += std::pow(p.x() - 0.5 * kWidth, 2) / kRacks;
        yy += std::pow(p.y() - 0.5 * kLength, 2) / kRacks;
    }
    const double across = kWidth - 2 * kRackR, along = kLength - 2 * kRackR;
    EXPECT_NEAR(x, 0.5 * kWidth, 4 * across / std::sqrt(12.0 * kRacks));
    EXPECT_NEAR(y, 0.5 * kLength, 4 * along / std::sqrt(12.0 * kRacks));
    // Jaws and pockets exclude a little of the corners.
    EXPECT_NEAR(xx, across * across / 12, 0.05 * across * across / 12);
    EXPECT_NEAR(yy, along * along / 12, 0.05 * along * along / 12);

    for (int seed = 1; seed <= 50; ++seed) {
        const Scene s = scatter("count = 40\ngap = 0.001\n", seed, place);
        ASSERT_EQ(s.ball.size(), 41u);
        EXPECT_EQ(s.ball[0].id, "cue");
        EXPECT_EQ(s.ball[40].id, "40");
        EXPECT_GE(closest_pair(s), 2 * kRackR + 0.001 - 1e-15);
        for (std::size_t i = 1; i < s.ball.size(); ++i) {
            EXPECT_GE(std::fmin(at(s, i).x(), kWidth - at(s, i).x()), kRackR + 0.001 - 1e-15);
            EXPECT_GE(std::fmin(at(s, i).y(), kLength - at(s, i).y()), kRackR + 0.001 - 1e-15);
            for (const carom::Pocket& pocket : s.table.pockets)
                EXPECT_GT((at(s, i) - pocket.center).norm(), pocket.radius);
        }
    }
    EXPECT_EQ(scatter("", 7).ball, scatter("", 7).ball);
    EXPECT_NE(scatter("", 7).ball, scatter("", 8).ball);
}

/// [m] Gap between two balls on the cloth.
double gap_between(const Scene& s, std::size_t i, std::size_t j) {
    return (at(s, i) - at(s, j)).norm() -
           carom::contact_distance(s.size_of(s.ball[i]).R, s.size_of(s.ball[j]).R, false);
}

std::string unlike(const std::string& sd, const std::string& rack) {
    return "[balls]\nradius_sd = " + sd + "\n[rack]\n" + rack;
}

// N balls pressed together have 2N - 3 degrees of freedom against each other, so that many contacts close;
// nine-ball and ten-ball have one contact more, fifteen balls three.
TEST(Template, OnlyRedundantContactsOpen) {
    struct Case {
        const char* rack;
        std::size_t balls, contacts;
    };
    constexpr double kTolerance = 4e-15;
    for (const Case& c : {Case{"game = \"nine_ball\"\n", 9, 16},
                          {"game = \"ten_ball\"\n", 10, 18},
                          {"game = \"eight_ball\"\n", 15, 30},
                          {"game = \"nine_ball\"\nspot_ball = 9\n", 9, 16},
                          {"game = \"triangle\"\nrows = 2\n", 3, 3}}) {
        const std::string keys = std::string(c.rack) + "method = \"template\"\nseed = ";
        for (int seed = 0; seed < 1000; ++seed) {
            const Scene s = parse_scene(unlike("2e-5", keys + std::to_string(seed) + "\n"), "s.toml");
            std::size_t closed = 0, near = 0;
            int at_spot = 0;
            for (std::size_t i = 0; i < c.balls; ++i) {
                at_spot += at(s, i) == Vec2(0.635, 1.905);
                for (std::size_t j = 0; j < i; ++j) {
                    const double gap = gap_between(s, i, j);
                    EXPECT_GE(gap, -kTolerance);
                    closed += gap <= kTolerance;
                    near += gap < 0.001;
                }
            }
            EXPECT_EQ(closed, 2 * c.balls - 3) << c.rack << seed;
            EXPECT_EQ(near, c.contacts) << c.rack << seed;
            EXPECT_EQ(at_spot, 1) << c.rack << seed;
        }
    }
}

TEST(Template, OfEqualBallsIsTheTouchingRack) {
    for (const std::string game : {"eight_ball", "nine_ball", "ten_ball"}) {
        const std::string keys = "game = \"" + game + "\"\n";
        EXPECT_EQ(rack(keys + "method = \"template\"\n").ball, rack("gap = 0\n" + keys).ball);
        EXPECT_EQ(rack(keys + "method = \"triangle\"\n").ball,
                  rack("gap = 5e-5\njitter = 5e-5\n" + keys).ball);
        EXPECT_EQ(rack(keys + "method = \"gap\"\n").ball, rack(keys).ball);
    }
    EXPECT_EQ(rack("method = \"triangle\"\ngap = 1e-5\njitter = 0\n").ball, rack("gap = 1e-5\n").ball);
}

// A normal distribution cut at c = 2.5 standard deviations has 0.9546 of the deviation: its variance is 1 - 2
// c phi(c) / (2 Phi(c) - 1).
TEST(Rack, RadiiVaryAndMassesFollow) {
    constexpr double kSd = 2e-5;
    double sum = 0.0, squares = 0.0, most = 0.0;
    int n = 0;
    for (int seed = 0; seed < 1000; ++seed) {
        const std::string keys = "game = \"ten_ball\"\nseed = " + std::to_string(seed) + "\n";
        const Scene s = parse_scene("[[ball]]\nid = \"cue\"\n" + unlike("2e-5", keys), "s.toml");
        const Scene alike = parse_scene("[[ball]]\nid = \"cue\"\n[rack]\n" + keys, "s.toml");
        EXPECT_FALSE(s.ball[0].own);
        for (std::size_t i = 1; i < s.ball.size(); ++i) {
            const carom::BallSize size = s.size_of(s.ball[i]);
            EXPECT_NEAR(size.m / s.balls.m, std::pow(size.R / kRackR, 3), 1e-15);
            EXPECT_EQ(s.ball[i].position.z(), size.R);
            EXPECT_LT((at(s, i) - at(alike, i)).norm(), 0.001) << "the same ball lies there";
            const double off = (size.R - kRackR) / kSd;
            sum += off, squares += off * off, ++n;
            most = std::fmax(most, std::abs(off));
        }
    }
    EXPECT_NEAR(sum / n, 0.0, 0.05);
    EXPECT_NEAR(std::sqrt(squares / n), 0.9546, 0.03);
    EXPECT_LE(most, 2.5 + 1e-9);
    EXPECT_GT(most, 2.4);
    // The other methods and games also accept it.
    for (const char* keys : {"method = \"triangle\"\n", "gap = 0\njitter = 1e-4\n", "game = \"snooker\"\n",
                             "game = \"three_cushion\"\n", "game = \"line\"\ncount = 7\n",
                             "game = \"scatter\"\ncount = 30\n", "game = \"triangle\"\nrows = 10\n"}) {
        const Scene s = parse_scene(unlike("1e-4", keys), "s.toml");
        EXPECT_FALSE(s.of_one_radius()) << keys;
        const Scene again = parse_scene(carom::scene_text(s), "s.toml");
        for (std::size_t i = 0; i < s.ball.size(); ++i) {
            EXPECT_EQ(again.ball[i].own, s.ball[i].own);
            EXPECT_EQ(again.ball[i].position, s.ball[i].position);
        }
    }
}

}  // namespace
