// A moving camera: one sample per pixel, with edges smoothed by the area that they cut off.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "carom/render/renderer.h"
#include "draw/edge_smoother.h"
#include "draw/table_parts.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

constexpr std::uint8_t kLeft = 1, kRight = 2;

// A camera that maps x and y, in pixels, to the same pixels with depth 1.
View flat_view(FrameSize size) {
    View view;
    view.view_projection[0] = 2.0F / static_cast<float>(size.width);
    view.view_projection[5] = 2.0F / static_cast<float>(size.height);
    view.view_projection[12] = view.view_projection[13] = -1.0F;
    view.view_projection[15] = 1.0F;
    view.planes[0] = 0.1F;
    return view;
}

// Whether a pixel's centre is left of the line from a to b, seen with y downwards.
bool is_left(const Vec2& a, const Vec2& b, double x, double y) {
    return cross(Vec2(b - a), Vec2(Vec2(x, y) - a)) < 0.0;
}

// White to the left of the line, black to the right, one sample per pixel.
Image two_faces(FrameSize size, const Vec2& a, const Vec2& b) {
    Image image;
    image.resize(size);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const bool left = is_left(a, b, x + 0.5, y + 0.5);
            std::uint8_t* pixel = image.rgbx.data() + 4 * (static_cast<std::size_t>(y * size.width + x));
            std::fill_n(pixel, 3, static_cast<std::uint8_t>(left ? 180 : 0));
            pixel[3] = left ? kLeft : kRight;
        }
    }
    return image;
}

TableEdge edge_between(const Vec2& a, const Vec2& b) {
    const Vec2 side = Vec2(b.y() - a.y(), a.x() - b.x());
    const auto point = [](const Vec2& p) {
        return std::array<float, 3>{static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F};
    };
    return {point(a), point(b), {{{kLeft, point(Vec2(a + side))}, {kRight, point(Vec2(a - side))}}}, false};
}

struct Line {
    Vec2 a, b;
};

const std::vector<Line>& lines() {
    static const std::vector<Line> kLines{{{-5.0, 7.3}, {45.0, 16.8}},  {{45.0, 3.1}, {-5.0, 21.0}},
                                          {{13.2, -5.0}, {21.9, 35.0}}, {{30.7, 35.0}, {9.4, -5.0}},
                                          {{-5.0, 12.0}, {45.0, 12.0}}, {{17.5, -5.0}, {17.5, 35.0}},
                                          {{-5.0, -4.7}, {45.0, 41.0}}};
    return kLines;
}

TEST(EdgeSmoother, WeightsEveryPixelByTheAreaBeyondTheEdge) {
    const FrameSize size{40, 24};
    for (const Line& line : lines()) {
        Image image = two_faces(size, line.a, line.b);
        smooth_edges(image, {edge_between(line.a, line.b)}, flat_view(size), {});
        double worst = 0.0;
        for (int y = 1; y + 1 < size.height; ++y) {
            for (int x = 1; x + 1 < size.width; ++x) {
                constexpr int kFine = 32;
                int inside = 0;
                for (int i = 0; i < kFine * kFine; ++i) {
                    const int row = i / kFine;
                    inside += is_left(line.a, line.b, x + (i % kFine + 0.5) / kFine, y + (row + 0.5) / kFine);
                }
                // 180 on the screen is 0.498 of radiance: the square root is exact below one half.
                const double share = static_cast<double>(inside) / (kFine * kFine);
                const double is = std::pow(image.pixel(x, y)[0] / 180.0, 2);
                worst = std::max(worst, std::abs(is - share));
            }
        }
        EXPECT_LT(worst, 0.03) << line.a.transpose() << " to " << line.b.transpose();
    }
}

