// The equations of the contact phase (docs/reference/physics.md, several contacts at once), one contact at a time,
// by another method: Dormand-Prince's order 5 with short steps whose ends are the events, located by bisection.
// Phases of contacts do not change within a step. It shares no code with the kernel and is slow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/kernel/contact_phase.h"

namespace carom::kernel {

struct Cluster {
    std::vector<double> motion;  // six numbers per ball
    std::vector<HertzContact> contacts;
    std::vector<double> inverse_mass;  // empty: all 1
    bool held = true;

    std::size_t balls() const { return motion.size() / 6; }
};

class ContactReference {
  public:
    ContactReference(const Cluster& c, const HertzLaw& law) : c_(c), law_(law), y_(9 * c.balls(), 0.0) {
        for (std::size_t b = 0; b < c.balls(); ++b)
            for (std::size_t k = 0; k < 6; ++k) y_[9 * b + 3 + k] = c.motion[6 * b + k];
        contacts_.resize(c.contacts.size());
        for (std::size_t n = 0; n < contacts_.size(); ++n) {
            const Now now = look(y_, n);
            if (now.d >= 0.0 && now.rate > 0.0) contacts_[n].phase = Phase::kLoading;
        }
    }

    /// Integrates for a time [L/V] in steps of at most `step`.
    void run(double time, double step = 0.01) {
        while (time > 1e-12) {
            double h = std::min(step, time);
            std::vector<double> after = advance(h);
            if (first_event(after) >= 0) {
                // The shortest step after which something has happened.
                double low = 0.0;
                while (h - low > 1e-13) {
                    const double middle = 0.5 * (low + h);
                    after = advance(middle);
                    (first_event(after) >= 0 ? h : low) = middle;
                }
                after = advance(h);
            }
            y_ = after;
            time -= h;
            for (std::size_t n = 0; n < contacts_.size(); ++n) change(n);
        }
    }

    std::vector<double> motion() const { return part(3, 6); }
    std::vector<double> moved() const { return part(0, 3); }

  private:
    enum class Phase { kOpen, kLoading, kUnloading };
    struct Contact {
        Phase phase = Phase::kOpen;
        double most = 0.0;
    };
    struct Now {
        std::array<double, 3> n;
        double d, rate;
    };

    std::vector<double> part(std::size_t first, std::size_t count) const {
        std::vector<double> out;
        for (std::size_t b = 0; b < c_.balls(); ++b)
            for (std::size_t k = 0; k < count; ++k) out.push_back(y_[9 * b + first + k]);
        return out;
    }

    Now look(const std::vector<double>& y, std::size_t number) const {
        const HertzContact& contact = c_.contacts[number];
        const std::size_t i = 9 * static_cast<std::size_t>(contact.i), j = 9 * static_cast<std::size_t>(contact.j);
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

    // What would change at y: the first such contact, or -1.
    int first_event(const std::vector<double>& y) const {
        for (std::size_t n = 0; n < contacts_.size(); ++n)
            if (next_phase(look(y, n), contacts_[n]) != contacts_[n].phase) return static_cast<int>(n);
        return -1;
    }
    static Phase next_phase(const Now& now, const Contact& contact) {
        switch (contact.phase) {
            case Phase::kOpen:
                return now.d > 0.0 ? Phase::kLoading : Phase::kOpen;
            case Phase::kLoading:
                return now.rate < 0.0 ? Phase::kUnloading : Phase::kLoading;
            default:
                return !(now.d > 0.0) ? Phase::kOpen
                       : now.d > contact.most && now.rate > 0.0 ? Phase::kLoading : Phase::kUnloading;
        }
    }
    void change(std::size_t n) {
        Contact& contact = contacts_[n];
        const Now now = look(y_, n);
        const Phase next = next_phase(now, contact);
        if (next == Phase::kUnloading && contact.phase == Phase::kLoading) contact.most = now.d;
        if (next == Phase::kOpen) contact.most = 0.0;
        contact.phase = next;
    }

    std::vector<double> slope(const std::vector<double>& y) const {
        std::vector<double> s(y.size(), 0.0), down(c_.balls(), 0.0);
        for (std::size_t b = 0; b < c_.balls(); ++b)
            for (std::size_t k = 0; k < 3; ++k) s[9 * b + k] = y[9 * b + 3 + k];
        for (std::size_t number = 0; number < contacts_.size(); ++number) {
            const Contact& contact = contacts_[number];
            const Now now = look(y, number);
            if (contact.phase == Phase::kOpen || !(now.d > 0.0)) continue;
            double F = c_.contacts[number].stiffness * std::pow(now.d, 1.5);
            if (contact.phase == Phase::kUnloading)
                F *= law_.a + law_.b * std::pow(now.d / contact.most, law_.p);
            const auto i = static_cast<std::size_t>(c_.contacts[number].i),
                       j = static_cast<std::size_t>(c_.contacts[number].j);
            std::array<double, 3> slip{}, w{}, f{};
            double square = law_.epsilon * law_.epsilon;
            for (std::size_t k = 0; k < 3; ++k) w[k] = y[9 * i + 6 + k] + y[9 * j + 6 + k];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
                slip[k] = y[9 * i + 3 + k] - y[9 * j + 3 + k] - now.rate * now.n[k] + w[l] * now.n[m] -
                          w[m] * now.n[l];
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
        for (std::size_t b = 0; b < c_.balls() && c_.held; ++b) {
            s[9 * b + 5] = 0.0;
            const double sign = law_.published_slip_sign ? -1.0 : 1.0;
            const double x = y[9 * b + 3] - sign * y[9 * b + 7], z = y[9 * b + 4] + sign * y[9 * b + 6];
            const double k = light(b) * law_.mu_s * std::max(down[b], 0.0) /
                             std::sqrt(x * x + z * z + law_.epsilon * law_.epsilon);
            s[9 * b + 3] -= k * x;
            s[9 * b + 4] -= k * z;
            s[9 * b + 6] -= 2.5 * k * z;
            s[9 * b + 7] += 2.5 * k * x;
        }
        return s;
    }
    double light(std::size_t b) const { return c_.inverse_mass.empty() ? 1.0 : c_.inverse_mass[b]; }

    // One step of J. R. Dormand and P. J. Prince, J. Comp. Appl. Math. 6 (1980), in halves so short that friction is
    // not stiff.
    std::vector<double> advance(double h) const {
        const int parts = std::max(1, static_cast<int>(std::ceil(h / 1e-3)));
        std::vector<double> y = y_;
        for (int part = 0; part < parts; ++part) y = dormand_prince(y, h / parts);
        return y;
    }
    std::vector<double> dormand_prince(const std::vector<double>& y, double h) const {
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

    const Cluster& c_;
    const HertzLaw law_;
    std::vector<double> y_;
    std::vector<Contact> contacts_;
};

}  // namespace carom::kernel
