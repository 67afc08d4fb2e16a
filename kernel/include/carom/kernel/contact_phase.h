// The contact phase of many equal balls: Hertz contacts with friction, whose normals turn as the balls move,
// in units of the approach speed V and of L = (V^2 m / k)^0.4 (docs/reference/physics.md, several contacts at
// once).
#pragma once

#include <cstddef>
#include <cstdint>

#include "carom/kernel/isa.h"

namespace carom::kernel {

struct HertzContact {
    int i, j;        ///< balls
    double nx, ny;   ///< unit normal from i to j
    double overlap;  ///< [L] at the start; negative: a gap
    /// Fraction of the balls' turning that the normal follows. With 0 the normal stays as at the touch,
    /// computed as if the earlier contacts took no time.
    double turn = 1.0;
};

/// F = d^1.5 while a contact is loaded for the first time, and d^1.5 (a + b (d / d_m)^p) below its largest
/// overlap d_m. Friction acts along the slip s, with |s| regularised to sqrt(s^2 + epsilon^2). Each contact
/// always has the friction of its current slip, mu_b + mu_b_more exp(-mu_b_fall |s|).
struct HertzLaw {
    double a, b;
    int p;  ///< a power of 2
    double mu_b, mu_s;
    double epsilon;            ///< [V] > 0
    bool published_slip_sign;  ///< of the cloth slip
    double mu_b_more = 0.0;    ///< 0: mu_b at every slip
    double mu_b_fall = 0.0;    ///< [1/V]
    /// [V^2/L] Deceleration of a ball that slips on the cloth under its weight. It is small, so it is applied
    /// only every few steps, after each flight and at the end.
    double slide = 0.0;
};

/// Input and output of one call. `numbers` and `places` are scratch memory of contact_phase_numbers() and
/// contact_phase_places() elements.
struct ContactPhase {
    int balls, contacts;
    double* motion;  ///< per ball v_x, v_y, R w_x, R w_y, R w_z [V]; replaced
    const HertzContact* contact;
    double* numbers;
    int* places;
    double curvature = 0.0;   ///< L/(2 R); 0: balls so large that the normals do not turn
    double* moved = nullptr;  ///< receives the displacement of each ball, x and y [L], unless null
    double* time = nullptr;   ///< receives the duration [L/V], unless null
};

constexpr std::size_t contact_phase_numbers(int balls, int contacts) noexcept {
    return 52 * (static_cast<std::size_t>(balls) + 4) + 20 * (static_cast<std::size_t>(contacts) + 8);
}
constexpr std::size_t contact_phase_places(int balls, int contacts) noexcept {
    return 2 * (static_cast<std::size_t>(balls) + 8) + 6 * (static_cast<std::size_t>(contacts) + 8);
}

/// Runge-Kutta steps until every contact is open and none would close again within look_ahead [L/V]. A step
/// is at most `longest_step` [L/V], or longer if all contacts are slow. Without friction the method is the
/// classical one. With friction it has order 3 and four, six or eight stages, is stable although friction is
/// stiff, and controls the step length by the error. Between two steps the cloth reacts to the load on the
/// balls. During a step normals turn at the speed of its start; after it they are set by the mean of both
/// ends. Stages skip contacts that cannot close within the step. While all contacts are open the balls fly
/// without steps. A contact that closes late in look_ahead turns less while it is closed, and at the end of
/// look_ahead not at all. A ball's contacts are summed in the given order.
/// @return the number of steps, or -1 if the contacts did not separate within time_limit [L/V]
using ContactPhaseFunction = std::int64_t (*)(const ContactPhase& phase, const HertzLaw& law,
                                              double longest_step, double look_ahead,
                                              double time_limit) noexcept;

/// The integration built for one instruction set (which must be available). All give the same bits.
ContactPhaseFunction contact_phase_function(Isa isa) noexcept;

struct HertzContactInSpace {
    int i, j;        ///< balls
    double n[3];     ///< unit normal from i to j
    double overlap;  ///< [L] at the start; negative: a gap
};

/// Properties of unlike balls, in units of one of them: its mass and the stiffness of two such balls are 1.
struct UnlikeBalls {
    const double* inverse_mass;  ///< per ball
    const double* stiffness;     ///< per contact
    /// Per contact [1/L]: 1 over the distance of the centres at the touch, times the fraction of the balls'
    /// turning that the normal follows; 0: fixed.
    const double* curvature;
    bool held;  ///< all balls stay on the cloth, and feel its friction
};

/// As ContactPhase, for balls that differ in size or of which at least one is in the air.
struct ContactPhaseInSpace {
    int balls, contacts;
    double* motion;  ///< per ball v (3 numbers), R w (3) [V]; replaced
    const HertzContactInSpace* contact;
    double* numbers;                      ///< scratch memory of contact_phase_in_space_numbers() elements
    double curvature;                     ///< L/(2 R); 0: fixed normals
    const UnlikeBalls* unlike = nullptr;  ///< null: all are alike, and not held
    double* moved = nullptr;              ///< as in ContactPhase
    double* time = nullptr;               ///< as in ContactPhase
};

constexpr std::size_t contact_phase_in_space_numbers(int balls, int contacts) noexcept {
    return 56 * static_cast<std::size_t>(balls) + 6 * static_cast<std::size_t>(contacts);
}

/// The same forces in space, without a cloth unless the balls are held: `law.mu_s`, `law.slide` and the sign
/// of the slip are ignored, because the contacts last a tenth as long as the impact with the cloth, which
/// comes next. The positions of the balls are integrated too, and determine every normal. Steps, flights and
/// the end are as in ContactPhaseFunction.
/// @return the number of steps, or -1 if the contacts did not separate within time_limit [L/V]
std::int64_t contact_phase_in_space(const ContactPhaseInSpace& phase, const HertzLaw& law,
                                    double longest_step, double look_ahead, double time_limit) noexcept;

}  // namespace carom::kernel
