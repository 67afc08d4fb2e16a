#include "cluster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "carom/engine/tolerances.h"

namespace carom {

double fifth_root(double x) {
    // x = 2^(5 q) f with f in [1, 32): start from a straight line in f, then Newton on y^5 = f with a fixed
    // number of steps.
    int exponent = static_cast<int>((std::bit_cast<std::uint64_t>(x) >> 52) & 0x7FF) - 1023;
    if (exponent == -1023) return fifth_root(x * 0x1p500) * 0x1p-100;  // subnormal
    int q = exponent / 5, left = exponent % 5;
    if (left < 0) {
        left += 5;
        --q;
    }
    const std::uint64_t mantissa = std::bit_cast<std::uint64_t>(x) & 0x000FFFFFFFFFFFFFull;
    const double f = std::bit_cast<double>(mantissa | (static_cast<std::uint64_t>(1023 + left) << 52));
    double y = 1.0 + (f - 1.0) * (1.0 / 31.0);
    for (int i = 0; i < 8; ++i) {
        const double y2 = y * y;
        y = 0.2 * (4.0 * y + f / (y2 * y2));
    }
    return y * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + q) << 52);
}

double contact_length(double V) {
    const double x = V * V / kContactStiffness;
    return fifth_root(x * x);
}

double contact_time(double V) {
    return kContactTimeFactor * contact_length(V) / V;
}

namespace {

constexpr std::size_t kPerBall = 5;

// The exponent p of the unloading law: the smallest power of 2 with e^2 >= 2.5 / (2.5 + p), so that the force
// stays a push.
int law_exponent(double e_b) {
    int p = 1;
    while (p < kLargestLawExponent && e_b * e_b < 2.5 / (2.5 + p)) p *= 2;
    return p;
}

double power(double x, int p) {  // p a power of 2
    for (; p > 1; p /= 2) x *= x;
    return x;
}

}  // namespace

void ClusterMap::load(const std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                      double R, double V, double L) {
    balls_ = balls.size();
    contacts_ = contacts.size();
    y_.resize(kPerBall * balls_);
    y_stage_.resize(y_.size());
    lift_.resize(balls_);
    for (std::vector<double>* a : {&d_, &memory_, &rate_before_, &d_stage_, &nx_, &ny_}) a->resize(contacts_);
    i_.resize(contacts_);
    j_.resize(contacts_);
    for (int k = 0; k < 4; ++k) {
        ky_[k].resize(y_.size());
        kd_[k].resize(contacts_);
    }
    for (std::size_t b = 0; b < balls_; ++b) {
        double* y = &y_[kPerBall * b];
        y[0] = balls[b].v.x() / V;
        y[1] = balls[b].v.y() / V;
        for (int k = 0; k < 3; ++k) y[2 + k] = R * balls[b].w[k] / V;
    }
    for (std::size_t c = 0; c < contacts_; ++c) {
        i_[c] = contacts[c].i;
        j_[c] = contacts[c].j;
        nx_[c] = contacts[c].n.x();
        ny_[c] = contacts[c].n.y();
        d_[c] = -contacts[c].gap / L;
        memory_[c] = 0.0;
    }
}

