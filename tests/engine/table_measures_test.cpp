// Presets with changed measures.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"
#include "support/scene_errors.h"

namespace carom::test {
namespace {

constexpr char kShot[] =
    "[[ball]]\nposition = [0.4, 0.5]\n[[ball]]\nid = \"1\"\nposition = [0.5, 0.9]\n[cue]\nspeed = 4\n"
    "aim_deg = 70\n";

std::string with_corner(const std::string& keys) {
    return "[table]\npreset = \"nine_foot\"\n[table.corner_pockets]\n" + keys + "\n" + kShot;
}

auto hash_of(const std::string& text) {
    return simulate(make_plan(parse_scene(text, "s.toml"), kernel::Isa::kFastest)).hash();
}

const Cushion& named(const Table& table, const std::string& name) {
    for (const Cushion& c : table.cushions)
        if (c.name == name) return c;
    throw std::logic_error("no cushion " + name);
}

const char* const kFacing = "head-left corner, facing of the head rail";
const char* const kOther = "head-left corner, facing of the left rail";

// A preset's own measures, written out, reproduce it bit for bit.
TEST(Measures, OfAPresetReproduceIt) {
    for (const char* preset : kTablePresets) {
        const Table plain = make_table(preset);
        Measures all = measures_of(preset);
        for (const bool throat : {false, true}) {
            for (const PocketSection& of : kPocketSections)
                (throat ? (all.*of.pockets).angle_deg : (all.*of.pockets).throat).reset();
            const Table same = make_table(preset, all);
            EXPECT_TRUE(same.cushions == plain.cushions) << preset;
            EXPECT_TRUE(same.jaws == plain.jaws) << preset;
            EXPECT_TRUE(same.pockets == plain.pockets) << preset;
            all = measures_of(preset);
        }
        EXPECT_EQ(error_of("[table]\npreset = \"" + std::string(preset) +
                           "\"\nsize = [0.9, 1.8]\n[[ball]]\nposition = [0.4, 0.5]\n"),
                  "")
            << preset;
    }
    EXPECT_EQ(hash_of(with_corner("mouth = \"4.5625 in\"\nangle_deg = 142\nshelf = \"1.75 in\"")),
              hash_of(kShot));
    EXPECT_NE(hash_of("[table]\nsize = [1.2, 2.4]\n" + std::string(kShot)), hash_of(kShot));
}

TEST(Measures, AppearInTheTable) {
    const Scene scene = parse_scene(
        "[table]\nrail_width = 0.045\ncushion_height = 0.036\nsize = [1.25, 2.5]\n"
        "[table.corner_pockets]\nmouth = 0.11\nangle_deg = 140\nshelf = 0.03\n"
        "radius = 0.06\njaw_radius = 0.004\n[table.side_pockets]\nmouth = 0.12\n"
        "angle_deg = 100\nshelf = 0.005\n" +
            std::string(kShot),
        "s.toml");
    const Table& t = scene.table;
    EXPECT_EQ(t.width, 1.25);
    EXPECT_EQ(t.length, 2.5);
    const Cushion &facing = named(t, kFacing), &other = named(t, kOther);
    EXPECT_EQ(facing.height, 0.036);
    EXPECT_NEAR(facing.from.y(), -0.045, 1e-15);
    // The lines of facing and nose meet at the ends of the mouth.
    const Vec2 along = facing.to - facing.from;
    const double x = facing.to.x() - facing.to.y() * along.x() / along.y();
    EXPECT_NEAR(x * std::sqrt(2.0), 0.11, 1e-14);
    EXPECT_NEAR(std::atan2(along.y(), -along.x()), 140.0 * M_PI / 180.0, 1e-12);
    // From the middle of the mouth to the nearest point of the hole.
    const Pocket& hole = t.pockets[0];
    EXPECT_NEAR((Vec2(x / 2.0, x / 2.0) - hole.center).norm() - hole.radius, 0.03, 1e-14);
    EXPECT_EQ(hole.radius, 0.06);
    EXPECT_EQ(t.jaws[0].radius, 0.004);
    const Cushion& side = named(t, "left side pocket, facing of the head half");
    EXPECT_NEAR(side.from.y(), (2.5 - 0.12) / 2.0 + 0.045 * std::tan(10.0 * M_PI / 180.0), 1e-14);
    EXPECT_NEAR(-t.pockets[1].center.x() - t.pockets[1].radius, 0.005, 1e-15);
    // The throat follows from the back ends, and determines the facing.
    const Measures all = measures_of("nine_foot", t.measures);
    EXPECT_NEAR((facing.from - other.from).norm(), *all.corner_pockets.throat, 1e-14);
    const Table again =
        parse_scene("[table]\nrail_width = 0.045\n[table.corner_pockets]\nmouth = 0.11\nthroat = " +
                        std::to_string(0.08) + "\n" + kShot,
                    "s.toml")
            .table;
    EXPECT_NEAR((named(again, kFacing).from - named(again, kOther).from).norm(), 0.08, 1e-14);
}

// A tighter mouth keeps the shelf.
TEST(Measures, KeepTheOthers) {
    const Measures plain = measures_of("nine_foot"),
                   tight = measures_of("nine_foot", {.corner_pockets = {.mouth = 0.108}});
    EXPECT_EQ(*tight.corner_pockets.mouth, 0.108);
    EXPECT_NEAR(*tight.corner_pockets.shelf, *plain.corner_pockets.shelf, 1e-15);
    EXPECT_TRUE(tight.side_pockets == plain.side_pockets);
}

// The messages for refused texts are in tests/data/scene_messages.toml.
TEST(Measures, BuiltInCodeObeyTheSameRules) {
    Scene scene = parse_scene(kShot, "s.toml");
    scene.table = make_table("nine_foot", {.corner_pockets = {.mouth = 0.05}});
    EXPECT_THROW(validate(scene), SceneError);
    scene.table = make_table("nine_foot", {.corner_pockets = {.mouth = std::nan("")}});
    EXPECT_THROW(validate(scene), SceneError);
}

TEST(Measures, SurviveTextsAndRecords) {
    const Scene scene = parse_scene(with_corner("mouth = 0.108\nthroat = 0.09"), "s.toml");
    const std::string text = scene_text(scene);
    EXPECT_NE(text.find("[table.corner_pockets]\nmouth = 0.108\nthroat = 0.09\n"), text.npos) << text;
    EXPECT_TRUE(parse_scene(text, "s.toml").table == scene.table);
    const Record record = simulate(make_plan(scene, kernel::Isa::kFastest));
    const Record kept = parse_record(record_json(record), "r.json");
    EXPECT_TRUE(kept.table == scene.table);
    EXPECT_EQ(kept.hash(), hash_of(text));
}

TEST(Measures, VaryInSweeps) {
    const Variation varied = Variation::from_text(
        kShot, "s.toml", {"table.corner_pockets.mouth=list(0.1, 0.12)", "table.cushion_height=list(0.036)"},
        1);
    for (std::uint64_t i = 0; i < 4; ++i) {
        const VariedShot shot = varied.shot(i);
        ASSERT_TRUE(shot.scene) << shot.error;
        const double mouth = number_of(shot.values[0]);
        EXPECT_TRUE(*shot.scene ==
                        parse_scene("[table]\ncushion_height = 0.036\n[table.corner_pockets]\nmouth = " +
                                        text_of(shot.values[0]) + "\n" + kShot,
                                    "s.toml") ||
                    shot.scene->table == make_table("nine_foot", shot.scene->table.measures));
        EXPECT_EQ(*shot.scene->table.measures.corner_pockets.mouth, mouth);
    }
    EXPECT_EQ(varied.unit(0), "m");
    EXPECT_THROW(Variation::from_text(kShot, "s.toml", {"table.corner_pockets.muoth=list(0.1)"}, 1),
                 VariationError);
}

/// A preset's outline as a person would write it.
std::string outline_of(const Table& table, double dx, double dy) {
    const auto at = [&](const Vec2& p) { return fmt::format("[{}, {}]", p.x() + dx, p.y() + dy); };
    std::string text;
    for (const Cushion& c : table.cushions)
        text += fmt::format("[[table.cushion]]\nfrom = {}\nto = {}\nheight = {}\n", at(c.from), at(c.to),
                            c.height);
    for (const Jaw& j : table.jaws)
        text += fmt::format("[[table.jaw]]\ncenter = {}\nradius = {}\nheight = {}\n", at(j.center), j.radius,
                            j.height);
    for (const Pocket& p : table.pockets)
        text += fmt::format("[[table.pocket]]\ncenter = {}\nradius = {}\n", at(p.center), p.radius);
    return text;
}

constexpr char kBreak[] =
    "[balls]\npreset = \"pool\"\n[rack]\ngame = \"nine_ball\"\n[[ball]]\nposition = [0.5, 0.4]\n[cue]\nspeed "
    "= 6\naim_deg = 86\n";

// Facings extend behind the noses; they once moved the rack.
TEST(Outlines, ArePlacedByTheirNoses) {
    for (const char* preset : {"nine_foot", "seven_foot", "english_pool"}) {
        const Table table = make_table(preset);
        EXPECT_EQ(hash_of(outline_of(table, 0.0, 0.0) + kBreak),
                  hash_of("[table]\npreset = \"" + std::string(preset) + "\"\n" + kBreak))
            << preset;
        const Table moved = parse_scene(outline_of(table, 0.25, -0.5) + kShot, "s.toml").table;
        EXPECT_NEAR(moved.corner.x(), 0.25, 1e-15);
        EXPECT_NEAR(moved.corner.y(), -0.5, 1e-15);
        EXPECT_NEAR(moved.length, table.length, 1e-15);
        EXPECT_NEAR((foot_spot(moved) - foot_spot(table) - Vec2(0.25, -0.5)).norm(), 0.0, 1e-15);
    }
    // An outline without straight rails uses its bounding box.
    const Table turned =
        parse_scene(
            "[[table.cushion]]\nfrom = [0, 1]\nto = [1, 0]\n[[table.cushion]]\nfrom = [1, 0]\n"
            "to = [2, 1]\n[[ball]]\nposition = [1, 1]\n",
            "s.toml")
            .table;
    EXPECT_EQ(turned.width, 2.0);
    EXPECT_EQ(turned.length, 1.0);
}

// Each game's balls fit its mouths, and a break ends at rest.
TEST(Presets, AreRackedAndBroken) {
    const struct {
        const char *table, *balls, *game;
        double width, length, corner, side;
    } kCases[] = {{"nine_foot_tight", "pool", "nine_ball", 1.27, 2.54, 0.10795, 0.1285875},
                  {"ten_foot", "pool", "ten_ball", 1.4224, 2.8448, 0.1158875, 0.1285875},
                  {"chinese_eight_ball", "pool", "eight_ball", 1.27, 2.54, 0.085, 0.086},
                  {"pyramid", "pyramid", "pyramid", 1.775, 3.55, 0.0725, 0.0825},
                  {"snooker_ten_foot", "snooker", "snooker", 1.4732, 2.8702, 0.089, 0.105},
                  {"carom_small", "carom", "three_cushion", 1.15, 2.3, 0.0, 0.0}};
    for (const auto& c : kCases) {
        const std::string cue = std::string(c.game) == "three_cushion"
                                    ? "[cue]\nball = \"white\"\n"
                                    : "[[ball]]\nposition = [0.5, 0.4]\n[cue]\n";
        const Scene scene =
            parse_scene(fmt::format("[table]\npreset = \"{}\"\n[balls]\npreset = \"{}\"\n[rack]\n"
                                    "game = \"{}\"\n{}speed = 6\naim_deg = 82\n",
                                    c.table, c.balls, c.game, cue),
                        "s.toml");
        EXPECT_EQ(scene.table.preset, c.table);
        EXPECT_NEAR(scene.table.width, c.width, 1e-15) << c.table;
        EXPECT_NEAR(scene.table.length, c.length, 1e-15) << c.table;
        const Measures all = measures_of(c.table);
        if (c.corner > 0.0) {
            EXPECT_NEAR(*all.corner_pockets.mouth, c.corner, 1e-15) << c.table;
            EXPECT_NEAR(*all.side_pockets.mouth, c.side, 1e-15) << c.table;
            // The preset meets the rules for a user's measures.
            Scene same = scene;
            same.table =
                make_table(c.table, {.cushion_height = all.cushion_height, .rail_width = all.rail_width});
            EXPECT_NO_THROW(validate(same)) << c.table;
        }
        const Record record = simulate(make_plan(scene, kernel::Isa::kFastest));
        EXPECT_EQ(record.tracks.size(), scene.ball.size());
        EXPECT_GT(record.events.size(), 5u) << c.table;
    }
}

// Fifteen balls at the foot spot; one rolled straight at a corner falls through a mouth that leaves 2.25 mm
// on either side.
TEST(Presets, APyramidBallFallsThroughItsMouth) {
    const Scene rack = parse_scene(
        "[table]\npreset = \"pyramid\"\n[balls]\npreset = \"pyramid\"\n[rack]\ngame = \"pyramid\"\ngap = 0\n",
        "s.toml");
    ASSERT_EQ(rack.ball.size(), 15u);
    EXPECT_NEAR((planar(rack.ball[0].position) - Vec2(0.8875, 2.6625)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((rack.ball[14].position - rack.ball[10].position).norm(), 8.0 * 0.034, 1e-15);
    const auto pocket = [](double aside) {
        const Scene scene = parse_scene(fmt::format("[table]\npreset = \"pyramid\"\n[balls]\npreset = "
                                                    "\"pyramid\"\n[[ball]]\nposition = [{}, {}]\n"
                                                    "velocity = [-1, -1]\n",
                                                    0.5 + aside, 0.5 - aside),
                                        "s.toml");
        return simulate(make_plan(scene, kernel::Isa::kFastest)).tracks[0].pocket;
    };
    EXPECT_EQ(pocket(0.0), 0);
    EXPECT_EQ(pocket(0.04), -1);
}

/// A draw in [low, high) from a simple generator.
class Draw {
  public:
    double operator()(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * (static_cast<double>(state_ >> 11) * 0x1p-53);
    }

  private:
    std::uint64_t state_ = 1;
};

// Every table either plays to rest, with its balls on it or in a pocket, or is refused with a line number.
TEST(Measures, AtRandomPlayOrAreRefused) {
    Draw draw;
    int played = 0;
    for (int i = 0; i < 1000; ++i) {
        std::string text = "[table]\npreset = \"" + std::string(i % 2 ? "nine_foot" : "snooker") + "\"\n";
        if (draw(0, 1) < 0.3) text += "rail_width = " + std::to_string(draw(0.01, 0.1)) + "\n";
        for (const char* section : {"corner_pockets", "side_pockets"}) {
            text += "[table." + std::string(section) + "]\n";
            const auto maybe = [&](const char* key, double low, double high) {
                if (draw(0, 1) < 0.35)
                    text += std::string(key) + " = " + std::to_string(draw(low, high)) + "\n";
            };
            maybe("mouth", 0.04, 0.2);
            if (draw(0, 1) < 0.5)
                maybe("throat", 0.02, 0.15);
            else
                maybe("angle_deg", 90, 150);
            maybe("shelf", 0.0, 0.1);
            maybe("jaw_radius", 0.0, 0.1);
            maybe("radius", 0.01, 0.1);
        }
        text += "[[ball]]\nposition = [0.6, 0.8]\n[cue]\nspeed = " + std::to_string(draw(2, 6)) +
                "\naim_deg = " + std::to_string(draw(0, 360)) + "\n";
        const std::string error = error_of(text);
        if (!error.empty()) {
            EXPECT_NE(error.find("s.toml:"), error.npos) << error;
            EXPECT_EQ(error.find("s.toml: "), error.npos) << error;
            continue;
        }
        ++played;
        const Record record = simulate(make_plan(parse_scene(text, "s.toml"), kernel::Isa::kFastest));
        const Segment& last = record.tracks[0].segments.back();
        const Table& t = record.table;
        const bool on_table = last.r.x() > -0.1 && last.r.x() < t.width + 0.1 && last.r.y() > -0.1 &&
                              last.r.y() < t.length + 0.1;
        EXPECT_TRUE(record.tracks[0].pocket >= 0 || on_table) << text;
    }
    EXPECT_GT(played, 50);
    EXPECT_LT(played, 900);
}

}  // namespace
}  // namespace carom::test
