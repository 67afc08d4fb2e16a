// Derivatives of shots, and fits.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/derivatives.h"
#include "carom/engine/plan.h"
#include "carom/games/fit.h"
#include "native.h"
#include "values.h"

namespace carom::python {
namespace {

/// unlocked(), for derivatives. @throws nb::value_error if there is none
template <class Work>
auto differentiated(Work&& work) {
    try {
        return unlocked(work);
    } catch (const DerivativeError& error) {
        throw nb::value_error(error.what());
    }
}

/// Position, velocity and spin of every ball at every time, each by every input.
void jacobian(const NativeRecord& r, const NativeScene* other, const std::vector<std::string>& inputs,
              const Flat<const double>& times, const Flat<double>& out) {
    const Scene& scene = scene_of(r, other);
    const kernel::Isa isa = chosen_isa();
    double* at = out.data();
    differentiated([&] {
        const Derivatives by(make_plan(scene, isa), *r.record, inputs,
                             {times.data(), times.data() + times.size()});
        by.check();
        for (std::size_t k = 0; k < times.size(); ++k)
            for (int ball = 0; ball < static_cast<int>(r.record->tracks.size()); ++ball) {
                for (std::size_t i = 0; i < inputs.size(); ++i) {
                    const StateDerivative slope = by.state(k, ball, i);
                    std::size_t row = 0;
                    for (const Vec3& vector : {slope.position, slope.velocity, slope.spin})
                        for (const double x : vector) at[row++ * inputs.size() + i] = x;
                }
                at += 9 * inputs.size();
            }
    });
}

/// The result, and its scene.
std::pair<nb::any, NativeScene> fit(const NativeScene& scene, const Flat<const double>& times,
                                    const Flat<const std::int32_t>& balls, const Flat<const double>& places,
                                    const std::vector<std::string>& vary, int most_shots) {
    std::vector<games::TrackPoint> points;
    for (std::size_t i = 0; i < times.size(); ++i)
        points.push_back(
            {times.data()[i], balls.data()[i], {places.data()[2 * i], places.data()[2 * i + 1]}});
    const kernel::Isa isa = chosen_isa();
    const games::Fit found = differentiated([&] {
        return games::fit(*scene.scene, points, {vary, most_shots}, isa);
    });
    return {given(found), with_cue("", found.scene)};
}

}  // namespace

void add_derivatives(nb::module_& m) {
    m.def("jacobian", jacobian, nb::arg("record"), nb::arg("scene").none(), nb::arg("inputs"),
          nb::arg("times"), nb::arg("out").noconvert());
    m.def("fit", fit, nb::arg("scene"), nb::arg("times"), nb::arg("balls"), nb::arg("places"),
          nb::arg("vary"), nb::arg("most_shots"));
}

}  // namespace carom::python
