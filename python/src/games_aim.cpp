// Games: aim help.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "carom/games/aim.h"
#include "native.h"

namespace carom::python {
namespace {

/// In the order of carom.games.PocketLine and carom.games.Aim.
using LineRow = std::tuple<std::string, std::pair<double, double>, double, double, std::string>;
using AimRow = std::tuple<std::optional<double>, double, double, std::string, int, std::string>;

std::vector<LineRow> pocket_lines(const NativeScene& scene, const std::string& ball,
                                  const std::string& cue_ball) {
    std::vector<LineRow> rows;
    for (const games::PocketLine& line : games::pocket_lines(*scene.scene, ball, cue_ball))
        rows.push_back({scene.scene->table.pockets[static_cast<std::size_t>(line.pocket)].id,
                        {line.towards.x(), line.towards.y()},
                        line.width_deg,
                        line.distance,
                        line.in_the_way});
    return rows;
}

AimRow row_of(const games::Aim& aim) {
    return {aim.cue ? std::optional(aim.cue->aim_deg) : std::nullopt,
            aim.geometric_deg,
            aim.cut_deg,
            aim.cushion,
            aim.shots,
            aim.why};
}

/// The scene's strike, whose aim is ignored. @throws nb::value_error if there is none
const Cue& cue_of(const NativeScene& scene) {
    if (!scene.scene->cue) throw nb::value_error("the scene has no cue; give the strike");
    return *scene.scene->cue;
}

AimRow aim_pot(const NativeScene& scene, const std::string& ball, const std::string& pocket) {
    const Cue& cue = cue_of(scene);
    const nb::gil_scoped_release no_gil;
    return row_of(games::aim_pot(*scene.scene, cue, ball, pocket));
}

std::vector<AimRow> bank_routes(const NativeScene& scene, const std::string& ball,
                                const std::string& pocket) {
    const Cue& cue = cue_of(scene);
    const nb::gil_scoped_release no_gil;
    std::vector<AimRow> rows;
    for (const games::Aim& aim : games::bank_routes(*scene.scene, cue, ball, pocket))
        rows.push_back(row_of(aim));
    return rows;
}

}  // namespace

void add_games_aim(nb::module_& m) {
    m.def("pocket_lines", pocket_lines);
    m.def("aim_pot", aim_pot);
    m.def("bank_routes", bank_routes);
    m.def("ghost_ball", [](std::pair<double, double> object, std::pair<double, double> towards, double both) {
        const Vec2 ghost =
            games::ghost_ball({object.first, object.second}, {towards.first, towards.second}, both);
        return std::pair(ghost.x(), ghost.y());
    });
    m.def("cut_angle_deg", [](std::pair<double, double> cue, std::pair<double, double> ghost,
                              std::pair<double, double> towards) {
        return games::cut_angle_deg({cue.first, cue.second}, {ghost.first, ghost.second},
                                    {towards.first, towards.second});
    });
}

}  // namespace carom::python
