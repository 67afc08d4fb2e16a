// Cameras, overlays and the outline, without pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/render/draw_list.h"
#include "carom/render/error.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

using render_test::add_ball;
using render_test::kR;

Record shot() {
    Record record;
    record.table = make_table("nine_foot");
    record.balls.R = kR;
    record.duration = 2.0;
    Segment segment = render_test::still({0.6, 0.5, kR});
    segment.v = Vec3(0.0, 1.0, 0.0);
    segment.w = Vec3(-1.0 / kR, 0.0, 20.0);
    segment.state = MotionState::kRolling;
    segment.a = Vec2(0.0, -1.0);  // at rest after one second
    segment.duration = 1.0;
    Segment stopped = render_test::still({0.6, 1.0, kR});
    stopped.start = 1.0;
    BallTrack track{"cue", {segment, stopped}, -1};
    record.tracks = {track};
    add_ball(record, "8", 0.6, 2.0);
    record.events = {{0.0, EventType::kCueStrike, 0, -1}, {1.0, EventType::kBallBall, 0, 1}};
    return record;
}

StageOptions view(const std::string& camera, FrameSize size = {640, 360}) {
    StageOptions options;
    options.camera = camera;
    options.size = size;
    return options;
}

constexpr FrameSize kSizes[] = {{640, 360}, {360, 640}, {500, 500}, {2000, 300}};

/// The largest distance of a moving ball from the middle of the image; 1 is the edge.
double farthest_out(const Record& record, const Camera& camera) {
    double most = 0.0;
    for (int k = 0; k <= 40; ++k) {
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            if (record.tracks[i].segments[0].v.norm() == 0.0) continue;
            const BallState state = record.state_at(static_cast<int>(i), 0.05 * k);
            const std::optional<Vec2> pixel = camera.project(state.position);
            if (!pixel) return 1e9;
            most = std::max({most, std::abs(2.0 * pixel->x() / camera.size.width - 1.0),
                             std::abs(2.0 * pixel->y() / camera.size.height - 1.0)});
        }
    }
    return most;
}

/// A shot over the whole table: one ball from corner to corner, and one across, away from the first.
Record long_shot() {
    Record record = shot();
    record.tracks.pop_back();
    record.events.pop_back();
    record.tracks[0].segments.resize(1);
    Segment& along = record.tracks[0].segments[0];
    along.r = Vec3(0.05, 0.3, kR);
    along.v = Vec3(0.57, 1.1, 0.0);
    along.a = Vec2::Zero();
    along.duration = 2.0;
    Segment across = along;
    across.r = Vec3(0.05, 2.4, kR);
    across.v = Vec3(0.57, -0.2, 0.0);
    add_ball(record, "3", across);
    return record;
}

TEST(Cameras, RailAndPlayerShowTheBallsThatMoveAtEverySize) {
    const Record small = shot(), large = long_shot();
    for (const FrameSize size : kSizes) {
        for (const char* name : {"rail", "player"}) {
            EXPECT_LT(farthest_out(small, Stage(small, view(name, size)).at(0.0).camera), 1.0)
                << name << size.width;
            const double out = farthest_out(large, Stage(large, view(name, size)).at(0.0).camera);
            EXPECT_LT(out, 1.0) << name << size.width;
            EXPECT_GT(out, 0.7) << name << size.width << ": the picture is full";
        }
        const Camera rail = Stage(large, view("rail", size)).at(0.0).camera;
        // The head rail is nearer, so lower in the image than the foot rail.
        EXPECT_GT(rail.project({0.6, 0.0, 0.0})->y(), rail.project({0.6, 2.5, 0.0})->y());
    }
}

TEST(Cameras, PlayerLooksAlongTheShot) {
    const Record record = shot();
    const Camera camera = Stage(record, view("player")).at(0.0).camera;
    const Vec2 ball = *camera.project({0.6, 0.5, kR}), target = *camera.project({0.6, 2.0, kR});
    EXPECT_NEAR(ball.x(), 320.0, 1.0);
    EXPECT_NEAR(target.x(), 320.0, 1.0);
    EXPECT_GT(ball.y(), target.y());
    EXPECT_GT(target.y(), 0.0);
    EXPECT_LT(ball.y(), 360.0);
}

