// s = (x, z) is the slip between the balls and u = (a, b) the slip of the active ball, which is pressed on
// the cloth, as in docs/design/impact_kernel.md. The independent variable is q, with dp = |s| |u| dq for the
// normal impulse p per unit mass: in q neither the end of the slip (|s| -> 0) nor a cloth slip that passes
// close to zero is singular. With ' = d/dq,
//
//     x' = -7 mu_b x |u| + mu_s mu_b z a             a' = mu_b x |u| - kappa mu_s mu_b z a
//     z' = -5 mu_b z |u| + 5/2 mu_s mu_b z b         b' = |s| |u| - 5/2 sigma mu_b z |u| - kappa mu_s mu_b z
//     b p' = |s| |u|    v' = 2 p' - mu_s mu_b z b      W' = v p'    D' = mu_b |s| p' + mu_s mu_b z |u|^2
//
// With masses m_1 and m_2 impulses are divided by twice the reduced mass m_r, and every effect on the pressed
// ball a alone has the factor f = 2 m_r/m_a: all of a' and b', and the terms with mu_s in x', z' and v'.
//
// The friction impulses are separate integrals: X' = mu_b x |u|, Z' = mu_b z |u|, A' = mu_s mu_b z a,
// B' = mu_s mu_b z b.
#include "reference/solver.h"

#include <algorithm>
#include <cmath>

