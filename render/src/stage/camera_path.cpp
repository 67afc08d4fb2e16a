#include "carom/render/camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/nearest.h"
#include "carom/engine/printable.h"
#include "carom/render/camera.h"
#include "carom/render/error.h"

namespace carom::render {

namespace {

// [m] Position of the follow camera's eye relative to the ball.
const Vec3 kFollowOffset(0.0, -0.95, 0.62);

// [s] Half the time over which the position of the followed
// ball is averaged, and the number of steps on each side.
constexpr double kFollowWindow = 0.5;
constexpr int kFollowSteps = 12;

// Direction of the first motion of the ball; +y if it does not move.
Vec2 aim_of(const Record& record, int ball) {
    if (record.tracks.empty()) return Vec2::UnitY();
    for (const Segment& segment : record.tracks[ball].segments) {
        const Vec2 v = segment.v.head<2>();
        if (v.norm() > 0.0) return v.normalized();
    }
    return Vec2::UnitY();
}

Vec3 downwards(const Vec2& direction, double degrees) {
    const double pitch = degrees * std::numbers::pi / 180.0;
    const Vec2 level = std::cos(pitch) * direction;
    return {level.x(), level.y(), -std::sin(pitch)};
}

// The outer sides of balls at the outermost of these places.
std::vector<Vec3> ends_of_balls(const std::vector<Vec2>& places, double R) {
    constexpr int kDirections = 24;
    std::vector<Vec3> ends;
    for (int k = 0; k < kDirections; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kDirections;
        const Vec2 direction(std::cos(angle), std::sin(angle));
        const Vec2& p = *std::max_element(places.begin(), places.end(), [&](const Vec2& a, const Vec2& b) {
            return a.dot(direction) < b.dot(direction);
        });
        const Vec2 side = p + R * direction;
        for (const double z : {0.0, 2.0 * R}) ends.emplace_back(side.x(), side.y(), z);
    }
    return ends;
}

// Behind the head rail. The table fills the image if all of it is played on.
Camera rail_camera(const Record& record, const TableMesh& table, FrameSize size) {
    std::vector<Vec2> places = visited_places(record, true);
    if (places.empty()) places = {table.bounds.low, table.bounds.high};
    const Bounds& all = table.bounds;
    Vec2 low = places[0], high = low;
    for (const Vec2& p : places) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    // At least a third of the table, and a little around the balls.
    const Vec2 least = (all.high - all.low) / 6.0, middle = 0.5 * (low + high);
    low = low.cwiseMin(middle - least).cwiseMax(all.low) - Vec2(0.1, 0.1);
    high = high.cwiseMax(middle + least).cwiseMin(all.high) + Vec2(0.1, 0.1);
    return fitting_camera(
        ends_of_balls({low, {high.x(), low.y()}, high, {low.x(), high.y()}}, record.balls.R),
        downwards(Vec2::UnitY(), 33.0), 40.0, size);
}

Camera player_camera(const Record& record, FrameSize size) {
    constexpr double kNearest = 0.7, kFarthest = 1.4;  // [m] behind the ball
    const int ball = first_ball(record);
    const Vec3 place = record.tracks.empty() ? Vec3::Zero() : Vec3(record.state_at(ball, 0.0).position);
    const Vec2 aim = aim_of(record, ball), at = place.head<2>();
    // The moving balls in front of this one, and a little of the table behind it.
    std::vector<Vec2> places{at - 0.12 * aim, at + 0.5 * aim};
    for (const Vec2& p : visited_places(record, true))
        if ((p - at).dot(aim) > 0.0) places.push_back(p);
    const double fov = size.width >= size.height ? 34.0 : 58.0;
    Camera camera = fitting_camera(ends_of_balls(places, record.balls.R), downwards(aim, 20.0), fov, size);
    const double behind = (at - camera.eye.head<2>()).dot(aim),
                 back = behind - std::clamp(behind, kNearest, kFarthest);
    camera.eye += back * camera.forward();
    return camera;
}

int ball_by_id(const Record& record, const std::string& id) {
    constexpr std::size_t kListed = 40;  // [-] most ids in a message
    std::string known;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        if (record.tracks[i].id == id) return static_cast<int>(i);
        if (i < kListed) known += (i == 0 ? "" : ", ") + printable(record.tracks[i].id);
    }
    if (record.tracks.size() > kListed)
        known += " and " + std::to_string(record.tracks.size() - kListed) + " more";
    throw RenderError("no ball '" + printable(id) + "' to follow; expected one of " + known);
}

// The position of a followed ball; the place of capture for a ball in a pocket.
Vec3 place_to_follow(const Record& record, int ball, double t) {
    const BallTrack& track = record.tracks[ball];
    const Segment& last = track.segments.back();
    if (is_gone(last.state) && t > last.start) t = last.start;
    Vec3 place = record.state_at(ball, t).position;
    place.z() = record.size(ball).R;
    return place;
}

}  // namespace

