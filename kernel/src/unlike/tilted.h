// The impact of two balls of any size, whose line of centres is tilted: its state and its forces. Equations:
// docs/reference/physics.md, "Balls of different size".
//
// Speeds are over the approach speed, impulses over the reduced mass times it. In the contact frame n = (0,
// C, S) points from ball 1 to ball 2, x is level and across, and z' = (0, -S, C) is across and steep. Ball 1
// is the smaller one, so S >= 0 and the normal force presses ball 1 on the cloth.
#pragma once

#include "carom/kernel/impact.h"
#include "frame.h"
#include "numbers.h"

namespace carom::kernel {
namespace {

struct Tilt {
    double S, C;      // sine and cosine of the tilt
    double share[2];  // reduced mass over that of a ball; together 1
    double mu_b, mu_s[2], e_b;
    double turn, drag;  // of a ball's spin and of the cloth on its slip at the cloth: +-5/2, 7/2 or -3/2
};

// The slip c of ball 1 on ball 2, the slips u of both on the cloth, and the closing speed along n.
struct Slips {
    double cx, cz, ux[2], uy[2], v;
};

// Forces over the normal force: friction between the balls, on ball 2 along x and z', and the cloth's
// friction on each ball. Integrated they are impulses.
struct Forces {
    double xi, zeta, gx[2], gy[2];
};

CAROM_INLINE Tilt tilt_of(const ImpactParams& p) {
    const double k = p.radius_ratio, m = p.mass_ratio;
    const bool published = p.cloth_slip == ClothSlip::kAsPublished;
    Tilt t;
    t.S = (k - 1.0) / (k + 1.0);
    t.C = 2.0 * square_root(k) / (k + 1.0);
    t.share[0] = m / (1.0 + m);
    t.share[1] = 1.0 / (1.0 + m);
    t.mu_b = p.mu_b;
    t.mu_s[0] = p.mu_s1;
    t.mu_s[1] = p.mu_s2;
    t.e_b = p.e_b;
    t.turn = published ? -2.5 : 2.5;
    t.drag = published ? -1.5 : 3.5;
    return t;
}

// The state after the normal impulse p and these impulses. The balls stay on the cloth: the vertical parts
// change no velocity.
CAROM_INLINE Slips moved(const Tilt& t, const Slips& s, double p, const Forces& f) {
    const double S = t.S, C = t.C, i1 = t.share[0], i2 = t.share[1];
    const double level = C * p - S * f.zeta;  // the contact's impulse along y
    Slips r;
    r.cx = s.cx - 3.5 * f.xi - i1 * (1.0 - 2.5 * S) * f.gx[0] + i2 * (1.0 + 2.5 * S) * f.gx[1];
    r.cz = s.cz + S * level - 2.5 * f.zeta - i1 * (2.5 - S) * f.gy[0] - i2 * (2.5 + S) * f.gy[1];
    r.ux[0] = s.ux[0] + i1 * ((t.turn * S - 1.0) * f.xi - t.drag * f.gx[0]);
    r.ux[1] = s.ux[1] + i2 * ((t.turn * S + 1.0) * f.xi - t.drag * f.gx[1]);
    r.uy[0] = s.uy[0] - i1 * (level + t.turn * f.zeta + t.drag * f.gy[0]);
    r.uy[1] = s.uy[1] + i2 * (level - t.turn * f.zeta - t.drag * f.gy[1]);
    r.v = s.v - C * (level + i1 * f.gy[0] - i2 * f.gy[1]);
    return r;
}

// The direction of a ball's slip on the cloth. Without slip it is that of the force on the ball, along which
// the slip starts.
CAROM_INLINE void slip_direction(const Tilt& t, const Slips& s, double xi, double zeta, int ball, double& x,
                                 double& y) {
    x = s.ux[ball];
    y = s.uy[ball];
    if (x == 0.0 && y == 0.0) {
        const double level = t.C - t.S * zeta;
        x = (t.turn * t.S + (ball == 0 ? -1.0 : 1.0)) * xi;
        y = (ball == 0 ? -level : level) - t.turn * zeta;
    }
    const double size2 = x * x + y * y, by = size2 > 0.0 ? 1.0 / square_root(size2) : 0.0;
    x *= by;
    y *= by;
}

// Adds the friction of the cloth under the ball that the contact presses down.
CAROM_INLINE void press(const Tilt& t, const Slips& s, Forces& f) {
    const double down = t.S + t.C * f.zeta;  // on ball 1
    const int ball = down < 0.0 ? 1 : 0;
    double x, y;
    slip_direction(t, s, f.xi, f.zeta, ball, x, y);
    const double g = t.mu_s[ball] * absolute(down);
    f.gx[ball] = g * x;
    f.gy[ball] = g * y;
    f.gx[1 - ball] = f.gy[1 - ball] = 0.0;
}

// The forces while the balls slip on each other.
CAROM_INLINE Forces sliding_forces(const Tilt& t, const Slips& s) {
    Forces f;
    const double c2 = s.cx * s.cx + s.cz * s.cz, by = c2 > 0.0 ? t.mu_b / square_root(c2) : 0.0;
    f.xi = by * s.cx;
    f.zeta = by * s.cz;
    press(t, s, f);
    return f;
}

// The forces that keep the balls from slipping on each other. Ball 1 is pressed down: down = 3.5 S/(...).
CAROM_INLINE Forces sticking_forces(const Tilt& t, const Slips& s) {
    const double S = t.S, C = t.C, i1 = t.share[0];
    Forces f;
    double x, y;
    slip_direction(t, s, 0.0, 0.4 * S * C, 0, x, y);
    const double k = i1 * (2.5 - S) * t.mu_s[0] * y;
    f.zeta = S * (C - k) / (2.5 + S * S + k * C);
    const double g = t.mu_s[0] * (S + C * f.zeta);
    f.xi = -i1 * (1.0 - 2.5 * S) * (g * x) / 3.5;
    f.gx[0] = g * x;
    f.gy[0] = g * y;
    f.gx[1] = f.gy[1] = 0.0;
    return f;
}

// A state in the contact frame as slips, over the approach speed n; R1 and R2 are the radii.
CAROM_INLINE Slips slips_of(const Tilt& t, const FrameState& s, double R1, double R2, double n) {
    const double by = 1.0 / n, sign = t.turn > 0.0 ? 1.0 : -1.0;
    const double wx = R1 * s.w1x + R2 * s.w2x, wy = R1 * s.w1y + R2 * s.w2y, wz = R1 * s.w1z + R2 * s.w2z;
    Slips r;
    r.cx = by * (s.v1x - s.v2x + wy * t.S - wz * t.C);
    r.cz = by * (wx - t.S * (s.v1y - s.v2y));
    r.ux[0] = by * (s.v1x - sign * R1 * s.w1y);
    r.uy[0] = by * (s.v1y + sign * R1 * s.w1x);
    r.ux[1] = by * (s.v2x - sign * R2 * s.w2y);
    r.uy[1] = by * (s.v2y + sign * R2 * s.w2x);
    r.v = by * (t.C * (s.v1y - s.v2y));
    return r;
}

// Adds the impulses p and f, over the approach speed n, to the velocities.
CAROM_INLINE void add_impulses(const Tilt& t, double p, const Forces& f, double n, double R1, double R2,
                               FrameState& s) {
    const double i1 = n * t.share[0], i2 = n * t.share[1], level = t.C * p - t.S * f.zeta;
    const double spin1 = 2.5 * i1 / R1, spin2 = 2.5 * i2 / R2;
    s.v1x -= i1 * (f.xi + f.gx[0]);
    s.v1y -= i1 * (level + f.gy[0]);
    s.v2x += i2 * (f.xi - f.gx[1]);
    s.v2y += i2 * (level - f.gy[1]);
    s.w1x -= spin1 * (f.zeta + f.gy[0]);
    s.w1y -= spin1 * (t.S * f.xi - f.gx[0]);
    s.w1z += spin1 * (t.C * f.xi);
    s.w2x -= spin2 * (f.zeta + f.gy[1]);
    s.w2y -= spin2 * (t.S * f.xi - f.gx[1]);
    s.w2z += spin2 * (t.C * f.xi);
}

}  // namespace
}  // namespace carom::kernel
