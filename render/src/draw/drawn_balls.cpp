#include "draw/drawn_balls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "carom/render/kept_image.h"
#include "draw/shader_numbers.h"

namespace carom::render {

namespace {

float linear(float srgb) {
    return srgb * srgb;  // the same conversion as from_screen() in shaders/common.glsl
}

// [radii] Height of the centre above the cloth.
double lift(const DrawBall& ball) {
    return std::max(1.0, ball.center.z() / ball.radius);
}

// The light comes from around the middle of the lamp, as in lamp_light() of the shaders.
LampSlopes lamp_slopes(const DrawBall& ball, const Lamp& lamp) {
    constexpr double kMiddle = 0.6, kMost = 1.6;  // of the lamp; of a slope
    const double height = lamp.center.z();
    const Vec2 away = lamp.endless ? Vec2::Zero() : Vec2((lamp.center - ball.center).head<2>() / height);
    const Vec2 half = lamp.endless ? Vec2(0.13, 0.3) : Vec2(kMiddle * lamp.half / height);
    const double less = std::min(1.0, kMost / std::max(away.norm(), 1e-9));
    const auto f = [](double value) { return static_cast<float>(value); };
    return {f(less * away.x()), f(less * away.y()), f(half.x()), f(half.y())};
}

BallPlace place_of(const DrawBall& ball, const TableMesh& table) {
    if (ball.in_pocket) return BallPlace::kPocket;
    const bool near = std::any_of(table.noses.begin(), table.noses.end(), [&](const auto& nose) {
        return distance_to_segment(ball.center.head<2>(), nose[0], nose[1]) < 2.3 * lift(ball) * ball.radius;
    });
    return near ? BallPlace::kCushion : BallPlace::kCloth;
}

BallInstance make_instance(const DrawBall& ball, BallPlace place, const TableMesh& table, double distance) {
    const Vec3 origin(table.origin.x(), table.origin.y(), 0.0);
    const auto f = [](double value) { return static_cast<float>(value); };
    const Vec3 center = ball.center - origin;
    const Eigen::Quaterniond& q = ball.orientation;
    const BallStyle& style = ball.style;
    return {{f(center.x()), f(center.y()), f(center.z()), f(ball.radius)},
            {f(q.x()), f(q.y()), f(q.z()), f(q.w())},
            {linear(style.color[0]), linear(style.color[1]), linear(style.color[2]),
             static_cast<float>(style.number)},
            {static_cast<float>(style.pattern), static_cast<float>(place), f(distance)},
            lamp_slopes(ball, table.lamp),
            {},
            {}};
}

// The nearest balls, which block light from this one. The weight falls to 0 before a ball is dropped.
void add_neighbours(BallInstance& instance, const DrawBall& ball, const std::vector<DrawBall>& all) {
    constexpr double kNear = 2.1, kFar = 2.5;  // [radii]
    std::vector<std::pair<double, const DrawBall*>> near;
    for (const DrawBall& other : all) {
        const double distance = (other.center - ball.center).norm();
        if (&other != &ball && distance < kFar * ball.radius) near.emplace_back(distance, &other);
    }
    const std::size_t count = std::min<std::size_t>(near.size(), shaders::kMaxNear);
    std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < count; ++i) {
        const double weight = std::min(1.0, (kFar - near[i].first / ball.radius) / (kFar - kNear));
        for (int k = 0; k < 3; ++k) {
            instance.near[i][k] = static_cast<float>((near[i].second->center - ball.center)[k]);
            instance.near_color[i][k] = linear(near[i].second->style.color[static_cast<std::size_t>(k)]);
        }
        instance.near[i][3] = static_cast<float>(weight);
    }
}

PixelBox whole(FrameSize size) {
    return {0, 0, size.width, size.height};
}

// The pixels between two points, and a soft edge around them.
PixelBox clipped(const Vec2& low, const Vec2& high, FrameSize size) {
    const auto inside = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, double(limit)));
    };
    return {inside(low.x() - 2.0, size.width), inside(low.y() - 2.0, size.height),
            inside(high.x() + 3.0, size.width), inside(high.y() + 3.0, size.height)};
}

