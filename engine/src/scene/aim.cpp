// Aims in a player's words: at a ball, at a part of it, at a diamond, into a pocket.
#include "scene/sections.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "carom/engine/event_details.h"
#include "carom/engine/math.h"
#include "carom/engine/strike.h"

namespace carom::detail {
namespace {

class Aim {
  public:
    Aim(const Section& s, const Scene& scene, const Cue& cue) : s_(s), scene_(scene), cue_(cue) {
        const BallStart& ball = ball_of("ball", cue.ball);
        from_ = planar(ball.position);
        R_ = radius(ball);
    }

    double at() const {
        const toml::node& node = *s_.node("aim_at");
        if (const auto* id = node.as_string())
            return towards("aim_at", planar(other("aim_at", id->get()).position));
        const toml::array* place = node.as_array();
        if (!place || place->size() != 2)
            s_.fail("aim_at", "cue.aim_at: write the id of a ball, or [x, y] in m");
        return towards("aim_at", {s_.number_of((*place)[0], "cue.aim_at[0]", kCoordinate),
                                  s_.number_of((*place)[1], "cue.aim_at[1]", kCoordinate)});
    }

    /// ["1", 0.75]: hit three quarters of the ball, its left half as the player sees it; -0.75: its right
    /// half.
    double hit() const {
        const toml::array& list =
            list_of("aim_hit", "[\"1\", 0.75]: a ball, and the fullness of the hit, -1 to 1");
        const BallStart& ball = other("aim_hit", text(list, "aim_hit"));
        const double full = s_.number_of(list[1], "cue.aim_hit[1]", {-1.0, false, 1.0, false, ""});
        if (full == 0.0)
            s_.fail("aim_hit", "cue.aim_hit: a hit of 0 misses the ball; write 1 for a full hit");
        const Vec2 way = planar(ball.position) - from_;
        const double reach = (1.0 - std::abs(full)) * (R_ + radius(ball)) / way.norm();
        if (!(reach < 1.0))
            s_.fail("aim_hit", "cue.aim_hit: the ball is too near for this hit; hit it fuller");
        return angle(way) + (full > 0.0 ? 1.0 : -1.0) * (90.0 - arc_cos(reach) * kDegrees);
    }

    /// ["1", "p3"]: the ball moves along the line from its centre to the middle of the pocket.
    double ghost() const {
        const toml::array& list = list_of("ghost", "[\"1\", \"p3\"]: a ball and a pocket");
        const BallStart& ball = other("ghost", text(list, "ghost"));
        const auto* id = list[1].as_string();
        const auto& pockets = scene_.table.pockets;
        const auto pocket = std::find_if(pockets.begin(), pockets.end(),
                                         [&](const Pocket& p) { return id != nullptr && p.id == id->get(); });
        if (pocket == pockets.end())
            s_.fail("ghost", "cue.ghost: the table has no such pocket; carom check lists its pockets");
        const Vec2 object = planar(ball.position), line = (pocket->center - object).normalized();
        const Vec2 place = object - (R_ + radius(ball)) * line;
        if ((place - from_).dot(line) <= 0.0)
            s_.fail("ghost", "cue.ghost: ball {} hides this pocket: the cut would be 90 degrees or more",
                    in_quotes(ball.id));
        return towards("ghost", place);
    }

    /// ["foot", 2.5]: a point on a rail, counted from the origin's side.
    double diamond() const {
        const toml::array& list =
            list_of("aim_diamond", "[\"foot\", 2.5]: head, foot, left or right, and a number");
        const std::string rail = text(list, "aim_diamond");
        const bool longs = rail == "left" || rail == "right";
        if (!longs && rail != "head" && rail != "foot")
            s_.fail("aim_diamond", "cue.aim_diamond: unknown rail {}; use head, foot, left or right",
                    in_quotes(rail));
        if (!diamond_place(scene_.table, rail, 0.0))
            s_.fail("aim_diamond", "cue.aim_diamond: the cloth is endless; choose a table");
        const double most = longs ? kLongRail : kShortRail;
        const double n = s_.number_of(list[1], "cue.aim_diamond[1]", {0.0, false, most, false, "diamonds"});
        return towards("aim_diamond", *diamond_place(scene_.table, rail, n));
    }

