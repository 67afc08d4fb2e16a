// The tables that come with the program.
#include <fmt/format.h>

#include <stdexcept>
#include <string_view>
#include <utility>

#include "carom/engine/math.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"

namespace carom {
namespace {

/// What defines a table with six pockets. Lengths in m, angles in degrees.
struct PocketTable {
    double length, width;  ///< between nose lines
    double cushion_width;  ///< the jaw facings reach back this far behind the nose line
    double nose_height;
    double corner_mouth;   ///< between the points where the facings' lines meet the nose lines
    double corner_angle;   ///< facing against the direction into the pocket (45 degrees to the rails)
    double corner_depth;   ///< pocket centre behind the corner of the nose lines
    double corner_radius;  ///< of the pocket circle
    double corner_jaw_radius;
    double side_mouth;
    double side_angle;  ///< facing against the normal of the rail
    double side_depth;
    double side_radius;
    double side_jaw_radius;
    double side_run;  ///< how far the side facing closes in, per length of depth: tan(side_angle) when
                      ///< straight on
};

/// Seven-foot table. Numbers of pooltool 0.6.0 for a Showood table; its side facings end at sin(angle)
/// instead of tan(angle) times the depth, 5e-5 m off the tangent, and that is kept so that the two tables are
/// the same one.
PocketTable seven_foot() {
    PocketTable t{};
    t.length = 1.9812;
    t.width = 0.9906;
    t.cushion_width = 0.0508;
    t.nose_height = 0.64 * 2.0 * 0.028575;
    t.corner_mouth = 0.118;
    t.corner_angle = 5.3;
    t.corner_depth = 0.0417;
    t.corner_radius = 0.062;
    t.corner_jaw_radius = 0.02095;
    t.side_mouth = 0.137;
    t.side_angle = 7.14;
    t.side_depth = 0.0685;
    t.side_radius = 0.0645;
    t.side_jaw_radius = 0.00795;
    t.side_run = sin_cos_deg(t.side_angle).sin;
    return t;
}

/// Nine-foot table. Playing surface 100 x 50 in; the mouths are the middle of what the WPA equipment
/// specifications allow (corner 4.5 to 4.625 in, side 5 to 5.125 in), and so are the angles between rail and
/// facing (corner 142, side 104 degrees; here they count from 135 and from 90). The nose, at 64 % of the
/// ball's diameter, lies within their 62.5 to 64.5 %. The numbers of the WPA are recalled, not read again for
/// this table. Carried over from the seven-foot table: cushion width, jaw radii, pocket radii and depths;
/// they give shelves of 37.6 mm in the corners and 4 mm at the sides (specified: 25 to 57 mm, 0 to 9.5 mm).
PocketTable nine_foot() {
    PocketTable t = seven_foot();
    t.length = 2.54;
    t.width = 1.27;
    t.corner_mouth = 4.5625 * 0.0254;
    t.corner_angle = 142.0 - 135.0;
    t.side_mouth = 5.0625 * 0.0254;
    t.side_angle = 104.0 - 90.0;
    t.side_run = tan_deg(t.side_angle);
    return t;
}

/// Eight-foot table: playing surface 92 x 46 in, the eight-foot size of the WPA equipment specifications
/// (recalled; tables of 88 x 44 in are sold as eight-foot too). Pockets as on the nine-foot table: the
/// specification has one set for both.
PocketTable eight_foot() {
    PocketTable t = nine_foot();
    t.length = 92.0 * 0.0254;
    t.width = 46.0 * 0.0254;
    return t;
}

/// Twelve-foot snooker table. Playing surface 3.569 x 1.778 m (11 ft 8 1/2 in x 5 ft 10 in, rules of the
/// WPBSA, section 1). Nose height 7/5 of the ball's radius (Mathavan, Jackson, Parkin 2010). The pocket
/// templates of the WPBSA are not published: mouths of 89 and 105 mm are the figures commonly quoted
/// (recalled), and jaw radii, depths and pocket radii are chosen to go with them: large round jaws, and a
/// ball falls where its centre passes the corner, or the rail line at the side.
PocketTable snooker_table() {
    PocketTable t{};
    t.length = 3.569;
    t.width = 1.778;
    t.cushion_width = 0.0508;
    t.nose_height = 1.4 * 0.02625;
    t.corner_mouth = 0.089;
    t.corner_angle = 0.0;
    t.corner_depth = 0.055;
    t.corner_radius = 0.050;
    t.corner_jaw_radius = 0.100;
    t.side_mouth = 0.105;
    t.side_angle = 10.0;
    t.side_depth = 0.055;
    t.side_radius = 0.050;
    t.side_jaw_radius = 0.040;
    t.side_run = tan_deg(t.side_angle);
    return t;
}

/// The parts of one quarter of the table, in the frame of its corner: x and y from the corner into the table,
/// the pocket at the origin. The other quarters are its mirror images.
struct Quarter {
    /// On the short rail: jaw centre, facing at the nose, facing at the back
    Vec2 short_jaw, short_tip, short_back;
    Vec2 long_jaw, long_tip, long_back;  ///< the same on the long rail
    Vec2 side_jaw, side_tip, side_back;  ///< on the long rail, at the side pocket
};

Quarter make_quarter(const PocketTable& t) {
    const double half = sin_cos_deg(45.0).cos;
    const double angle = 45.0 + t.corner_angle;
    const SinCos c = sin_cos_deg(angle);
    const SinCos s = sin_cos_deg(t.side_angle);
    const double mouth = t.corner_mouth * half;
    // A jaw circle touches the nose line and the facing.
    const double start = mouth + t.corner_jaw_radius / tan_deg((90.0 + angle) / 2.0);
    const double back = mouth - t.cushion_width * tan_deg(angle);
    const double r = t.corner_jaw_radius;
    Quarter q;
    q.short_jaw = {start, -r};
    q.short_tip = {start - r * c.cos, -r + r * c.sin};
    q.short_back = {back, -t.cushion_width};
    q.long_jaw = {q.short_jaw.y(), q.short_jaw.x()};
    q.long_tip = {q.short_tip.y(), q.short_tip.x()};
    q.long_back = {q.short_back.y(), q.short_back.x()};
    const double rs = t.side_jaw_radius;
    const double end = (t.length - t.side_mouth) / 2.0;
    q.side_jaw = {-rs, end - rs / tan_deg((90.0 + t.side_angle) / 2.0)};
    q.side_tip = {-rs + rs * s.sin, q.side_jaw.y() + rs * s.cos};
    q.side_back = {-t.cushion_width, end + t.cushion_width * t.side_run};
    return q;
}

class TableBuilder {
  public:
    TableBuilder(const char* preset, double width, double length, double nose) : nose_(nose) {
        table_.preset = preset;
        table_.width = width;
        table_.length = length;
    }
    void cushion(const char* name, const Vec2& from, const Vec2& to) {
        table_.cushions.push_back({fmt::format("c{}", table_.cushions.size() + 1), from, to, nose_, name});
    }
    void jaw(const char* name, const Vec2& center, double radius) {
        table_.jaws.push_back({fmt::format("j{}", table_.jaws.size() + 1), center, radius, nose_, name});
    }
    void pocket(const char* name, const Vec2& center, double radius) {
        table_.pockets.push_back(
            {fmt::format("p{}", table_.pockets.size() + 1), center, radius, kPocketDepth, name});
    }
    Table take() { return std::move(table_); }