TEST(Cameras, FollowIsSmoothAndKeepsTheBallInSight) {
    const Record record = shot();
    const Stage stage(record, view("follow"));
    Vec3 before = stage.at(-1.0).camera.eye, step_before = Vec3::Zero();
    for (int k = -59; k <= 240; ++k) {
        const double t = k / 60.0;
        const Camera camera = stage.at(t).camera;
        const Vec2 ball = *camera.project(record.state_at(0, t).position);
        EXPECT_GT(ball.minCoeff(), 0.0);
        EXPECT_LT(ball.x(), 640.0);
        EXPECT_LT(ball.y(), 360.0);
        // The ball starts at 1 m/s at once; the camera's step changes little from frame to frame.
        const Vec3 step = camera.eye - before;
        EXPECT_LT((step - step_before).norm(), 0.1 / 60.0) << t;
        before = camera.eye;
        step_before = step;
    }
    EXPECT_TRUE(stage.at(1.8).camera == stage.at(1.9).camera) << "at rest the table need not be drawn again";
}

TEST(Cameras, FreeViewsWorkAndBadOnesAreRefused) {
    const Record record = shot();
    StageOptions options = view("top");
    options.view.eye = Vec3(0.0, -1.0, 1.0);
    options.view.target = Vec3(0.6, 1.0, 0.0);
    const Camera camera = Stage(record, options).at(0.0).camera;
    EXPECT_NEAR((*camera.project({0.6, 1.0, 0.0}) - Vec2(320, 180)).norm(), 0.0, 1e-9);
    EXPECT_GT(camera.image_up().z(), 0.0);
    options.view.eye = Vec3(0.6, 1.0, 3.0);
    EXPECT_NEAR(Stage(record, options).at(0.0).camera.image_up().y(), 1.0, 1e-12) << "straight down";
    options.view.target.reset();
    EXPECT_THROW(Stage(record, options), RenderError);
    options.view.target = options.view.eye;
    EXPECT_THROW(Stage(record, options), RenderError);
    EXPECT_THROW(Stage(record, view("drone")), RenderError);
    options = view("follow");
    options.view.ball = "17";
    try {
        const Stage stage(record, options);
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_STREQ(error.what(), "no ball '17' to follow; expected one of cue, 8");
    }
    // A record's ids come from a file.
    Record hostile = record;
    hostile.tracks[1].id = "\x1b[2J";
    for (int i = 0; i < 50; ++i) hostile.tracks.push_back(hostile.tracks[1]);
    try {
        const Stage stage(hostile, options);
        FAIL();
    } catch (const RenderError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.find('\x1b'), std::string::npos) << what;
        EXPECT_NE(what.find("expected one of cue, ?[2J, ?[2J"), std::string::npos) << what;
        EXPECT_NE(what.find(" and 12 more"), std::string::npos) << what;
    }
}

// The cue aims, draws back, meets the ball at 0, follows through, and disappears.
TEST(Cues, AreDrawnAroundTheStrike) {
    Record record = shot();
    const Stage stage(record, view("top"));
    const auto gap = [&](double t) {
        const std::optional<DrawCue> cue = stage.at(t).cue;
        EXPECT_TRUE(cue) << t;
        EXPECT_NEAR((cue->butt - cue->tip).norm(), 1.47, 1e-9);
        EXPECT_LT(cue->butt.y(), cue->tip.y()) << "the ball goes along +y";
        EXPECT_GT(cue->butt.z(), stage.table()->wood_top) << "it is above the rail";
        return (cue->tip - Vec3(0.6, 0.5, kR)).norm();
    };
    EXPECT_NEAR(gap(0.0), kR, 1e-9);
    EXPECT_GT(gap(-0.3), gap(-1.5) + 0.1);
    EXPECT_LT(gap(-0.1), gap(-0.3));
    EXPECT_LT(stage.at(0.05).cue->butt.y(), -0.8) << "it follows through by less than the ball goes";
    EXPECT_GT(stage.at(0.05).cue->tip.y(), stage.at(0.0).cue->tip.y());
    // Struck on its right, a ball turns counter-clockwise.
    EXPECT_GT(stage.at(0.0).cue->tip.x(), 0.6);
    EXPECT_FALSE(stage.at(0.2).cue);
    record.render.hides_cue = true;
    EXPECT_FALSE(Stage(record, view("top")).at(0.0).cue);
    record = shot();
    record.events.clear();
    EXPECT_FALSE(Stage(record, view("top")).at(0.0).cue) << "nothing was struck";
}