// Pixels that a disc with these two radii may cover, where it is in front of the eye.
PixelBox box_of_disc(const Vec3& center, const Vec3& right, const Vec3& up, const Camera& camera) {
    constexpr double kNear = 0.01;  // [m]
    constexpr int kCorners = 8;
    std::array<Vec3, kCorners> corners;  // of an octagon around the disc
    for (int i = 0; i < kCorners; ++i) {
        const double angle = (i + 0.5) * std::numbers::pi / 4.0, out = 1.0823922;  // 1 / cos(pi / 8)
        corners[static_cast<std::size_t>(i)] =
            center + out * (std::cos(angle) * right + std::sin(angle) * up);
    }
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    const auto add = [&](const Vec3& corner) {
        const std::optional<Vec2> pixel = camera.project(corner);
        if (!pixel) return;
        low = low.cwiseMin(*pixel);
        high = high.cwiseMax(*pixel);
    };
    for (std::size_t i = 0; i < kCorners; ++i) {
        const Vec3 &a = corners[i], &b = corners[(i + 1) % kCorners];
        const double from = camera.depth(a) - kNear, to = camera.depth(b) - kNear;
        if (from >= 0.0) add(a);
        if ((from < 0.0) != (to < 0.0)) add(a + (1e-9 + from / (from - to)) * (b - a));
    }
    if (!(low.x() <= high.x())) return {0, 0, 0, 0};
    return clipped(low, high, camera.size);
}

// The same for a ball around the centre: the disc faces the eye.
PixelBox box_of_sphere(const Vec3& center, double radius, const Camera& camera) {
    const Vec3 to_eye = camera.eye - center;
    const double distance = to_eye.norm();
    if (distance <= 1.01 * radius) return whole(camera.size);
    const double silhouette = radius * distance / std::sqrt(distance * distance - radius * radius);
    Vec3 right = camera.image_up().cross(to_eye);
    // The eye straight above or below the centre: any direction will do.
    if (right.norm() < 1e-9 * distance) right = camera.right();
    right.normalize();
    const Vec3 up = to_eye.cross(right) / distance;
    return box_of_disc(center, silhouette * right, silhouette * up, camera);
}

// Pixels that the shadow on the cloth may cover: a disc from the side of the lamp to the end of the shadow.
PixelBox box_of_shadow(const DrawBall& ball, const LampSlopes& lamp, const Camera& camera) {
    const Vec2 slope(lamp.x, lamp.y);
    // The lowest ray of the lamp that passes over a ball on the cloth.
    const double lowest = slope.norm() + std::hypot(lamp.half_x, lamp.half_y);
    const double unit = lift(ball) * ball.radius, near = shaders::kShadowReach * unit,
                 far = std::max(near, (lowest + std::hypot(lowest, 1.0)) * unit), reach = 0.5 * (near + far);
    const Vec2 away = slope.norm() > 0.0 ? Vec2(-slope.normalized()) : Vec2::Zero();
    const Vec2 middle = ball.center.head<2>() + 0.5 * (far - near) * away;
    return box_of_disc({middle.x(), middle.y(), 0.0}, Vec3(reach, 0.0, 0.0), Vec3(0.0, reach, 0.0), camera);
}

}  // namespace

ClothMap::ClothMap(const std::vector<std::uint8_t>& rgba, FrameSize size)
    : columns_((size.width + kSide - 1) / kSide),
      cloth_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>((size.height + kSide - 1) / kSide),
             true) {
    const std::uint8_t* alpha = rgba.data() + 3;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x, alpha += 4) {
            if (*alpha != 255) cloth_[place(x / kSide, y / kSide)] = false;
        }
    }
}

bool ClothMap::all_cloth(const PixelBox& box) const {
    if (cloth_.empty()) return false;
    for (int y = box.y0 / kSide; y * kSide < box.y1; ++y) {
        for (int x = box.x0 / kSide; x * kSide < box.x1; ++x) {
            if (!cloth_[place(x, y)]) return false;
        }
    }
    return true;
}

