// One solution of one group of resting contacts (resting.h): the effect of impulses (resting_response.cpp);
// the impulses that leave no contact closing at the end of an interval, the step over it, and the criteria
// for a solution (resting_newton.cpp); the length of the interval (resting_interval.cpp); and their order
// (resting.cpp).
//
// Everything is evaluated at the end of the interval h (an implicit step, after J. J. Moreau's time-stepping
// for unilateral contacts with friction). For each ball, per mass, let v be its velocity, s = R (w_y, -w_x)
// the velocity with which it would roll, and u = v - s its slip:
//   v' = v + P + f - d,  s' = s + 5/2 (C - f) - d,  u' = u + P - 5/2 C + 7/2 f
// P = sum of +-J n are the pushes, C = -sum of Z n the couples of the vertical friction Z between two balls,
// f is the friction of the cloth, and d the rolling resistance. The friction opposes the slip at the end:
// f = -mu_s g h u'/|u'|, or less if that suffices to end the slip; d likewise opposes the velocity at the
// end. So a ball stops, rolls, or slides by the effect of the whole interval, and the step remains valid if a
// direction reverses, for any h. The impulses of the contacts satisfy J >= 0, gap rate at the end >= 0,
// J x rate = 0.
//
// Z opposes the slip between the balls at the end, and loads the cloth. It lags by one Newton step: for given
// Z the rates are the gradient of a convex function of J, so that J exists and is found. Balls that lock each
// other would let Z grow without limit; after some steps it may only decrease, and so never drives them.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting.h"
#include "contact/resting_constants.h"

namespace carom::resting {

enum class Mode : unsigned char { kSliding, kRolling, kResting };

struct Matrix {
    double xx = 0.0, xy = 0.0, yy = 0.0;
    Vec2 operator*(const Vec2& a) const { return {xx * a.x() + xy * a.y(), xy * a.x() + yy * a.y()}; }
};

inline bool moves(const Vec2& a) {
    return a.x() != 0.0 || a.y() != 0.0;
}

/// A ball of the group in the equations.
struct Body {
    // At the start of the interval [m/s].
    Vec2 v = Vec2::Zero(), s = Vec2::Zero();
    Vec2 u = Vec2::Zero();  ///< exactly zero if the ball rolls or rests
    /// Direction of the friction at the middle of the interval, from an earlier solution.
    bool guided = false;
    Vec2 guide = Vec2::Zero();
    double slid = 0.0;  ///< fraction of the interval in which a ball that slips at its start continues to
    double load = 1.0;  ///< share of the weight that the cloth supports
    double R = 0.0;     ///< [m]
    double ease = 1.0;  ///< mass of the lightest ball over that of this one: its response to an impulse

    // At the end.
    Mode mode = Mode::kResting;
    Vec2 v_end = Vec2::Zero(), s_end = Vec2::Zero();
    Vec2 push = Vec2::Zero(), couple = Vec2::Zero();  ///< P and C
    double lift = 0.0;                                ///< vertical impulse of the contacts
    double impulses = 0.0;                            ///< sum of |J| per mass, for rounding
    Matrix by_push;                                   ///< derivative of v_end

    Vec2 slip_end() const { return v_end - s_end; }
};

/// A contact in the equations; i and j index the bodies, j = -1 for the table.
struct Link {
    int i, j;
    Vec2 first;  ///< the normal at the start of the interval
    Vec2 n;      ///< in its middle: the direction of the impulse
    Contact contact;
    /// [m] between the centres, as the normal turns; 0: straight cushion; negative: wall around the ball
    double distance = 0.0;
    double gap = 0.0;      ///< [m]; negative: overlap
    bool begins = false;   ///< the contact begins now, and so cannot end now
    bool open = false;     ///< the gap opens by more than rounding
    double slack = 0.0;    ///< [m/s] closing rate allowed at an instant because it has a gap
    double turning = 0.0;  ///< [m/s^2] of the gap at the end, in addition to the rate along n
    double tilt = 0.0;     ///< of the normal, upwards from i to j: vertical over level component
    // Impulses [m/s] per mass of the lightest ball: level; vertical by friction on ball i; all vertical.
    double J = 0.0, Z = 0.0, lift = 0.0;
    double friction_z = 0.0;  ///< Z divided by the J for which it was computed
    /// Mean of friction_z over the interval, from an earlier solution.
    std::optional<double> guide = std::nullopt;
};

struct Group {
    RestingGroup& group;
    const RestingSurroundings& around;
    const MotionParams& motion;  ///< of the first ball: the frictions, which all balls share
    double now;
    std::vector<Body> bodies{};  ///< as group.balls
    std::vector<Link> links{};   ///< as group.contacts
    double solved = 0.0;         ///< [s] interval that the bodies and links solve; 0: none
    bool smooth = false;         ///< the solution has less than the full friction between balls
    double overlap = 0.0;        ///< [m] the deepest one being removed
    double noise = 0.0;          ///< [m/s] rounding of the group's speeds in a few sums of eight terms
    // Workspace of solve_interval() and step().
    std::vector<Body> bodies_before{};
    std::vector<Link> links_before{};
    Complementarity problem{};
};

/// Removes energy at the end of an interval, or of an instant (h = 0), that did not exist at the start.
/// @return whether there was any
bool keep_energy(Group& g, double h);
/// [m/s] Velocity of the other ball, or of the table, relative to ball i: v or v_end.
Vec2 relative(const Group& g, const Link& link, Vec2 Body::*velocity);

/// The gap within the interval h, for its solution.
class GapCourse {
  public:
    GapCourse(const Group& g, const Link& link, double h);
    /// [m]
    double at(double t) const {
        const Vec2 moved = t * (v_ + t * half_a_);
        if (round_ == 0.0) return gap_ + dot(from_, moved);
        const Vec2 to = from_ + moved;
        return gap_ + round_ * dot(moved, from_ + to) / (far_ + length(to));
    }
    /// [m] The smallest and the largest until h.
    using Range = std::pair<double, double>;
    Range range(double h) const;

  private:
    double gap_, round_, far_;  // round_: the sign of the distance
    Vec2 from_, v_, half_a_;
};

/// [m/s] Rate at which the gap opens at the start of the interval, and at its end along Link::n.
double gap_rate(const Group& g, const Link& link);
double end_rate(const Group& g, const Link& link);
/// [m/s] Upward slip of two balls at their contact, and the slip parallel to the cloth.
Vec2 contact_slip(const Group& g, const Link& link, bool at_end);

// resting_response.cpp
/// Moves the balls by the impulses of their contacts over h [s]; at an instant, h = 0, without friction.
void respond(Group& g, double h);

// resting_newton.cpp
/// [m/s] Slip of two balls that their friction can end within the interval.
double slip_ended(const Group& g, const Link& link);
/// Solves the step over h [s]; 0 is an instant, without friction. @return whether there is a solution; if
/// not, leaves the nearest state
bool step(Group& g, double h);
/// Solves for the impulses that leave no contact closing. @return whether there is a solution
bool strike(Group& g);
/// [m/s] Friction between balls, given the slip at the start.
double friction_at_start(const Group& g, const Link& link);

// resting_interval.cpp
/// [s] Time at which friction has ended the slip of a ball that slips at the start of the interval h.
double slip_gone(const Group& g, const Body& b, double h);
/// [s] How long a solution over h is accurate.
double accurate_interval(const Group& g, double h);
/// Chooses the interval, solves it and writes the segments.
void solve_interval(Group& g);

}  // namespace carom::resting