int first_ball(const Record& record) {
    for (const Event& event : record.events) {
        if (event.type == EventType::kCueStrike) return event.a;
    }
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        if (!record.tracks[i].segments.empty() && record.tracks[i].segments.front().v.norm() > 0.0) {
            return static_cast<int>(i);
        }
    }
    return 0;
}

std::vector<Vec2> visited_places(const Record& record, bool moving) {
    constexpr int kPieces = 4;  // [-] per segment
    std::vector<Vec2> places;
    for (const BallTrack& track : record.tracks) {
        const auto moves = [](const Segment& s) { return s.v.norm() > 0.0; };
        if (moving && std::none_of(track.segments.begin(), track.segments.end(), moves)) continue;
        for (std::size_t i = 0; i < track.segments.size(); ++i) {
            const Segment& segment = track.segments[i];
            if (is_gone(segment.state)) continue;
            const double next = i + 1 < track.segments.size() ? track.segments[i + 1].start : record.duration;
            const double lasts = std::min(std::max(0.0, next - segment.start), segment.duration);
            for (int piece = 0; piece <= kPieces; ++piece) {
                const Vec3 place = position_at(segment, lasts * piece / kPieces);
                if (place.allFinite()) places.push_back(place.head<2>());
                if (lasts == 0.0) break;
            }
        }
    }
    return places;
}

Camera fitting_camera(const std::vector<Vec3>& points, const Vec3& direction, double fov_y_deg,
                      FrameSize size) {
    Camera camera;
    camera.size = size;
    camera.fov_y_deg = fov_y_deg;
    camera.up = Vec3::UnitZ();
    const Vec3 along = direction.normalized();
    Vec3 lowest = points.at(0), highest = lowest;
    for (const Vec3& p : points) {
        lowest = lowest.cwiseMin(p);
        highest = highest.cwiseMax(p);
    }
    const double extent = (highest - lowest).norm();
    Vec3 target = 0.5 * (lowest + highest);
    // Extent of the points in the image from distance d (1: they
    // fill the image), and their centre in the image [pixels].
    const auto frame = [&](double d, Vec2& centre) {
        camera.target = target;
        camera.eye = target - d * along;
        Vec2 low(1e9, 1e9), high(-1e9, -1e9);
        for (const Vec3& point : points) {
            const std::optional<Vec2> pixel = camera.project(point);
            if (!pixel) return 1e9;
            low = low.cwiseMin(*pixel);
            high = high.cwiseMax(*pixel);
        }
        centre = 0.5 * (low + high);
        return std::max((high.x() - low.x()) / size.width, (high.y() - low.y()) / size.height);
    };
    for (int round = 0; round < 6; ++round) {
        double near = 0.0, far = 1e3 * extent + 10.0;
        Vec2 centre(0.0, 0.0);
        for (int i = 0; i < 60; ++i) {
            const double d = 0.5 * (near + far);
            (frame(d, centre) > 0.97 ? near : far) = d;
        }
        frame(far, centre);
        // Shift the target sideways and up, so that the box is centred in the image.
        const double metres = 1.0 / camera.scale(target);
        target += metres * ((centre.x() - 0.5 * size.width) * camera.right() -
                            (centre.y() - 0.5 * size.height) * camera.image_up());
    }
    return camera;
}

