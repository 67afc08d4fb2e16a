// Rules about the values of one section, beyond the range of a single key.
#include <fmt/format.h>

#include <string>
#include <utility>

#include "carom/engine/ball_ball.h"
#include "carom/engine/printable.h"
#include "carom/engine/strike.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/tolerance.h"
#include "scene/sections.h"

namespace carom::detail {

void check_id(const Section& section, const std::string& id) {
    if (id.empty()) section.fail("id", "a ball's id is empty; give it a name");
    if (id.size() > kMaxIdLength)
        section.fail("id", "the ball id {} is longer than {} bytes; shorten it", in_quotes(id), kMaxIdLength);
    if (!is_utf8(id)) section.fail("id", "the ball id {} is not UTF-8; convert it", in_quotes(id));
    if (!is_plain(id) || id.find_first_of(",;\"") != id.npos)
        section.fail(
            "id", "the ball id {} contains a comma, a semicolon, a quote or a control character; remove it",
            in_quotes(id));
    // Spreadsheets read these as formulas, and a shell reads the last one as an option.
    if (id.find_first_of("=+@-") == 0)
        section.fail("id", "the ball id {} begins with {}; begin it with a letter or a digit", in_quotes(id),
                     in_quotes(id.substr(0, 1)));
    const bool numbered = id.size() > 1 && id.find_first_not_of("0123456789", 1) == id.npos;
    if (numbered && (id[0] == 'c' || id[0] == 'j' || id[0] == 'p'))
        section.fail("id", "the ball id {} is the name of a cushion, a jaw or a pocket; choose another",
                     in_quotes(id));
}

void check_fits(const Section& section, const BallParams& balls) {
    if (balls.e_c > 1.0)
        section.fail("e_c_fit", "balls.e_c_fit starts at a restitution of {}; use 0 to 1", balls.e_c);
}

void check_cushion(const Section& section, const Cushion& cushion) {
    if (cushion.from == cushion.to)
        section.fail("to",
                     "a cushion ends where it begins; move one end, or use a "
                     "[[table.jaw]] of radius 0 for a post");
}

void check_cue(const Section& section, const Scene& scene, const Cue& cue) {
    const Vec2 offset(cue.side, cue.height);
    if (offset.squaredNorm() > kMiscueOffset * kMiscueOffset) {
        section.fail(
            "offset",
            "cue.offset is {:.4g} ball radii from the centre, where the tip slips off; keep it within {}",
            offset.norm(), kMiscueOffset);
    }
    if (cue.end_mass > cue.mass) {
        section.fail("end_mass",
                     "cue.end_mass = {} is more than the whole cue, cue.mass = {}; make it smaller",
                     cue.end_mass, cue.mass);
    }
    const BallStart* struck = nullptr;
    for (const BallStart& ball : scene.ball) {
        if (ball.id == cue.ball) struck = &ball;
    }
    if (!struck) {
        section.fail("ball", "cue.ball: there is no ball {}; add a [[ball]] with this id or name another",
                     in_quotes(cue.ball));
    }
    if (!struck->velocity.isZero(0.0) || !struck->spin.isZero(0.0)) {
        section.fail(
            struck->where,
            "ball {} has a velocity or spin of its own and is struck by the cue; remove one of the two",
            in_quotes(struck->id));
    }
}

void check_kernel(const Section& top, const Scene& scene) {
    if (scene.physics.march == March::kPublished && !scene.physics.substeps)
        top.fail(top.where("physics", "march"),
                 "physics.march = \"published\" needs physics.substeps; set physics.substeps = 1000, or "
                 "leave march out");
    const BallParams& p = scene.balls;
    for (const auto& [key, value] :
         {std::pair{"mu_s", p.mu_s},
          std::pair{p.mu_b_more > 0.0 ? "mu_b_fit" : "mu_b", p.mu_b + p.mu_b_more}}) {
        if (value > kernel::kLargestFriction && scene.physics.ball_ball->reads_tolerance &&
            !scene.physics.substeps)
            top.fail(
                top.where("balls", key),
                "balls.{} = {}: an impact solved to a tolerance accepts friction up to {}; lower it, or set "
                "physics.substeps = 1000",
                key, value, kernel::kLargestFriction);
    }
}

void check_camera(const Section& section, const RenderSettings& r) {
    if (r.eye.has_value() != r.target.has_value())
        section.fail(r.eye ? "eye" : "target",
                     "render.eye and render.target go together; give both or neither");
    if (r.eye && section.has("camera"))
        section.fail("camera", "render.camera and render.eye exclude each other; remove one of the two");
    if (r.eye && *r.eye == *r.target)
        section.fail("target", "render.target and render.eye are the same point; move one of them");
    if (r.cloth && !color_of(*r.cloth))
        section.fail("cloth",
                     "render.cloth is not a colour: {}; write six hexadecimal digits, as in \"#1d6a54\"",
                     in_quotes(*r.cloth));
}

}  // namespace carom::detail
