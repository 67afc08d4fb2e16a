// The long side of the table runs to the right: x of the page is y of the table, and y of the page, which
// points down, is x of the table. Each piece of a ball's motion is a parabola, which is a Bezier curve.
#include "report/diagram.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/console.h"
#include "carom/engine/event_details.h"
#include "carom/engine/printable.h"
#include "carom/render/draw_list.h"
#include "carom/render/look.h"
#include "carom/render/table_mesh.h"
#include "page/table_shape.h"
#include "report/diagram_page.h"
#include "report/diagram_words.h"

namespace carom::tools {
namespace {

namespace look = render::look;
using Json = nlohmann::ordered_json;
using Color = look::Color;

// All in points of the page.
constexpr double kDrawingWidth = 640.0, kMargin = 20.0, kTitleHeight = 26.0, kInsetHeight = 84.0;
constexpr double kTitleSize = 15.0, kTextSize = 8.0;
constexpr Color kBlack{0.0, 0.0, 0.0}, kWhite{1.0, 1.0, 1.0}, kGray{0.55, 0.55, 0.55};
constexpr double kDot = 0.9;
// [m/s] Slower contacts are drawn without a speed.
constexpr double kLeastSpeed = 0.05;
// [m] Below this a path is a dot.
constexpr double kLeastPath = 1e-4;

Color mixed(const Color& a, const Color& b, double share) {
    Color c{};
    for (std::size_t i = 0; i < 3; ++i) c[i] = a[i] + share * (b[i] - a[i]);
    return c;
}

/// One shot on the page.
class Drawing {
  public:
    Drawing(cairo_t* cr, const DiagramShot& shot, const DiagramStyle& style)
        : cr_(cr), shot_(shot), record_(shot.record), style_(style) {
        std::vector<Vec2> visited;
        for (const BallTrack& track : record_.tracks)
            for (const Segment& s : track.segments)
                if (!is_gone(s.state)) visited.push_back(planar(s.r));
        mesh_ = render::make_table_mesh(record_.table, record_.balls.R, visited);
        low_ = mesh_.bounds.low;
        high_ = mesh_.bounds.high;
        scale_ = kDrawingWidth / std::max(high_.y() - low_.y(), 1e-9);
        for (const Event& event : record_.events)
            if (struck_ < 0 && event.type == EventType::kCueStrike) struck_ = event.a;
    }
    double height() const { return kTitleHeight + scale_ * (high_.x() - low_.x()) + kInsetHeight; }

    void draw() {
        text(0.0, kTitleHeight - 10.0, shot_.title, kTitleSize, kBlack, 0.0);
        cairo_save(cr_);
        cairo_translate(cr_, 0.0, kTitleHeight);
        draw_table();
        // Below the paths: a ball may come back along the cue.
        draw_cue();
        for (std::size_t i = 0; i < record_.tracks.size(); ++i) draw_path(static_cast<int>(i));
        draw_ghost();
        draw_spreads();
        for (std::size_t i = 0; i < record_.tracks.size(); ++i) draw_ball(static_cast<int>(i));
        if (style_.speeds) draw_speeds();
        cairo_translate(cr_, 0.0, scale_ * (high_.x() - low_.x()));
        draw_inset();
        cairo_restore(cr_);
    }

  private:
    double px(const Vec2& p) const { return scale_ * (p.y() - low_.y()); }
    double py(const Vec2& p) const { return scale_ * (p.x() - low_.x()); }
    void color(const Color& c, double alpha = 1.0) { cairo_set_source_rgba(cr_, c[0], c[1], c[2], alpha); }

    /// @param side  0 begins at x, 0.5 is centred, 1 ends there
    void text(double x, double y, const std::string& words, double size, const Color& c, double side) {
        cairo_set_font_size(cr_, size);
        cairo_text_extents_t extents;
        cairo_text_extents(cr_, words.c_str(), &extents);
        color(c);
        cairo_move_to(cr_, x - side * extents.x_advance, y);
        cairo_show_text(cr_, words.c_str());
        cairo_new_path(cr_);
    }
    void stroke(const Color& c, double width) {
        color(c);
        cairo_set_line_width(cr_, width);
        cairo_stroke(cr_);
    }
    void circle(const Vec2& center, double radius) {
        cairo_new_sub_path(cr_);
        cairo_arc(cr_, px(center), py(center), radius, 0.0, 2.0 * std::numbers::pi);
    }

