// Arithmetic on arrays that numpy has no function for, or none with the same bits on every machine.
#include <cstddef>
#include <cstdint>

#include "base/splitmix64.h"
#include "carom/games/aim.h"
#include "native.h"

namespace carom::python {
namespace {

/// Draws as many numbers for every row as `out` has room for, uniform in [0, 1), and moves the generators on.
/// @param states  (n) of each row's generator
/// @param out     (n x k), row after row
void uniforms(const Flat<std::uint64_t>& states, const Flat<double>& out) {
    const std::size_t rows = states.size();
    if (rows == 0) return;
    const std::size_t draws = out.size() / rows;
    if (draws * rows != out.size()) throw nb::value_error("expected as many numbers in every row");
    double* next = out.data();
    for (std::size_t row = 0; row < rows; ++row) {
        SplitMix64 random(states.data()[row]);
        for (std::size_t draw = 0; draw < draws; ++draw) *next++ = random.uniform();
        states.data()[row] = random.state();
    }
}

/// Angles of directions from +x towards +y [degrees], from -180 to 180; 0 for no direction, NaN where a number is none.
void directions_deg(const Flat<const double>& x, const Flat<const double>& y, const Flat<double>& out) {
    if (x.size() != y.size() || x.size() != out.size()) throw nb::value_error("expected arrays of one size");
    for (std::size_t i = 0; i < out.size(); ++i) {
        out.data()[i] = games::direction_deg({x.data()[i], y.data()[i]});
    }
}

}  // namespace

void add_arrays(nb::module_& m) {
    m.def("uniforms", uniforms, nb::arg("states").noconvert(), nb::arg("out").noconvert());
    m.def("directions_deg", directions_deg, nb::arg("x").noconvert(), nb::arg("y").noconvert(),
          nb::arg("out").noconvert());
}

}  // namespace carom::python
