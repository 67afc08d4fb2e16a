#include "physics/cluster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "carom/engine/tolerances.h"

namespace carom {

namespace {

constexpr std::size_t kCacheLine = 64;  // [bytes]

// [L/V] The integration continues while a listed pair would touch within this time.
constexpr double kClusterLookAhead = 4.0;
// [V] With smaller errors of a step, rounding prevails.
constexpr double kClusterTightest = 1e-11;
// [-] Largest exponent of the unloading law: in a cluster, no restitution is below 0.0016.
constexpr int kLargestLawExponent = 1 << 20;
// [-] With less restitution, contacts open in proportion more slowly.
constexpr double kPlastic = 0.05;
// [-] Limit on sweeps of the rigid projection; a rack of 15 needs about 500.
constexpr std::int64_t kRigidSweeps = 100000;

}  // namespace

double fifth_root(double x) {
    if (x == 0.0) return 0.0;
    // x = 2^(5 q) f with f in [1, 32): start from a linear function of f, then apply a fixed number of Newton
    // steps to y^5 = f.
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
    // V^4 would underflow, but a contact has a length at any speed. The scaling changes no bit.
    if (V < 0x1p-200 && V > 0.0) return contact_length(V * 0x1p250) * 0x1p-200;
    const double x = V * V / kContactStiffness;
    return fifth_root(x * x);
}

double contact_time(double V) {
    return kContactTimeFactor * contact_length(V) / V;
}

double pair_softness(const BallSize& one, const BallSize& two, const BallSize& usual) {
    if (one == usual && two == usual) return 1.0;
    const double mass = 2.0 * one.m * two.m / ((one.m + two.m) * usual.m);
    const double softness2 = (one.R + two.R) * usual.R / (2.0 * one.R * two.R);
    return fifth_root(mass * mass * softness2);
}

namespace {

// The exponent p of the unloading law: the smallest power of 2 with e^2 >= 2.5 / (2.5 + p), so that the force
// remains a push.
int law_exponent(double e_b) {
    int p = 1;
    while (p < kLargestLawExponent && e_b * e_b < 2.5 / (2.5 + p)) p *= 2;
    return p;
}

kernel::HertzLaw law_of(const ClusterSettings& s, double V) {
    const int p = law_exponent(s.e_b);
    const double b = std::min(1.0, (1.0 - s.e_b * s.e_b) * 0.4 / (0.4 - 1.0 / (2.5 + p)));
    const double slide = s.slide * contact_length(V) / (V * V);
    return {1.0 - b,
            b,
            p,
            s.mu_b,
            s.mu_s,
            s.epsilon,
            s.published_cloth_slip,
            s.mu_b_more,
            s.mu_b_fall * V,
            slide,
            s.gravity * contact_length(V) / (V * V),
            s.hop * s.hop / (V * V)};
}

// The integration reads and writes four numbers at once. With cache-line alignment, no such group crosses two
// lines; otherwise, the contact phase of a break took 20% longer.
double* on_cache_line(std::vector<double>& numbers) {
    void* first = numbers.data();
    std::size_t space = numbers.size() * sizeof(double);
    return static_cast<double*>(std::align(kCacheLine, space - kCacheLine, first, space));
}

double radius(const ClusterBall& ball, const ClusterSettings& settings) {
    return settings.unlike ? ball.R : settings.R;
}

}  // namespace

Placed ClusterMap::Reached::placed(int ball, const double* state) const {
    return {(*balls)[static_cast<std::size_t>(ball)].r + L * Vec3(state[0], state[1], state[2]),
            V * Vec3(state[3], state[4], state[5])};
}

Vec3 ClusterMap::Reached::spin(int ball, const double* state) const {
    const double R = radius((*balls)[static_cast<std::size_t>(ball)], *settings);
    return V / R * Vec3(state[6], state[7], state[8]);
}

void ClusterMap::load(const std::vector<ClusterBall>& balls, const ClusterSettings& settings, double V) {
    motion_.clear();
    mass_.clear();
    inverse_mass_.clear();
    moved_.assign(3 * balls.size(), 0.0);
    for (const ClusterBall& ball : balls) {
        const double R = radius(ball, settings);
        for (int k = 0; k < 3; ++k) motion_.push_back(ball.v[k] / V);
        for (int k = 0; k < 3; ++k) motion_.push_back(R * ball.w[k] / V);
        mass_.push_back(settings.unlike ? ball.mass : 1.0);
        inverse_mass_.push_back(1.0 / mass_.back());
    }
}

void ClusterMap::unload(const ClusterSettings& settings, double V, std::vector<ClusterBall>& balls) {
    const double L = contact_length(V);
    for (double& x : moved_) x *= L;
    duration_ *= L / V;
    const double* y = motion_.data();
    for (ClusterBall& ball : balls) {
        const double R = radius(ball, settings);
        for (int k = 0; k < 3; ++k) ball.v[k] = *y++ * V;
        for (int k = 0; k < 3; ++k) ball.w[k] = *y++ * V / R;
    }
}

double ClusterMap::energy() const {
    double e = 0.0;
    const double* m = mass_.data();
    for (const double* y = motion_.data(); y != motion_.data() + motion_.size(); y += 6, ++m) {
        const double v2 = y[0] * y[0] + y[1] * y[1] + y[2] * y[2],
                     w2 = y[3] * y[3] + y[4] * y[4] + y[5] * y[5];
        e += *m * (0.5 * v2 + 0.2 * w2);
    }
    return e;
}

// The step error can raise the energy if e = 1 and mu = 0. Scaling the velocities about their mean prevents
// that and preserves the momentum and the signs of relative velocities.
void ClusterMap::keep_energy(double before) {
    const double after = energy();
    if (!(after > before)) return;
    double mean[3] = {}, relative = 0.0, all = 0.0;
    for (std::size_t b = 0; b < mass_.size(); ++b) {
        all += mass_[b];
        for (int k = 0; k < 3; ++k) mean[k] += mass_[b] * motion_[6 * b + k];
    }
    for (double& m : mean) m /= all;
    for (std::size_t b = 0; b < mass_.size(); ++b) {
        for (int k = 0; k < 3; ++k) {
            const double x = motion_[6 * b + k] - mean[k];
            relative += 0.5 * mass_[b] * (x * x);
        }
    }
    const double wanted = relative - (after - before);
    if (!(relative > 0.0) || !(wanted > 0.0)) return;
    const double factor = std::sqrt(wanted / relative);
    for (std::size_t n = 0; n < motion_.size(); n += 6)
        for (int k = 0; k < 3; ++k) motion_[n + k] = mean[k] + factor * (motion_[n + k] - mean[k]);
}

namespace {

// [L] The distance at which balls touch. The stiffness is that of pool balls, so small balls at hundreds of
// m/s would overlap by more than their radius and have no normal. They are treated as larger balls that touch
// at the same points. Balls so large that normals do not turn replace them where the balls must stay in
// place.
double touching(double L, double distance, bool turns) {
    constexpr double kLeast = 8.0, kNoTurn = 1e9;
    return turns ? std::max(kLeast, distance / L) : kNoTurn;
}

// A slow pair can touch first just before faster ones do. The fastest sets the scale: otherwise its forces
// would need a million steps.
double fastest(const std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts, double V) {
    for (const ClusterContact& c : contacts) V = std::max(V, dot3(balls[c.i].v - balls[c.j].v, c.n));
    return V;
}

// [m/s] The unit of speed of a cluster whose fastest approach is V. Below about 1 mm/s the weight's friction
// is stronger than the contacts, and in units of V it would need a million steps: with this unit it is at
// most 1.
double unit_of_speed(double V, double slide) {
    constexpr double kFast = 1e-3;
    constexpr int kRounds = 8;
    double U = V;
    if (!(slide * contact_length(V) > kFast * V * V)) return U;
    for (int round = 0; round < kRounds; ++round) U = std::sqrt(V * V + slide * contact_length(U));
    return U;
}

// [L] Overlap of two balls of this mass, at least the overlap at mass 1.
double overlap_of(double mass) {
    return mass > 1.0 ? fifth_root(mass * mass) : 1.0;
}

std::int64_t most_evaluations(double tolerance) {
    return static_cast<std::int64_t>(kClusterEvaluations / fifth_root(std::min(1.0, 1e6 * tolerance)));
}

}  // namespace

std::int64_t ClusterMap::compliant(std::vector<ClusterBall>& balls,
                                   const std::vector<ClusterContact>& contacts,
                                   const ClusterSettings& settings, double V, bool held) {
    const double approach = fastest(balls, contacts, V);
    V = unit_of_speed(approach, settings.slide);
    const double L = contact_length(V), share = approach / V;
    load(balls, settings, V);
    contacts_.clear();
    for (const ClusterContact& c : contacts) {
        const double Ri = radius(balls[c.i], settings), Rj = radius(balls[c.j], settings);
        // Hertz: the stiffness is proportional to the root of the effective radius.
        const double stiffness = settings.unlike ? std::sqrt(2.0 * Ri * Rj / ((Ri + Rj) * settings.R)) : 1.0;
        contacts_.push_back({c.i,
                             c.j,
                             {c.n.x(), c.n.y(), c.n.z()},
                             -c.gap / L,
                             touching(L, Ri + Rj, settings.turns),
                             stiffness});
    }
    const int m = static_cast<int>(balls.size()), n = static_cast<int>(contacts.size());
    numbers_.resize(
        std::max(numbers_.size(), kernel::contact_phase_numbers(m, n) + kCacheLine / sizeof(double)));
    places_.resize(std::max(places_.size(), kernel::contact_phase_places(m, n)));
    history_.assign(contacts.size(), {-1.0, 0.0});
    lies_.clear();
    for (const ClusterBall& ball : balls) lies_.push_back((radius(ball, settings) - ball.r.z()) / L);
    Reached reached{&balls, &settings, V, L};
    const kernel::ContactSurfaces surfaces{
        &reached,
        [](void* owner, int ball, const double* state) noexcept {
            const Reached& at = *static_cast<Reached*>(owner);
            return at.settings->surfaces->next(static_cast<std::size_t>(ball), at.placed(ball, state),
                                               at.spin(ball, state)) *
                   (at.V / at.L);
        },
        [](void* owner, int ball, double time, double* state) noexcept {
            const Reached& at = *static_cast<Reached*>(owner);
            const Placed before = at.placed(ball, state);
            Velocities now{before.velocity, at.spin(ball, state)};
            at.settings->surfaces->hit(static_cast<std::size_t>(ball), time * (at.L / at.V), before.position,
                                       now);
            const double R = radius((*at.balls)[static_cast<std::size_t>(ball)], *at.settings);
            for (int k = 0; k < 3; ++k) state[3 + k] = now.v[k] / at.V;
            for (int k = 0; k < 3; ++k) state[6 + k] = R * now.w[k] / at.V;
        },
        [](void* owner, int ball, const double* state) noexcept {
            const Reached& at = *static_cast<Reached*>(owner);
            return at.settings->surfaces->out(static_cast<std::size_t>(ball), at.placed(ball, state)) *
                   (at.V / at.L);
        }};
    const double before = energy();
    const double tolerance = std::max(kClusterTightest, share * settings.tolerance);
    const kernel::ContactPhase phase{
        .balls = m,
        .contacts = n,
        .motion = motion_.data(),
        .contact = contacts_.data(),
        .numbers = on_cache_line(numbers_),
        .places = places_.data(),
        .held = held,
        .surfaces = settings.surfaces != nullptr ? &surfaces : nullptr,
        .lies = held || settings.surfaces == nullptr ? nullptr : lies_.data(),
        .inverse_mass = settings.unlike ? inverse_mass_.data() : nullptr,
        .moved = moved_.data(),
        .time = &duration_,
        .history = history_.data(),
        .most = settings.longest > 0.0 ? most_evaluations(settings.tolerance) : kernel::kMostEvaluations};
    // Heavy balls compress each other for longer.
    const double heaviest = overlap_of(*std::max_element(mass_.begin(), mass_.end()));
    kernel::HertzLaw law = law_of(settings, V);
    law.epsilon *= share;
    // A slow contact lasts longer in this unit of time.
    const double slow = contact_length(approach) / (approach * (L / V));
    double limit = slow * kClusterTimeLimit * heaviest;
    if (settings.e_b < kPlastic) limit *= kPlastic / std::max(settings.e_b, std::sqrt(2.5 / law.p));
    if (settings.longest > 0.0) limit = std::min(limit, settings.longest / (L / V));
    const std::int64_t evaluations =
        settings.integrate(phase, law, tolerance, slow * kClusterLookAhead, limit);
    if (evaluations < 0) return evaluations;
    double risen = 0.0;
    for (std::size_t b = 0; b < balls.size(); ++b) risen += mass_[b] * law.gravity * moved_[3 * b + 2];
    keep_energy(before - risen);
    unload(settings, V, balls);
    pushes_.clear();
    for (const kernel::HertzHistory& h : history_)
        pushes_.push_back({h.first < 0.0 ? -1.0 : h.first * (L / V), h.impulse * V});
    return evaluations;
}

std::int64_t ClusterMap::rigid(std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                               const ClusterSettings& settings) {
    const double e_b = settings.e_b;
    const auto mobility = [&](int b) { return settings.unlike ? 1.0 / balls[b].mass : 1.0; };
    std::vector<Vec3>& v = velocity_;
    v.clear();
    for (const ClusterBall& b : balls) v.push_back(b.v);
    std::vector<double>& impulse = impulse_;  // of the contacts, then of the cloth under every ball
    impulse.assign(contacts.size() + balls.size(), 0.0);
    double scale = 0.0;
    for (const Vec3& x : v) scale = std::max(scale, length3(x));
    std::int64_t sweeps = 0;
    for (; sweeps < kRigidSweeps; ++sweeps) {
        double change = 0.0;
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            const int i = contacts[c].i, j = contacts[c].j;
            const Vec3& n = contacts[c].n;
            const double closing = dot3(v[i] - v[j], n);
            const double light_i = mobility(i), light_j = mobility(j);
            const double next = std::max(0.0, impulse[c] + closing / (light_i + light_j));
            const double J = next - impulse[c];
            impulse[c] = next;
            v[i] -= (light_i * J) * n;
            v[j] += (light_j * J) * n;
            change = std::max(change, std::abs(J));
        }
        for (std::size_t b = 0; b < balls.size(); ++b) {
            if (balls[b].r.z() > radius(balls[b], settings)) continue;
            double& up = impulse[contacts.size() + b];
            const double next = std::max(0.0, up - v[b].z()), J = next - up;
            up = next;
            v[b].z() += J;
            change = std::max(change, std::abs(J));
        }
        if (change <= 1e-16 * scale) break;
    }
    for (std::size_t b = 0; b < balls.size(); ++b) balls[b].v = (1.0 + e_b) * v[b] - e_b * balls[b].v;
    pushes_.clear();
    for (std::size_t c = 0; c < contacts.size(); ++c)
        pushes_.push_back({impulse[c] > 0.0 ? 0.0 : -1.0, (1.0 + e_b) * impulse[c]});
    return sweeps;
}

}  // namespace carom
