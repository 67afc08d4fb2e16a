// Games: noise.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Adds the errors of a shot to the five numbers of its strike.
void add_noise_to(double* numbers, const Five& sd, std::uint64_t seed, std::uint64_t index) {
    Cue cue;
    for (std::size_t k = 0; k < kOfACue; ++k) cue.*kCueNumbers[k] = numbers[k];
    cue = games::with_noise(cue, {sd[0], sd[1], sd[2], sd[3], sd[4]}, seed, index);
    for (std::size_t k = 0; k < kOfACue; ++k) numbers[k] = cue.*kCueNumbers[k];
}

/// Adds the errors of shots first, first + 1, ... to strikes, in place.
void add_noise(const Flat<double>& cues, const Five& sd, std::uint64_t seed, std::uint64_t first) {
    for (std::size_t i = 0; i < cues.size() / kOfACue; ++i)
        add_noise_to(cues.data() + i * kOfACue, sd, seed, first + i);
}

/// The same for strikes with a seed and an index each. A strike with a number that is not finite stays as it
/// is.
void add_noise_each(const Flat<double>& cues, const Five& sd, const Flat<const std::uint64_t>& seeds,
                    const Flat<const std::int64_t>& indices) {
    if (cues.size() != kOfACue * seeds.size() || seeds.size() != indices.size())
        throw nb::value_error("expected a seed and an index for every strike");
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        double* numbers = cues.data() + i * kOfACue;
        if (!std::all_of(numbers, numbers + kOfACue, [](double number) { return std::isfinite(number); }))
            continue;
        add_noise_to(numbers, sd, seeds.data()[i], static_cast<std::uint64_t>(indices.data()[i]));
    }
}

}  // namespace

void add_games(nb::module_& m) {
    m.def("standard_strike", standard_strike);
    m.def("noise_by_name", noise_by_name);
    m.def("add_noise", add_noise, nb::arg("cues").noconvert(), nb::arg("sd"), nb::arg("seed"),
          nb::arg("first"));
    m.def("add_noise_each", add_noise_each, nb::arg("cues").noconvert(), nb::arg("sd"),
          nb::arg("seeds").noconvert(), nb::arg("indices").noconvert());
}

}  // namespace carom::python