CameraPath::CameraPath(const Record& record, const TableMesh& table, const std::string& name,
                       const FreeCamera& free, FrameSize size)
    : record_(record) {
    if (free.eye.has_value() != free.target.has_value())
        throw RenderError("a free camera needs both eye and target");
    if (free.eye) {
        const Vec3 view = *free.target - *free.eye;
        if (!free.eye->allFinite() || !free.target->allFinite() || !(view.norm() > 1e-6)) {
            throw RenderError("the eye and the target of a free camera must be different, finite points");
        }
        if (!(free.fov_deg > 0.0 && free.fov_deg < 170.0))
            throw RenderError("the field of view must be 0 to 170 degrees");
        fixed_.eye = *free.eye;
        fixed_.target = *free.target;
        fixed_.fov_y_deg = free.fov_deg;
        fixed_.size = size;
        // If the camera looks straight down, +y points up in the image.
        fixed_.up = view.head<2>().norm() > 1e-6 * view.norm() ? Vec3::UnitZ() : Vec3::UnitY();
    } else if (name == "top") {
        fixed_ = top_camera(table.bounds, size);
    } else if (name == "rail") {
        fixed_ = rail_camera(record, table, size);
    } else if (name == "player") {
        fixed_ = player_camera(record, size);
    } else if (name == "follow") {
        if (record.tracks.empty()) throw RenderError("no ball to follow");
        follow_ball_ = free.ball.empty() ? first_ball(record) : ball_by_id(record, free.ball);
        follow_offset_ = kFollowOffset;
        fixed_.size = size;
        fixed_.fov_y_deg = size.width >= size.height ? 42.0 : 64.0;
        fixed_.up = Vec3::UnitZ();
    } else {
        throw RenderError("unknown camera '" + printable(name) +
                          "'; use top, rail, player, follow, or give eye and target" +
                          did_you_mean(name, {"top", "rail", "player", "follow"}));
    }
}

Camera CameraPath::at(double t) const {
    if (follow_ball_ < 0) return fixed_;
    // Raised-cosine average over past and future positions:
    // the camera starts before the ball and moves smoothly.
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (int i = -kFollowSteps; i <= kFollowSteps; ++i) {
        const double weight = 1.0 + std::cos(std::numbers::pi * i / (kFollowSteps + 1.0));
        sum += weight * place_to_follow(record_, follow_ball_, t + kFollowWindow * i / kFollowSteps);
        weights += weight;
    }
    Camera camera = fixed_;
    camera.target = sum / weights;
    camera.eye = camera.target + follow_offset_;
    return camera;
}

Vec3 Camera::forward() const {
    return (target - eye).normalized();
}

Vec3 Camera::right() const {
    return forward().cross(up).normalized();
}

Vec3 Camera::image_up() const {
    return right().cross(forward());
}

double Camera::tan_half_y() const {
    return std::tan(fov_y_deg * std::numbers::pi / 360.0);
}

double Camera::tan_half_x() const {
    return tan_half_y() * size.width / size.height;
}

double Camera::depth(const Vec3& point) const {
    return (point - eye).dot(forward());
}

std::optional<Vec2> Camera::project(const Vec3& point) const {
    const Vec3 offset = point - eye;
    const double z = offset.dot(forward());
    if (!(z > 0.0)) return std::nullopt;
    const double x = offset.dot(right()) / (z * tan_half_x());
    const double y = offset.dot(image_up()) / (z * tan_half_y());
    return Vec2((1.0 + x) * 0.5 * size.width, (1.0 - y) * 0.5 * size.height);
}

double Camera::scale(const Vec3& point) const {
    return 0.5 * size.height / (tan_half_y() * depth(point));
}

bool Camera::operator==(const Camera& other) const {
    return eye == other.eye && target == other.target && up == other.up && fov_y_deg == other.fov_y_deg &&
           size == other.size;
}

Camera top_camera(const Bounds& bounds, FrameSize size) {
    // [deg] Narrow, so that balls at the rails are hardly seen from the side, but wide enough to keep the
    // depth.
    constexpr double kFov = 16.0;
    const Vec2 extent = (bounds.high - bounds.low).cwiseMax(1e-3);
    const Vec2 centre = 0.5 * (bounds.low + bounds.high);
    const double upright = std::min(size.width / extent.x(), size.height / extent.y());
    const double lying = std::min(size.width / extent.y(), size.height / extent.x());

    Camera camera;
    camera.size = size;
    camera.fov_y_deg = kFov;
    // y x (-x) = z: if +y points to the right of the image, -x points up, seen from above.
    camera.up = lying > upright ? Vec3(-1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const double pixels_per_metre = std::max(upright, lying);
    const double distance = 0.5 * size.height / (pixels_per_metre * camera.tan_half_y());
    camera.target = Vec3(centre.x(), centre.y(), 0.0);
    camera.eye = Vec3(centre.x(), centre.y(), bounds.top + distance);
    return camera;
}

}  // namespace carom::render