    void outlines(const Json& loops, const Color& fill, bool edge) {
        for (const Json& loop : loops) {
            for (std::size_t i = 0; i + 1 < loop.size(); i += 2) {
                const Vec2 p(loop[i].get<double>(), loop[i + 1].get<double>());
                (i == 0 ? cairo_move_to : cairo_line_to)(cr_, px(p), py(p));
            }
            cairo_close_path(cr_);
        }
        color(fill);
        cairo_fill_preserve(cr_);
        // Neighbours of one colour would show a seam.
        edge ? stroke(kBlack, 0.6) : stroke(fill, 0.4);
    }
    /// The edge of the table: the box around its boards.
    void frame(const Json& boards) {
        Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
        for (const Json& board : boards) {
            for (const Json& loop : board.at("loops")) {
                for (std::size_t i = 0; i + 1 < loop.size(); i += 2) {
                    const Vec2 p(loop[i].get<double>(), loop[i + 1].get<double>());
                    low = low.cwiseMin(p);
                    high = high.cwiseMax(p);
                }
            }
        }
        if (boards.empty()) return;
        cairo_rectangle(cr_, px(low), py(low), px(high) - px(low), py(high) - py(low));
        stroke(kBlack, 0.8);
    }
    void draw_table() {
        const Json shape = table_shape(record_.table, mesh_);
        const bool colored = style_.color;
        // Light colours, because a page is read on paper.
        for (const Json& board : shape.at("wood"))
            outlines(board.at("loops"), colored ? mixed(look::kPlainWood, kWhite, 0.35) : kWhite, false);
        frame(shape.at("wood"));
        outlines(shape.at("trim"), colored ? look::kPlainPocket : kWhite, true);
        outlines(shape.at("cloth"), colored ? mixed(mesh_.cloth, kWhite, 0.62) : kWhite, !colored);
        outlines(shape.at("cushion"), colored ? mixed(mesh_.cloth, kWhite, 0.3) : mixed(kWhite, kGray, 0.25),
                 true);
        if (style_.grid) draw_grid();
        outlines(shape.at("chalk"), colored ? kWhite : kGray, false);
        for (const Json& hole : shape.at("holes")) {
            const Json& center = hole.at("center");
            circle({center[0].get<double>(), center[1].get<double>()},
                   scale_ * hole.at("radius").get<double>());
            color(colored ? look::kPlainPocket : kWhite);
            cairo_fill_preserve(cr_);
            stroke(kBlack, 0.6);
        }
        outlines(shape.at("inlay"), colored ? look::kInlay : kBlack, false);
        if (style_.diamond_numbers) draw_diamond_numbers();
    }
    /// A line for each quarter of a diamond, from rail to rail.
    void draw_grid() {
        constexpr int kQuarters = 32, kAcross = kQuarters / 2;
        const carom::Table& t = record_.table;
        if (!(t.width > 0.0 && t.length > 0.0)) return;
        const auto line = [&](const Vec2& from, const Vec2& to, bool diamond) {
            cairo_move_to(cr_, px(from), py(from));
            cairo_line_to(cr_, px(to), py(to));
            stroke(style_.color ? mixed(mesh_.cloth, kWhite, 0.3) : mixed(kWhite, kGray, 0.6),
                   diamond ? 0.5 : 0.2);
        };
        for (int k = 1; k < kQuarters; ++k) {
            const double y = t.corner.y() + t.length * k / kQuarters;
            line({t.corner.x(), y}, {t.corner.x() + t.width, y}, k % 4 == 0);
        }
        for (int k = 1; k < kAcross; ++k) {
            const double x = t.corner.x() + t.width * k / kAcross;
            line({x, t.corner.y()}, {x, t.corner.y() + t.length}, k % 4 == 0);
        }
    }
    /// On the cushions, beside the diamonds of the rail.
    void draw_diamond_numbers() {
        for (const auto& [at, number] : render::diamond_numbers(record_.table, mesh_))
            text(px(at), py(at) + 0.35 * kTextSize, fmt::format("{}", number), kTextSize,
                 style_.color ? kWhite : kBlack, 0.5);
    }

