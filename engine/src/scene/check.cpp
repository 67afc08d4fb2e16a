// Rules that involve several sections of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/geometry.h"
#include "carom/engine/tolerances.h"
#include "contact/touch.h"
#include "physics/reach.h"
#include "scene/sections.h"

namespace carom::detail {
namespace {

void check_ids(const Section& top, const Scene& scene) {
    std::unordered_map<std::string, SourceLocation> seen;
    for (const BallStart& ball : scene.ball) {
        const auto [first, fresh] = seen.emplace(ball.id, ball.where);
        if (fresh) continue;
        const bool in_file = top.has("ball") || top.has("rack");
        top.fail(ball.where, "ball id {} is already used{}; give each ball an id of its own",
                 in_quotes(ball.id), in_file ? fmt::format(" in line {}", first->second.line) : "");
    }
    for (const Jaw& jaw : scene.table.jaws)
        if (const auto ball = seen.find(jaw.id); jaw.is_arc() && ball != seen.end())
            top.fail(ball->second, "the ball id {} is the name of an arc; choose another", in_quotes(jaw.id));
}

void check_overlaps(const Section& top, const Scene& scene) {
    double largest = 0.0;
    for (const BallStart& ball : scene.ball) largest = std::max(largest, scene.size_of(ball).R);
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        const double x = ball.position.x(), y = ball.position.y(), R = scene.size_of(ball).R;
        const double touch = touch_tolerance(planar(ball.position)), reach = R + largest;
        for (std::size_t j = 0; j < i; ++j) {
            // Compare the axes first, because most of up to eight million pairs are far apart.
            const BallStart& other = scene.ball[j];
            const double dx = x - other.position.x(), dy = y - other.position.y();
            if (std::abs(dx) >= reach || std::abs(dy) >= reach) continue;
            const double other_R = scene.size_of(other).R;
            const bool lie = ball.height == 0.0 && other.height == 0.0;
            const double diameter = lie ? contact_distance(R, other_R, scene.balls.discs()) : R + other_R;
            const double up = lie ? 0.0 : ball.position.z() - other.position.z();
            const double distance = std::sqrt(dx * dx + dy * dy + up * up);
            if (distance >= diameter - touch) continue;
            top.fail(ball.where, "balls {} and {} overlap by {:.4g} m; move one of them", in_quotes(other.id),
                     in_quotes(ball.id), diameter - distance);
        }
    }
}

void check_reach(const Section& top, const Scene& scene) {
    const auto refuse = [&](const BallStart& ball, const char* kind, const std::string& id, double depth) {
        top.fail(ball.where, "ball {} reaches {:.4g} m into {} {}; move it away", in_quotes(ball.id), depth,
                 kind, id);
    };
    for (const BallStart& ball : scene.ball) {
        const Vec2 p = planar(ball.position);
        const double touch = touch_tolerance(p), R = scene.size_of(ball).R;
        const BallAt at{ball.position, Vec3::Zero(), R, ball.height != 0.0};
        const auto depth_in = [&](Nose nose) {
            nose.inset = nose_inset(scene.physics.cushion_touch, R, nose.height);
            // No cloth lies inside the circle of a jaw, however high the ball starts.
            BallAt there = at;
            there.flies = at.flies && !behind(nose, p);
            return -touch_part(nose, there).gap;
        };
        const auto depth_at = [&](const Vec2& point, double height) {
            return depth_in({point, 0.0, height, Partner::kCushion, 0});
        };
        // Most parts are far from most balls, and a batch checks every shot.
        const auto is_far = [&](const Vec2& a, const Vec2& b, double radius) {
            const double near = radius + kNoseReach * R;
            return p.x() < std::min(a.x(), b.x()) - near || p.x() > std::max(a.x(), b.x()) + near ||
                   p.y() < std::min(a.y(), b.y()) - near || p.y() > std::max(a.y(), b.y()) + near;
        };
        for (const Cushion& c : scene.table.cushions) {
            if (is_far(c.from, c.to, 0.0)) continue;
            const double depth = depth_at(nearest_point(line_of(c, 0.0), p), c.height);
            if (depth > touch) refuse(ball, "cushion", c.id, depth);
        }
        for (const Jaw& j : scene.table.jaws) {
            if (!j.is_arc() && is_far(j.center, j.center, j.radius)) continue;
            const Nose nose = nose_of(j, 0, 0.0);
            if (!j.is_arc()) {
                if (!at.flies && length(p - j.center) < j.radius - R)
                    top.fail(
                        ball.where,
                        "ball {} lies inside jaw {}, which balls touch from outside; move it out, or write "
                        "[[table.arc]] with side = \"inside\" for a round wall",
                        in_quotes(ball.id), j.id);
                if (const double depth = depth_in(nose); depth > touch) refuse(ball, "jaw", j.id, depth);
                continue;
            }
            double depth = 0.0;
            if (nose.span.holds(p - nose.center)) {
                if (behind(nose, p))
                    top.fail(ball.where,
                             "ball {} lies behind arc {}, whose side is \"{}\"; move it to that side",
                             in_quotes(ball.id), j.id, *j.side);
                depth = depth_in(nose);
            }
            if (!nose.span.whole)
                for (const Vec2& end : {nose.span.from, nose.span.to})
                    depth = std::max(depth, depth_at(j.center + j.radius * end, j.height));
            if (depth > touch) refuse(ball, "arc", j.id, depth);
        }
    }
}

/// Refuses a nose at or above the top of a ball: no ball could hit it.
void check_noses(const Section& top, const Scene& scene) {
    const auto check = [&](const char* kind, const std::string& id, double height) {
        for (const BallStart& ball : scene.ball) {
            const double R = scene.size_of(ball).R;
            if (height < 2.0 * R) continue;
            const std::string message = fmt::format(
                "the nose of {} {} is {} m high, not below the top of a ball ({} m); "
                "use larger balls or a lower cushion",
                kind, id, height, 2.0 * R);
            if (ball.own) top.fail(ball.where, "{}", message);
            top.fail(top.has("table") ? "table" : "balls", "{}", message);
        }
    };
    for (const Cushion& c : scene.table.cushions) check("cushion", c.id, c.height);
    for (const Jaw& j : scene.table.jaws) check(j.is_arc() ? "arc" : "jaw", j.id, j.height);
}

/// Refuses a cloth on which rolling decelerates a ball more than sliding: resting contacts have no solution
/// there. Without sliding friction (mu_s = 0) there is nothing to compare.
void check_cloth(const Section& top, const Scene& scene) {
    const BallParams& p = scene.balls;
    if (p.mu_s == 0.0 || p.mu_r <= p.mu_s) return;
    const bool by_name = !top.has("balls", "mu_r") && scene.table.cloth;
    const SourceLocation where = by_name ? top.where("table", "cloth")
                                         : top.where("balls", top.has("balls", "mu_r") ? "mu_r" : "mu_s");
    top.fail(where,
             "balls.mu_r = {} is above balls.mu_s = {}: a rolling ball would have more friction than a "
             "sliding one; lower mu_r or raise mu_s",
             p.mu_r, p.mu_s);
}

/// The reason why the integrated impact cannot handle two ball sizes of the scene; "" if it can.
std::string sizes_refused(const Scene& scene, const BallSize& one, const BallSize& two) {
    const double masses = std::max(one.m, two.m) / std::min(one.m, two.m);
    const double radii = std::max(one.R, two.R) / std::min(one.R, two.R);
    if (!(masses <= kernel::kLargestMassRatio))
        return fmt::format("accepts mass ratios up to {}", kernel::kLargestMassRatio);
    if (!(radii <= kernel::kLargestRadiusRatio))
        return fmt::format("accepts radius ratios up to {}", kernel::kLargestRadiusRatio);
    const double mu_b = scene.balls.ball_friction().most();
    const PairLaw law{*scene.physics.ball_ball, {.cloth_slip = scene.physics.cloth_slip}, scene.balls};
    if (kernel::sizes_have_solution(law.params(one, two, mu_b))) return "";
    return fmt::format(
        "has no solution with balls.mu_s = {} and a friction of {} between balls of these sizes",
        scene.balls.mu_s, mu_b);
}

/// Refuses balls of different size if the scene's models have no formula for them.
void check_sizes(const Section& top, const Scene& scene) {
    if (scene.alike()) return;
    if (scene.physics.cushion_touch == CushionTouch::kNose)
        top.fail(top.where("physics", "cushion_touch"),
                 "physics.cushion_touch = \"nose\" needs balls of equal size; leave it out");
    const BallBallModelInfo& model = *scene.physics.ball_ball;
    const bool rough = model.reads_friction && scene.balls.ball_friction().any();
    const BallSize first = scene.size_of(scene.ball.front());
    for (const BallStart& ball : scene.ball) {
        const BallSize size = scene.size_of(ball);
        if (size == first) continue;
        const SourceLocation where = ball.own ? ball.where : scene.ball.front().where;
        const auto refuse = [&](const std::string& why) {
            top.fail(where, "balls {} and {} differ in size: {}", in_quotes(scene.ball.front().id),
                     in_quotes(ball.id), why);
        };
        if (rough && size.R != first.R && !model.free && !model.reads_tolerance)
            refuse(
                fmt::format("the model {} has no formula for friction between balls of different radius; use "
                            "physics.ball_ball = \"mathavan\" or set balls.mu_b = 0",
                            model.name));
        if (!model.reads_tolerance) continue;
        for (const BallStart& other : scene.ball) {
            const std::string why = sizes_refused(scene, scene.size_of(other), size);
            if (!why.empty())
                refuse(fmt::format("the model {} {}; use physics.ball_ball = \"two_step\"", model.name, why));
        }
    }
}

/// Refuses a scene in which an impact may have no solution in its model.
void check_cushion_model(const Section& top, const Scene& scene) {
    const BallParams& p = scene.balls;
    const auto check = [&](const CushionModelInfo& model, const char* kind, const std::string& id,
                           double height) {
        if (model.accepts == nullptr) return;
        for (const BallStart& ball : scene.ball) {
            const BallSize size = scene.size_of(ball);
            if (model.accepts({size.R, size.m, p.mu_s, p.e_c, p.cushion_friction().most(), height})) continue;
            top.fail(top.has("physics") ? "physics" : "balls",
                     "with f_c = {} and mu_s = {} a ball could jam under the nose of {} {} in the "
                     "model {}; lower one of them or use another cushion model",
                     p.cushion_friction().most(), p.mu_s, kind, id, model.name);
        }
    };
    for (const Cushion& c : scene.table.cushions) check(*scene.physics.cushion, "cushion", c.id, c.height);
    for (const Jaw& j : scene.table.jaws)
        check(*scene.physics.jaw_model(), j.is_arc() ? "arc" : "jaw", j.id, j.height);
}

/// Whether a ball of the scene may ever leave the cloth.
bool may_fly(const Scene& scene) {
    const bool impacts = scene.physics.ball_ball->free || scene.balls.e_h > 0.0;
    return scene.lifts() || (scene.physics.vertical == Vertical::kKeep && impacts);
}

/// Refuses settings without formulas for discs and pucks.
void check_discs(const Section& top, const Scene& scene) {
    const BallParams& p = scene.balls;
    const BallBallModelInfo& model = *scene.physics.ball_ball;
    if (p.discs() && !scene.of_one_radius() && (model.reads_tolerance || model.free))
        top.fail(top.where("balls", "shape"),
                 "discs of different size need a model without spins, not {}; set physics.ball_ball = "
                 "\"elastic\" or \"inelastic\"",
                 model.name);
    if (p.rolls()) return;
    const auto refuse = [&](const char* key, const char* what) {
        top.fail(top.has("balls", key) ? top.where("balls", key) : top.where("balls", "rolls"),
                 "balls.rolls = false makes pucks, {}", what);
    };
    if (model.reads_friction && p.ball_friction().any())
        refuse("mu_b", "whose impacts have no friction model; set balls.mu_b = 0");
    const auto rough = [&](const CushionModelInfo* cushion) {
        return cushion->reads_friction && p.cushion_friction().any();
    };
    if ((!scene.table.cushions.empty() && rough(scene.physics.cushion)) ||
        (!scene.table.jaws.empty() && rough(scene.physics.jaw_model())))
        refuse("f_c", "whose impacts on cushions have no friction model; set balls.f_c = 0");
    if (p.e_h > 0.0) refuse("e_h", "which do not hop; set balls.e_h = 0");
    if (scene.cue)
        top.fail("cue", "a cue cannot strike pucks (balls.rolls = false); give one a velocity instead");
}

/// Refuses arcs if a ball may fly.
void check_arcs(const Section& top, const Scene& scene) {
    const auto arc = std::find_if(scene.table.jaws.begin(), scene.table.jaws.end(),
                                  [](const Jaw& j) { return j.is_arc(); });
    if (arc == scene.table.jaws.end()) return;
    if (may_fly(scene))
        top.fail(
            top.has("table") ? "table" : "",
            "a ball of this scene may fly, and arc {} meets balls on the cloth only; set physics.vertical = "
            "\"drop\"",
            arc->id);
    for (const Jaw& j : scene.table.jaws)
        for (const BallStart& ball : scene.ball)
            if (const double R = scene.size_of(ball).R; j.around() && !(j.radius > R))
                top.fail(ball.where, "ball {} has a radius of {} m, and arc {} {} m; no ball fits inside",
                         in_quotes(ball.id), R, j.id, j.radius);
}

/// Refuses everything that a planar scene cannot represent.
void check_vertical(const Section& top, const Scene& scene) {
    if (scene.physics.vertical == Vertical::kKeep) return;
    for (const BallStart& ball : scene.ball)
        if (ball.flies())
            top.fail(ball.where,
                     "ball {} starts in the air, which physics.vertical = \"drop\" does not simulate; remove "
                     "one of "
                     "the two",
                     in_quotes(ball.id));
    if (scene.physics.ball_ball->free)
        top.fail(
            top.where("physics", "ball_ball"),
            "physics.ball_ball = \"{}\" lifts balls, which physics.vertical = \"drop\" does not simulate; "
            "remove one of the two",
            scene.physics.ball_ball->name);
    if (scene.table.bed)
        top.fail(top.where("table", "bed"),
                 "table.bed needs balls that fly, which physics.vertical = \"drop\" does not simulate; "
                 "remove one of the two");
}

/// Refuses a bed without area, and balls in the air outside it.
void check_bed(const Section& top, const Scene& scene) {
    if (!scene.table.bed) return;
    const Rectangle& bed = *scene.table.bed;
    if (!(bed[0] < bed[2]) || !(bed[1] < bed[3]))
        top.fail(
            top.where("table", "bed"),
            "table.bed = [{}, {}, {}, {}] encloses no area; give the corner of smallest x and y, then the "
            "opposite one",
            bed[0], bed[1], bed[2], bed[3]);
    for (const BallStart& ball : scene.ball) {
        if (!ball.flies() || is_inside(bed, planar(ball.position))) continue;
        top.fail(ball.where, "ball {} starts in the air outside table.bed; move it", in_quotes(ball.id));
    }
}

/// Refuses balls in the air behind the cushions of a preset table: they would land on its rail.
void check_rails(const Section& top, const Scene& scene) {
    const Table& table = scene.table;
    if (table.preset.empty() || table.bed) return;
    const Vec2 low = table.corner, high = low + Vec2(table.width, table.length);
    // A ball exactly above a nose is behind it if it moves there.
    const auto next = [](double x, double v) {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        return v == 0.0 ? x : std::nextafter(x, v > 0.0 ? kFar : -kFar);
    };
    for (const BallStart& ball : scene.ball) {
        const Vec2 p(next(ball.position.x(), ball.velocity.x()), next(ball.position.y(), ball.velocity.y()));
        if (!ball.flies() || is_inside(Rectangle(low.x(), low.y(), high.x(), high.y()), p)) continue;
        // Between two jaws there is cloth, at most R beyond the line of the noses, and then the pocket.
        const double R = scene.size_of(ball).R;
        const bool in_mouth = std::any_of(table.pockets.begin(), table.pockets.end(), [&](const Pocket& k) {
            return length(p - k.center) < k.radius + 2.0 * R;
        });
        if (in_mouth) continue;
        top.fail(ball.where, "ball {} starts in the air behind the cushions; move it", in_quotes(ball.id));
    }
}

/// Whether impacts with the table can cause vertical spin.
bool cushions_twist(const Scene& scene) {
    const auto twists = [&](const CushionModelInfo* model) {
        return model->reads_friction && scene.balls.cushion_friction().most() > 0.0;
    };
    return (!scene.table.cushions.empty() && twists(scene.physics.cushion)) ||
           (!scene.table.jaws.empty() && twists(scene.physics.jaw_model()));
}

struct Motions {
    bool travel = false;  ///< some ball can move over the cloth
    bool slip = false;    ///< some ball can slide on the cloth
    bool twist = false;   ///< some ball can have vertical spin
};

Motions possible_motions(const Scene& scene) {
    Motions m;
    const bool struck = scene.cue && scene.cue->speed > 0.0;
    m.travel = m.slip = struck || scene.lifts();
    m.twist = struck && scene.cue->side != 0.0;
    for (const BallStart& ball : scene.ball) {
        const double R = scene.size_of(ball).R;
        const double vx = ball.velocity.x(), vy = ball.velocity.y(), wx = ball.spin.x(), wy = ball.spin.y();
        m.travel = m.travel || vx != 0.0 || vy != 0.0 || wx != 0.0 || wy != 0.0;
        const double slip = Vec2(vx - R * wy, vy + R * wx).norm();
        const double scale = ball.velocity.norm() + R * ball.spin.norm();
        m.slip = m.slip || slip > kRollingUlp * 0x1p-52 * scale;
        m.twist = m.twist || ball.spin.z() != 0.0;
    }
    if (!m.travel) return m;
    // An impact can turn rolling into sliding and, with friction, cause vertical spin.
    const bool cushions = !scene.table.cushions.empty() || !scene.table.jaws.empty();
    const bool pairs = scene.ball.size() > 1;
    m.slip = m.slip || cushions || pairs;
    m.twist = m.twist || (pairs && scene.balls.ball_friction().any()) || cushions_twist(scene);
    return m;
}

void check_rest(const Section& top, const Scene& scene) {
    if (scene.stop.time || scene.stop.events) return;
    const Motions m = possible_motions(scene);
    const auto refuse = [&](const char* section, const char* cause, const char* result) {
        top.fail(section,
                 "with {} = 0 {} for ever and the run cannot end at rest; add [stop] with time or events",
                 cause, result);
    };
    if (scene.physics.gravity == 0.0 && (m.travel || m.twist))
        refuse("physics", "physics.gravity", "balls move");
    if (scene.balls.e_t + scene.balls.e_t_more >= 1.0 && may_fly(scene))
        top.fail(top.has("balls", "e_t_fit") ? top.where("balls", "e_t_fit") : top.where("balls", "e_t"),
                 "with balls.e_t = 1 balls bounce for ever and the run cannot end at rest; lower it, or add "
                 "[stop] "
                 "with time or events");
    if (scene.balls.mu_s == 0.0 && m.slip) refuse("balls", "balls.mu_s", "balls slide");
    if (scene.balls.mu_r == 0.0 && m.travel && scene.balls.rolls())
        refuse("balls", "balls.mu_r", "balls roll");
    if (scene.balls.mu_sp == 0.0 && m.twist) refuse("balls", "balls.mu_sp", "balls spin");
}

void check_numbers(const Section& top, const Scene& scene, Change change) {
    check_cloth(top, scene);
    check_vertical(top, scene);
    check_bed(top, scene);
    check_rails(top, scene);
    check_noses(top, scene);
    check_sizes(top, scene);
    check_cushion_model(top, scene);
    check_discs(top, scene);
    check_arcs(top, scene);
    if (change != Change::kNumbers) {
        check_overlaps(top, scene);
        check_reach(top, scene);
    }
    check_rest(top, scene);
}

}  // namespace

void check_scene(const Section& top, const Scene& scene) {
    if (scene.ball.empty()) top.fail(SourceLocation{}, "there is no ball; add a [[ball]] or a [rack]");
    check_ids(top, scene);
    check_numbers(top, scene, Change::kAnything);
}

void check_again(const Section& top, const Scene& scene, Change change) {
    check_kernel(top, scene);
    if (scene.cue) check_cue(top, scene, *scene.cue);
    if (change >= Change::kTable)
        for (const Cushion& cushion : scene.table.cushions) check_cushion(top, cushion);
    if (change >= Change::kTable)
        for (const Jaw& jaw : scene.table.jaws) check_jaw(Section(scene.file, "table.arc"), jaw);
    check_numbers(top, scene, change);
}

}  // namespace carom::detail
