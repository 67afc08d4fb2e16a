// The cue, lines and boxes of a picture, and the pixels that they may cover.
#include "draw/drawn_balls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace carom::render {

namespace {

// Pixels between two corners, in any order, and `reach` around them.
PixelBox box_around(const Vec2& a, const Vec2& b, double reach, FrameSize size) {
    const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
    const auto inside = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, double(limit)));
    };
    return {inside(low.x() - reach, size.width), inside(low.y() - reach, size.height),
            inside(high.x() + reach + 1.0, size.width), inside(high.y() + reach + 1.0, size.height)};
}

DrawnShape everywhere(FrameSize size) {
    return {{}, {0, 0, size.width, size.height}, Vec2::Zero(), Vec2::Zero(), -1.0};
}

// From one place to another. @param half_width [pixels]
DrawnShape long_shape(const Vec3& from, const Vec3& to, double half_width, const Camera& camera) {
    DrawnShape shape = everywhere(camera.size);
    const std::optional<Vec2> a = camera.project(from), b = camera.project(to);
    // A shape this near to the eye is cut off, and may cover anything.
    constexpr double kNear = 0.02;  // m, twice what the painters cut off at
    if (!a || !b || !a->allFinite() || !b->allFinite()) return shape;
    if (!(camera.depth(from) > kNear && camera.depth(to) > kNear)) return shape;
    shape.from = *a;
    shape.to = *b;
    // For round ends, the soft edge, and the painters' single precision.
    shape.reach = half_width + 3.0;
    shape.box = box_around(*a, *b, shape.reach, camera.size);
    return shape;
}

DrawnShape shape_of(const DrawLine& line, const Camera& camera) {
    DrawnShape shape = long_shape(line.a, line.b, 0.5 * static_cast<double>(line.width), camera);
    shape.what = line;
    return shape;
}

// The cue and its shadow on the cloth.
DrawnShape shape_of(const DrawCue& cue, const Camera& camera) {
    DrawnShape shape = everywhere(camera.size);
    shape.what = cue;
    const auto below = [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.0); };
    const double nearest = std::min({camera.depth(cue.tip), camera.depth(cue.butt),
                                     camera.depth(below(cue.tip)), camera.depth(below(cue.butt))});
    if (!(nearest > 0.0)) return shape;
    const double pixels = camera.scale(camera.eye + nearest * camera.forward());
    shape.box = joined(long_shape(cue.tip, cue.butt, kCueReach * pixels, camera).box,
                       long_shape(below(cue.tip), below(cue.butt), kCueShadowReach * pixels, camera).box);
    return shape;
}

DrawnShape shape_of(const DrawBox& box, FrameSize size) {
    DrawnShape shape = everywhere(size);
    shape.what = box;
    if (box.low.allFinite() && box.high.allFinite()) shape.box = box_around(box.low, box.high, 2.0, size);
    return shape;
}

// A slanting line covers a small part of the box around it.
void add_boxes_of(const DrawnShape& shape, std::vector<PixelBox>& boxes) {
    constexpr double kPart = 64.0, kMost = 1000.0;  // pixels of a part; parts
    const double parts = std::ceil((shape.to - shape.from).cwiseAbs().minCoeff() / kPart);
    if (!(shape.reach >= 0.0 && parts > 1.0 && parts < kMost)) {
        boxes.push_back(shape.box);
        return;
    }
    const PixelBox& all = shape.box;
    for (double i = 0.0; i < parts; ++i) {
        const Vec2 a = shape.from + (shape.to - shape.from) * (i / parts),
                   b = shape.from + (shape.to - shape.from) * ((i + 1.0) / parts);
        const PixelBox part = box_around(a, b, shape.reach, {all.x1, all.y1});
        if (part.x0 < part.x1 && part.y0 < part.y1) boxes.push_back(part);
    }
}

}  // namespace

std::vector<DrawnShape> drawn_shapes(const DrawList& list) {
    std::vector<DrawnShape> shapes;
    shapes.reserve(list.lines.size() + list.boxes.size());
    if (list.cue) shapes.push_back(shape_of(*list.cue, list.camera));
    for (const DrawLine& line : list.lines) shapes.push_back(shape_of(line, list.camera));
    for (const DrawBox& box : list.boxes) shapes.push_back(shape_of(box, list.camera.size));
    return shapes;
}

void add_differing(const std::vector<DrawnShape>& before, const std::vector<DrawnShape>& after,
                   std::vector<PixelBox>& boxes) {
    // Shapes in both lists in the same order match; a longer search would find a few more.
    constexpr std::size_t kSearch = 64;
    std::size_t next = 0;  // in `before`
    for (const DrawnShape& shape : after) {
        const std::size_t end = std::min(before.size(), next + kSearch);
        std::size_t found = next;
        while (found < end && !(before[found].what == shape.what)) ++found;
        if (found == end) {
            add_boxes_of(shape, boxes);
            continue;
        }
        for (; next < found; ++next) add_boxes_of(before[next], boxes);
        ++next;
    }
    for (; next < before.size(); ++next) add_boxes_of(before[next], boxes);
}

}  // namespace carom::render
