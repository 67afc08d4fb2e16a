// Arithmetic on arrays that numpy has no function for, or none with the same bits on every machine.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "base/splitmix64.h"
#include "carom/engine/math.h"
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

/// Of the cosine and the sine the smaller one says the angle: there the arc cosine is as exact as its argument.
double direction_deg(double x, double y) {
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0.0)) return length;
    // Below 1e-154 squares lose digits, and a quotient may pass 1.
    const double cosine = std::clamp(x / length, -1.0, 1.0), sine = std::clamp(y / length, -1.0, 1.0);
    if (std::abs(x) <= std::abs(y)) return std::copysign(arc_cos(cosine) * kDegrees, y);
    const double off = 90.0 - arc_cos(sine) * kDegrees;
    return x > 0.0 ? off : std::copysign(180.0, y) - off;
}

/// Angles of directions from +x towards +y [degrees], from -180 to 180; 0 for no direction, NaN where a number is none.
void directions_deg(const Flat<const double>& x, const Flat<const double>& y, const Flat<double>& out) {
    if (x.size() != y.size() || x.size() != out.size()) throw nb::value_error("expected arrays of one size");
    for (std::size_t i = 0; i < out.size(); ++i) {
        out.data()[i] = direction_deg(x.data()[i], y.data()[i]);
    }
}

}  // namespace

void add_arrays(nb::module_& m) {
    m.def("uniforms", uniforms, nb::arg("states").noconvert(), nb::arg("out").noconvert());
    m.def("directions_deg", directions_deg, nb::arg("x").noconvert(), nb::arg("y").noconvert(),
          nb::arg("out").noconvert());
}

}  // namespace carom::python
