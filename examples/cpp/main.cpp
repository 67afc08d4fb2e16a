// A cut shot built in code, without a scene file: simulates it and prints its events.
#include <cstdio>
#include <exception>
#include <string>

#include "carom/engine/simulate.h"

namespace {

carom::BallStart ball_at(const std::string& id, double x, double y, double radius) {
    carom::BallStart ball;
    ball.id = id;
    ball.position = {x, y, radius};  // m; the centre is one radius above the cloth
    return ball;
}

carom::Scene cut_shot() {
    carom::Scene scene;
    scene.file = "cut shot";  // the name in messages
    scene.table = carom::make_table("nine_foot");
    carom::use_balls(scene, "pool");  // and the model of their cushions
    scene.ball = {ball_at("cue", 0.635, 0.60, scene.balls.R), ball_at("1", 0.65, 1.40, scene.balls.R)};
    carom::Cue cue;
    cue.ball = "cue";
    cue.speed = 3.0;  // m/s
    cue.aim_deg = 90.0;
    cue.side = 0.1;    // ball radii, left
    cue.height = 0.0;  // not above the centre, as it would be by default
    scene.cue = cue;
    return scene;
}

}  // namespace

int main() {
    try {
        const carom::Scene scene = cut_shot();
        carom::validate(scene);  // what a scene file is checked for
        const carom::Plan plan = carom::make_plan(scene, carom::kernel::best_isa());
        const carom::Record record = carom::simulate(plan);
        for (const carom::Event& event : record.events)
            std::printf("%9.6f s  %-14s %s %s\n", event.time, carom::name(event.type),
                        record.tracks[event.a].id.c_str(), record.partner_id(event).c_str());
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const carom::BallState end = record.state_at(static_cast<int>(i), record.duration);
            std::printf("%s ends at (%.4f, %.4f) m, %s\n", record.tracks[i].id.c_str(), end.position.x(),
                        end.position.y(), carom::name(end.state));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
