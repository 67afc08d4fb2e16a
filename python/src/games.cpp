// Games: noise, and aim help.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/games/aim.h"
#include "carom/games/noise.h"
#include "native.h"
#include "values.h"

namespace carom::python {
namespace {

/// The numbers of a strike in the order of Python's arrays.
constexpr double Cue::*kCueNumbers[] = {&Cue::speed, &Cue::aim_deg, &Cue::elevation_deg, &Cue::side,
                                        &Cue::height};
constexpr std::size_t kOfACue = std::size(kCueNumbers);
using Five = std::array<double, kOfACue>;

Five standard_strike() {
    Five numbers{};
    const Cue cue;
    for (std::size_t k = 0; k < kOfACue; ++k) numbers[k] = cue.*kCueNumbers[k];
    return numbers;
}

/// Adds the errors of a shot to the five numbers of its strike.
void add_noise_to(double* numbers, const games::Noise& sd, std::uint64_t seed, std::uint64_t index) {
    Cue cue;
    for (std::size_t k = 0; k < kOfACue; ++k) cue.*kCueNumbers[k] = numbers[k];
    cue = games::with_noise(cue, sd, seed, index);
    for (std::size_t k = 0; k < kOfACue; ++k) numbers[k] = cue.*kCueNumbers[k];
}

/// Adds the errors of shots first, first + 1, ... to strikes, in place.
void add_noise(const Flat<double>& cues, nb::handle noise, std::uint64_t seed, std::uint64_t first) {
    const games::Noise sd = taken<games::Noise>(noise, "noise");
    for (std::size_t i = 0; i < cues.size() / kOfACue; ++i)
        add_noise_to(cues.data() + i * kOfACue, sd, seed, first + i);
}

/// As above for strikes with a seed and an index each. A strike with a number that is not finite is
/// unchanged.
void add_noise_each(const Flat<double>& cues, nb::handle noise, const Flat<const std::uint64_t>& seeds,
                    const Flat<const std::int64_t>& indices) {
    if (cues.size() != kOfACue * seeds.size() || seeds.size() != indices.size())
        throw nb::value_error("expected a seed and an index for every strike");
    const games::Noise sd = taken<games::Noise>(noise, "noise");
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        double* numbers = cues.data() + i * kOfACue;
        if (!std::all_of(numbers, numbers + kOfACue, [](double number) { return std::isfinite(number); }))
            continue;
        add_noise_to(numbers, sd, seeds.data()[i], static_cast<std::uint64_t>(indices.data()[i]));
    }
}

/// The scene's strike, whose aim is ignored. @throws nb::value_error if there is none
const Cue& cue_of(const NativeScene& scene) {
    if (!scene.scene->cue) throw nb::value_error("the scene has no cue; give the strike");
    return *scene.scene->cue;
}

}  // namespace

void add_games(nb::module_& m) {
    m.def("standard_strike", standard_strike);
    m.def("noise_by_name",
          [](const std::string& name, double radius) { return given(games::noise_by_name(name, radius)); });
    m.def("add_noise", add_noise, nb::arg("cues").noconvert(), nb::arg("sd"), nb::arg("seed"),
          nb::arg("first"));
    m.def("add_noise_each", add_noise_each, nb::arg("cues").noconvert(), nb::arg("sd"),
          nb::arg("seeds").noconvert(), nb::arg("indices").noconvert());
    m.def("pocket_lines", [](const NativeScene& scene, const std::string& ball, const std::string& cue_ball) {
        return given(games::pocket_lines(*scene.scene, ball, cue_ball));
    });
    m.def("aim_pot", [](const NativeScene& scene, const std::string& ball, const std::string& pocket) {
        return given(unlocked([&] { return games::aim_pot(*scene.scene, cue_of(scene), ball, pocket); }));
    });
    m.def("bank_routes", [](const NativeScene& scene, const std::string& ball, const std::string& pocket) {
        return given(unlocked([&] { return games::bank_routes(*scene.scene, cue_of(scene), ball, pocket); }));
    });
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