TEST(EdgeSmoother, LeavesHiddenEdgesAndPanelsAlone) {
    const FrameSize size{40, 24};
    for (const Line& line : lines()) {
        const Image raw = two_faces(size, line.a, line.b);
        // Another object is in front of both faces.
        Image hidden = raw;
        for (std::size_t i = 3; i < hidden.rgbx.size(); i += 4)
            hidden.rgbx[i] = hidden.rgbx[i] == kLeft ? 77 : 0;
        const Image before = hidden;
        smooth_edges(hidden, {edge_between(line.a, line.b)}, flat_view(size), {});
        EXPECT_TRUE(render_test::same_pixels(hidden, before));
        Image panel = raw;
        smooth_edges(panel, {edge_between(line.a, line.b)}, flat_view(size), {{0, 0, 40, 24}});
        EXPECT_TRUE(render_test::same_pixels(panel, raw));
        // An edge inside a curved face that continues beyond it.
        Image curved = raw;
        TableEdge edge = edge_between(line.a, line.b);
        edge.smooth = true;
        smooth_edges(curved, {edge}, flat_view(size), {});
        EXPECT_TRUE(render_test::same_pixels(curved, raw));
    }
}

TEST(TableEdges, BoundEveryFaceAndLieInsideNone) {
    const TableMesh mesh =
        make_table_mesh(make_table("nine_foot"), render_test::kR, {Vec2(0.5, 0.5)}, Edges::kSharp);
    const TableEdges found = find_edges(mesh);
    ASSERT_EQ(found.faces.size(), mesh.solid.size() / 3);
    for (std::size_t i = 0; i < found.faces.size(); ++i) {
        const bool cloth = mesh.solid[3 * i].material == static_cast<float>(Material::kCloth);
        EXPECT_EQ(found.faces[i] == kClothFace, cloth);
        EXPECT_TRUE(cloth || (found.faces[i] >= 1 && found.faces[i] <= kLastFace));
    }
    // The rims of six holes in 96 pieces, and at most a few thousand from the mesh.
    EXPECT_GT(found.edges.size(), 600U);
    EXPECT_LT(found.edges.size(), 6000U);
    for (const TableEdge& edge : found.edges) {
        EXPECT_NE(edge.a, edge.b);
        EXPECT_NE(edge.sides[0].face, 0);
    }
}

// Two edges on one line would smooth a pixel twice. This checks every pair; find_edges compares only those in
// one place.
TEST(TableEdges, NoEdgeLiesWithinALongerOne) {
    for (const char* table : {"nine_foot", "snooker"}) {
        const TableEdges found =
            find_edges(make_table_mesh(make_table(table), render_test::kR, {}, Edges::kSharp));
        const auto point = [](const std::array<float, 3>& p) { return Vec3(p[0], p[1], p[2]); };
        int pairs = 0;
        for (const TableEdge& longer : found.edges) {
            const Vec3 from = point(longer.a), along = point(longer.b) - from;
            if (longer.smooth || along.norm() <= 0.2) continue;
            const auto away = [&](const Vec3& p) {
                const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
                return (p - from - t * along).norm();
            };
            for (const TableEdge& edge : found.edges) {
                const Vec3 a = point(edge.a), b = point(edge.b);
                if ((b - a).norm() + 1e-4 >= along.norm()) continue;
                ++pairs;
                EXPECT_GE(std::max(away(a), away(b)), 1e-5)
                    << table << ", from " << edge.a[0] << ", " << edge.a[1];
            }
        }
        EXPECT_GT(pairs, 10000) << table;
    }
}

// Cutting along the squares around the holes changes no area; only the parts inside a square are tested.
TEST(TableParts, HaveTheAreaOfTheMesh) {
    const TableMesh mesh = make_table_mesh(make_table("nine_foot"), render_test::kR, {Vec2(0.5, 0.5)});
    const auto area = [](const MeshVertex& a, const MeshVertex& b, const MeshVertex& c) {
        const Vec3 p(a.x, a.y, a.z), q(b.x, b.y, b.z), r(c.x, c.y, c.z);
        return 0.5 * Vec3(q - p).cross(Vec3(r - p)).norm();
    };
    double whole = 0.0, parts_area = 0.0, tested = 0.0;
    for (const auto* list : {&mesh.solid, &mesh.blended}) {
        for (std::size_t i = 0; i + 2 < list->size(); i += 3)
            whole += area((*list)[i], (*list)[i + 1], (*list)[i + 2]);
    }
    const TableParts parts = sort_parts(mesh, {});
    ASSERT_EQ(parts.ends.back(), parts.vertices.size());
    for (std::size_t i = 0; i + 2 < parts.vertices.size(); i += 3) {
        const double piece =
            area(parts.vertices[i].vertex, parts.vertices[i + 1].vertex, parts.vertices[i + 2].vertex);
        parts_area += piece;
        const auto cut = static_cast<std::size_t>(Part::kCutCloth);
        if (i >= parts.ends[cut - 1] && i < parts.ends[cut]) tested += piece;
    }
    EXPECT_NEAR(parts_area, whole, 1e-4 * whole);
    EXPECT_GT(tested, 0.0);
    EXPECT_LT(tested, 0.12) << "m^2 of cloth, of more than 3";
}