  private:
    Table table_;
    double nose_;
};

/// Clockwise from the corner at the origin: head-left corner, left rail, foot rail, right rail, head rail.
Table build(const char* preset, const PocketTable& t) {
    const Quarter q = make_quarter(t);
    const double w = t.width, l = t.length;
    const auto hl = [](const Vec2& p) { return p; };
    const auto fl = [l](const Vec2& p) { return Vec2(p.x(), l - p.y()); };
    const auto fr = [w, l](const Vec2& p) { return Vec2(w - p.x(), l - p.y()); };
    const auto hr = [w](const Vec2& p) { return Vec2(w - p.x(), p.y()); };
    const double start = q.long_jaw.y(), end = q.side_jaw.y();
    const Vec2 long_start(0.0, start), long_end(0.0, end), short_start(start, 0.0);

    TableBuilder b(preset, w, l, t.nose_height);
    b.cushion("head-left corner, facing of the head rail", hl(q.short_back), hl(q.short_tip));
    b.cushion("head-left corner, facing of the left rail", hl(q.long_back), hl(q.long_tip));
    b.cushion("left rail, head half", hl(long_start), hl(long_end));
    b.cushion("left side pocket, facing of the head half", hl(q.side_back), hl(q.side_tip));
    b.cushion("left side pocket, facing of the foot half", fl(q.side_back), fl(q.side_tip));
    b.cushion("left rail, foot half", fl(long_end), fl(long_start));
    b.cushion("foot-left corner, facing of the left rail", fl(q.long_back), fl(q.long_tip));
    b.cushion("foot-left corner, facing of the foot rail", fl(q.short_back), fl(q.short_tip));
    b.cushion("foot rail", fl(short_start), fr(short_start));
    b.cushion("foot-right corner, facing of the foot rail", fr(q.short_back), fr(q.short_tip));
    b.cushion("foot-right corner, facing of the right rail", fr(q.long_back), fr(q.long_tip));
    b.cushion("right rail, foot half", fr(long_start), fr(long_end));
    b.cushion("right side pocket, facing of the foot half", fr(q.side_back), fr(q.side_tip));
    b.cushion("right side pocket, facing of the head half", hr(q.side_back), hr(q.side_tip));
    b.cushion("right rail, head half", hr(long_end), hr(long_start));
    b.cushion("head-right corner, facing of the right rail", hr(q.long_back), hr(q.long_tip));
    b.cushion("head-right corner, facing of the head rail", hr(q.short_back), hr(q.short_tip));
    b.cushion("head rail", hr(short_start), hl(short_start));

    const double rc = t.corner_jaw_radius, rs = t.side_jaw_radius;
    b.jaw("head-left corner, jaw of the head rail", hl(q.short_jaw), rc);
    b.jaw("head-left corner, jaw of the left rail", hl(q.long_jaw), rc);
    b.jaw("left side pocket, jaw of the head half", hl(q.side_jaw), rs);
    b.jaw("left side pocket, jaw of the foot half", fl(q.side_jaw), rs);
    b.jaw("foot-left corner, jaw of the left rail", fl(q.long_jaw), rc);
    b.jaw("foot-left corner, jaw of the foot rail", fl(q.short_jaw), rc);
    b.jaw("foot-right corner, jaw of the foot rail", fr(q.short_jaw), rc);
    b.jaw("foot-right corner, jaw of the right rail", fr(q.long_jaw), rc);
    b.jaw("right side pocket, jaw of the foot half", fr(q.side_jaw), rs);
    b.jaw("right side pocket, jaw of the head half", hr(q.side_jaw), rs);
    b.jaw("head-right corner, jaw of the right rail", hr(q.long_jaw), rc);
    b.jaw("head-right corner, jaw of the head rail", hr(q.short_jaw), rc);

    const double diagonal = t.corner_depth * sin_cos_deg(45.0).cos;
    const Vec2 corner(-diagonal, -diagonal), side(-t.side_depth, l / 2.0);
    b.pocket("head-left corner pocket", hl(corner), t.corner_radius);
    b.pocket("left side pocket", hl(side), t.side_radius);
    b.pocket("foot-left corner pocket", fl(corner), t.corner_radius);
    b.pocket("foot-right corner pocket", fr(corner), t.corner_radius);
    b.pocket("right side pocket", hr(side), t.side_radius);
    b.pocket("head-right corner pocket", hr(corner), t.corner_radius);
    return b.take();
}

/// Carom table, 2.84 x 1.42 m between nose lines, nose 37 mm above the cloth (UMB rules), no pockets.
Table carom_table() {
    const double w = 1.42, l = 2.84;
    TableBuilder b("carom", w, l, 0.037);
    b.cushion("left rail", {0.0, 0.0}, {0.0, l});
    b.cushion("foot rail", {0.0, l}, {w, l});
    b.cushion("right rail", {w, l}, {w, 0.0});
    b.cushion("head rail", {w, 0.0}, {0.0, 0.0});
    return b.take();
}

}  // namespace

Vec2 foot_spot(const Table& table) {
    return {table.corner.x() + table.width / 2.0, table.corner.y() + 3.0 * table.length / 4.0};
}

Table make_table(std::string_view preset) {
    if (preset == "seven_foot") return build("seven_foot", seven_foot());
    if (preset == "nine_foot") return build("nine_foot", nine_foot());
    if (preset == "eight_foot") return build("eight_foot", eight_foot());
    if (preset == "snooker") return build("snooker", snooker_table());
    if (preset == "carom") return carom_table();
    throw std::invalid_argument(fmt::format("unknown table preset \"{}\"", preset));
}

BallParams make_ball_params(std::string_view preset) {
    BallParams p{};
    // Pool: sources and measured ranges in docs/physics.md; the frictions and restitutions serve all three presets.
    p.R = 0.028575;
    p.m = 0.170097;
    p.mu_s = 0.2;
    p.mu_r = 0.01;
    p.mu_sp = 0.0127;
    p.mu_b = 0.05;
    p.e_b = 0.95;
    p.e_c = 0.85;
    p.f_c = 0.2;
    if (preset == "pool") return p;
    if (preset == "snooker") {
        p.R = 0.02625;
        p.m = 0.140;
        return p;
    }
    if (preset == "carom") {
        p.R = 0.03075;
        p.m = 0.21;
        return p;
    }
    throw std::invalid_argument(fmt::format("unknown ball preset \"{}\"", preset));
}

}  // namespace carom