    Color ball_color(int ball) const {
        const std::array<float, 3> c =
            render::ball_style(record_.tracks[ball].id, record_.table.preset, ball).color;
        return {c[0], c[1], c[2]};
    }
    /// Dark enough to be visible on the cloth.
    Color path_color(int ball) const { return style_.color ? mixed(ball_color(ball), kBlack, 0.25) : kBlack; }
    /// As dark as ink: dots and ellipses are small, and half of the balls are as pale as the cloth.
    Color spread_color(int ball) const {
        return mixed(path_color(ball), kBlack, ball == struck_ ? 0.9 : 0.45);
    }
    /// The struck ball's path is white between black edges, unlike any other ball's path.
    void stroke_path(int ball) {
        if (ball != struck_) return stroke(path_color(ball), 1.1);
        color(kBlack);
        cairo_set_line_width(cr_, 2.6);
        cairo_stroke_preserve(cr_);
        stroke(kWhite, 1.3);
    }

    /// When the ball first meets another one, or the end of the shot.
    double first_contact(int ball) const {
        for (const Event& event : record_.events) {
            bool in = false;
            each_hit(event, record_.hits(event), [&](const Hit& hit) {
                in = in || (hit.partner == Partner::kBall && (hit.a == ball || hit.b == ball));
            });
            if (in) return event.time;
        }
        return record_.duration;
    }

    void draw_path(int ball) {
        const std::vector<Segment>& segments = record_.tracks[ball].segments;
        const double contact = first_contact(ball);
        for (const bool dashed : {false, true}) {
            bool begun = false;
            Vec2 last, direction = Vec2::Zero();
            for (std::size_t i = 0; i < segments.size(); ++i) {
                const Segment& s = segments[i];
                const double end = i + 1 < segments.size() ? segments[i + 1].start : record_.duration;
                const double time = std::min(end - s.start, s.duration);
                if (!(time > 0.0) || is_gone(s.state) || (s.start >= contact) != dashed) continue;
                const Vec2 from = planar(s.r), to = planar(position_at(s, time)), v = planar(s.v);
                if ((to - from).norm() < kLeastPath) continue;
                if (!begun) cairo_move_to(cr_, px(from), py(from));
                begun = true;
                // The middle point of the parabola's control polygon, and the cubic curve that equals it.
                const Vec2 middle = from + 0.5 * time * v;
                const Vec2 c1 = from + 2.0 / 3.0 * (middle - from), c2 = to + 2.0 / 3.0 * (middle - to);
                cairo_curve_to(cr_, px(c1), py(c1), px(c2), py(c2), px(to), py(to));
                direction = to - from;
                last = to;
            }
            if (!begun) continue;
            const double dash[] = {ball == struck_ ? 9.0 : 3.5, 2.5};
            cairo_set_dash(cr_, dash, dashed ? 2 : 0, 0.0);
            stroke_path(ball);
            cairo_set_dash(cr_, dash, 0, 0.0);
            (dashed ? has_dashes_ : has_solid_) = true;
            if (dashed || contact >= record_.duration)
                arrow(last, direction, ball == struck_ ? kBlack : path_color(ball), ball);
        }
    }
    /// The ball at rest at the end of its path, as a ring with an arrow.
    void arrow(const Vec2& tip, const Vec2& direction, const Color& c, int ball) {
        if (!(direction.norm() > 0.0)) return;
        const double angle = std::atan2(py(tip + direction) - py(tip), px(tip + direction) - px(tip));
        cairo_save(cr_);
        cairo_translate(cr_, px(tip), py(tip));
        cairo_rotate(cr_, angle);
        cairo_move_to(cr_, 0.0, 0.0);
        cairo_line_to(cr_, -7.0, 2.8);
        cairo_line_to(cr_, -7.0, -2.8);
        cairo_close_path(cr_);
        color(c);
        cairo_fill(cr_);
        cairo_restore(cr_);
        const BallState end = record_.state_at(ball, record_.duration);
        if (is_gone(end.state)) return;
        circle(planar(end.position), scale_ * record_.size(ball).R);
        stroke(c, 0.7);
        has_rings_ = true;
    }