TEST(Overlays, NamesAreReadAndUnknownOnesRefused) {
    EXPECT_FALSE(parse_overlay("").any());
    const Overlay some = parse_overlay("trails,clock");
    EXPECT_TRUE(some.trails && some.clock);
    EXPECT_FALSE(some.events || some.spin || some.ghost || some.margin);
    const Overlay all = parse_overlay("all");
    EXPECT_TRUE(all.trails && all.events && all.spin && all.ghost && all.clock && all.margin);
    EXPECT_TRUE(parse_overlay("diamonds").diamonds && parse_overlay("diamonds").any());
    EXPECT_FALSE(all.diamonds);
    EXPECT_TRUE(parse_overlay("trails=ball").trails && parse_overlay("trails=ball").ball_trails);
    EXPECT_FALSE(all.ball_trails);
    for (const char* bad : {"trail", "clock=ball", "trails,", "trails, clock", "trails;clock"}) {
        EXPECT_THROW(parse_overlay(bad), RenderError) << bad;
    }
}

DrawList overlaid(const std::string& overlay, double t) {
    static const Record record = shot();
    StageOptions options = view("top");
    options.overlay = parse_overlay(overlay);
    return Stage(record, options).at(t, FrameBudget{20.0, 10.0});
}

TEST(Overlays, TrailsEndAtTheBall) {
    EXPECT_TRUE(overlaid("trails", 0.0).lines.empty());
    const DrawList list = overlaid("trails", 0.4);
    ASSERT_EQ(list.lines.size(), 1U);
    EXPECT_NEAR(list.lines[0].a.y(), 0.5, 1e-12);
    EXPECT_NEAR(list.lines[0].b.y(), 0.82, 1e-12);
    EXPECT_EQ(list.lines[0].layer, LineLayer::kUnderBalls);
}

// A curved path is drawn within a quarter of a pixel at any size.
TEST(Overlays, CurvedTrailsHaveNoCorners) {
    Record record = shot();
    Segment& segment = record.tracks[0].segments[0];
    segment.v = Vec3(0.3, 1.2, 0.0);
    segment.a = Vec2(-1.8, -0.4);
    record.tracks[0].segments.resize(1);
    StageOptions options = view("top", {1920, 1080});
    options.overlay = parse_overlay("trails=ball");
    const DrawList list = Stage(record, options).at(0.8);
    ASSERT_GT(list.lines.size(), 8U);
    double end = 0.0;
    for (std::size_t i = 0; i < list.lines.size(); ++i) {
        const double middle = 0.8 * (static_cast<double>(i) + 0.5) / static_cast<double>(list.lines.size());
        const Vec3 path = position_at(segment, middle), line = 0.5 * (list.lines[i].a + list.lines[i].b);
        EXPECT_LT((path - line).head<2>().norm() * list.camera.scale(path), 0.26);
        end = list.lines[i].b.y();
        EXPECT_EQ(list.lines[i].color[0], ball_style("cue", "nine_foot", 0).color[0]);
    }
    EXPECT_NEAR(end, position_at(segment, 0.8).y(), 1e-9);
}

// A pocketed ball sinks from its place, and lies still after 0.15 s.
TEST(Stages, APocketedBallSinks) {
    Record record = shot();
    const Pocket& pocket = record.table.pockets[0];
    Segment gone = render_test::still({pocket.center.x(), pocket.center.y(), -pocket.depth});
    gone.state = MotionState::kPocketed;
    gone.start = 0.5;
    record.tracks[0].segments.resize(1);
    record.tracks[0].segments.push_back(gone);
    record.tracks[0].pocket = 0;
    const Stage stage(record, view("top"));
    Vec3 before = record.state_at(0, 0.4999999).position;
    for (int k = 0; k <= 160; ++k) {
        const DrawBall ball = stage.at(0.5 + 0.001 * k).balls[0];
        EXPECT_TRUE(ball.in_pocket);
        EXPECT_LE(ball.center.z(), before.z() + 1e-9) << k;
        EXPECT_LT((ball.center - before).norm(), k == 0 ? 1e-5 : 0.02)
            << "no faster than a ball falls and rolls";
        before = ball.center;
    }
    EXPECT_TRUE(before == gone.r);
}

TEST(Overlays, EventsAppearWhenTheyHappen) {
    EXPECT_EQ(overlaid("events", 0.9).lines.size(), 1U) << "the cue strike";
    const DrawList fresh = overlaid("events", 1.1), old = overlaid("events", 1.9);
    EXPECT_EQ(old.lines.size(), 2U);
    EXPECT_GT(fresh.lines.size(), 10U) << "with a ring";
    EXPECT_NEAR(old.lines[1].a.y(), 1.5, 1e-9) << "between the two balls";
}