// Equations 1 to 4, in units of V and L: forces d^1.5, mass 1.
void ClusterMap::derivative(const std::vector<double>& y, const std::vector<double>& d,
                            const ClusterSettings& s, const Law& law, std::vector<double>& dy,
                            std::vector<double>& dd) {
    std::fill(dy.begin(), dy.end(), 0.0);
    std::fill(lift_.begin(), lift_.end(), 0.0);
    const double eps2 = s.epsilon * s.epsilon;
    for (std::size_t c = 0; c < contacts_; ++c) {
        const double *yi = &y[kPerBall * static_cast<std::size_t>(i_[c])],
                     *yj = &y[kPerBall * static_cast<std::size_t>(j_[c])];
        const double nx = nx_[c], ny = ny_[c];
        const double dvx = yi[0] - yj[0], dvy = yi[1] - yj[1];
        dd[c] = dvx * nx + dvy * ny;
        if (!(d[c] > 0.0)) continue;
        double F = d[c] * std::sqrt(d[c]);
        if (d[c] < memory_[c]) F *= law.a + law.b * power(d[c] / memory_[c], law.p);
        // t = n x z = (n_y, -n_x); s_x = (v_i - v_j) . t - R (w_iz + w_jz), s_z = R (w_i + w_j) . t.
        const double s_x = dvx * ny - dvy * nx - (yi[4] + yj[4]);
        const double s_z = (yi[2] + yj[2]) * ny - (yi[3] + yj[3]) * nx;
        const double k = -s.mu_b * F / std::sqrt(s_x * s_x + s_z * s_z + eps2);
        const double f_x = k * s_x, f_z = k * s_z;
        double *ai = &dy[kPerBall * static_cast<std::size_t>(i_[c])],
               *aj = &dy[kPerBall * static_cast<std::size_t>(j_[c])];
        const double fx = -F * nx + f_x * ny, fy = -F * ny - f_x * nx;
        const double tx = 2.5 * f_z * ny, ty = -2.5 * f_z * nx, tz = -2.5 * f_x;
        ai[0] += fx;
        ai[1] += fy;
        aj[0] -= fx;
        aj[1] -= fy;
        ai[2] += tx;
        ai[3] += ty;
        ai[4] += tz;
        aj[2] += tx;
        aj[3] += ty;
        aj[4] += tz;
        lift_[static_cast<std::size_t>(i_[c])] += f_z;
        lift_[static_cast<std::size_t>(j_[c])] -= f_z;
    }
    const double sign = s.published_cloth_slip ? 1.0 : -1.0;
    for (std::size_t b = 0; b < balls_; ++b) {
        if (!(lift_[b] < 0.0)) continue;
        const double* v = &y[kPerBall * b];
        double* a = &dy[kPerBall * b];
        const double ux = v[0] + sign * v[3], uy = v[1] - sign * v[2];
        const double k = s.mu_s * lift_[b] / std::sqrt(ux * ux + uy * uy + eps2);
        a[0] += k * ux;
        a[1] += k * uy;
        a[2] += 2.5 * k * uy;
        a[3] -= 2.5 * k * ux;
    }
}

void ClusterMap::step(const ClusterSettings& s, const Law& law, double h) {
    const double share[4] = {0.0, 0.5 * h, 0.5 * h, h};
    for (int k = 0; k < 4; ++k) {
        if (k == 0) {
            derivative(y_, d_, s, law, ky_[0], kd_[0]);
            continue;
        }
        for (std::size_t n = 0; n < y_.size(); ++n) y_stage_[n] = y_[n] + share[k] * ky_[k - 1][n];
        for (std::size_t c = 0; c < contacts_; ++c) d_stage_[c] = d_[c] + share[k] * kd_[k - 1][c];
        derivative(y_stage_, d_stage_, s, law, ky_[k], kd_[k]);
    }
    const double sixth = h / 6.0;
    for (std::size_t n = 0; n < y_.size(); ++n)
        y_[n] += sixth * ((ky_[0][n] + ky_[3][n]) + 2.0 * (ky_[1][n] + ky_[2][n]));
    for (std::size_t c = 0; c < contacts_; ++c) {
        d_stage_[c] = d_[c];  // overlap before the step, for remember()
        rate_before_[c] = kd_[0][c];
        d_[c] += sixth * ((kd_[0][c] + kd_[3][c]) + 2.0 * (kd_[1][c] + kd_[2][c]));
    }
}

// Largest overlap since a contact opened, with the peak inside a step from the cubic Hermite interpolant:
// without it the energy of each contact carries an error of order h^2.
void ClusterMap::remember(double h) {
    for (std::size_t c = 0; c < contacts_; ++c) {
        if (!(d_[c] > 0.0)) {
            memory_[c] = 0.0;
            continue;
        }
        const double *yi = &y_[kPerBall * static_cast<std::size_t>(i_[c])],
                     *yj = &y_[kPerBall * static_cast<std::size_t>(j_[c])];
        const double rate = (yi[0] - yj[0]) * nx_[c] + (yi[1] - yj[1]) * ny_[c];
        double most = std::max(memory_[c], d_[c]);
        if (rate_before_[c] > 0.0 && rate < 0.0) {
            const double d0 = d_stage_[c], m0 = h * rate_before_[c], m1 = h * rate, rise = d_[c] - d0;
            // d(s) = d0 + m0 s + (3 rise - 2 m0 - m1) s^2 + (m0 + m1 - 2 rise) s^3; its slope falls from m0 >
            // 0 to m1 < 0.
            const double q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
            const double root = std::sqrt(std::max(0.0, q2 * q2 - 3.0 * q3 * m0));
            const double s = m0 / (root - q2);
            if (s > 0.0 && s < 1.0) most = std::max(most, d0 + s * (m0 + s * (q2 + s * q3)));
        }
        memory_[c] = most;
    }
}