    /// The struck ball at its first contact with another ball.
    void draw_ghost() {
        if (struck_ < 0) return;
        const double time = first_contact(struck_);
        if (time >= record_.duration) return;
        const double R = scale_ * record_.size(struck_).R;
        ghost_ = planar(record_.state_at(struck_, time).position);
        circle(*ghost_, R);
        color(kWhite, 0.55);
        cairo_fill_preserve(cr_);
        const double dots[] = {1.4, 1.4};
        cairo_set_dash(cr_, dots, 2, 0.0);
        stroke(kBlack, 0.8);
        cairo_set_dash(cr_, dots, 0, 0.0);
    }

    void draw_spreads() {
        constexpr int kCorners = 90;
        cairo_save(cr_);
        cairo_rectangle(cr_, 0.0, 0.0, kDrawingWidth, scale_ * (high_.x() - low_.x()));
        cairo_clip(cr_);
        for (const DiagramSpread& spread : shot_.spreads) {
            for (const Vec2& end : spread.ends) {
                circle(end, kDot);
                color(spread_color(spread.ball), 0.5);
                cairo_fill(cr_);
            }
            for (const double deviations : {1.0, 2.0}) {
                for (int i = 0; i < kCorners; ++i) {
                    const double angle = 2.0 * std::numbers::pi * i / kCorners;
                    const Vec2 p = spread.center + deviations * (std::cos(angle) * spread.along +
                                                                 std::sin(angle) * spread.across);
                    (i == 0 ? cairo_move_to : cairo_line_to)(cr_, px(p), py(p));
                }
                cairo_close_path(cr_);
                stroke(spread_color(spread.ball), 1.2);
            }
        }
        cairo_restore(cr_);
    }

    void draw_ball(int ball) {
        const BallState s = record_.state_at(ball, 0.0);
        if (is_gone(s.state)) return;
        const render::BallStyle of = render::ball_style(record_.tracks[ball].id, record_.table.preset, ball);
        const double R = scale_ * record_.size(ball).R;
        const Vec2 center = planar(s.position);
        const bool stripe = of.pattern == render::BallPattern::kStripe;
        const bool white = !style_.color || stripe;
        circle(center, R);
        color(white ? kWhite : ball_color(ball));
        cairo_fill_preserve(cr_);
        cairo_save(cr_);
        cairo_clip_preserve(cr_);
        cairo_new_path(cr_);
        if (stripe) {
            cairo_rectangle(cr_, px(center) - R, py(center) - look::kStripe * R, 2.0 * R,
                            2.0 * look::kStripe * R);
            color(style_.color ? ball_color(ball) : kGray);
            cairo_fill(cr_);
        }
        cairo_restore(cr_);
        circle(center, R);
        stroke(kBlack, 0.7);
        // Without colour, a ball without a number shows its first letter, and the struck one is blank.
        std::string sign = of.number > 0 ? fmt::format("{}", of.number) : "";
        if (sign.empty() && !style_.color && ball != struck_)
            sign = static_cast<char>(std::toupper(static_cast<unsigned char>(record_.tracks[ball].id[0])));
        if (sign.empty()) return;
        circle(center, (style_.color ? look::kSpot : 0.68) * R);
        color(style_.color ? look::kIvory : kWhite);
        cairo_fill(cr_);
        const double size = R * (of.number > 9 ? 0.85 : 1.0);
        text(px(center), py(center) + 0.36 * size, sign, size, kBlack, 0.5);
    }

