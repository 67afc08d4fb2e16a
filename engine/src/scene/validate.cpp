// Validates scenes built in code: every rule of the reader, in the same order, on the struct itself.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/tolerances.h"
#include "scene/sections.h"

namespace carom {
namespace {

using detail::in_quotes;
using detail::Section;

/// Refuses a ball whose centre does not match its height, which no file can express.
void check_heights(const Section& top, const Scene& scene) {
    for (const BallStart& ball : scene.ball) {
        const double R = scene.size_of(ball).R;
        if (ball.position.z() == R + ball.height) continue;
        top.fail(SourceLocation{},
                 "ball {} has its centre at z = {} m, its radius is {} m and its height above the cloth {} "
                 "m; set z to the sum of the two",
                 in_quotes(ball.id), ball.position.z(), R, ball.height);
    }
}

/// Refuses missing models, which no file can omit.
void check_models(const Section& top, const Physics& physics) {
    for (const auto& [key, there] : {std::pair{"ball_ball", physics.ball_ball != nullptr},
                                     std::pair{"cushion", physics.cushion != nullptr}})
        if (!there) top.fail(SourceLocation{}, "physics.{} is not a model; choose one", key);
}

template <class Part, std::size_t kRows>
void check_parts(const Scene& scene, const char* path, const Field<Part> (&fields)[kRows],
                 const std::vector<Part>& parts) {
    const Section section(scene.file, path);
    if (parts.size() > kMaxTableParts)
        section.fail(SourceLocation{}, "{} has {} entries; at most {} are allowed", path, parts.size(),
                     kMaxTableParts);
    for (const Part& part : parts) {
        section.check(fields, part);
        if constexpr (std::is_same_v<Part, Cushion>) check_cushion(section, part);
        if constexpr (std::is_same_v<Part, Jaw>) check_jaw(section, part);
    }
}

void check_table(const Scene& scene) {
    Table named;
    named.cloth = scene.table.cloth;
    named.bed = scene.table.bed;
    named.preset = scene.table.preset.empty() ? kStandardTable : scene.table.preset;
    const Section table(scene.file, "table");
    table.check(kTableFields, named);
    table.check(kMeasureFields, scene.table.measures);
    for (const PocketSection& of : kPocketSections)
        Section(scene.file, of.path).check(kPocketMeasureFields, scene.table.measures.*of.pockets);
    check_measures(table, scene);
    check_parts(scene, "table.cushion", kCushionFields, scene.table.cushions);
    check_parts(scene, "table.jaw", kJawFields, scene.table.jaws);
    check_parts(scene, "table.pocket", kPocketFields, scene.table.pockets);
}

void check_balls(const Scene& scene) {
    const Section section(scene.file, "ball");
    std::size_t count = 0;
    for (const BallStart& ball : scene.ball) {
        if (count++ == kMaxBalls)
            section.fail(SourceLocation{}, "more than {} balls; leave some out", kMaxBalls);
        if (ball.own) section.check(kSizeFields, *ball.own);
        section.check(kBallStartFields, ball);
        check_id(section, ball.id);
    }
}

void check_effects(const Scene& scene) {
    const Section section(scene.file, "effects");
    const std::span<const EffectInfo> known = effect_table();
    for (auto effect = scene.effects.begin(); effect != scene.effects.end(); ++effect) {
        if (std::none_of(known.begin(), known.end(),
                         [&](const EffectInfo& info) { return effect->keyword == info.keyword; })) {
            std::vector<std::string_view> keywords;
            for (const EffectInfo& info : known) keywords.emplace_back(info.keyword);
            throw detail::UnknownKey(scene.file, {}, effect->keyword, "effects", keywords);
        }
        if (std::any_of(scene.effects.begin(), effect,
                        [&](const EffectOverride& other) { return other.keyword == effect->keyword; }))
            section.fail(SourceLocation{}, "effects.{} appears twice; keep one of the two", effect->keyword);
    }
}

void check_all(const Scene& scene) {
    const Section top(scene.file, "");
    const Section balls(scene.file, "balls");
    balls.check(kBallPresetFields, scene);
    balls.check(kBallFields, scene.balls);
    if (scene.cue_ball) Section(scene.file, "balls.cue").check(kSizeFields, *scene.cue_ball);
    check_fits(balls, scene.balls);
    check_models(top, scene.physics);
    Section(scene.file, "physics").check(kPhysicsFields, scene.physics);
    check_kernel(top, scene);
    check_table(scene);
    check_balls(scene);
    check_heights(top, scene);
    if (scene.cue) {
        const Section cue(scene.file, "cue");
        cue.check(kCueFields, *scene.cue);
        check_cue(cue, scene, *scene.cue);
    }
    check_effects(scene);
    Section(scene.file, "stop").check(kStopFields, scene.stop);
    const Section render(scene.file, "render");
    render.check(kRenderFields, scene.render);
    check_camera(render, scene.render);
    check_scene(top, scene);
}

// Drops the location, which belongs to a file that may have changed since.
[[noreturn]] void throw_without_place(const Scene& scene, const SceneError& error) {
    throw SceneError(scene.file, {}, error.message());
}

}  // namespace

void validate(const Scene& scene) {
    try {
        check_all(scene);
    } catch (const SceneError& error) {
        throw_without_place(scene, error);
    }
}

void validate_change(const Scene& scene, Change change) {
    if (change == Change::kAnything) return validate(scene);
    try {
        check_again(Section(scene.file, ""), scene, change);
    } catch (const SceneError& error) {
        throw_without_place(scene, error);
    }
}

}  // namespace carom
