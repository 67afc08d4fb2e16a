// Cushions and jaws near a cluster, which act by the scene's own law, and the cloth under its balls in space.
#include "loop/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "carom/engine/airborne.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/cushion/bounce.h"

namespace carom {

namespace {

// [m/s] A ball that closes more slowly during a cluster would be pushed in by some nanometres. The event loop
// finds it afterwards.
constexpr double kCreeps = 1e-6;
// [R] Smaller distances are rounding of the places.
constexpr double kTouches = 1e-9;
// [R] A ball that is deeper in a cushion than this has left the model.
constexpr double kDeepest = 0.25;
// [-] Pushes that may bring a ball out of a corner.
constexpr int kRounds = 8;

}  // namespace

void NearSurfaces::begin(const std::vector<ClusterBall>& members, bool in_space, double longest) {
    m_.parts_.clear();
    m_.hits_.clear();
    m_.ball_.clear();
    for (const ClusterBall& m : members) m_.ball_.push_back(m.ball);
    in_space_ = in_space;
    longest_ = longest;
}

// A tree finds the parts in any order.
void NearSurfaces::sort() {
    std::sort(m_.parts_.begin(), m_.parts_.end(), [](const auto& p, const auto& q) {
        return std::tuple(p.member, p.contact.with, p.contact.other) <
               std::tuple(q.member, q.contact.with, q.contact.other);
    });
}

bool NearSurfaces::lies(int ball, const Placed& at) const {
    const MotionParams& p = plan_.motion[static_cast<std::size_t>(ball)];
    const double v = at.velocity.z(), end = bounce_end(p.R, p.gravity);
    return !in_space_ || v * v + 2.0 * p.gravity * (at.position.z() - p.R) <= end * end;
}

template <class F>
void NearSurfaces::each_beside(std::size_t member, const Placed& at, F&& f) const {
    BallAt ball{at.position, at.velocity, R(member), !lies(m_.ball_[member], at)};
    for (const ClusterSurfacesMemory::Part& part : m_.parts_) {
        if (part.member != member) continue;
        const Touch touch = touch_part(plan_.geometry, part.contact, ball);
        BallAt there = ball;
        const double time = touch.gap > 0.0 && touch.closing > 0.0 ? touch.gap / touch.closing : 0.0;
        there.r += time * there.v;
        const auto is_beside = [&there](const auto& nose) { return beside(nose, there); };
        if (with_nose(plan_.geometry, part.contact, is_beside)) f(part.contact, touch, time);
    }
}

NearSurfaces::Reached NearSurfaces::find(std::size_t member, const Placed& at, const Vec3& spin) const {
    Reached first{nullptr, kNever};
    const double noise = std::max(kCreeps, closing_noise(R(member), {at.velocity, spin}));
    each_beside(member, at, [&](const Contact& part, const Touch& touch, double time) {
        if (!(touch.closing > noise)) return;
        if (touch.gap <= kTouches * R(member)) time = 0.0;
        if (time < first.time || (time == first.time && touch.closing > first.touch.closing))
            first = {&part, time, touch};
    });
    if (!in_space_ || first.time == 0.0) return first;
    const double height = at.position.z() - R(member), v = at.velocity.z(), g = motion(member).gravity;
    if (lies(m_.ball_[member], at)) {
        // The cloth stops it, in either direction.
        if (std::abs(v) > noise) return {nullptr, 0.0};
        return first;
    }
    if (height <= kTouches * R(member) && v < 0.0) return {nullptr, 0.0};
    const double root = std::sqrt(std::max(0.0, v * v + 2.0 * g * height));
    const double lands = v < 0.0 ? 2.0 * height / (root - v) : (v + root) / g;
    return lands < first.time ? Reached{nullptr, lands} : first;
}

double NearSurfaces::next(std::size_t member, const Placed& at, const Vec3& spin) const {
    return find(member, at, spin).time;
}

void NearSurfaces::hit(std::size_t member, double time, const Vec3& r, Velocities& ball) {
    const Placed at{r, ball.v};
    const Reached met = find(member, at, ball.w);
    const int index = m_.ball_[member];
    const double mass = plan_.sizes[static_cast<std::size_t>(index)].m;
    if (met.part == nullptr) {
        const double down = ball.v.z();
        if (down < 0.0) {
            hit_cloth(plan_.balls, motion(member), ball);
            m_.hits_.push_back({time, index, Partner::kNone, -1, mass * (ball.v.z() - down)});
        } else {
            ball.v.z() = 0.0;
        }
        return;
    }
    const Contact& part = *met.part;
    const Partner partner = partner_of(part, plan_.geometry);
    const CushionModelInfo& model = plan_.model_of(partner);
    const Vec3 n = -met.touch.n;
    const Vec3 before = ball.v;
    bool solved = true;
    if (!lies(index, at)) {
        hit_nose(plan_.balls, R(member), model, n, parting_speed(R(member), plan_.gravity), ball);
    } else {
        const double height = with_nose(plan_.geometry, part, [](const auto& nose) { return nose.height; });
        const std::array touches{NoseTouch{planar(n), height, &model}};
        solved = bounce(plan_.balls, plan_.sizes[static_cast<std::size_t>(index)], touches,
                        in_space_ ? std::optional(motion(member).gravity) : std::nullopt,
                        plan_.impact.tolerance, ball);
    }
    // A ball that would still close stays at the part, without a rebound.
    const double left = ball.v.dot(n);
    if (!solved || !(left > -kCreeps)) ball.v -= left * n;
    m_.hits_.push_back({time, index, partner, event_partner(part, plan_.geometry, planar(r)),
                        mass * std::max(0.0, (ball.v - before).dot(n))});
}

double NearSurfaces::out(std::size_t member, const Placed& at) const {
    double longest = 0.0;
    each_beside(member, at, [&](const Contact&, const Touch& touch, double) {
        const double time = touch.closing < 0.0 ? touch.gap / touch.closing : 0.0;
        if (touch.gap < -kTouches * R(member) && time <= longest_)
            longest = std::max(longest, time * (1.0 + kTouches));
    });
    return longest;
}

std::optional<Vec3> NearSurfaces::outside(std::size_t member, const Vec3& from, const Placed& at) const {
    Placed there = at;
    const bool down = lies(m_.ball_[member], at) || there.position.z() < R(member);
    if (in_space_ && down) there.position.z() = R(member);
    bool inside = true, through = false;
    for (int round = 0; round < kRounds && inside; ++round) {
        inside = false;
        each_beside(member, there, [&](const Contact& part, const Touch& touch, double) {
            const BallAt ball{from, at.velocity, R(member), false};
            through = through || touch.n.dot(touch_part(plan_.geometry, part, ball).n) < 0.0 ||
                      touch.gap < -kDeepest * R(member);
            if (touch.gap >= -kTouchUlp * R(member)) return;
            there.position += touch.gap * touch.n;
            inside = true;
        });
    }
    if (inside || through) return std::nullopt;
    return there.position;
}

}  // namespace carom