TEST(Overlays, GhostMarksTheBallsPlaceAtContact) {
    const DrawList list = overlaid("ghost", 0.2);
    ASSERT_GT(list.lines.size(), 10U);
    for (std::size_t i = 0; i + 1 < list.lines.size(); ++i) {
        EXPECT_NEAR((list.lines[i].a - Vec3(0.6, 1.0, kR)).norm(), kR, 1e-9);
    }
    EXPECT_TRUE(overlaid("ghost", 1.5).lines.empty());
}

TEST(Overlays, SpinArrowFollowsTheTopOfTheBall) {
    const DrawList list = overlaid("spin", 0.5);
    ASSERT_FALSE(list.lines.empty());
    const Vec3 arrow = list.lines[0].b - list.lines[0].a;
    EXPECT_NEAR(arrow.x(), 0.0, 1e-12);
    EXPECT_NEAR(arrow.y(), 0.05, 1e-9) << "a tenth of a second at half a metre a second";
    EXPECT_TRUE(overlaid("spin", 1.5).lines.empty()) << "nothing turns any more";
}

TEST(Overlays, ClockAndMarginAreBoxesInsideTheImage) {
    for (const char* name : {"clock", "margin"}) {
        const DrawList list = overlaid(name, 0.5);
        ASSERT_GT(list.boxes.size(), 4U);
        for (const DrawBox& box : list.boxes) {
            EXPECT_GE(box.low.minCoeff(), 0.0);
            EXPECT_LE(box.high.x(), 640.0);
            EXPECT_LE(box.high.y(), 360.0);
        }
    }
}

TEST(BallStyles, DependOnIdAndTable) {
    EXPECT_EQ(ball_style("3", "nine_foot", 0).number, 3);
    EXPECT_EQ(ball_style("3", "nine_foot", 0).pattern, BallPattern::kSolid);
    EXPECT_EQ(ball_style("8", "", 0).pattern, BallPattern::kSolid);
    EXPECT_EQ(ball_style("9", "", 0).pattern, BallPattern::kStripe);
    for (int i = 1; i <= 7; ++i) {
        EXPECT_EQ(ball_style(std::to_string(i), "", 0).color, ball_style(std::to_string(i + 8), "", 0).color)
            << i;
    }
    const BallStyle red = ball_style("red", "snooker", 0);
    EXPECT_EQ(ball_style("3", "snooker", 0).color, red.color) << "numbered reds";
    EXPECT_EQ(ball_style("3", "snooker", 0).number, 0);
    EXPECT_GT(red.color[0], 0.7F);
    EXPECT_LT(red.color[1], 0.2F);
    for (const char* id : {"yellow", "green", "brown", "blue", "pink", "black", "white", "cue"}) {
        EXPECT_EQ(ball_style(id, "snooker", 0).pattern, BallPattern::kDots) << id;
        EXPECT_NE(ball_style(id, "snooker", 0).color, red.color) << id;
    }
    EXPECT_EQ(ball_style("target", "", 2).pattern, BallPattern::kHalves);
    EXPECT_EQ(ball_style("", "", 2).number, 0);
    EXPECT_EQ(ball_style("123", "", 2).number, 0);
}

TEST(TableMesh, ThePresetsHaveAllParts) {
    for (const char* preset : {"seven_foot", "nine_foot", "carom"}) {
        const Table table = make_table(preset);
        const TableMesh mesh = make_table_mesh(table, kR, {Vec2(0.5, 0.5)});
        EXPECT_EQ(mesh.holes.size(), table.pockets.size());
        std::array<int, 9> used{};
        for (const MeshVertex& vertex : mesh.solid) {
            ASSERT_TRUE(std::isfinite(vertex.x + vertex.y + vertex.z + vertex.nx + vertex.ny + vertex.nz));
            ++used[vertex.material];
        }
        EXPECT_GT(used[static_cast<std::size_t>(Material::kCloth)], 0);
        EXPECT_GT(used[static_cast<std::size_t>(Material::kCushion)], 0);
        EXPECT_GT(used[static_cast<std::size_t>(Material::kWood)], 0);
        EXPECT_EQ(used[static_cast<std::size_t>(Material::kPocket)] > 0, !table.pockets.empty());
        EXPECT_FALSE(mesh.blended.empty());
    }
}

