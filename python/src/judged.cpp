// Shots of one player's game, played and judged by its rules, for environments of more than one shot.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "batches.h"
#include "carom/games/judge_many.h"
#include "native.h"

namespace carom::python {
namespace {

/// Plays and judges n shots without the GIL: simulate_many with arrays of n and of n x balls (x and y
/// alternate), as in games::JudgedArrays.
std::vector<Failure> judge_many(const NativeScene& native, const std::string& name, std::size_t shots,
                                const std::vector<Column>& columns, const Flat<const std::uint8_t>& absent,
                                std::optional<std::int64_t> max_events, int threads, const ShotArrays& out,
                                const Flat<double>& xy, const Flat<std::int32_t>& group,
                                const Flat<std::int32_t>& foul, const Flat<std::int32_t>& points,
                                const Flat<std::uint8_t>& goes_on) {
    for (const std::size_t size : {group.size(), foul.size(), points.size(), goes_on.size(),
                                   xy.size() / (2 * native.scene->ball.size())})
        if (size != shots) throw nb::value_error("expected arrays with the same number of shots");
    const games::Game game = games::game_named(name);
    const games::JudgedArrays judged = {xy.data(), group.data(), foul.data(), points.data(), goes_on.data()};
    return played_columns(native, columns, absent, std::nullopt, max_events, threads, out,
                          [&](const Scene& scene, std::span<const BatchColumn> list, kernel::Isa isa,
                              const BatchOptions& options, const BatchArrays& into) {
                              return games::judge_many(game, scene, shots, list, isa, options, into, judged);
                          });
}

/// Which balls may be hit first: out is n x balls, 0 everywhere if no ball is left to play at.
void legal_many(const NativeScene& native, const std::string& game, const Flat<const double>& xy,
                const Flat<const std::int32_t>& group, const Flat<std::uint8_t>& out) {
    const std::vector<BallStart>& balls = native.scene->ball;
    const games::Game of = games::game_named(game);
    if (xy.size() != 2 * out.size() || out.size() != group.size() * balls.size())
        throw nb::value_error("expected arrays with the same number of tables");
    std::fill_n(out.data(), out.size(), std::uint8_t{0});
    std::vector<std::string> ids;
    for (std::size_t row = 0; row < group.size(); ++row) {
        const std::size_t at = row * balls.size();
        ids.clear();
        for (std::size_t i = 0; i < balls.size(); ++i)
            if (!std::isnan(xy.data()[2 * (at + i)])) ids.push_back(balls[i].id);
        std::vector<std::string> first;
        try {
            const auto own = static_cast<games::Group>(group.data()[row]);
            first = games::legal(games::state_of_turn(of, own), ids).first;
        } catch (const std::invalid_argument&) {
            continue;
        }
        for (std::size_t i = 0; i < balls.size(); ++i)
            out.data()[at + i] = std::find(first.begin(), first.end(), balls[i].id) != first.end();
    }
}

}  // namespace

void add_judged(nb::module_& m) {
    m.def("judge_many", judge_many, nb::arg("scene"), nb::arg("game"), nb::arg("shots"), nb::arg("columns"),
          nb::arg("absent"), nb::arg("max_events").none(), nb::arg("threads"), nb::arg("out").noconvert(),
          nb::arg("xy").noconvert(), nb::arg("group").noconvert(), nb::arg("foul").noconvert(),
          nb::arg("points").noconvert(), nb::arg("goes_on").noconvert());
    m.def("legal_many", legal_many, nb::arg("scene"), nb::arg("game"), nb::arg("xy").noconvert(),
          nb::arg("group").noconvert(), nb::arg("out").noconvert());
    m.def("foul_names", names_in_files<games::Foul>);
}

}  // namespace carom::python
