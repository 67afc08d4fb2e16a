// The contact phase of a cluster: Hertz contacts with friction between balls that move, in units of a speed V
// and of L = (V^2 m / k)^0.4 (docs/reference/physics.md, several contacts at once).
#pragma once

#include <cstddef>
#include <cstdint>

#include "carom/kernel/isa.h"

namespace carom::kernel {

struct HertzContact {
    int i, j;        ///< balls
    double n[3];     ///< unit normal from i to j at the start
    double overlap;  ///< [L] at the start; negative: a gap
    double touch;    ///< [L] distance of the centres at which the balls touch
    double stiffness = 1.0;
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
    /// [V^2/L] Deceleration of a ball that slips on the cloth under its weight.
    double slide = 0.0;
    /// Of free balls that lie or fly (ContactPhase::lies): gravity [V^2/L], and the largest v_z^2 + 2 gravity
    /// height [V^2] with which a ball does not leave the cloth.
    double gravity = 0.0, hop = 0.0;
};

/// The course of one contact.
struct HertzHistory {
    double first;  ///< [L/V] when the balls touched for the first time; negative: never
    double
        impulse;  ///< [m V] along the normal, positive if they pushed each other; of order 4, as the method
};

/// Cushions, and the cloth under free balls. They react ten times as slowly as contacts between balls, so
/// they act only on a ball that touches no other one. A state is the place relative to the start (3 numbers)
/// [L], v (3) and R w (3) [V].
struct ContactSurfaces {
    void* owner;
    /// @return [L/V] time until the ball hits one; 0: it does so now; infinite: never
    double (*next)(void* owner, int ball, const double* state) noexcept;
    /// Replaces v and R w by those after the hit. @param time  [L/V]
    void (*hit)(void* owner, int ball, double time, double* state) noexcept;
    /// @return [L/V] time until a ball that has been pushed into one is out of it again; 0: it is out
    double (*out)(void* owner, int ball, const double* state) noexcept;
};

inline constexpr std::int64_t kMostEvaluations = 10'000'000;

/// Input and output of one call. `numbers` and `places` are scratch memory of contact_phase_numbers() and
/// contact_phase_places() elements.
struct ContactPhase {
    int balls, contacts;
    double* motion;  ///< per ball v (3 numbers), R w (3) [V]; replaced
    const HertzContact* contact;
    double* numbers;
    int* places;
    /// All balls stay on the cloth, which exerts friction; false: all are free, and the cloth is a surface.
    bool held = true;
    const ContactSurfaces* surfaces = nullptr;
    const double* lies =
        nullptr;  ///< per free ball: z relative to the start at which it lies on the cloth [L]
    const double* inverse_mass = nullptr;  ///< per ball; null: all have the mass 1
    double* moved = nullptr;               ///< receives the displacement of each ball (3 numbers) [L]
    double* time = nullptr;                ///< receives the duration [L/V]
    HertzHistory* history = nullptr;       ///< per contact, unless null
    std::int64_t most = kMostEvaluations;  ///< evaluations of the forces; more are a failure
};

constexpr std::size_t contact_phase_numbers(int balls, int contacts) noexcept {
    return 144 * (static_cast<std::size_t>(balls) + 1) + 40 * (static_cast<std::size_t>(contacts) + 8);
}
constexpr std::size_t contact_phase_places(int balls, int contacts) noexcept {
    return 3 * (static_cast<std::size_t>(balls) + 4) + 6 * (static_cast<std::size_t>(contacts) + 8);
}

/// Integrates places, velocities and spins as one differential equation until every contact is open and none
/// would close again within look_ahead [L/V]. Normals and overlaps follow the places. The method is ROCK4, of
/// order 4 and stable although friction is stiff; steps end where a contact opens, closes or turns from
/// loading to unloading. While all contacts are open the balls fly without steps. A ball's contacts are
/// summed in the given order.
/// @param tolerance  [V] error of the velocities and spins that a step may make
/// @return the number of evaluations of the forces, or -1 if the contacts did not separate within time_limit
///         [L/V], phase.most evaluations or kMostSteps
using ContactPhaseFunction = std::int64_t (*)(const ContactPhase& phase, const HertzLaw& law,
                                              double tolerance, double look_ahead,
                                              double time_limit) noexcept;

/// [L/V] A longer phase ends as soon as no contact is closed, even if one is about to close: the balls have
/// moved far.
inline constexpr double kLongPhase = 40.0;
/// [slide L/V] Regularisation of the slip that the weight stops: it is stopped within 0.03 L/V, so it is not
/// stiff.
inline constexpr double kWeightSlip = 0.1;
inline constexpr std::int64_t kMostSteps = 100'000;

/// The integration built for one instruction set (which must be available). All give the same bits.
ContactPhaseFunction contact_phase_function(Isa isa) noexcept;

}  // namespace carom::kernel