    /// The stick behind the ball that it strikes.
    void draw_cue() {
        if (!shot_.cue || struck_ < 0) return;
        const double aim = shot_.cue->aim_deg * std::numbers::pi / 180.0;
        const Vec2 along(std::cos(aim), std::sin(aim)), left(-along.y(), along.x());
        const double R = record_.size(struck_).R;
        const Vec2 tip =
            planar(record_.state_at(struck_, 0.0).position) + shot_.cue->side * R * left - 1.3 * R * along;
        cairo_save(cr_);
        cairo_rectangle(cr_, 0.0, 0.0, kDrawingWidth, scale_ * (high_.x() - low_.x()));
        cairo_clip(cr_);
        // To scale: leather, ferrule, shaft and butt.
        constexpr double kLength = 1.47, kTipHalf = 0.0065, kButtHalf = 0.0145;
        const Color shaft = mixed(look::kInlay, kWhite, 0.2);
        const std::tuple<double, double, Color> parts[] = {{0.0, 0.006, {0.13, 0.35, 0.62}},
                                                           {0.006, 0.03, kWhite},
                                                           {0.03, 0.75, shaft},
                                                           {0.75, kLength, mixed(shaft, kBlack, 0.55)}};
        for (const auto& [from, to, c] : parts) {
            for (const auto& [at, side] : {std::pair(from, 1.0), {to, 1.0}, {to, -1.0}, {from, -1.0}}) {
                const double half = kTipHalf + (kButtHalf - kTipHalf) * at / kLength;
                const Vec2 p = tip - at * along + side * half * left;
                cairo_line_to(cr_, px(p), py(p));
            }
            cairo_close_path(cr_);
            color(style_.color ? c : kWhite);
            cairo_fill_preserve(cr_);
            stroke(kBlack, 0.5);
        }
        cairo_restore(cr_);
    }

    /// Whether a label around a place [points] leaves the balls, the ghost ball and other labels free.
    bool is_free(double x, double y, double half_width) const {
        const double R = scale_ * record_.size(struck_).R;
        const auto clear = [&](const Vec2& ball) {
            return std::hypot(std::max(std::abs(px(ball) - x) - half_width, 0.0),
                              std::max(std::abs(py(ball) - y) - 0.6 * kTextSize, 0.0)) > R;
        };
        for (std::size_t i = 0; i < record_.tracks.size(); ++i)
            if (!clear(planar(record_.state_at(static_cast<int>(i), 0.0).position))) return false;
        return (!ghost_ || clear(*ghost_)) &&
               std::none_of(labels_.begin(), labels_.end(), [&](const Vec2& other) {
                   return std::abs(other.x() - x) < 2.0 * half_width &&
                          std::abs(other.y() - y) < 1.3 * kTextSize;
               });
    }

    void draw_speeds() {
        int told = 0;
        for (std::size_t i = 0; i < record_.events.size() && told < 6; ++i) {
            const Event& event = record_.events[i];
            const EventKind& of = kind(event.type);
            const bool contact = of.phase == EventPhase::kImpact &&
                                 (of.partner == Partner::kBall || of.partner == Partner::kCushion);
            if (!contact || (event.a != struck_ && !(of.partner == Partner::kBall && event.b == struck_)))
                continue;
            const EventDetails d = details_of(record_, i);
            const BallAtEvent& ball = d.balls[event.a == struck_ ? 0 : 1];
            const Vec2 place = planar(ball.after.position);
            const Vec2 v = planar(ball.before.velocity);
            if (v.norm() < kLeastSpeed) continue;
            const std::string words = speed_text(v.norm(), style_.units);
            cairo_text_extents_t extents;
            cairo_set_font_size(cr_, kTextSize);
            cairo_text_extents(cr_, words.c_str(), &extents);
            const double half = 0.5 * extents.x_advance + 1.5;
            // Beside the path, on the side from which the ball comes, as near as possible without hiding
            // anything.
            const Vec2 back = -v.normalized(), aside(-back.y(), back.x());
            Vec2 at;
            bool free = false;
            for (const double away : {1.5, 2.3, 3.1, 3.9, 4.7, 5.5}) {
                for (const double side : {1.9, -1.9}) {
                    if (free) break;
                    const Vec2 p = place + record_.size(struck_).R * (away * back + side * aside);
                    at = Vec2(std::clamp(px(p), half, kDrawingWidth - half), py(p));
                    free = is_free(at.x(), at.y(), half);
                }
            }
            if (!free) continue;
            labels_.push_back(at);
            cairo_rectangle(cr_, at.x() - half, at.y() - 0.5 * kTextSize - 1.0, 2.0 * half, kTextSize + 2.0);
            color(kWhite, 0.75);
            cairo_fill(cr_);
            text(at.x(), at.y() + 0.36 * kTextSize, words, kTextSize, kBlack, 0.5);
            ++told;
        }
    }

