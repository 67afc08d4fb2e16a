// The built-in tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/scene.h"

namespace {

using carom::make_table;
using carom::Table;
using carom::Vec2;

Vec2 point(const nlohmann::json& p) {
    return {p[0].get<double>(), p[1].get<double>()};
}

bool same(const Vec2& a, const Vec2& b) {
    return (a - b).cwiseAbs().maxCoeff() <= 1e-15;
}

// tests/data/seven_foot_table.json contains the numbers and their sources. It numbers cushions and jaws by
// position; its straight cushion N is our c<N>.
TEST(SevenFoot, AgreesWithTheReferenceTable) {
    std::ifstream in(std::string(CAROM_TEST_DATA) + "/seven_foot_table.json");
    const nlohmann::json want = nlohmann::json::parse(in);
    const Table got = make_table("seven_foot");
    EXPECT_EQ(got.width, want["width"].get<double>());
    EXPECT_EQ(got.length, want["length"].get<double>());
    ASSERT_EQ(got.cushions.size(), want["cushions"].size());
    ASSERT_EQ(got.jaws.size(), want["jaws"].size());
    ASSERT_EQ(got.pockets.size(), want["pockets"].size());
    for (const auto& w : want["cushions"]) {
        const auto index = static_cast<std::size_t>(std::stoi(w["id"].get<std::string>()) - 1);
        ASSERT_LT(index, got.cushions.size());
        const carom::Cushion& c = got.cushions[index];
        const Vec2 p1 = point(w["p1"]), p2 = point(w["p2"]);
        EXPECT_TRUE((same(c.from, p1) && same(c.to, p2)) || (same(c.from, p2) && same(c.to, p1)))
            << c.id << " " << c.name << ": " << c.from.transpose() << " to " << c.to.transpose();
        EXPECT_NEAR(c.height, w["height"].get<double>(), 1e-17);
    }
    for (const auto& w : want["jaws"]) {
        int found = 0;
        for (const carom::Jaw& j : got.jaws) {
            if (!same(j.center, point(w["center"]))) continue;
            ++found;
            EXPECT_EQ(j.radius, w["radius"].get<double>());
        }
        EXPECT_EQ(found, 1) << w;
    }
    for (const auto& w : want["pockets"]) {
        int found = 0;
        for (const carom::Pocket& p : got.pockets) {
            if (!same(p.center, point(w["center"]))) continue;
            ++found;
            EXPECT_EQ(p.radius, w["radius"].get<double>());
            EXPECT_EQ(p.depth, w["depth"].get<double>());
        }
        EXPECT_EQ(found, 1) << w;
    }
}

/// Smallest distance from a point to the ends of the cushions whose index passes.
double nearest_end(const Table& t, const Vec2& p) {
    double best = 1e9;
    for (const carom::Cushion& c : t.cushions) {
        best = std::fmin(best, std::fmin((c.from - p).norm(), (c.to - p).norm()));
    }
    return best;
}

TEST(PocketTables, RailsAndFacingsMeetTheirJaws) {
    for (const char* preset : {"seven_foot", "seven_foot_bar", "eight_foot", "nine_foot"}) {
        const Table t = make_table(preset);
        ASSERT_EQ(t.cushions.size(), 18u);
        ASSERT_EQ(t.jaws.size(), 12u);
        ASSERT_EQ(t.pockets.size(), 6u);
        for (const carom::Jaw& j : t.jaws) {
            // Each jaw circle has two cushion ends on it: the rail's and the facing's.
            int on_circle = 0;
            for (const carom::Cushion& c : t.cushions) {
                for (const Vec2& end : {c.from, c.to}) {
                    if (std::abs((end - j.center).norm() - j.radius) < 1e-14) ++on_circle;
                }
            }
            EXPECT_EQ(on_circle, 2) << preset << " " << j.id;
        }
    }
}

TEST(NineFoot, FacingsAreTangentToTheirJaws) {
    const Table t = make_table("nine_foot");
    int facings = 0;
    for (const carom::Cushion& c : t.cushions) {
        if (c.name.find("facing") == std::string::npos) continue;
        ++facings;
        const Vec2 along = (c.to - c.from).normalized();
        double best = 1e9;
        for (const carom::Jaw& j : t.jaws) {
            if (std::abs((c.to - j.center).norm() - j.radius) < 1e-14) {
                best = std::fmin(best, std::abs((c.to - j.center).dot(along)) / j.radius);
            }
        }
        EXPECT_LT(best, 1e-12) << c.id << " " << c.name;
    }
    EXPECT_EQ(facings, 12);
}

TEST(NineFoot, MouthsAndAnglesFollowTheSpecification) {
    const Table t = make_table("nine_foot");
    EXPECT_EQ(t.width, 1.27);
    EXPECT_EQ(t.length, 2.54);
    // The points where a facing's line meets the nose lines x = 0 and y = 0.
    const auto on_axis = [](const carom::Cushion& c, int axis) {
        const double s = -c.from[axis] / (c.to[axis] - c.from[axis]);
        return Vec2(c.from + s * (c.to - c.from));
    };
    const Vec2 a = on_axis(t.cushions[0], 1), b = on_axis(t.cushions[1], 0);
    EXPECT_NEAR((a - b).norm(), 4.5625 * 0.0254, 1e-14);
    const Vec2 c = on_axis(t.cushions[3], 0), d = on_axis(t.cushions[4], 0);
    EXPECT_NEAR((c - d).norm(), 5.0625 * 0.0254, 1e-14);
    const auto angle_to_rail = [](const carom::Cushion& facing, const Vec2& rail) {
        return std::acos((facing.from - facing.to).normalized().dot(rail)) * 180.0 / 3.14159265358979323846;
    };
    EXPECT_NEAR(angle_to_rail(t.cushions[0], Vec2(1, 0)), 142.0, 1e-9);
    EXPECT_NEAR(angle_to_rail(t.cushions[3], Vec2(0, -1)), 104.0, 1e-9);
    const double nose = t.cushions[0].height / 0.05715;
    EXPECT_GE(nose, 0.625);
    EXPECT_LE(nose, 0.645);
}

// The surface is two inches longer than seven_foot's, the corners wider, the sides narrower.
TEST(SevenFootBar, HasItsSurfaceAndMouths) {
    const Table t = make_table("seven_foot_bar");
    EXPECT_EQ(t.preset, "seven_foot_bar");
    EXPECT_NEAR(t.width, 1.016, 1e-15);
    EXPECT_NEAR(t.length, 2.032, 1e-15);
    const auto on_axis = [](const carom::Cushion& c, int axis) {
        const double s = -c.from[axis] / (c.to[axis] - c.from[axis]);
        return Vec2(c.from + s * (c.to - c.from));
    };
    EXPECT_NEAR((on_axis(t.cushions[0], 1) - on_axis(t.cushions[1], 0)).norm(), 4.875 * 0.0254, 1e-14);
    EXPECT_NEAR((on_axis(t.cushions[3], 0) - on_axis(t.cushions[4], 0)).norm(), 4.75 * 0.0254, 1e-14);
    // The shelf: from the line of the points to where a ball falls.
    const Vec2 mouth = (on_axis(t.cushions[0], 1) + on_axis(t.cushions[1], 0)) / 2.0;
    const double shelf = (mouth - t.pockets[0].center).norm() - t.pockets[0].radius;
    EXPECT_GT(shelf, 0.041);
    EXPECT_LT(shelf, 0.048);
}

TEST(PocketTables, AreTheirOwnMirrorImages) {
    for (const char* preset : {"seven_foot", "seven_foot_bar", "eight_foot", "nine_foot"}) {
        const Table t = make_table(preset);
        for (const carom::Cushion& c : t.cushions) {
            for (const Vec2& end : {c.from, c.to}) {
                EXPECT_LT(nearest_end(t, Vec2(t.width - end.x(), end.y())), 1e-15);
                EXPECT_LT(nearest_end(t, Vec2(end.x(), t.length - end.y())), 1e-15);
            }
        }
    }
}

TEST(PocketTables, OrderIsClockwiseFromTheOrigin) {
    const Table t = make_table("nine_foot");
    EXPECT_EQ(t.cushions[2].id, "c3");
    EXPECT_EQ(t.cushions[2].name, "left rail, head half");
    EXPECT_EQ(t.cushions[2].from.x(), 0.0);
    EXPECT_EQ(t.cushions[8].name, "foot rail");
    EXPECT_EQ(t.cushions[8].from.y(), 2.54);
    EXPECT_EQ(t.cushions[17].name, "head rail");
    EXPECT_EQ(t.cushions[17].from.y(), 0.0);
    const double x[6] = {0, 0, 0, 1, 1, 1}, y[6] = {0, 0.5, 1, 1, 0.5, 0};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(t.pockets[i].id, std::string("p").append(std::to_string(i + 1)));
        EXPECT_NEAR(t.pockets[i].center.x() / t.width, x[i], 0.06) << i;
        EXPECT_NEAR(t.pockets[i].center.y() / t.length, y[i], 0.06) << i;
    }
    std::set<std::string> ids, names;
    for (const auto& c : t.cushions) ids.insert(c.id), names.insert(c.name);
    for (const auto& j : t.jaws) ids.insert(j.id), names.insert(j.name);
    for (const auto& p : t.pockets) ids.insert(p.id), names.insert(p.name);
    EXPECT_EQ(ids.size(), 36u);
    EXPECT_EQ(names.size(), 36u);
}