namespace carom::reference {
namespace {

using Real = long double;

enum Variable { kX, kZ, kA, kB, kP, kV, kW, kD, kXi, kZeta, kGa, kGb, kVariables };

struct Constants {
    Real mu_b, mu_s, kappa, sigma, f;
};

struct Expansion {
    int order;
    Real c[kVariables][kTruthMaxOrder + 1];  // coefficients of every variable
};

Real product(const Real* f, const Real* g, int k) {
    Real sum = 0;
    for (int i = 0; i <= k; ++i) sum += f[i] * g[k - i];
    return sum;
}

// Coefficient k of the square root of `square`, from the coefficients below it.
Real root_term(const Real* square, const Real* root, int k) {
    if (k == 0) return std::sqrt(square[0]);
    Real sum = square[k];
    for (int i = 1; i < k; ++i) sum -= root[i] * root[k - i];
    return sum / (2 * root[0]);
}

void expand(const Constants& m, const Real (&state)[kVariables], Expansion& e) {
    Real s[kTruthMaxOrder + 1], u[kTruthMaxOrder + 1];
    Real s2[kTruthMaxOrder + 1], u2[kTruthMaxOrder + 1], p1[kTruthMaxOrder + 1];
    for (int i = 0; i < kVariables; ++i) e.c[i][0] = state[i];
    for (int k = 0; k < e.order; ++k) {
        s2[k] = product(e.c[kX], e.c[kX], k) + product(e.c[kZ], e.c[kZ], k);
        u2[k] = product(e.c[kA], e.c[kA], k) + product(e.c[kB], e.c[kB], k);
        s[k] = root_term(s2, s, k);
        u[k] = root_term(u2, u, k);
        p1[k] = product(s, u, k);
        const Real xi = m.mu_b * product(e.c[kX], u, k), zeta = m.mu_b * product(e.c[kZ], u, k);
        const Real g = m.mu_s * m.mu_b;
        const Real g_a = g * product(e.c[kZ], e.c[kA], k), g_b = g * product(e.c[kZ], e.c[kB], k);
        Real rate[kVariables];
        rate[kX] = -7 * xi + m.f * g_a;
        rate[kZ] = -5 * zeta + Real(2.5) * m.f * g_b;
        rate[kA] = m.f * (xi - m.kappa * g_a);
        rate[kB] = m.f * (p1[k] - Real(2.5) * m.sigma * zeta - m.kappa * g_b);
        rate[kP] = p1[k];
        rate[kV] = 2 * p1[k] - m.f * g_b;
        rate[kW] = product(e.c[kV], p1, k);
        rate[kD] = m.mu_b * product(s, p1, k) + g * product(e.c[kZ], u2, k);
        rate[kXi] = xi;
        rate[kZeta] = zeta;
        rate[kGa] = g_a;
        rate[kGb] = g_b;
        for (int i = 0; i < kVariables; ++i) e.c[i][k + 1] = rate[i] / (k + 1);
    }
}

Real value(const Expansion& e, int variable, Real q) {
    Real sum = 0;
    for (int k = e.order; k >= 0; --k) sum = sum * q + e.c[variable][k];
    return sum;
}

// The longest q for which the last terms of every variable stay below the tolerance (relative to v_n = 1).
Real step_length(const Expansion& e, Real tolerance) {
    Real shortest = 1e30L;
    for (const int i : {kX, kZ, kA, kB, kV, kW, kXi, kZeta, kGa, kGb}) {
        for (int k = e.order - 2; k <= e.order; ++k) {
            const Real size = std::fabs(e.c[i][k]);
            if (size > 0) shortest = std::min(shortest, std::pow(tolerance / size, Real(1) / k));
        }
    }
    return Real(0.8) * shortest;
}

// The q at which a variable that rises over [0, q] reaches `target`, by bisection.
Real crossing(const Expansion& e, int variable, Real target, Real q) {
    Real lo = 0, hi = q;
    for (int i = 0; i < 70; ++i) {
        const Real middle = (lo + hi) / 2;
        (value(e, variable, middle) < target ? lo : hi) = middle;
    }
    return (lo + hi) / 2;
}

void advance(const Expansion& e, Real q, Real (&state)[kVariables]) {
    for (int i = 0; i < kVariables; ++i) state[i] = value(e, i, q);
}

// A cloth slip of zero gets the direction of the force that will move it.
void leave_zero_slip(const Constants& m, Real (&state)[kVariables], Real size) {
    const Real s = std::hypot(state[kX], state[kZ]);
    const Real fx = m.mu_b * state[kX] / s, fz = 1 - Real(2.5) * m.sigma * m.mu_b * state[kZ] / s;
    const Real f = std::hypot(fx, fz);
    state[kA] = f > 0 ? size * fx / f : size;
    state[kB] = f > 0 ? size * fz / f : 0;
}

// The rest of the impact after friction has ended.
void finish_frictionless(Real work_left, bool compressing, Real e_b, Real (&state)[kVariables], Real& W_c) {
    if (compressing) {
        state[kP] += -state[kV] / 2;
        W_c = -state[kW] + state[kV] * state[kV] / 4;
        state[kV] = 0;
        work_left = e_b * e_b * W_c;
    }
    const Real v_end = std::sqrt(state[kV] * state[kV] + 4 * work_left);
    state[kP] += (v_end - state[kV]) / 2;
    state[kV] = v_end;
}

struct Outcome {
    bool ok, stuck;
    Real W_c;
    int steps;
};

Outcome integrate(const Constants& m, Real e_b, const TruthSettings& settings, Real (&state)[kVariables]) {
    Outcome out{false, false, 0, 0};
    bool compressing = true;
    Real work_goal = 0;
    Expansion e;
    e.order = settings.order;
    for (; out.steps < 4000; ++out.steps) {
        const Real s = std::hypot(state[kX], state[kZ]);
        if (s <= settings.vanished || m.mu_b == 0) {
            out.stuck = m.mu_b > 0;
            finish_frictionless(work_goal - state[kW], compressing, e_b, state, out.W_c);
            out.ok = true;
            return out;
        }
        const Real u = std::hypot(state[kA], state[kB]);
        const bool inward = state[kB] < 0;
        if (u <= settings.vanished / 2 || (u <= settings.vanished && inward))
            leave_zero_slip(m, state, settings.vanished);
        expand(m, state, e);
        const Real q = step_length(e, settings.tolerance);
        if (compressing && value(e, kV, q) >= 0) {
            const Real q_c = crossing(e, kV, 0, q);
            advance(e, q_c, state);
            out.W_c = -state[kW];
            work_goal = e_b * e_b * out.W_c;
            state[kW] = state[kV] = 0;
            compressing = false;
            if (e_b == 0) {
                out.ok = true;
                return out;
            }
        } else if (!compressing && value(e, kW, q) >= work_goal) {
            advance(e, crossing(e, kW, work_goal, q), state);
            out.ok = true;
            return out;
        } else {
            advance(e, q, state);
        }
    }
    return out;
}

struct Vector2 {
    Real x, y;  // in the contact frame: x, y
};

Vector2 project(const double* v, Real yx, Real yy) {
    return {v[0] * yy - v[1] * yx, v[0] * yx + v[1] * yy};
}

void restore(const Vector2& d, Real yx, Real yy, const double* before, Real z, Real* after) {
    after[0] = before[0] + d.x * yy + d.y * yx;
    after[1] = before[1] - d.x * yx + d.y * yy;
    after[2] = before[2] + z;
}

}  // namespace

ImpactTruth reference_impact(const kernel::Ball& ball1, const kernel::Ball& ball2,
                             const kernel::ImpactParams& params, const TruthSettings& settings) {
    ImpactTruth result{};
    const Real dx = Real(ball2.r[0]) - ball1.r[0], dy = Real(ball2.r[1]) - ball1.r[1], d = std::hypot(dx, dy);
    const Real yx = dx / d, yy = dy / d, R = params.R;
    const Vector2 v1 = project(ball1.v, yx, yy), w1 = project(ball1.w, yx, yy);
    const Vector2 v2 = project(ball2.v, yx, yy), w2 = project(ball2.w, yx, yy);
    const Real n = v1.y - v2.y;
    result.approach = n;
    if (!(n > 0)) return result;
    const bool published = params.cloth_slip == kernel::ClothSlip::kAsPublished;
    const Real side = published ? 1 : -1;
    const Real c_z = R * (w1.x + w2.x);
    const bool second = c_z < 0;  // ball 2 is pressed on the cloth
    const Vector2 u = second ? Vector2{v2.x + side * R * w2.y, v2.y - side * R * w2.x}
                             : Vector2{-(v1.x + side * R * w1.y), -(v1.y - side * R * w1.x)};
    // 2 m_r/m_i of either ball.
    const Real f1 = 2 * Real(params.mass_ratio) / (1 + Real(params.mass_ratio)), f2 = 2 - f1;
    const Constants m{params.mu_b, second ? params.mu_s2 : params.mu_s1, 1 - Real(2.5) * side, side,
                      second ? f2 : f1};
    Real state[kVariables] = {};
    state[kX] = (v1.x - v2.x - R * (Real(ball1.w[2]) + ball2.w[2])) / n;
    state[kZ] = std::fabs(c_z) / n;
    state[kA] = u.x / n;
    state[kB] = u.y / n;
    state[kV] = -1;
    const Outcome out = integrate(m, params.e_b, settings, state);
    result.ok = out.ok;
    result.stuck = out.stuck;
    result.steps = out.steps;
    result.compression_work = out.W_c * n * n;
    result.friction_loss = state[kD] * n * n;
    const Real p = state[kP] * n, xi = state[kXi] * n, zeta = (second ? 1 : -1) * state[kZeta] * n;
    const Real g_a = state[kGa] * n, g_b = state[kGb] * n, spin = Real(2.5) / R;
    const Vector2 on1 = second ? Vector2{0, 0} : Vector2{g_a, g_b};
    const Vector2 on2 = second ? Vector2{-g_a, -g_b} : Vector2{0, 0};
    restore({f1 * (-xi + on1.x), f1 * (-p + on1.y)}, yx, yy, ball1.v, 0, result.v1);
    restore({f2 * (xi + on2.x), f2 * (p + on2.y)}, yx, yy, ball2.v, 0, result.v2);
    const Real spin1 = f1 * spin, spin2 = f2 * spin;
    restore({spin1 * (zeta + on1.y), -spin1 * on1.x}, yx, yy, ball1.w, spin1 * xi, result.w1);
    restore({spin2 * (zeta + on2.y), -spin2 * on2.x}, yx, yy, ball2.w, spin2 * xi, result.w2);
    return result;
}

double error_of(const kernel::ImpactResult& result, const ImpactTruth& truth, double R) {
    Real worst = 0;
    for (int k = 0; k < 3; ++k) {
        worst =
            std::max({worst, std::fabs(result.v1[k] - truth.v1[k]), std::fabs(result.v2[k] - truth.v2[k]),
                      R * std::fabs(result.w1[k] - truth.w1[k]), R * std::fabs(result.w2[k] - truth.w2[k])});
    }
    return static_cast<double>(worst / truth.approach);
}

}  // namespace carom::reference
