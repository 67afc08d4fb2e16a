// The C interface: aiming aids.
#include "carom/games/aim.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "cue.h"
#include "guard.h"
#include "handles.h"
#include "text.h"

using namespace carom::c;

namespace {

namespace games = carom::games;

const carom::BallStart& ball_of(const carom::Scene& scene, const std::string& id) {
    if (const int ball = index_of(scene.ball, id); ball >= 0) return scene.ball[ball];
    throw BadArgument("the scene has no ball \"" + id + "\"");
}

carom_aim aim_of(const games::Aim& aim) {
    carom_aim out{};
    out.found = aim.cue ? 1 : 0;
    if (aim.cue)
        for (const auto& [theirs, ours] : kCueNumbers) out.cue.*theirs = *aim.cue.*ours;
    out.geometric_deg = aim.geometric_deg;
    out.cut_deg = aim.cut_deg;
    put_text(out.cushion, aim.cushion);
    put_text(out.why, aim.why);
    return out;
}

}  // namespace

carom_status carom_pocket_lines(const carom_scene* scene, const char* ball, const char* cue_ball,
                                carom_pocket_line* lines) {
    return guarded([&] {
        need({scene, ball, cue_ball, lines});
        const carom::Scene& s = scene->scene;
        const carom::BallStart& object = ball_of(s, ball);
        const double both = s.size_of(object).R + s.size_of(ball_of(s, cue_ball)).R;
        for (const games::PocketLine& line : asked([&] { return games::pocket_lines(s, ball, cue_ball); })) {
            const carom::Vec2 ghost = games::ghost_ball(carom::planar(object.position), line.towards, both);
            *lines = {{line.towards.x(), line.towards.y()},
                      {ghost.x(), ghost.y()},
                      line.width_deg,
                      line.distance,
                      {}};
            put_text(lines++->in_the_way, line.in_the_way);
        }
    });
}

carom_status carom_aim_pot(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                           const char* ball, const char* pocket, carom_aim* aim) {
    return guarded([&] {
        need({scene, cue_ball, how, ball, pocket, aim});
        *aim =
            aim_of(asked([&] { return games::aim_pot(scene->scene, cue_of(cue_ball, *how), ball, pocket); }));
    });
}

carom_status carom_bank_routes(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                               const char* ball, const char* pocket, size_t size, carom_aim* aims,
                               size_t* count) {
    return guarded([&] {
        need({scene, cue_ball, how, ball, pocket, count});
        if (size > 0) need({aims});
        const std::vector<games::Aim> found =
            asked([&] { return games::bank_routes(scene->scene, cue_of(cue_ball, *how), ball, pocket); });
        *count = found.size();
        for (size_t i = 0; i < std::min(size, found.size()); ++i) aims[i] = aim_of(found[i]);
    });
}