std::vector<DrawnBall> visible_balls(const DrawList& list, const ClothMap& cloth) {
    std::vector<DrawnBall> balls;
    for (const DrawBall& ball : list.balls) {
        const double distance = (ball.center - list.camera.eye).norm();
        // A ball that contains the eye or lies behind it is not visible.
        if (distance <= 1.05 * ball.radius || list.camera.depth(ball.center) <= -ball.radius) continue;
        const BallPlace place = place_of(ball, *list.table);
        BallInstance instance = make_instance(ball, place, *list.table, distance);
        add_neighbours(instance, ball, list.balls);
        const PixelBox body = box_of_sphere(ball.center, ball.radius, list.camera),
                       shadow = box_of_shadow(ball, instance.lamp, list.camera),
                       beside = box_of_sphere(ball.center, 2.15 * ball.radius, list.camera);
        PixelBox box = body;
        if (place != BallPlace::kPocket) box = joined(box, shadow);
        if (place == BallPlace::kCushion) box = joined(box, beside);
        if (box.x1 <= box.x0 || box.y1 <= box.y0) continue;
        balls.push_back({instance, box, body, shadow, beside, !ball.in_pocket && cloth.all_cloth(box)});
    }
    // Balls are drawn from far to near, so that the soft edges of near balls blend over the far ones.
    std::stable_sort(balls.begin(), balls.end(), [](const DrawnBall& a, const DrawnBall& b) {
        return a.instance.pattern[2] > b.instance.pattern[2];
    });
    return balls;
}

std::vector<PixelBox> differing_boxes(const DrawnPicture& before, const DrawnPicture& after, FrameSize size) {
    // Smoothing reaches one pixel beyond the changes, and needs a picture that was read as a whole.
    if (!before.table || before.table != after.table || after.edges) return {whole(size)};
    std::vector<PixelBox> boxes;
    const auto add_missing = [&boxes](const DrawnPicture& from, const DrawnPicture& in) {
        for (const DrawnBall& ball : from.balls) {
            if (std::find(in.balls.begin(), in.balls.end(), ball) == in.balls.end())
                boxes.push_back(ball.box);
        }
    };
    add_missing(before, after);
    add_missing(after, before);
    add_differing(before.shapes, after.shapes, boxes);
    return boxes;
}

std::vector<PixelBox> ChangedBoxes::next(const KeptImage& image) {
    if (!(size_ == image.image_.size)) shows_ = nullptr;
    size_ = image.image_.size;
    const std::shared_ptr<const DrawnPicture> before = std::exchange(shows_, image.shows_);
    if (!before || !shows_) return {whole(size_)};
    return differing_boxes(*before, *shows_, size_);
}

std::vector<PixelBox> ChangedBoxes::next(const Image& image) {
    size_ = image.size;
    shows_ = nullptr;
    return {whole(size_)};
}

Inside inside(const DrawnPicture& picture, std::vector<PixelBox>& boxes, FrameSize size) {
    Inside result{std::vector<bool>(picture.balls.size(), false),
                  std::vector<bool>(picture.shapes.size(), false)};
    const auto pixels = [](const PixelBox& box) { return double(box.x1 - box.x0) * (box.y1 - box.y0); };
    const double most = 0.5 * pixels(whole(size));
    double sum = 0.0;
    for (std::size_t checked = 0; checked < boxes.size(); ++checked) {
        const PixelBox box = boxes[checked];
        sum += pixels(box);
        if (sum > most) {
            boxes = {whole(size)};
            return {std::vector<bool>(picture.balls.size(), true),
                    std::vector<bool>(picture.shapes.size(), true)};
        }
        const auto add = [&](std::vector<bool>::reference flag, const PixelBox& of) {
            if (flag || !of.meets(box)) return;
            flag = true;
            boxes.push_back(of);
        };
        for (std::size_t i = 0; i < picture.balls.size(); ++i) add(result.balls[i], picture.balls[i].box);
        for (std::size_t i = 0; i < picture.shapes.size(); ++i) add(result.shapes[i], picture.shapes[i].box);
    }
    return result;
}

// The cue, lines and boxes of a picture, and the pixels that they may cover.

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
