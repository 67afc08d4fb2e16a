#include "reference/contact_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::reference {
namespace {

// [L/V] The longest step, in which no contact may open and close unseen; that of the method, in which
// friction is not stiff; and the resolution of events.
constexpr double kStep = 0.01, kShort = 1e-3, kEvent = 1e-13;
// [L/V] A surface that is nearer than this is hit now.
constexpr double kAtOnce = 1e-9;

}  // namespace

ContactReference::ContactReference(Cluster cluster, const HertzLaw& law)
    : c_(std::move(cluster)), law_(law), y_(9 * c_.balls(), 0.0), contacts_(c_.contacts.size()) {
    for (std::size_t b = 0; b < c_.balls(); ++b)
        for (std::size_t k = 0; k < 6; ++k) y_[9 * b + 3 + k] = c_.motion[6 * b + k];
    for (std::size_t n = 0; n < contacts_.size(); ++n) {
        const Now now = look(y_, n);
        if (now.d > -kEvent && now.rate > 0.0) contacts_[n].phase = Phase::kLoading;
    }
}

void ContactReference::run(double time) {
    while (time > 1e-12) {
        double h = std::min({kStep, time, hit_surfaces()});
        std::vector<double> after = advance(h);
        if (happens(after)) {
            // The shortest step after which something has happened.
            double low = 0.0;
            while (h - low > kEvent) {
                const double middle = 0.5 * (low + h);
                (happens(advance(middle)) ? h : low) = middle;
            }
            after = advance(h);
        }
        y_ = after;
        time -= h;
        time_ += h;
        for (std::size_t n = 0; n < contacts_.size(); ++n) change(n);
    }
}

double ContactReference::run_to_end(double look_ahead, double time_limit) {
    double time = 0.0;
    while (!ended(time > kernel::kLongPhase ? 0.0 : look_ahead) || !is_out()) {
        if (!(time < time_limit)) return -1.0;
        run(kStep);
        time += kStep;
    }
    return time;
}

std::vector<double> ContactReference::part(std::size_t first, std::size_t count) const {
    std::vector<double> out;
    for (std::size_t b = 0; b < c_.balls(); ++b)
        for (std::size_t k = 0; k < count; ++k) out.push_back(y_[9 * b + first + k]);
    return out;
}

ContactReference::Now ContactReference::look(const std::vector<double>& y, std::size_t number) const {
    const HertzContact& contact = c_.contacts[number];
    const std::size_t i = 9 * static_cast<std::size_t>(contact.i),
                      j = 9 * static_cast<std::size_t>(contact.j);
    std::array<double, 3> z{};
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        z[k] = (contact.touch - contact.overlap) * contact.n[k] + (y[j + k] - y[i + k]);
        square += z[k] * z[k];
    }
    const double distance = std::sqrt(square);
    Now now{{}, contact.touch - distance, 0.0};
    for (std::size_t k = 0; k < 3; ++k) {
        now.n[k] = z[k] / distance;
        now.rate += (y[i + 3 + k] - y[j + 3 + k]) * now.n[k];
    }
    return now;
}

ContactReference::Phase ContactReference::next_phase(const Now& now, const Contact& contact) {
    switch (contact.phase) {
        case Phase::kOpen:
            return now.d > 0.0 ? Phase::kLoading : Phase::kOpen;
        case Phase::kLoading:
            return now.rate < 0.0 ? Phase::kUnloading : Phase::kLoading;
        default:
            if (!(now.d > 0.0)) return Phase::kOpen;
            return now.d > contact.most && now.rate > 0.0 ? Phase::kLoading : Phase::kUnloading;
    }
}

bool ContactReference::happens(const std::vector<double>& y) const {
    for (std::size_t n = 0; n < contacts_.size(); ++n)
        if (next_phase(look(y, n), contacts_[n]) != contacts_[n].phase) return true;
    return false;
}

void ContactReference::change(std::size_t number) {
    Contact& contact = contacts_[number];
    const Now now = look(y_, number);
    const Phase next = next_phase(now, contact);
    if (next == Phase::kUnloading && contact.phase == Phase::kLoading) contact.most = now.d;
    if (next == Phase::kOpen) contact.most = 0.0;
    contact.phase = next;
}

bool ContactReference::ended(double look_ahead) const {
    for (std::size_t n = 0; n < contacts_.size(); ++n) {
        if (contacts_[n].phase != Phase::kOpen) return false;
        // |z - v t| = touch
        const Now now = look(y_, n);
        if (!(now.rate > 1e-12)) continue;
        const std::size_t i = 9 * static_cast<std::size_t>(c_.contacts[n].i),
                          j = 9 * static_cast<std::size_t>(c_.contacts[n].j);
        double speed2 = 0.0;
        for (std::size_t k = 3; k < 6; ++k) speed2 += (y_[i + k] - y_[j + k]) * (y_[i + k] - y_[j + k]);
        const double touch = c_.contacts[n].touch, towards = now.rate * (touch - now.d);
        const double q = -now.d * (2.0 * touch - now.d), root2 = towards * towards - speed2 * q;
        if (root2 > 0.0 && q / (towards + std::sqrt(root2)) < look_ahead) return false;
    }
    return true;
}

