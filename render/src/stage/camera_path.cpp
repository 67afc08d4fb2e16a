#include "carom/render/camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/nearest.h"
#include "carom/engine/printable.h"
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

Camera player_camera(const Record& record, FrameSize size) {
    const int ball = first_ball(record);
    const Vec3 place = record.tracks.empty() ? Vec3::Zero() : Vec3(record.state_at(ball, 0.0).position);
    const Vec2 aim = aim_of(record, ball);
    Camera camera;
    camera.size = size;
    camera.fov_y_deg = size.width >= size.height ? 40.0 : 62.0;
    camera.up = Vec3::UnitZ();
    camera.eye = place + Vec3(-0.75 * aim.x(), -0.75 * aim.y(), 0.42);
    camera.target = place + Vec3(0.45 * aim.x(), 0.45 * aim.y(), -0.02);
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

Camera fitting_camera(const Bounds& bounds, const Vec3& direction, double fov_y_deg, FrameSize size) {
    Camera camera;
    camera.size = size;
    camera.fov_y_deg = fov_y_deg;
    camera.up = Vec3::UnitZ();
    const Vec3 along = direction.normalized();
    const Vec3 middle(0.5 * (bounds.low.x() + bounds.high.x()), 0.5 * (bounds.low.y() + bounds.high.y()),
                      0.0);
    const double extent = (bounds.high - bounds.low).norm();
    Vec3 target = middle;
    // Extent of the box in the image from distance d (1: it
    // fills the image), and its centre in the image [pixels].
    const auto frame = [&](double d, Vec2& centre) {
        camera.target = target;
        camera.eye = target - d * along;
        Vec2 low(1e9, 1e9), high(-1e9, -1e9);
        for (int i = 0; i < 8; ++i) {
            const std::optional<Vec2> pixel =
                camera.project({(i & 1) ? bounds.high.x() : bounds.low.x(),
                                (i & 2) ? bounds.high.y() : bounds.low.y(), (i & 4) ? bounds.top : -0.1});
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
        const double pitch = 38.0 * std::numbers::pi / 180.0;
        fixed_ = fitting_camera(table.bounds, {0.0, std::cos(pitch), -std::sin(pitch)}, 34.0, size);
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

}  // namespace carom::render