    /// The contact of the tip with the ball, and the shot in words.
    void draw_inset() {
        const double r = 26.0, x = r + 4.0, y = r + 10.0;
        std::string words;
        if (shot_.cue && struck_ >= 0) {
            const Cue& cue = *shot_.cue;
            cairo_arc(cr_, x, y, r, 0.0, 2.0 * std::numbers::pi);
            color(style_.color ? ball_color(struck_) : kWhite);
            cairo_fill_preserve(cr_);
            stroke(kBlack, 0.8);
            for (const auto& [dx, dy] : {std::pair(r, 0.0), std::pair(0.0, r)}) {
                cairo_move_to(cr_, x - dx, y - dy);
                cairo_line_to(cr_, x + dx, y + dy);
            }
            stroke(kGray, 0.5);
            // The offset is along the left of the player, who looks along the aim.
            cairo_arc(cr_, x - r * cue.side, y - r * cue.height, 5.0, 0.0, 2.0 * std::numbers::pi);
            color(style_.color ? Color{0.13, 0.35, 0.62} : kBlack);
            cairo_fill(cr_);
            words = stroke_words(cue, style_.units);
        }
        const double left = words.empty() ? 0.0 : 2.0 * r + 16.0;
        text(left, y - 8.0, words, 9.5, kBlack, 0.0);
        text(left, y + 5.0, outcome_words(record_), 9.5, kBlack, 0.0);
        text(left, y + 18.0, places_words(record_, style_.units), kTextSize, kBlack, 0.0);
        text(left, y + 29.0, legend(), kTextSize, kGray, 0.0);
        if (!shot_.spreads.empty())
            text(left, y + 40.0,
                 "ellipses: one and two standard deviations of the end, to first order; dots: where played "
                 "shots end",
                 kTextSize, kGray, 0.0);
    }
    std::string legend() const {
        std::string words;
        const auto add = [&words](bool there, const char* what) {
            if (there) words += fmt::format("{}{}", words.empty() ? "" : "; ", what);
        };
        add(struck_ >= 0, "white line: the ball that is struck");
        add(has_solid_ && has_dashes_, "dashed: after a ball met another");
        add(ghost_.has_value(), "dotted ring: ghost ball");
        add(has_rings_, "ring: where a ball stops");
        return words;
    }
    cairo_t* cr_;
    const DiagramShot& shot_;
    const Record& record_;
    const DiagramStyle& style_;
    render::TableMesh mesh_;
    Vec2 low_, high_;
    double scale_ = 1.0;  ///< [points/m]
    int struck_ = -1;
    bool has_solid_ = false, has_dashes_ = false, has_rings_ = false;
    std::optional<Vec2> ghost_;
    std::vector<Vec2> labels_;  ///< middles [points]
};

}  // namespace

// In two columns if there are several shots.
std::pair<double, double> paint_diagram(cairo_t* cr, const std::vector<DiagramShot>& shots,
                                        const DiagramStyle& style) {
    const std::size_t columns = shots.size() > 1 ? 2 : 1;
    double y = kMargin;
    for (std::size_t first = 0; first < shots.size(); first += columns) {
        double highest = 0.0;
        for (std::size_t i = first; i < std::min(first + columns, shots.size()); ++i) {
            Drawing drawing(cr, shots[i], style);
            cairo_save(cr);
            cairo_translate(cr, kMargin + static_cast<double>(i - first) * (kDrawingWidth + kMargin), y);
            drawing.draw();
            cairo_restore(cr);
            highest = std::max(highest, drawing.height());
        }
        y += highest + kMargin;
    }
    return {kMargin + static_cast<double>(columns) * (kDrawingWidth + kMargin), y};
}

std::string diagram_format(const std::string& path) {
    for (const char* format : kDiagramFormats)
        if (path.ends_with(format)) return format;
    throw UsageError(fmt::format("{}: expected a name that ends with .svg, .pdf or .png", harmless(path)));
}

std::string draw_diagram(const std::vector<DiagramShot>& shots, const DiagramStyle& style,
                         const std::string& format) {
    return cairo_page(format, [&](cairo_t* cr) { return paint_diagram(cr, shots, style); });
}

}  // namespace carom::tools