// Hits the surfaces that free balls have reached. @return [L/V] time until the next one
double ContactReference::hit_surfaces() {
    double next = kStep;
    for (std::size_t b = 0; c_.surfaces != nullptr && b < c_.balls(); ++b) {
        if (touched(b)) continue;
        std::array<double, 9> at = state(b);
        for (double time;
             (time = c_.surfaces->next(c_.surfaces->owner, static_cast<int>(b), at.data())) < kStep;) {
            if (time > kAtOnce) {
                next = std::min(next, time);
                break;
            }
            c_.surfaces->hit(c_.surfaces->owner, static_cast<int>(b), time_, at.data());
        }
        std::copy_n(at.begin() + 3, 6, y_.begin() + static_cast<std::ptrdiff_t>(9 * b + 3));
        if (c_.held) y_[9 * b + 5] = 0.0;
    }
    return next;
}

bool ContactReference::is_out() const {
    for (std::size_t b = 0; c_.surfaces != nullptr && b < c_.balls(); ++b)
        if (c_.surfaces->out(c_.surfaces->owner, static_cast<int>(b), state(b).data()) > 0.0) return false;
    return true;
}

std::array<double, 9> ContactReference::state(std::size_t ball) const {
    std::array<double, 9> at{};
    std::copy_n(y_.begin() + static_cast<std::ptrdiff_t>(9 * ball), 9, at.begin());
    return at;
}

bool ContactReference::aloft(std::size_t ball) const {
    if (c_.held || c_.lies.empty()) return false;
    const double v = y_[9 * ball + 5], height = y_[9 * ball + 2] - c_.lies[ball];
    return v * v + 2.0 * law_.gravity * height > law_.hop;
}

bool ContactReference::touched(std::size_t ball) const {
    for (std::size_t n = 0; n < contacts_.size(); ++n) {
        const HertzContact& contact = c_.contacts[n];
        if (contacts_[n].phase != Phase::kOpen &&
            (static_cast<std::size_t>(contact.i) == ball || static_cast<std::size_t>(contact.j) == ball))
            return true;
    }
    return false;
}

std::vector<double> ContactReference::slope(const std::vector<double>& y) const {
    std::vector<double> s(y.size(), 0.0), down(c_.balls(), 0.0);
    for (std::size_t b = 0; b < c_.balls(); ++b)
        for (std::size_t k = 0; k < 3; ++k) s[9 * b + k] = y[9 * b + 3 + k];
    for (std::size_t number = 0; number < contacts_.size(); ++number) {
        const Contact& contact = contacts_[number];
        const Now now = look(y, number);
        if (contact.phase == Phase::kOpen || !(now.d > 0.0)) continue;
        double F = c_.contacts[number].stiffness * std::pow(now.d, 1.5);
        if (contact.phase == Phase::kUnloading) F *= law_.a + law_.b * std::pow(now.d / contact.most, law_.p);
        const auto i = static_cast<std::size_t>(c_.contacts[number].i),
                   j = static_cast<std::size_t>(c_.contacts[number].j);
        std::array<double, 3> slip{}, w{}, f{};
        double square = law_.epsilon * law_.epsilon;
        for (std::size_t k = 0; k < 3; ++k) w[k] = y[9 * i + 6 + k] + y[9 * j + 6 + k];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
            slip[k] =
                y[9 * i + 3 + k] - y[9 * j + 3 + k] - now.rate * now.n[k] + w[l] * now.n[m] - w[m] * now.n[l];
            square += slip[k] * slip[k];
        }
        const double size = std::sqrt(square),
                     mu = law_.mu_b + law_.mu_b_more * std::exp(-law_.mu_b_fall * size);
        for (std::size_t k = 0; k < 3; ++k) f[k] = -mu * F * slip[k] / size;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
            const double push = f[k] - F * now.n[k], twist = 2.5 * (now.n[l] * f[m] - now.n[m] * f[l]);
            s[9 * i + 3 + k] += light(i) * push;
            s[9 * j + 3 + k] -= light(j) * push;
            s[9 * i + 6 + k] += light(i) * twist;
            s[9 * j + 6 + k] += light(j) * twist;
        }
        down[i] -= f[2] - F * now.n[2];
        down[j] += f[2] - F * now.n[2];
    }
    for (std::size_t b = 0; b < c_.balls(); ++b)
        if (aloft(b)) s[9 * b + 5] -= law_.gravity;
    for (std::size_t b = 0; b < c_.balls() && c_.held; ++b) {
        s[9 * b + 5] = 0.0;
        if (!touched(b)) continue;
        const double sign = law_.published_slip_sign ? -1.0 : 1.0;
        const double x = y[9 * b + 3] - sign * y[9 * b + 7], z = y[9 * b + 4] + sign * y[9 * b + 6];
        const double k = light(b) * law_.mu_s * std::max(down[b], 0.0) /
                         std::sqrt(x * x + z * z + law_.epsilon * law_.epsilon);
        if (law_.slide > 0.0) {
            const double u[2] = {y[9 * b + 3] - y[9 * b + 7], y[9 * b + 4] + y[9 * b + 6]};
            const double sharp = kernel::kWeightSlip * law_.slide,
                         weight = law_.slide / std::sqrt(u[0] * u[0] + u[1] * u[1] + sharp * sharp);
            s[9 * b + 3] -= weight * u[0];
            s[9 * b + 4] -= weight * u[1];
            s[9 * b + 6] -= 2.5 * weight * u[1];
            s[9 * b + 7] += 2.5 * weight * u[0];
        }
        s[9 * b + 3] -= k * x;
        s[9 * b + 4] -= k * z;
        s[9 * b + 6] -= 2.5 * k * z;
        s[9 * b + 7] += 2.5 * k * x;
    }
    return s;
}
// Friction is not stiff in such short steps. A ball that nothing touches slides with constant deceleration
// until it rolls.
std::vector<double> ContactReference::advance(double h) const {
    const int parts = std::max(1, static_cast<int>(std::ceil(h / kShort)));
    std::vector<double> y = y_;
    for (int part = 0; part < parts; ++part) y = dormand_prince(y, h / parts);
    if (law_.slide > 0.0 && (c_.held || !c_.lies.empty()))
        for (std::size_t b = 0; b < c_.balls(); ++b)
            if (!touched(b) && !aloft(b)) glide(y, b, h);
    return y;
}

