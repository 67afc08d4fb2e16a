// From a scene back to a scene file, and the check of scenes that were built in code.
#include <fmt/format.h>

#include <iterator>
#include <stdexcept>
#include <string>

#include "carom/engine/scene.h"

namespace carom {
namespace {

using Out = std::back_insert_iterator<fmt::memory_buffer>;

/// A TOML string.
std::string quote(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + '"';
}

std::string point(const Vec2& p) {
    return fmt::format("[{}, {}]", p.x(), p.y());
}

std::string point(const Vec3& p) {
    return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z());
}

bool same_parts(const Table& a, const Table& b) {
    if (a.cushions.size() != b.cushions.size() || a.jaws.size() != b.jaws.size() ||
        a.pockets.size() != b.pockets.size())
        return false;
    for (std::size_t i = 0; i < a.cushions.size(); ++i) {
        const Cushion &x = a.cushions[i], &y = b.cushions[i];
        if (x.from != y.from || x.to != y.to || x.height != y.height) return false;
    }
    for (std::size_t i = 0; i < a.jaws.size(); ++i) {
        const Jaw &x = a.jaws[i], &y = b.jaws[i];
        if (x.center != y.center || x.radius != y.radius || x.height != y.height) return false;
    }
    for (std::size_t i = 0; i < a.pockets.size(); ++i) {
        const Pocket &x = a.pockets[i], &y = b.pockets[i];
        if (x.center != y.center || x.radius != y.radius) return false;
    }
    return true;
}

/// Whether the table is still that of its preset.
bool is_preset(const Table& table) {
    if (table.preset.empty()) return false;
    try {
        return same_parts(table, make_table(table.preset));
    } catch (const std::invalid_argument&) {
        return true;  // the reader will say what is wrong with the name
    }
}

void write_table(Out out, const Table& table) {
    fmt::format_to(out, "[table]\n");
    if (is_preset(table)) {
        fmt::format_to(out, "preset = {}\n", quote(table.preset));
        return;
    }
    if (table.cushions.empty()) fmt::format_to(out, "cushion = []\n");
    for (const Cushion& c : table.cushions)
        fmt::format_to(out, "[[table.cushion]]\nfrom = {}\nto = {}\nheight = {}\n", point(c.from),
                       point(c.to), c.height);
    for (const Jaw& j : table.jaws)
        fmt::format_to(out, "[[table.jaw]]\ncenter = {}\nradius = {}\nheight = {}\n", point(j.center),
                       j.radius, j.height);
    for (const Pocket& p : table.pockets)
        fmt::format_to(out, "[[table.pocket]]\ncenter = {}\nradius = {}\n", point(p.center), p.radius);
}

void write_balls(Out out, const Scene& scene) {
    const BallParams& p = scene.balls;
    fmt::format_to(
        out,
        "[balls]\npreset = {}\nradius = {}\nmass = {}\nmu_s = {}\nmu_r = {}\nmu_sp = {}\ne_b = {}\n"
        "e_c = {}\nf_c = {}\n",
        quote(scene.ball_preset), p.R, p.m, p.mu_s, p.mu_r, p.mu_sp, p.e_b, p.e_c, p.f_c);
    if (p.mu_b_more != 0.0 || p.mu_b_fall != 0.0)
        fmt::format_to(out, "mu_b_fit = [{}, {}, {}]\n", p.mu_b, p.mu_b_more, p.mu_b_fall);
    else
        fmt::format_to(out, "mu_b = {}\n", p.mu_b);
    for (const BallStart& ball : scene.ball) {
        fmt::format_to(out, "[[ball]]\nid = {}\nposition = {}\nvelocity = {}\nspin = {}\n", quote(ball.id),
                       point(Vec2(ball.position.head<2>())), point(Vec2(ball.velocity.head<2>())),
                       point(ball.spin));
        if (ball.own) fmt::format_to(out, "radius = {}\nmass = {}\n", ball.own->R, ball.own->m);
    }
}

void write_cue(Out out, const Cue& cue) {
    fmt::format_to(
        out,
        "[cue]\nball = {}\nspeed = {}\naim_deg = {}\nelevation_deg = {}\noffset = [{}, {}]\nmass = {}\n"
        "end_mass = {}\n",
        quote(cue.ball), cue.speed, cue.aim_deg, cue.elevation_deg, cue.side, cue.height, cue.mass,
        cue.end_mass);
}

void write_physics(Out out, const Physics& p) {
    fmt::format_to(out, "[physics]\ngravity = {}\nball_ball = \"{}\"\ncushion = \"{}\"\n", p.gravity,
                   name(p.ball_ball), name(p.cushion));
    if (p.jaw) fmt::format_to(out, "jaw = \"{}\"\n", name(*p.jaw));
    fmt::format_to(out, "cloth_slip = \"{}\"\nclusters = \"{}\"\n", name(p.cloth_slip), name(p.clusters));
    if (p.substeps)
        fmt::format_to(out, "substeps = {}\n", *p.substeps);
    else
        fmt::format_to(out, "tolerance = {}\n", p.tolerance);
}

void write_render(Out out, const RenderSettings& r) {
    fmt::format_to(out, "[render]\nfps = {}\nsize = [{}, {}]\n", r.fps, r.width, r.height);
    if (r.eye) fmt::format_to(out, "eye = {}\n", point(*r.eye));
    if (r.target) fmt::format_to(out, "target = {}\n", point(*r.target));
    if (!r.eye && !r.target) fmt::format_to(out, "camera = {}\n", quote(r.camera));
}

/// What no file can say: a ball that is not on the cloth.
void check_heights(const Scene& scene) {
    for (const BallStart& ball : scene.ball) {
        if (ball.position.z() == scene.size_of(ball).R && ball.velocity.z() == 0.0) continue;
        throw SceneError(
            scene.file, {},
            fmt::format("ball {} has its centre at z = {} m and rises at {} m/s; balls roll on the "
                        "cloth: z has to be the radius, {} m, and the speed 0",
                        quote(ball.id), ball.position.z(), ball.velocity.z(), scene.size_of(ball).R));
    }
}

}  // namespace

std::string scene_text(const Scene& scene) {
    fmt::memory_buffer buffer;
    const Out out(buffer);
    write_table(out, scene.table);
    write_balls(out, scene);
    if (scene.cue) write_cue(out, *scene.cue);
    write_physics(out, scene.physics);
    if (!scene.effects.empty()) fmt::format_to(out, "[effects]\n");
    for (const EffectOverride& effect : scene.effects)
        fmt::format_to(out, "{} = {}\n", effect.keyword, effect.in_force);
    if (scene.stop.time || scene.stop.events) fmt::format_to(out, "[stop]\n");
    if (scene.stop.time) fmt::format_to(out, "time = {}\n", *scene.stop.time);
    if (scene.stop.events) fmt::format_to(out, "events = {}\n", *scene.stop.events);
    write_render(out, scene.render);
    return fmt::to_string(buffer);
}

void validate(const Scene& scene) {
    check_heights(scene);
    try {
        parse_scene(scene_text(scene), scene.file);
    } catch (const SceneError& error) {
        // The lines are those of a text that nobody wrote.
        throw SceneError(scene.file, {}, error.message());
    }
}

}  // namespace carom