// Two boards meet in each corner of the frame, and the grain of one ends there.
TEST(TableMesh, WoodHasAMitreAtEveryCorner) {
    const Table table = make_table("nine_foot");
    const TableMesh mesh = make_table_mesh(table, kR, {Vec2(0.5, 0.5)});
    for (const double x : {mesh.inner_low.x(), mesh.inner_high.x()}) {
        for (const double y : {mesh.inner_low.y(), mesh.inner_high.y()}) {
            float least = 1e9F, most = -1e9F;
            int found = 0;
            for (const MeshVertex& vertex : mesh.solid) {
                const bool wood = static_cast<Material>(static_cast<int>(vertex.material)) == Material::kWood;
                const Vec2 place = Vec2(vertex.x, vertex.y) + mesh.origin - Vec2(x, y);
                if (!wood || place.norm() > 1e-5 || vertex.z < mesh.wood_top - 0.01) continue;
                ++found;
                least = std::min(least, vertex.u);
                most = std::max(most, vertex.u);
            }
            EXPECT_GT(found, 1);
            EXPECT_GT(most - least, 0.1F) << x << " " << y;
        }
    }
}

// The drawn noses are the cushions and jaws that balls bounce off: at nose height no vertex of a cushion
// reaches into the table, and every point of the outline is drawn.
TEST(TableMesh, NosesAreTheOutlineThatBallsBounceOff) {
    const Table table = make_table("nine_foot");
    const TableMesh mesh = make_table_mesh(table, kR, {Vec2(0.5, 0.5)});
    std::vector<Vec2> noses;
    for (const MeshVertex& vertex : mesh.solid) {
        const bool cushion = static_cast<Material>(static_cast<int>(vertex.material)) == Material::kCushion;
        if (cushion) noses.emplace_back(vertex.x + mesh.origin.x(), vertex.y + mesh.origin.y());
    }
    for (const Vec2& nose : noses) {
        const bool inside = nose.x() > 1e-6 && nose.x() < table.width - 1e-6 && nose.y() > 1e-6 &&
                            nose.y() < table.length - 1e-6;
        EXPECT_FALSE(inside) << nose.transpose();
    }
    const auto is_drawn = [&](const Vec2& point) {
        double nearest = 1.0;
        for (const Vec2& nose : noses) nearest = std::min(nearest, (nose - point).norm());
        return nearest < 1e-6;
    };
    for (const Cushion& cushion : table.cushions) {
        EXPECT_TRUE(is_drawn(cushion.from)) << cushion.id;
        EXPECT_TRUE(is_drawn(cushion.to)) << cushion.id;
    }
    // The middle of each jaw's arc: the point of its circle nearest to the middle of the table or a pocket's
    // mouth.
    for (const Jaw& jaw : table.jaws) {
        int on_circle = 0;
        for (const Vec2& nose : noses) on_circle += std::abs((nose - jaw.center).norm() - jaw.radius) < 1e-6;
        EXPECT_GT(on_circle, 20) << jaw.id;
    }
}

TEST(TableMesh, OddOutlinesYieldFiniteMeshes) {
    Table table;
    table.cushions = {{"a", {0, 0}, {1, 0}, 0.03}, {"b", {1, 0}, {1, 1}, 0.03}, {"c", {3, 3}, {4, 4}, 0.03}};
    table.jaws = {{"post", {2, 2}, 0.1, 0.03}};
    for (const std::vector<Vec2>& visited :
         {std::vector<Vec2>{}, std::vector<Vec2>{{0.5, 0.5}}, std::vector<Vec2>{{0.5, 0.5}, {2.0, -1.0}},
          std::vector<Vec2>{{9e4, -9e4}}}) {
        const TableMesh mesh = make_table_mesh(table, kR, visited);
        EXPECT_FALSE(mesh.solid.empty());
        for (const MeshVertex& vertex : mesh.solid) {
            ASSERT_TRUE(std::isfinite(vertex.x + vertex.y + vertex.z + vertex.nx + vertex.ny + vertex.nz));
        }
        EXPECT_TRUE(mesh.bounds.low.allFinite() && mesh.bounds.high.allFinite());
        EXPECT_GT((mesh.bounds.high - mesh.bounds.low).minCoeff(), 0.0);
    }
}

}  // namespace
}  // namespace carom::render
