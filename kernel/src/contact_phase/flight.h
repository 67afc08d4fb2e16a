// Between the contacts of a contact phase: flights, and contacts that turn less than the balls. Part of
// contact_phase.cpp.
#pragma once

#include "carom/kernel/contact_phase.h"
#include "contact_phase/state.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

// If a contact closes after a flight of at most this fraction of the look-ahead, its normal turns with the
// balls. Beyond that it turns less, and so do contacts that close up to this much later [L/V].
constexpr double kFlight = 0.5, kSoonAfter = 0.5;
// [longest steps] A contact that would touch within this time touches at once.
constexpr double kAtOnce = 1e-3;

CAROM_INLINE bool any_overlap(const Work& w) {
    int bits = 0;
    for (int c = 0; c < w.lanes; c += 4) bits |= bits_less(broadcast<4>(0.0), load<4>(w.d + c));
    return bits != 0;
}

// Whether a contact overlaps and still acts.
CAROM_INLINE bool any_pressed(const Work& w, const HertzLaw& law, double time_left) {
    for (int c = 0; c < w.contacts; ++c) {
        const double d = w.d[c];
        if (!(d > 0.0)) continue;
        const double F = normal_force(law.a, law.b, law.p, d, w.inverse[c]);
        if (!is_over(F, d, w.rate[0][c], time_left)) return true;
    }
    return false;
}

constexpr double kNever = 1e300;

// The free motion of two balls along and across their line of centres. Lengths in L, kappa = L/(2 R).
struct RelativePath {
    double closing, across, speed2;  // speeds, and their total squared
    double kappa, gap, apart;        // kappa, the gap, and kappa times the distance of the centres

    // Time of their touch: |z - v s| = 2 R, without subtracting nearly equal numbers.
    double touch() const {
        if (!(closing > 0.0)) return kNever;
        const double q = gap * (2.0 + kappa * gap), c = apart * closing, root2 = c * c - kappa * speed2 * q;
        return root2 < 0.0 ? kNever : q / (c + square_root(root2));
    }
    // Time until they touch or are nearest.
    double nearest() const {
        const double s = touch();
        if (s < kNever) return s;
        return closing > 0.0 && kappa > 0.0 ? apart * closing / (kappa * speed2) : 0.0;
    }
    double gap_after(double s) const {
        const double change = s * (kappa * speed2 * s - 2.0 * apart * closing);
        return gap + change / (square_root(apart * apart + kappa * change) + apart);
    }
};

CAROM_INLINE RelativePath relative_path(const Work& w, int c, double nx, double ny, double gap) {
    const double *i = w.y + w.i[c], *j = w.y + w.j[c];
    const double x = i[0] - j[0], y = i[2] - j[2];
    const double along = x * nx + y * ny, across = y * nx - x * ny;
    return {along, across, along * along + across * across, w.curvature, gap, 1.0 + w.curvature * gap};
}

// The normal after a flight of length s.
CAROM_INLINE void turn_by_flight(const RelativePath& path, double s, double& nx, double& ny) {
    const double along = path.apart - path.kappa * path.closing * s, across = -path.kappa * path.across * s;
    const double x = nx * along - ny * across, y = ny * along + nx * across;
    const double length = square_root(x * x + y * y);
    nx = x / length;
    ny = y / length;
}

// Time at which the next contact closes, without forces.
CAROM_INLINE double next_touch(const Work& w) {
    double first = kNever;
    for (int c = 0; c < w.contacts; ++c) {
        if (w.rate[0][c] > kNothing)
            first = smallest(first, relative_path(w, c, w.nx[c], w.ny[c], -w.d[c]).touch());
    }
    return first;
}

// Falls smoothly from 1 at x <= from to 0 at x >= to.
CAROM_INLINE double falling(double x, double from, double to) {
    if (!(x > from)) return 1.0;
    if (!(x < to)) return 0.0;
    const double t = (x - from) / (to - from);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

// Moves all balls straight ahead for `time`, when the first contact closes. If that is almost the whole
// look-ahead, the caller is about to take over with instantaneous impacts of two balls, whose normals do not
// turn. So the normals of contacts that close then, or soon after, turn less. The caller updates the rates.
CAROM_INLINE void fly(const ContactPhase& phase, Work& w, double time, double look_ahead) {
    const double less = 1.0 - falling(time, kFlight * look_ahead, look_ahead);
    for (int n = 0; n < kRow * w.rows; n += kRow) add_displacement(w, n, time * load<4>(w.y + n));
    w.shares = false;
    for (int c = 0; c < w.contacts; ++c) {
        const RelativePath path = relative_path(w, c, w.nx[c], w.ny[c], -w.d[c]);
        const double late = path.touch() - time;
        w.d[c] = smallest(0.0, -path.gap_after(time));
        if (late <= 0.0) w.d[c] = 0.0;
        turn_by_flight(path, time, w.nx[c], w.ny[c]);
        w.share[c] = phase.contact[w.id[c]].turn * (1.0 - less * falling(late, 0.0, kSoonAfter));
        w.bend[c] = w.curvature;
        w.shares |= w.share[c] < 1.0 && w.curvature > 0.0;
    }
}

// Closes a contact that turns less than the balls. By HertzContact::turn its normal moves from that of the
// balls towards the one with which they would touch if they had moved with their present velocities since the
// first touch, without earlier contacts. A contact that merely closes late has the normal of the balls.
CAROM_INLINE void close_contact(const ContactPhase& phase, Work& w, int c, double time) {
    double &nx = w.nx[c], &ny = w.ny[c];
    turn_by_flight(relative_path(w, c, nx, ny, largest(0.0, -w.d[c])), time, nx, ny);
    const HertzContact& first = phase.contact[w.id[c]];
    double x = first.nx, y = first.ny;
    const RelativePath since = relative_path(w, c, x, y, -first.overlap);
    turn_by_flight(since, since.nearest(), x, y);
    const double share = first.turn;
    nx = share * nx + (1.0 - share) * x;
    ny = share * ny + (1.0 - share) * y;
    const double length = square_root(nx * nx + ny * ny);
    nx /= length;
    ny /= length;
    w.bend[c] = w.share[c] * w.curvature;
}

// Contacts that turn less than the balls do so from their touch to their end. A step ends when one of them
// touches.
// @return the longest step
CAROM_INLINE double update_turning(const ContactPhase& phase, Work& w, double longest) {
    double h = longest;
    bool changed = false;
    for (int c = 0; c < w.contacts; ++c) {
        if (!(w.share[c] < 1.0)) continue;
        const bool closed = w.bend[c] < w.curvature, open = !(w.d[c] > 0.0);
        if (closed) {
            if (!open || w.rate[0][c] > 0.0) continue;
            w.bend[c] = w.curvature;
            changed = true;
            continue;
        }
        const double time = open ? relative_path(w, c, w.nx[c], w.ny[c], -w.d[c]).touch() : 0.0;
        if (time > kAtOnce * longest) {
            h = smallest(h, time);
            continue;
        }
        close_contact(phase, w, c, time);
        changed = true;
    }
    if (changed) update_rates(w);
    return h;
}

}  // namespace
}  // namespace carom::kernel