    /// The cue speed that gives the struck ball this speed.
    double speed() const {
        const double wanted =
            s_.number_of(*s_.node("ball_speed"), "cue.ball_speed", at_least(0.0, kMaxSpeed, "m/s"));
        const double gain = ball_speed_gain(cue_, scene_.size_of(ball_of("ball", cue_.ball)));
        if (!(wanted <= kMaxSpeed * gain))
            s_.fail("ball_speed", "cue.ball_speed = {} needs a cue faster than {} m/s; lower it", wanted,
                    kMaxSpeed);
        return wanted / gain;
    }

  private:
    const BallStart& ball_of(std::string_view key, const std::string& id) const {
        for (const BallStart& ball : scene_.ball)
            if (ball.id == id) return ball;
        s_.fail(key, "cue.{}: there is no ball {}; add a [[ball]] with this id or name another", key,
                in_quotes(id));
    }
    const BallStart& other(std::string_view key, const std::string& id) const {
        if (id == cue_.ball) s_.fail(key, "cue.{}: ball {} cannot be aimed at itself", key, in_quotes(id));
        return ball_of(key, id);
    }
    double radius(const BallStart& ball) const { return ball.own.value_or(scene_.balls.size()).R; }
    const toml::array& list_of(std::string_view key, std::string_view shape) const {
        const toml::array* list = s_.node(key)->as_array();
        if (!list || list->size() != 2) s_.fail(key, "cue.{}: write {}", key, shape);
        return *list;
    }
    std::string text(const toml::array& list, std::string_view key) const {
        const auto* id = list[0].as_string();
        if (!id) s_.fail(key, "cue.{}: its first value must be a name in quotes", key);
        return id->get();
    }
    static double angle(const Vec2& way) { return direction_deg(way.x(), way.y()); }
    double towards(std::string_view key, const Vec2& place) const {
        const Vec2 way = place - from_;
        if (!(way.norm() > 0.0)) s_.fail(key, "cue.{}: the ball is there already; aim at another place", key);
        return angle(way);
    }

    const Section& s_;
    const Scene& scene_;
    const Cue& cue_;
    Vec2 from_ = Vec2::Zero();
    double R_ = 0.0;
};

}  // namespace

void read_aim(const Section& s, const Scene& scene, Cue& cue) {
    const char* said = s.has("aim_deg") ? "aim_deg" : nullptr;
    for (const char* key : {"aim_at", "aim_hit", "aim_diamond", "ghost"}) {
        if (!s.has(key)) continue;
        if (said) s.fail(key, "cue.{} and cue.{} are two aims; remove one", said, key);
        said = key;
        const Aim aim(s, scene, cue);
        const std::string_view which = key;
        cue.aim_deg = which == "aim_at"    ? aim.at()
                      : which == "aim_hit" ? aim.hit()
                      : which == "ghost"   ? aim.ghost()
                                           : aim.diamond();
    }
    if (!s.has("ball_speed")) return;
    if (s.has("speed")) s.fail("ball_speed", "cue.speed and cue.ball_speed are two speeds; remove one");
    cue.speed = Aim(s, scene, cue).speed();
}

void write_aim(toml::table& file, const Cue& cue, bool keep_ball_speed) {
    toml::table* section = file["cue"].as_table();
    if (!section) return;
    if (section->contains("elevation_deg") && section->at("elevation_deg").is_string())
        section->insert_or_assign("elevation_deg", cue.elevation_deg);
    for (const std::string_view key : kAimKeys) {
        if ((keep_ball_speed && key == "ball_speed") || section->erase(key) == 0) continue;
        if (key == "ball_speed")
            section->insert_or_assign("speed", cue.speed);
        else
            section->insert_or_assign("aim_deg", cue.aim_deg);
    }
}

}  // namespace carom::detail