const Record& rack_to_follow() {
    static const Record record = [] {
        const Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
        return simulate(make_plan(scene, kernel::Isa::kScalar));
    }();
    return record;
}

Image picture(Renderer& renderer, DrawList list, int samples) {
    list.camera_moves = samples == 0;
    list.table_samples = samples;
    renderer.draw(list);
    Image image;
    renderer.read(image);
    return image;
}

// Mean difference between two pictures' colours, and between their changes since the previous picture.
double apart(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgbx.size(); ++i) {
        if (i % 4 != 3) sum += std::abs(a.rgbx[i] - b.rgbx[i]);
    }
    return sum / static_cast<double>(a.rgbx.size());
}

double flicker(const Image& a0, const Image& a1, const Image& b0, const Image& b1) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a0.rgbx.size(); ++i) {
        if (i % 4 != 3) sum += std::abs((a1.rgbx[i] - a0.rgbx[i]) - (b1.rgbx[i] - b0.rgbx[i]));
    }
    return sum / static_cast<double>(a0.rgbx.size());
}

// Closer to a picture with 64 samples than one with 4 samples is, and steadier in a slow pan.
TEST(MovingCamera, LooksLikeManySamples) {
    StageOptions options;
    options.camera = "follow";
    options.size = {640, 360};
    const Stage stage(rack_to_follow(), options);
    Renderer renderer;
    for (const double t : {0.2, 0.9, 3.0}) {
        DrawList list = stage.at(t);
        ASSERT_TRUE(list.camera_moves);
        list.balls.clear();
        const Image fine = picture(renderer, list, 64), four = picture(renderer, list, 4),
                    smooth = picture(renderer, list, 0);
        EXPECT_LT(apart(smooth, fine), apart(four, fine)) << t;
        list.camera.eye.x() += 0.001;
        list.camera.target.x() += 0.001;
        const Image fine_next = picture(renderer, list, 64);
        EXPECT_LT(flicker(smooth, picture(renderer, list, 0), fine, fine_next),
                  flicker(four, picture(renderer, list, 4), fine, fine_next))
            << t;
    }
}

// Half of a ball behind a cushion: the cushion's edge is as smooth across the ball as across the cloth.
TEST(MovingCamera, ABallBehindACushionIsCutByASmoothEdge) {
    Record record = render_test::rectangle_record();
    render_test::add_ball(record, "cue", 0.5, render_test::kR + 0.001);
    StageOptions options;
    options.camera = "follow";
    options.size = {640, 360};
    const Stage stage(record, options);
    DrawList list = stage.at(0.0);
    list.camera.eye = Vec3(0.62, -0.5, 0.12);
    list.camera.target = Vec3(0.5, 0.0, 0.03);
    Renderer renderer;
    const Image fine = picture(renderer, list, 64), smooth = picture(renderer, list, 0);
    DrawList bare = list;
    bare.balls.clear();
    const Image no_ball = picture(renderer, bare, 64);
    // Counts the pixels changed by the ball: if the cushion cut it in steps, the worst would be far off.
    int off = 0, seen = 0;
    for (std::size_t i = 0; i < fine.rgbx.size(); i += 4) {
        if (std::abs(fine.rgbx[i] - no_ball.rgbx[i]) < 20) continue;
        ++seen;
        off += std::abs(fine.rgbx[i] - smooth.rgbx[i]) > 40;
    }
    EXPECT_GT(seen, 300);
    EXPECT_LE(off, 4);
}

}  // namespace
}  // namespace carom::render
