// Games: noise.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "carom/games/noise.h"
#include "native.h"

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

Five noise_by_name(const std::string& name, double radius) {
    const games::Noise sd = games::noise_by_name(name, radius);
    return {sd.speed, sd.aim_deg, sd.elevation_deg, sd.side, sd.height};
}

/// Adds the errors of shots first, first + 1, ... to strikes, in place.
void add_noise(const Flat<double>& cues, const Five& sd, std::uint64_t seed, std::uint64_t first) {
    double* at = cues.data();
    for (std::uint64_t i = 0; i < cues.size() / kOfACue; ++i, at += kOfACue) {
        Cue cue;
        for (std::size_t k = 0; k < kOfACue; ++k) cue.*kCueNumbers[k] = at[k];
        cue = games::with_noise(cue, {sd[0], sd[1], sd[2], sd[3], sd[4]}, seed, first + i);
        for (std::size_t k = 0; k < kOfACue; ++k) at[k] = cue.*kCueNumbers[k];
    }
}

}  // namespace

void add_games(nb::module_& m) {
    m.def("standard_strike", standard_strike);
    m.def("noise_by_name", noise_by_name);
    m.def("add_noise", add_noise, nb::arg("cues").noconvert(), nb::arg("sd"), nb::arg("seed"),
          nb::arg("first"));
}

}  // namespace carom::python
