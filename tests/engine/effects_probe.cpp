// The cost of each effect, and of profiling: a bare scene, and the same with one thing added. For
// lab/measure/effects_cost and the callgrind test.
//
//   effects_probe list names of the cases, with the effect's own functions and how the case differs
//   effects_probe run CASE N N runs of one case; prints the events of one run
//   effects_probe time CASE nanoseconds per event, the smallest of many runs
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"

namespace {

using namespace carom;

void add(Scene& scene, const char* id, double x, double y, double vx, double vy) {
    BallStart ball;
    ball.id = id;
    ball.position = Vec3(x, y, scene.balls.R);
    ball.velocity = Vec3(vx, vy, 0.0);
    ball.spin = Vec3(-vy / scene.balls.R, vx / scene.balls.R, 0.0);
    scene.ball.push_back(ball);
}

// Two balls that roll without resistance, with elastic impacts and reflecting cushions: straight lines only.
Scene bare() {
    Scene scene;
    scene.file = "(probe)";
    scene.balls = make_ball_params("pool_classic");
    scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = scene.balls.mu_b = scene.balls.f_c = 0.0;
    scene.balls.e_b = scene.balls.e_c = 1.0;
    scene.physics.ball_ball = ball_ball_model("elastic");
    scene.physics.cushion = &kSmooth;
    scene.physics.clusters = ClusterModel::kSequential;
    const double w = 0.5, l = 0.7, h = 0.036576;
    scene.table.width = w;
    scene.table.length = l;
    scene.table.cushions = {{"c1", {0, 0}, {0, l}, h},
                            {"c2", {0, l}, {w, l}, h},
                            {"c3", {w, l}, {w, 0}, h},
                            {"c4", {w, 0}, {0, 0}, h}};
    scene.stop.events = 400;
    add(scene, "a", 0.12, 0.15, 1.3, 0.9);
    add(scene, "b", 0.35, 0.5, -0.7, 1.1);
    return scene;
}

struct Case {
    const char* name;       // of the effect
    const char* functions;  // its functions, as callgrind names them; separated by spaces
    const char* what;       // for the table
    void (*add)(Scene&);
    bool profile = false;
};

const Case kCases[] = {
    {"bare", "", "two rolling balls, elastic, reflecting cushions", [](Scene&) {}},
    {"sliding", "carom::effects::sliding_friction", "mu_s = 0.2", [](Scene& s) { s.balls.mu_s = 0.2; }},
    {"rolling", "carom::effects::rolling_resistance", "mu_r = 1e-4", [](Scene& s) { s.balls.mu_r = 1e-4; }},
    {"spin_decay", "carom::effects::spin_decay", "w_z = 30 rad/s, mu_sp = 1e-4",
     [](Scene& s) {
         s.balls.mu_sp = 1e-4;
         for (BallStart& b : s.ball) b.spin.z() = 30.0;
     }},
    {"throw", "carom::effects::pair_friction", "model inelastic, mu_b = 0.05",
     [](Scene& s) {
         s.physics.ball_ball = ball_ball_model("inelastic");
         s.balls.mu_b = 0.05;
     }},
    {"throw:mathavan", "", "model mathavan, mu_b = 0.05, no friction on the cloth",
     [](Scene& s) {
         s.physics.ball_ball = &kMathavan;
         s.balls.mu_b = 0.05;
     }},
    {"cloth_in_impact", "carom::kernel::scalar::tolerance_single",
     "the same with mu_s = 0.2, and gravity 0: the cloth acts in impacts only",
     [](Scene& s) {
         s.physics.ball_ball = &kMathavan;
         s.physics.gravity = 0.0;
         s.balls.mu_b = 0.05;
         s.balls.mu_s = 0.2;
     }},
    {"cushion_friction", "carom::detail::cushion_han_2005", "han_2005, f_c = 0.2",
     [](Scene& s) {
         s.physics.cushion = &kHan2005;
         s.balls.f_c = 0.2;
     }},
    {"cushion_friction:stronge", "carom::detail::cushion_stronge", "stronge, f_c = 0.2",
     [](Scene& s) {
         s.physics.cushion = cushion_model("stronge");
         s.balls.f_c = 0.2;
     }},
    {"cushion_friction:mathavan_2010", "carom::detail::cushion_mathavan_2010", "mathavan_2010, f_c = 0.2",
     [](Scene& s) {
         s.physics.cushion = cushion_model("mathavan_2010");
         s.balls.f_c = 0.2;
         s.balls.e_c = 0.95;
     }},
    {"pockets", "carom::time_to_pocket carom::pocketed_segment",
     "six pockets at the rails that no centre enters",
     [](Scene& s) {
         for (const double y : {0.0, 0.35, 0.7})
             for (const double x : {0.0, 0.5}) s.table.pockets.push_back({"p", Vec2(x, y), 0.025, 0.08});
     }},
    {"clusters", "carom::Clusters::collect carom::ClusterMap::compliant", "a third ball at rest",
     [](Scene& s) {
         s.physics.clusters = ClusterModel::kCompliant;
         add(s, "c", 0.25, 0.33, 0.0, 0.0);
     }},
    {"contact_time", "carom::effects::contact_turn", "clusters = \"compliant\"",
     [](Scene& s) { s.physics.clusters = ClusterModel::kCompliant; }},
    {"clusters:none", "", "the third ball alone, pair by pair",
     [](Scene& s) {
         s.physics.clusters = ClusterModel::kSequential;
         add(s, "c", 0.25, 0.33, 0.0, 0.0);
     }},
    {"cushions:none", "", "no cushions: the two go their ways",
     [](Scene& s) {
         s.table = {};
         s.stop.events.reset();
         s.stop.time = 1.0;
     }},
    {"cushions", "carom::time_to_line carom::detail::cushion_smooth",
     "the reflecting cushions of the bare scene", [](Scene&) {}},
    {"squirt", "carom::effects::squirt", "the cue strikes 0.3 R off centre",
     [](Scene& s) {
         s.ball[0].velocity.setZero();
         s.ball[0].spin.setZero();
         Cue cue;
         cue.ball = "a";
         cue.speed = 1.0;
         cue.side = 0.3;
         cue.height = 0.0;
         s.cue = cue;
     }},
    {"airborne", "carom::airborne_segment carom::hit_cloth carom::flight_to_line",
     "a ball is thrown up at 1 m/s",
     [](Scene& s) {
         s.ball[0].velocity.z() = 1.0;
         s.balls.e_t = 0.9;
     }},
    {"profile", "std::chrono::_V2::steady_clock::now", "every event timed", [](Scene&) {}, true},
};

const Case& find(const std::string& name) {
    for (const Case& c : kCases)
        if (name == c.name) return c;
    std::fprintf(stderr, "no case %s\n", name.c_str());
    std::exit(2);
}

Plan plan(const Case& c) {
    Scene scene = bare();
    c.add(scene);
    return make_plan(scene, kernel::Isa::kScalar);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "";
    if (mode == "list") {
        for (const Case& c : kCases) std::printf("%s|%s|%s\n", c.name, c.functions, c.what);
        return 0;
    }
    if (argc < 3) return 2;
    const Case& c = find(argv[2]);
    const Plan p = plan(c);
    SimulateOptions options;
    options.profile = c.profile;
    if (mode == "run") {
        std::size_t events = 0;
        for (int n = argc > 3 ? std::atoi(argv[3]) : 1; n > 0; --n)
            events = simulate(p, options).events.size();
        std::printf("%zu\n", events);
        return 0;
    }
    double best = 1e300;
    std::size_t events = 1;
    for (int n = 0; n < 300; ++n) {
        const auto start = std::chrono::steady_clock::now();
        events = simulate(p, options).events.size();
        const double ns =
            std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
        if (ns < best) best = ns;
    }
    std::printf("%.1f\n", best / static_cast<double>(events ? events : 1));
    return 0;
}
