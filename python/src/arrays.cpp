// Array arithmetic that numpy lacks, that it does with different bits on different machines, or that needs
// many calls, longer than a shot.
#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "carom/games/aim.h"
#include "carom/kernel/splitmix64.h"
#include "native.h"

namespace carom::python {
namespace {

/// Clamps to [-1, 1]; NaN stays NaN.
template <class T>
T within_one(T value) {
    return value < T(-1) ? T(-1) : value > T(1) ? T(1) : value;
}

/// From the first end at -1 to the second at 1, exact to the bit at both.
double between(const std::pair<double, double>& ends, double part) {
    const double far = 0.5 * (part + 1.0);
    return ends.first * (1.0 - far) + ends.second * far;
}

/// Turns actions into strikes, as Strikes in carom.gym describes. numpy's arctan2 has other bits on other
/// processors.
/// @param actions n x 5, or n x 6 with the elevation @param along n x 2 directions, or empty: the first two
/// numbers of the actions
/// @param offset the largest [ball radii] @param out n x 5
void strikes(std::size_t shots, const Flat<const double>& actions, const Flat<const double>& along,
             const std::pair<double, double>& speed, const std::pair<double, double>& elevation,
             double offset, const Flat<double>& out) {
    if (shots == 0) return;
    const std::size_t size = actions.size() / shots;
    if (size * shots != actions.size() || size < 5 || out.size() != 5 * shots ||
        (along.size() != 0 && along.size() != 2 * shots))
        throw nb::value_error("expected arrays with the same number of shots");
    for (std::size_t shot = 0; shot < shots; ++shot) {
        const double* const action = actions.data() + size * shot;
        const auto number = [action](std::size_t k) { return within_one(action[k]); };
        const double* const ahead = along.size() > 0 ? along.data() + 2 * shot : nullptr;
        double* const cue = out.data() + 5 * shot;
        cue[0] = between(speed, number(2));
        cue[1] =
            games::direction_deg(ahead != nullptr ? Vec2(ahead[0], ahead[1]) : Vec2(number(0), number(1)));
        cue[2] = size > 5 ? between(elevation, number(5)) : elevation.first;
        // Maps the square to the disc: continuous, one to one, and unchanged near the centre.
        const double side = number(3), height = number(4);
        cue[3] = offset * side * std::sqrt(1.0 - 0.5 * height * height);
        cue[4] = offset * height * std::sqrt(1.0 - 0.5 * side * side);
    }
}

/// Positions of balls are drawn from low + room * [0, 1)^2, outside every disc, and this far apart.
struct Room {
    Flat<const double> low, room;  ///< [m] 2 each
    Flat<const double> discs;      ///< m x 3: centre [m] and square of the radius
    double apart2;                 ///< [m^2]

    bool takes(const double* places, std::size_t ball) const {
        const double x = places[2 * ball], y = places[2 * ball + 1];
        for (std::size_t i = 0; i + 2 < discs.size(); i += 3) {
            const double dx = x - discs.data()[i], dy = y - discs.data()[i + 1];
            if (!(dx * dx + dy * dy > discs.data()[i + 2])) return false;
        }
        for (std::size_t other = 0; other < ball; ++other) {
            const double dx = x - places[2 * other], dy = y - places[2 * other + 1];
            if (!(dx * dx + dy * dy > apart2)) return false;
        }
        return true;
    }
};

/// Draws positions of balls for every row until they fit, all of them each time: `out` is n x balls x 2. Each
/// row has its own generator, SplitMix64, which advances: the draws of a table do not depend on the others.
/// @return whether every row found positions within this number of tries
bool random_places(const Flat<std::uint64_t>& states, const Flat<const double>& low,
                   const Flat<const double>& room, const Flat<const double>& discs, double apart2, int tries,
                   const Flat<double>& out) {
    const std::size_t rows = states.size();
    if (rows == 0) return true;
    const std::size_t balls = out.size() / (2 * rows);
    if (balls * 2 * rows != out.size() || low.size() != 2 || room.size() != 2)
        throw nb::value_error("expected the same number of places in every row");
    const Room where = {low, room, discs, apart2};
    bool all = true;
    for (std::size_t row = 0; row < rows; ++row) {
        SplitMix64 random(states.data()[row]);
        double* const places = out.data() + row * balls * 2;
        bool fits = false;
        for (int round = 0; round < tries && !fits; ++round) {
            for (std::size_t i = 0; i < 2 * balls; ++i)
                places[i] = low.data()[i % 2] + room.data()[i % 2] * random.uniform();
            fits = true;
            for (std::size_t ball = 0; ball < balls && fits; ++ball) fits = where.takes(places, ball);
        }
        states.data()[row] = random.state();
        all = all && fits;
    }
    return all;
}

/// Observations of n tables: x and y from -1 to 1 across the table, and 1; three zeros for a missing ball
/// (NaN).
/// @param balls n x a x 2 [m] @param marks n x b x 2 [m] @param middle, half of the table, 2 each [m]
/// @param out n x (a + b) x 3
void observe(std::size_t tables, const Flat<const double>& balls, const Flat<const double>& marks,
             const Flat<const double>& middle, const Flat<const double>& half, const Flat<float>& out) {
    if (tables == 0) return;
    const std::size_t a = balls.size() / (2 * tables), b = marks.size() / (2 * tables);
    if (2 * a * tables != balls.size() || 2 * b * tables != marks.size() || middle.size() != 2 ||
        half.size() != 2 || out.size() != 3 * (a + b) * tables)
        throw nb::value_error("expected arrays with the same number of tables");
    float* to = out.data();
    const auto put = [&](const double* place) {
        const bool there = !std::isnan(place[0]);
        for (int axis = 0; axis < 2; ++axis)
            *to++ =
                there
                    ? within_one(static_cast<float>((place[axis] - middle.data()[axis]) / half.data()[axis]))
                    : 0.0F;
        *to++ = there ? 1.0F : 0.0F;
    };
    for (std::size_t table = 0; table < tables; ++table) {
        for (std::size_t i = 0; i < a; ++i) put(balls.data() + 2 * (table * a + i));
        for (std::size_t i = 0; i < b; ++i) put(marks.data() + 2 * (table * b + i));
    }
}

}  // namespace

void add_arrays(nb::module_& m) {
    m.def("random_places", random_places, nb::arg("states").noconvert(), nb::arg("low").noconvert(),
          nb::arg("room").noconvert(), nb::arg("discs").noconvert(), nb::arg("apart2"), nb::arg("tries"),
          nb::arg("out").noconvert());
    m.def("observe", observe, nb::arg("tables"), nb::arg("balls").noconvert(), nb::arg("marks").noconvert(),
          nb::arg("middle").noconvert(), nb::arg("half").noconvert(), nb::arg("out").noconvert());
    m.def("strikes", strikes, nb::arg("shots"), nb::arg("actions").noconvert(), nb::arg("along").noconvert(),
          nb::arg("speed"), nb::arg("elevation"), nb::arg("offset"), nb::arg("out").noconvert());
}

}  // namespace carom::python