TEST(PocketTables, ABallFitsIntoEveryPocket) {
    for (const char* preset : {"seven_foot", "seven_foot_bar", "eight_foot", "nine_foot"}) {
        const Table t = make_table(preset);
        for (const carom::Pocket& p : t.pockets) {
            // Straight from the middle of the table (or of its half) into the pocket.
            const Vec2 middle(t.width / 2, std::abs(p.center.y() - t.length / 2) < 0.1 ? t.length / 2
                                           : p.center.y() < 0                          ? t.width / 2
                                                              : t.length - t.width / 2);
            const Vec2 way = p.center - middle;
            const double length = way.norm() - p.radius;
            for (int i = 0; i <= 1000; ++i) {
                const Vec2 at = middle + way.normalized() * (length * i / 1000.0);
                for (const carom::Jaw& j : t.jaws)
                    EXPECT_GT((at - j.center).norm(), j.radius + 0.028575) << preset << p.id;
                EXPECT_GT(nearest_end(t, at), 0.028575) << preset << p.id;
            }
        }
    }
}

TEST(CaromTable, HasFourRailsAndNothingElse) {
    const Table t = make_table("carom");
    EXPECT_TRUE(make_table("carom_ten_foot") == t);
    EXPECT_EQ(t.width, 1.42);
    EXPECT_EQ(t.length, 2.84);
    ASSERT_EQ(t.cushions.size(), 4u);
    EXPECT_TRUE(t.jaws.empty());
    EXPECT_TRUE(t.pockets.empty());
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(t.cushions[i].id, std::string("c").append(std::to_string(i + 1)));
        EXPECT_EQ(t.cushions[i].height, 0.037);
        EXPECT_EQ(t.cushions[i].to, t.cushions[(i + 1) % 4].from);
    }
}

