// A plain integration of balls in contact: Hertz springs with the unloading law of docs/reference/physics.md,
// friction with almost sharp stick, and everything moves, positions too. It shares no code with the kernel
// and is slow: the step is a two-thousandth of L/V. SI units.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace carom::test {

struct MovingBall {
    std::array<double, 3> x, v;  ///< [m], [m/s]
    std::array<double, 3> w;     ///< [rad/s]
};

struct MovingLaw {
    double R = 0.028575, stiffness = 4.736e9;  ///< [m], k/m [m^-0.5 s^-2]
    double mu_b = 0.05, mu_s = 0.2, e_b = 0.95;
    double mu_b_more = 0.0, mu_b_fall = 0.0;  ///< friction mu_b + more exp(-fall |slip|), slip in m/s
    double slip = 1e-4;                       ///< [V] regularisation of the friction
    double step = 5e-4;                       ///< [L/V]
    double look_ahead = 2.0;  ///< [L/V] run() ends when all are open and none touches within this time
    double weight = 0.0;      ///< [m/s^2] gravity, which presses all balls on the cloth
    double reach = 40.0;      ///< [L] pairs with a larger gap at the start never touch
    bool cloth = true;  ///< holds every ball, with friction under those pressed down; else they move in space
};

class MovingContacts {
  public:
    /// @param V  [m/s] scale of the step, of the regularisation and of the end
    MovingContacts(std::vector<MovingBall> balls, const MovingLaw& law, double V)
        : balls_(std::move(balls)), law_(law) {
        const double length = std::pow(V * V / law.stiffness, 0.4);
        unit_ = length / V;
        slip_ = law.slip * V;
        const double e2 = law.e_b * law.e_b;
        while (e2 < 2.5 / (2.5 + power_)) power_ *= 2.0;
        share_ = (1.0 - e2) * 0.4 / (0.4 - 1.0 / (2.5 + power_));
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            for (std::size_t j = i + 1; j < balls_.size(); ++j) {
                // A gap that is only the rounding of touching positions counts as 0.
                const double gap = distance(balls_[i], balls_[j]) - 2.0 * law.R;
                if (gap < law.reach * length) pairs_.push_back({i, j, 0.0, gap < 1e-13 ? gap : 0.0});
            }
        }
    }

    /// Runs to the end; returns the duration [s], or -1 if it exceeds 200 L/V.
    double run() {
        const double h = law_.step * unit_;
        double time = 0.0;
        for (; time < 200.0 * unit_; time += h) {
            step(h);
            const bool apart = all_open();
            if (apart && !apart_) ends_.push_back(balls_);
            apart_ = apart;
            if (apart && finished()) return time;
        }
        return -1.0;
    }

    /// Runs for a duration [s], and on until no contact is closed. @return the total duration
    double run_for(double duration) {
        const auto steps = static_cast<int>(std::ceil(duration / (law_.step * unit_)));
        const double h = duration / steps;
        int done = 0;
        for (; done < steps || !all_open(); ++done) step(h);
        return done * h;
    }

    const std::vector<MovingBall>& balls() const { return balls_; }
    /// The balls at every instant after which no two touch for a while.
    const std::vector<std::vector<MovingBall>>& ends() const { return ends_; }

  private:
    struct Pair {
        std::size_t i, j;
        double most;    // largest overlap since the pair opened
        double offset;  // [m] rounding at the start
    };

    static double distance(const MovingBall& a, const MovingBall& b) {
        return std::hypot(b.x[0] - a.x[0], b.x[1] - a.x[1], b.x[2] - a.x[2]);
    }

    double overlap(const std::vector<MovingBall>& at, const Pair& p) const {
        return 2.0 * law_.R + p.offset - distance(at[p.i], at[p.j]);
    }

    double force(double d, double most) const {
        const double loading = law_.stiffness * d * std::sqrt(d);
        return d < most ? loading * (1.0 - share_ + share_ * std::pow(d / most, power_)) : loading;
    }

    // x' = v, v' and w' of all balls.
    std::vector<MovingBall> slope(const std::vector<MovingBall>& at) const {
        std::vector<MovingBall> s(at.size());
        std::vector<double> up(at.size(), 0.0);
        for (std::size_t b = 0; b < at.size(); ++b) s[b] = {at[b].v, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
        const double R = law_.R;
        for (const Pair& p : pairs_) {
            const double d = overlap(at, p);
            if (d <= 0.0) continue;
            const MovingBall &a = at[p.i], &b = at[p.j];
            const double length = distance(a, b);
            std::array<double, 3> n{}, slip{}, spins{};
            double closing = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                n[k] = (b.x[k] - a.x[k]) / length;
                closing += (a.v[k] - b.v[k]) * n[k];
                spins[k] = R * (a.w[k] + b.w[k]);
            }
            const double F = force(d, p.most);
            double size = slip_ * slip_;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
                slip[k] = a.v[k] - b.v[k] - closing * n[k] + spins[l] * n[m] - spins[m] * n[l];
                size += slip[k] * slip[k];
            }
            size = std::sqrt(size);
            const double mu = law_.mu_b + law_.mu_b_more * std::exp(-law_.mu_b_fall * size);
            std::array<double, 3> f{};
            for (std::size_t k = 0; k < 3; ++k) f[k] = -mu * F * slip[k] / size;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
                const double push = f[k] - F * n[k], twist = 2.5 / R * (n[l] * f[m] - n[m] * f[l]);
                s[p.i].v[k] += push;
                s[p.j].v[k] -= push;
                s[p.i].w[k] += twist;
                s[p.j].w[k] += twist;
            }
        }
        if (!law_.cloth) return s;
        for (std::size_t b = 0; b < at.size(); ++b) {
            up[b] = s[b].v[2];
            s[b].v[2] = 0.0;
        }
        for (std::size_t b = 0; b < at.size(); ++b) {
            const double u[2] = {at[b].v[0] - R * at[b].w[1], at[b].v[1] + R * at[b].w[0]};
            const double u2 = u[0] * u[0] + u[1] * u[1], sharp = 0.02 * slip_;
            // The weight is small compared with the contacts, so its friction can stick more sharply.
            const double k = std::min(up[b], 0.0) / std::sqrt(u2 + slip_ * slip_) -
                             law_.weight / std::sqrt(u2 + sharp * sharp);
            const double f[2] = {law_.mu_s * k * u[0], law_.mu_s * k * u[1]};
            s[b].v[0] += f[0];
            s[b].v[1] += f[1];
            s[b].w[0] += 2.5 / R * f[1];
            s[b].w[1] -= 2.5 / R * f[0];
        }
        return s;
    }

    static void add(std::vector<MovingBall>& to, const std::vector<MovingBall>& slope, double h) {
        for (std::size_t b = 0; b < to.size(); ++b) {
            for (std::size_t k = 0; k < 3; ++k) {
                to[b].x[k] += h * slope[b].x[k];
                to[b].v[k] += h * slope[b].v[k];
                to[b].w[k] += h * slope[b].w[k];
            }
        }
    }

    void step(double h) {
        const std::vector<MovingBall> k1 = slope(balls_);
        std::vector<MovingBall> at = balls_;
        add(at, k1, 0.5 * h);
        const std::vector<MovingBall> k2 = slope(at);
        at = balls_;
        add(at, k2, 0.5 * h);
        const std::vector<MovingBall> k3 = slope(at);
        at = balls_;
        add(at, k3, h);
        const std::vector<MovingBall> k4 = slope(at);
        add(balls_, k1, h / 6.0);
        add(balls_, k2, h / 3.0);
        add(balls_, k3, h / 3.0);
        add(balls_, k4, h / 6.0);
        for (Pair& p : pairs_) {
            const double d = overlap(balls_, p);
            p.most = d > 0.0 ? std::max(p.most, d) : 0.0;
        }
    }

    bool all_open() const {
        return std::none_of(pairs_.begin(), pairs_.end(),
                            [this](const Pair& p) { return overlap(balls_, p) > 0.0; });
    }

    bool finished() const {
        for (const Pair& p : pairs_) {
            const MovingBall &a = balls_[p.i], &b = balls_[p.j];
            double speed2 = 0.0, approach = 0.0, apart2 = -4.0 * law_.R * law_.R;
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = b.x[k] - a.x[k], v = b.v[k] - a.v[k];
                speed2 += v * v;
                approach -= x * v;
                apart2 += x * x;
            }
            const double root2 = approach * approach - speed2 * apart2;
            if (approach > 0.0 && root2 > 0.0 &&
                apart2 < law_.look_ahead * unit_ * (approach + std::sqrt(root2)))
                return false;
        }
        return true;
    }

    std::vector<MovingBall> balls_;
    MovingLaw law_;
    std::vector<Pair> pairs_;
    std::vector<std::vector<MovingBall>> ends_;
    bool apart_ = false;
    double unit_, slip_, power_ = 1.0, share_;
};

}  // namespace carom::test