bool ClusterMap::finished() const {
    for (std::size_t c = 0; c < contacts_; ++c) {
        if (d_[c] > 0.0) return false;
        const double *yi = &y_[kPerBall * static_cast<std::size_t>(i_[c])],
                     *yj = &y_[kPerBall * static_cast<std::size_t>(j_[c])];
        const double rate = (yi[0] - yj[0]) * nx_[c] + (yi[1] - yj[1]) * ny_[c];
        if (rate > 0.0 && -d_[c] < kClusterLookAhead * rate) return false;
    }
    return true;
}

double ClusterMap::energy() const {
    double e = 0.0;
    for (std::size_t b = 0; b < balls_; ++b) {
        const double* y = &y_[kPerBall * b];
        e += 0.5 * (y[0] * y[0] + y[1] * y[1]) + 0.2 * (y[2] * y[2] + y[3] * y[3] + y[4] * y[4]);
    }
    return e;
}

// Step error can raise the energy where e = 1 and mu = 0: scale the velocities about their mean so that it
// does not. Momentum and the signs of relative velocities are kept.
void ClusterMap::keep_energy(double before) {
    const double after = energy();
    if (!(after > before)) return;
    double mx = 0.0, my = 0.0, relative = 0.0;
    for (std::size_t b = 0; b < balls_; ++b) {
        mx += y_[kPerBall * b];
        my += y_[kPerBall * b + 1];
    }
    mx /= static_cast<double>(balls_);
    my /= static_cast<double>(balls_);
    for (std::size_t b = 0; b < balls_; ++b) {
        const double x = y_[kPerBall * b] - mx, y = y_[kPerBall * b + 1] - my;
        relative += 0.5 * (x * x + y * y);
    }
    const double wanted = relative - (after - before);
    if (!(relative > 0.0) || !(wanted > 0.0)) return;
    const double factor = std::sqrt(wanted / relative);
    for (std::size_t b = 0; b < balls_; ++b) {
        y_[kPerBall * b] = mx + factor * (y_[kPerBall * b] - mx);
        y_[kPerBall * b + 1] = my + factor * (y_[kPerBall * b + 1] - my);
    }
}

long ClusterMap::compliant(std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                           const ClusterSettings& settings, double V) {
    load(balls, contacts, settings.R, V, contact_length(V));
    Law law{};
    law.p = law_exponent(settings.e_b);
    law.b = std::min(1.0, (1.0 - settings.e_b * settings.e_b) * 0.4 / (0.4 - 1.0 / (2.5 + law.p)));
    law.a = 1.0 - law.b;
    // The second limit is the stiffness of the regularised friction (equation 6).
    const double h = settings.mu_b > 0.0 ? std::min(settings.step, 0.31 * settings.epsilon / settings.mu_b)
                                         : settings.step;
    const double before = energy();
    const long limit = static_cast<long>(kClusterTimeLimit / h);
    long steps = 0;
    do {
        if (++steps > limit) return -1;
        step(settings, law, h);
        remember(h);
    } while (!finished());
    keep_energy(before);
    for (std::size_t b = 0; b < balls_; ++b) {
        const double* y = &y_[kPerBall * b];
        balls[b].v = Vec3(y[0] * V, y[1] * V, 0.0);
        for (int k = 0; k < 3; ++k) balls[b].w[k] = y[2 + k] * V / settings.R;
    }
    return steps;
}

long ClusterMap::rigid(std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                       double e_b) {
    std::vector<Vec2> v;
    for (const ClusterBall& b : balls) v.push_back(Vec2(b.v.x(), b.v.y()));
    std::vector<double> impulse(contacts.size(), 0.0);
    double scale = 0.0;
    for (const Vec2& x : v) scale = std::max(scale, x.norm());
    long sweeps = 0;
    for (; sweeps < kRigidSweeps; ++sweeps) {
        double change = 0.0;
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            const auto i = static_cast<std::size_t>(contacts[c].i),
                       j = static_cast<std::size_t>(contacts[c].j);
            const Vec2& n = contacts[c].n;
            const double closing = (v[i] - v[j]).dot(n);
            const double next = std::max(0.0, impulse[c] + 0.5 * closing);
            const double J = next - impulse[c];
            impulse[c] = next;
            v[i] -= J * n;
            v[j] += J * n;
            change = std::max(change, std::abs(J));
        }
        if (change <= 1e-16 * scale) break;
    }
    for (std::size_t b = 0; b < balls.size(); ++b) {
        balls[b].v.x() = (1.0 + e_b) * v[b].x() - e_b * balls[b].v.x();
        balls[b].v.y() = (1.0 + e_b) * v[b].y() - e_b * balls[b].v.y();
    }
    return sweeps;
}

}  // namespace carom