TEST(Tables, UnknownPresetIsRefused) {
    EXPECT_THROW(make_table("twenty_foot"), std::invalid_argument);
    EXPECT_THROW(make_table(""), std::invalid_argument);
}

// Published sizes; table_presets.cpp names the unpublished ones.
TEST(Tables, PublishedSizes) {
    EXPECT_NEAR(make_table("eight_foot").length, 2.3368, 1e-12);
    EXPECT_NEAR(make_table("eight_foot").width, 1.1684, 1e-12);
    EXPECT_EQ(make_table("snooker").length, 3.569);
    EXPECT_EQ(make_table("snooker").width, 1.778);
    EXPECT_NEAR(make_table("snooker").cushions[0].height, 1.4 * 0.02625, 1e-15);
}

// Every pocket captures a ball that rolls at its middle, and none captures one that rolls along a rail past a
// corner's jaw.
TEST(Tables, NewTablesHaveSixPocketsThatFitABall) {
    for (const char* preset : {"eight_foot", "snooker"}) {
        const Table t = make_table(preset);
        const double R = preset == std::string("snooker") ? 0.02625 : 0.028575;
        ASSERT_EQ(t.pockets.size(), 6u);
        EXPECT_EQ(t.jaws.size(), 12u);
        EXPECT_EQ(t.cushions.size(), 18u);
        for (const carom::Pocket& p : t.pockets) {
            // The mouth, between the two nearest jaws, lets a ball in.
            std::vector<carom::Jaw> jaws = t.jaws;
            std::sort(jaws.begin(), jaws.end(), [&](const carom::Jaw& a, const carom::Jaw& b) {
                return (a.center - p.center).norm() < (b.center - p.center).norm();
            });
            const double mouth = (jaws[0].center - jaws[1].center).norm() - jaws[0].radius - jaws[1].radius;
            EXPECT_GT(mouth, 3.0 * R) << preset << " " << p.id;
            EXPECT_LT(mouth, 5.0 * R) << preset << " " << p.id;
            const Vec2 middle(t.width / 2.0, t.length / 2.0);
            const Vec2 inward = (middle - p.center).normalized();
            EXPECT_GT(p.radius, R * 0.9);
            EXPECT_LT((p.center - middle).dot(inward), 0.0);
        }
    }
}

// The BCA's middle value, 1 3/4 in, from the line between the two points to the edge over which a ball falls.
TEST(Tables, ShelvesFollowTheSpecification) {
    for (const char* preset : {"nine_foot", "eight_foot", "seven_foot_bar"}) {
        const Table t = make_table(preset);
        const double mouth = (preset == std::string("seven_foot_bar") ? 4.875 : 4.5625) * 0.0254;
        const double shelf = mouth / 2.0 + t.pockets[0].center.norm() - t.pockets[0].radius;
        EXPECT_NEAR(shelf, 1.75 * 0.0254, 1e-15) << preset;
        EXPECT_NEAR(-t.pockets[1].center.x() - t.pockets[1].radius, 0.004, 1e-15) << preset;
        EXPECT_EQ(t.jaws[0].radius, 0.003) << preset;
    }
}

}  // namespace
