// carom check: validates a scene and prints its plan.
#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <string>
#include <string_view>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/ball_ball.h"

namespace carom::tools {
namespace {

struct CheckArgs {
    std::string scene;
};

template <class List>
std::string ids(const List& list) {
    std::string text;
    for (const auto& item : list) text += (text.empty() ? "" : " ") + item.id;
    return text.empty() ? "none" : text;
}

std::string kernel_line(const Plan& plan) {
    const Physics& physics = plan.scene.physics;
    if (!physics.ball_ball->reads_tolerance) return "closed form";
    if (physics.substeps)
        return fmt::format("published march, {} substeps, {}; cloth slip {}", *physics.substeps,
                           physics.march == March::kPublished ? "step by step" : "summed",
                           carom::name(physics.cloth_slip));
    return fmt::format("by tolerance {}: closed forms, else collocation; cloth slip {}", physics.tolerance,
                       carom::name(physics.cloth_slip));
}

/// The instruction set of each kernel in the plan.
std::string isa_line(const Plan& plan) {
    const auto with = [&plan](std::string_view text) {
        return fmt::format("{} (available: {})", text, kernel::available_isas());
    };
    if (plan.isa != kernel::Isa::kFastest) return with(kernel::name(plan.isa));
    const kernel::KernelKind impact = plan.impact.march == nullptr ? kernel::KernelKind::kTolerance
                                      : plan.scene.physics.march == March::kPublished
                                          ? kernel::KernelKind::kMarch
                                          : kernel::KernelKind::kSummedMarch;
    const char* known = kernel::measured_processor();
    return with(fmt::format("impacts {}, clusters {}: {}", kernel::name(kernel::fastest_isa(impact)),
                            kernel::name(kernel::fastest_isa(kernel::KernelKind::kContactPhase)),
                            known != nullptr ? fmt::format("measured on {}", known)
                                             : "the widest; this processor was not measured"));
}

/// Measures of a table: its spots, and, of a preset, its noses and pockets.
std::string measures_lines(const carom::Table& table, double R) {
    constexpr double kMillimetres = 1000.0, kInches = 1.0 / 0.0254;
    std::string text;
    if (table.length > 0.0) {
        const Vec2 foot = foot_spot(table);
        text += fmt::format("          head spot [{:.6g}, {:.6g}], foot spot [{:.6g}, {:.6g}] m\n", foot.x(),
                            table.corner.y() + table.length / 4.0, foot.x(), foot.y());
    }
    if (table.preset.empty()) return text;
    const Measures all = measures_of(table.preset, table.measures);
    text += fmt::format("          noses {:.4g} mm high\n", *all.cushion_height * kMillimetres);
    for (const PocketSection& of : kPocketSections) {
        const PocketMeasures& p = all.*of.pockets;
        if (!p.mouth) continue;
        text += fmt::format(
            "          {}: mouth {:.4g} mm, throat {:.4g} mm, facings at {:.4g} degrees, shelf {:.3g} mm, "
            "points "
            "rounded by {:.4g} mm\n"
            "            for players: mouth {:.4g} in, {:.3g} in more than the throat, shelf {:.3g} in; "
            "cut-off "
            "angle {:.3g} degrees\n",
            of.key, *p.mouth * kMillimetres, *p.throat * kMillimetres, *p.angle_deg, *p.shelf * kMillimetres,
            *p.jaw_radius * kMillimetres, *p.mouth * kInches, (*p.mouth - *p.throat) * kInches,
            *p.shelf * kInches, cut_off_deg(*p.mouth, R));
    }
    return text;
}

std::string stop_line(const Stop& stop) {
    std::string text = "at rest";
    if (stop.time) text += fmt::format(", or after {} s", *stop.time);
    if (stop.events)
        text += fmt::format(", or after {}", counted(static_cast<std::size_t>(*stop.events), "event"));
    return text;
}

std::string report(const Plan& plan) {
    const Scene& scene = plan.scene;
    const carom::Table& table = scene.table;
    const BallParams& p = plan.balls;
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line, "scene     {}: valid\n", scene.file);
    fmt::format_to(line, "table     {}, {} x {} m{}\n", table.preset.empty() ? "custom" : table.preset,
                   table.width, table.length, table.cloth ? ", cloth " + *table.cloth : "");
    fmt::format_to(line, "{}", measures_lines(table, p.R));
    fmt::format_to(line, "balls     {}: {}\n", scene.ball.size(), ids(scene.ball));
    fmt::format_to(
        line,
        "          {}: R {} m, mass {} kg, mu_s {}, mu_r {}, mu_sp {}, mu_b {}, e_b {}, e_c {}, f_c {}\n",
        scene.ball_preset, p.R, p.m, p.mu_s, p.mu_r, p.mu_sp, scene.balls.mu_b, p.e_b, p.e_c, p.f_c);
    if (scene.balls.mu_b_more > 0.0)
        fmt::format_to(line, "          mu_b at slip u: {} + {} exp(-{} u)\n", scene.balls.mu_b,
                       scene.balls.mu_b_more, scene.balls.mu_b_fall);
    for (const BallStart& ball : scene.ball) {
        if (ball.own)
            fmt::format_to(line, "          ball {} differs: R {} m, mass {} kg\n", ball.id, ball.own->R,
                           ball.own->m);
    }
    if (scene.cue) {
        const Cue& cue = *scene.cue;
        fmt::format_to(line,
                       "cue       ball {}, {} m/s, aim {} deg, elevation {} deg, offset [{}, {}]\n"
                       "          {}: mass {} kg, end mass {} kg, restitution {}\n",
                       cue.ball, cue.speed, cue.aim_deg, cue.elevation_deg, cue.side, cue.height, cue.preset,
                       cue.mass, cue.end_mass, cue.restitution);
    }
    fmt::format_to(line, "models    ball-ball {}, cushion {}, jaws {}, clusters {}, gravity {} m/s^2\n",
                   name(scene.physics.ball_ball), name(scene.physics.cushion),
                   name(scene.physics.jaw_model()), name(scene.physics.clusters), plan.gravity);
    fmt::format_to(line, "kernel    {}\n", kernel_line(plan));
    fmt::format_to(line, "isa       {}\n", isa_line(plan));
    fmt::format_to(line, "search    balls {}, table {}{}\n", name(plan.ball_search), name(plan.table_search),
                   plan.box_travel < std::numeric_limits<double>::infinity()
                       ? fmt::format("; boxes start at {} ball radii", plan.box_travel)
                       : "; boxes reach to a ball's next own event");
    fmt::format_to(line, "stop      {}\n", stop_line(scene.stop));
    fmt::format_to(line, "render    {} fps, {}x{}, camera {}\n", scene.render.fps, scene.render.width,
                   scene.render.height, scene.render.camera);
    fmt::format_to(line, "\neffects\n");
    for (const EffectDecision& effect : plan.effects) {
        fmt::format_to(line, "  {:<17} {:<9} {}\n", effect.keyword, effect.in_force ? "in force" : "skipped",
                       effect.reason);
    }
    fmt::format_to(line, "\ncushions  {}\njaws      {}\npockets   {}\n", ids(table.cushions), ids(table.jaws),
                   ids(table.pockets));
    return fmt::to_string(out);
}

int run(const CheckArgs& args) {
    print(report(plan_scene(args.scene)));
    return kOk;
}

}  // namespace

void add_check(Options& program) {
    auto [command, args] = program.command<CheckArgs>(
        "check", "Check a scene and print its plan: effects, models, kernels, names", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
}

}  // namespace carom::tools
