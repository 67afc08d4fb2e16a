#include "stage/overlay_lines.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "carom/render/table_mesh.h"
#include "font/glyphs.h"

namespace carom::render {

namespace {

constexpr double kOnCloth = 0.0012;  // [m] height of lines on the cloth

// [s] Duration of the ring around a new event.
constexpr double kRingTime = 0.33;

Rgba state_color(MotionState state) {
    switch (state) {
        case MotionState::kSliding:
        case MotionState::kColliding:
            return {1.0F, 0.62F, 0.18F, 1.0F};
        case MotionState::kRolling:
            return {0.94F, 0.94F, 0.90F, 1.0F};
        case MotionState::kStationary:
        case MotionState::kSpinning:
        case MotionState::kPocketed:
        case MotionState::kFalling:
        case MotionState::kAirborne:
        case MotionState::kOut:
            break;
    }
    return {0.55F, 0.75F, 1.0F, 1.0F};
}

// Line width [pixels] in proportion to the image, at least 1.
float line_width(const DrawList& list, double pixels_at_720) {
    const double shorter = std::min(list.camera.size.width, list.camera.size.height);
    return static_cast<float>(std::max(1.0, pixels_at_720 * shorter / 720.0));
}

// Straight pieces that stay within a quarter of a pixel of a curved path.
int pieces_of(const Camera& camera, const Segment& segment, double lasts) {
    const Vec2 v = segment.v.head<2>();
    // acceleration across the first direction
    const double across = std::abs(cross(v, segment.a)) / v.norm();
    if (!(across > 1e-9 * segment.a.norm())) return 1;
    // A piece of duration h is at most a h^2 / 8 away from its chord.
    double scale = 0.0;
    for (const double at : {0.0, 0.5, 1.0}) {
        const Vec3 place = position_at(segment, at * lasts);
        if (camera.depth(place) > 0.05) scale = std::max(scale, camera.scale(place));
    }
    const double pieces = lasts * std::sqrt(segment.a.norm() * scale / (8.0 * 0.25));
    return static_cast<int>(std::clamp(std::ceil(pieces), 1.0, 400.0));
}

void add_trail(DrawList& list, const BallTrack& track, double t, float width, const Rgba* color) {
    for (std::size_t i = 0; i < track.segments.size(); ++i) {
        const Segment& segment = track.segments[i];
        if (segment.start >= t || is_gone(segment.state)) return;
        const double end = i + 1 < track.segments.size() ? std::min(track.segments[i + 1].start, t) : t;
        const double lasts = std::min(end - segment.start, segment.duration);
        if (!(lasts > 0.0) || segment.v.norm() == 0.0) continue;
        const int pieces = pieces_of(list.camera, segment, lasts);
        Vec3 before = segment.r;
        for (int piece = 1; piece <= pieces; ++piece) {
            const Vec3 next = position_at(segment, lasts * piece / pieces);
            list.lines.push_back({{before.x(), before.y(), kOnCloth},
                                  {next.x(), next.y(), kOnCloth},
                                  width,
                                  color != nullptr ? *color : state_color(segment.state),
                                  LineLayer::kUnderBalls});
            before = next;
        }
    }
}

void add_circle(DrawList& list, const Vec3& center, double radius, double from, double to, float width,
                const Rgba& color, LineLayer layer) {
    const int pieces = std::max(3, static_cast<int>(std::ceil(std::abs(to - from) / 0.2)));
    const auto point = [&](int i) {
        const double angle = from + (to - from) * i / pieces;
        return Vec3(center + radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
    };
    for (int i = 0; i < pieces; ++i) list.lines.push_back({point(i), point(i + 1), width, color, layer});
}

Rgba event_color(EventType type) {
    const EventKind& event = kind(type);
    if (event.phase == EventPhase::kStrike) return {1.0F, 1.0F, 1.0F, 1.0F};
    if (event.partner == Partner::kPocket) return {0.75F, 0.45F, 1.0F, 1.0F};
    if (event.partner == Partner::kBall) return {1.0F, 0.30F, 0.25F, 1.0F};
    return {0.35F, 0.75F, 1.0F, 1.0F};
}

void add_events(DrawList& list, const Record& record, double t) {
    for (const Event& event : record.events) {
        if (event.time > t) break;
        const EventPhase phase = kind(event.type).phase;
        if ((phase != EventPhase::kImpact && phase != EventPhase::kStrike) || event.a < 0) continue;
        const double when = std::nextafter(event.time, -1.0);  // before the ball moves into a pocket
        Vec3 place = record.state_at(event.a, when).position;
        const bool pair = event.b >= 0 && balls_collide(event.type);
        if (pair) place = 0.5 * (place + record.state_at(event.b, when).position);
        place.z() = kOnCloth;
        const Rgba color = event_color(event.type);
        list.lines.push_back({place, place, line_width(list, 6.0), color, LineLayer::kUnderBalls});
        const double age = (t - event.time) / kRingTime;
        if (age >= 1.0) continue;
        Rgba fading = color;
        fading[3] = static_cast<float>(1.0 - age);
        add_circle(list, place, record.balls.R * (1.0 + 2.0 * age), 0.0, 2.0 * std::numbers::pi,
                   line_width(list, 2.0), fading, LineLayer::kOverBalls);
    }
}

void add_arrow_head(DrawList& list, const Vec3& tip, const Vec3& along, double size, float width,
                    const Rgba& color) {
    const Vec3 side(-along.y(), along.x(), 0.0);
    for (double sign : {-1.0, 1.0}) {
        list.lines.push_back(
            {tip, tip - size * (along + sign * 0.6 * side), width, color, LineLayer::kOverBalls});
    }
}

// Adds a dark copy under the lines from `first` on; a yellow line on a yellow ball would otherwise be
// invisible.
void add_outline(DrawList& list, std::size_t first, float wider) {
    std::vector<DrawLine> dark(list.lines.begin() + static_cast<std::ptrdiff_t>(first), list.lines.end());
    for (DrawLine& line : dark) {
        line.width += wider;
        line.color = {0.0F, 0.0F, 0.0F, 0.85F};
    }
    list.lines.insert(list.lines.begin() + static_cast<std::ptrdiff_t>(first), dark.begin(), dark.end());
}

void add_spin(DrawList& list, const Record& record, double t) {
    const std::size_t first = list.lines.size();
    const float width = line_width(list, 2.6);
    const Rgba level{1.0F, 0.95F, 0.35F, 1.0F}, vertical{0.45F, 1.0F, 0.95F, 1.0F};
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState state = record.state_at(static_cast<int>(i), t);
        if (is_gone(state.state) || state.state == MotionState::kStationary) continue;
        const double R = record.size(static_cast<int>(i)).R;
        const Vec3 top = state.position + Vec3(0.0, 0.0, R);
        // The spin moves the top of the ball with w x R z; the arrow shows 0.1 s of this, at most ten radii.
        const Vec3 surface(R * state.spin.y(), -R * state.spin.x(), 0.0);
        const double length = std::min(0.1 * surface.norm(), 10.0 * R);
        if (length > 0.2 * R) {
            const Vec3 along = surface.normalized(), tip = top + length * along;
            list.lines.push_back({top, tip, width, level, LineLayer::kOverBalls});
            add_arrow_head(list, tip, along, std::min(0.6 * R, 0.5 * length), width, level);
        }
        // The longest arc represents 60 rad/s about the vertical, or more.
        const double arc = std::clamp(state.spin.z() / 60.0, -1.0, 1.0) * 1.7 * std::numbers::pi;
        if (std::abs(arc) > 0.05) {
            const Vec3 level_center(state.position.x(), state.position.y(), R);
            add_circle(list, level_center, 1.4 * R, 0.0, arc, width, vertical, LineLayer::kOverBalls);
            const Vec3 tip = level_center + 1.4 * R * Vec3(std::cos(arc), std::sin(arc), 0.0);
            const double sign = arc > 0.0 ? 1.0 : -1.0;
            add_arrow_head(list, tip, sign * Vec3(-std::sin(arc), std::cos(arc), 0.0), 0.4 * R, width,
                           vertical);
        }
    }
    add_outline(list, first, line_width(list, 2.2));
}

void add_ghost(DrawList& list, const Record& record, double t) {
    const auto next = std::find_if(record.events.begin(), record.events.end(), [t](const Event& event) {
        return event.time > t && balls_collide(event.type);
    });
    if (next == record.events.end()) return;
    const auto speed = [&](int ball) {
        return record.state_at(ball, std::nextafter(next->time, -1.0)).velocity.norm();
    };
    const int striker = next->b >= 0 && speed(next->b) > speed(next->a) ? next->b : next->a;
    const double R = record.size(striker).R;
    const Vec3 there = record.state_at(striker, next->time).position,
               here = record.state_at(striker, t).position;
    const Rgba color{1.0F, 1.0F, 1.0F, 0.85F};
    const float width = line_width(list, 1.6);
    add_circle(list, there, R, 0.0, 2.0 * std::numbers::pi, width, color, LineLayer::kOverBalls);
    if ((there - here).norm() > 2.0 * R) {
        const Vec3 along = (there - here).normalized();
        list.lines.push_back({here + R * along, there - R * along, width, color, LineLayer::kUnderBalls});
    }
}

constexpr Rgba kPanel{0.0F, 0.0F, 0.0F, 0.60F};      // background of the panels
constexpr Rgba kTextInk{0.97F, 0.97F, 0.95F, 1.0F};  // text

// [pixels] Height of a capital letter: readable in small
// frames, bounded in large ones; both panels fit side by side.
double text_height(const DrawList& list) {
    return std::clamp(std::min(list.camera.size.height / 48.0, list.camera.size.width / 36.0), 5.0, 28.0);
}

// [pixels] From the sides of the image to the panels, which leaves the corner pockets free if the table fills
// the image.
double side_room(const DrawList& list) {
    return 0.11 * list.camera.size.width;
}

// [-] Width of one character divided by the height of a capital letter.
constexpr double kAdvance = 0.92;

double text_width(double height, std::string_view text) {
    return height * kAdvance * static_cast<double>(text.size());
}

}  // namespace

void add_text(DrawList& list, const Vec2& at, double height, std::string_view text, const Rgba& color) {
    // A cell of the atlas is 6 x 9 units; the capital in its centre is 4 x 6 units.
    const double unit = height / 6.0;
    double x = at.x();
    for (char c : text) {
        const int glyph = glyph_index(c);
        if (glyph >= 0) {
            const Vec2 low(x - unit, at.y() - 1.5 * unit);
            list.boxes.push_back({low, low + unit * Vec2(6.0, 9.0), color, glyph});
        }
        x += height * kAdvance;
    }
}

namespace {

void add_clock(DrawList& list, double t) {
    const double height = text_height(list), room = 0.6 * height;
    const std::string text = fmt::format("{:.3f} s", t);
    const double left = side_room(list);
    list.boxes.push_back(
        {{left, room}, {left + 2.0 * room + text_width(height, text), 3.0 * room + height}, kPanel, -1});
    add_text(list, {left + room, 2.0 * room}, height, text, kTextInk);
}

/// The numbers of the table's diamonds, on its cushions.
void add_diamond_numbers(DrawList& list, const Table& table) {
    const double nose = table.cushions.empty() ? 0.0 : table.cushions.front().height;
    for (const auto& [at, number] : diamond_numbers(table, *list.table)) {
        const auto pixel = list.camera.project({at.x(), at.y(), nose});
        if (!pixel) continue;
        const std::string text = fmt::format("{}", number);
        const double height = 0.8 * text_height(list);
        add_text(list, *pixel - 0.5 * Vec2(text_width(height, text), height), height, text, kTextInk);
    }
}

void add_margin_bar(DrawList& list, const FrameBudget& cost) {
    const double height = text_height(list), room = 0.6 * height, width = 16.0 * height;
    const double right = list.camera.size.width - side_room(list), left = right - width - 2.0 * room;
    const std::string text = fmt::format("{:.1f} of {:.1f} ms", cost.cost_ms, cost.budget_ms);
    list.boxes.push_back({{left, room}, {right, 4.0 * room + 1.7 * height}, kPanel, -1});
    add_text(list, {left + room, 2.0 * room}, height, text, kTextInk);
    // The full bar is twice the budget; beyond its middle the frame exceeds its budget.
    const double top = 3.0 * room + height, share = std::clamp(0.5 * cost.cost_ms / cost.budget_ms, 0.0, 1.0);
    const Rgba good{0.25F, 0.80F, 0.35F, 1.0F}, bad{0.92F, 0.25F, 0.20F, 1.0F}, mark{1.0F, 1.0F, 1.0F, 0.9F};
    const double x = left + room, bottom = top + 0.7 * height;
    list.boxes.push_back({{x, top}, {x + share * width, bottom}, share <= 0.5 ? good : bad, -1});
    list.boxes.push_back({{x + 0.5 * width - 1.0, top}, {x + 0.5 * width + 1.0, bottom}, mark, -1});
}

}  // namespace

void add_overlay(DrawList& list, const Record& record, const Overlay& overlay, double t,
                 std::optional<FrameBudget> cost) {
    if (overlay.trails) {
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const BallTrack& track = record.tracks[i];
            const BallStyle style = ball_style(track.id, record.table.preset, static_cast<int>(i));
            const Rgba color{style.color[0], style.color[1], style.color[2], 1.0F};
            add_trail(list, track, t, line_width(list, 3.0), overlay.ball_trails ? &color : nullptr);
        }
    }
    if (overlay.events) add_events(list, record, t);
    if (overlay.ghost) add_ghost(list, record, t);
    if (overlay.spin) add_spin(list, record, t);
    if (overlay.diamonds) add_diamond_numbers(list, record.table);
    if (overlay.clock) add_clock(list, t);
    if (overlay.margin && cost) add_margin_bar(list, *cost);
}

}  // namespace carom::render