void ContactReference::glide(std::vector<double>& y, std::size_t ball, double h) const {
    const std::size_t b = 9 * ball;
    const double u[2] = {y_[b + 3] - y_[b + 7], y_[b + 4] + y_[b + 6]}, slip = std::hypot(u[0], u[1]);
    if (slip == 0.0) return;
    const double lasts = std::min(h, slip / (3.5 * law_.slide)), dv = law_.slide * lasts / slip;
    for (std::size_t k = 0; k < 2; ++k) {
        y[b + k] -= dv * (h - 0.5 * lasts) * u[k];
        y[b + 3 + k] -= dv * u[k];
    }
    y[b + 6] -= 2.5 * dv * u[1];
    y[b + 7] += 2.5 * dv * u[0];
}

// J. R. Dormand and P. J. Prince, J. Comp. Appl. Math. 6 (1980).
std::vector<double> ContactReference::dormand_prince(const std::vector<double>& y, double h) const {
    static constexpr double kNodes[6][6] = {
        {1.0 / 5.0},
        {3.0 / 40.0, 9.0 / 40.0},
        {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
        {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
        {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
        {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}};
    std::array<std::vector<double>, 6> k;
    std::vector<double> at = y;
    for (std::size_t stage = 0; stage < 6; ++stage) {
        k[stage] = slope(at);
        at = y;
        for (std::size_t n = 0; n <= stage; ++n)
            for (std::size_t m = 0; m < y.size(); ++m) at[m] += h * kNodes[stage][n] * k[n][m];
    }
    return at;
}

std::int64_t contact_phase(const ContactPhase& phase, const HertzLaw& law, double, double look_ahead,
                           double time_limit) noexcept {
    const auto balls = static_cast<std::size_t>(phase.balls),
               contacts = static_cast<std::size_t>(phase.contacts);
    Cluster cluster{
        {phase.motion, phase.motion + 6 * balls}, {phase.contact, phase.contact + contacts}, {}, phase.held};
    if (phase.inverse_mass != nullptr)
        cluster.inverse_mass.assign(phase.inverse_mass, phase.inverse_mass + balls);
    cluster.surfaces = phase.surfaces;
    if (phase.lies != nullptr) cluster.lies.assign(phase.lies, phase.lies + balls);
    ContactReference reference(cluster, law);
    const double time = reference.run_to_end(look_ahead, time_limit);
    if (time < 0.0) return -1;
    // Emscripten's library has no std::ranges::copy.
    const auto motion = reference.motion(), moved = reference.moved();
    std::copy(motion.begin(), motion.end(), phase.motion);
    if (phase.moved != nullptr) std::copy(moved.begin(), moved.end(), phase.moved);
    if (phase.time != nullptr) *phase.time = time;
    return static_cast<std::int64_t>(6.0 * time / kShort);
}

}  // namespace carom::reference
