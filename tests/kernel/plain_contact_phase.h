// A plain program for the equations of the contact phase (docs/reference/physics.md, several contacts at
// once); every instruction set must match it bit for bit.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "carom/kernel/contact_phase.h"

namespace carom::kernel {
namespace {

constexpr double kLookAhead = 2.0, kTimeLimit = 2000.0;

struct Cluster {
    std::vector<double> motion;
    std::vector<HertzContact> contacts;
    double curvature = 0.0;

    int balls() const { return static_cast<int>(motion.size() / 5); }
};

struct Direction {
    double x, y;
};

Direction turned(const Direction& n, double along, double across) {
    const double x = n.x * along - n.y * across, y = n.y * along + n.x * across,
                 length = std::sqrt(x * x + y * y);
    return {x / length, y / length};
}

double falling(double x, double from, double to) {
    if (x <= from) return 1.0;
    if (x >= to) return 0.0;
    const double t = (x - from) / (to - from);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

// The equations one contact at a time, in the order that contact_phase.h promises.
class Plain {
  public:
    Plain(const Cluster& c, const HertzLaw& law)
        : start_(c.contacts),
          law_(law),
          curvature_(c.curvature),
          ahead_(static_cast<std::size_t>(c.balls()), 0.0),
          y(c.motion),
          moved(2 * ahead_.size(), 0.0) {
        for (const HertzContact& one : start_)
            contacts_.push_back({one.overlap, 0.0, {one.nx, one.ny}, 0.0, one.turn, false});
        look();
    }

    long run(double longest_step) {
        next_ = longest_step;
        for (long steps = 1; time < kTimeLimit; ++steps) {
            time += step(settle(longest_step * slowness()), longest_step / 64.0);
            if (pressed(kTimeLimit - time)) continue;
            const double flight = next_touch();
            if (!(flight < kLookAhead)) return steps;
            if (overlapping()) continue;
            if (time > 40.0) return steps;
            fly(flight);
            time += flight;
        }
        return -1;
    }

  private:
    struct Contact {
        double d, memory;
        Direction n;
        double turn;   // angle per unit of time
        double share;  // of the turning while closed
        bool closed;
    };
    const std::vector<HertzContact> start_;
    std::vector<Contact> contacts_;
    const HertzLaw law_;
    const double curvature_;
    double next_ = 0.0;          // the longest step permitted by the last error
    std::vector<double> ahead_;  // each ball's vertical impulse whose cloth friction is already applied

  public:
    std::vector<double> y;
    std::vector<double> moved;  // displacements, as of ContactPhase
    double time = 0.0;
    std::set<std::size_t> stages;  // of the steps with friction

  private:
    struct Slope {
        std::vector<double> y, d, lift, limit;
    };

    Direction closing(const std::vector<double>& at, std::size_t c) const {
        const double *i = &at[5 * static_cast<std::size_t>(start_[c].i)],
                     *j = &at[5 * static_cast<std::size_t>(start_[c].j)];
        return {i[0] - j[0], i[1] - j[1]};
    }

    double rate(const std::vector<double>& at, std::size_t c, const Direction& n) const {
        const Direction v = closing(at, c);
        return v.x * n.x + v.y * n.y;
    }
    double rate(std::size_t c) const { return rate(y, c, contacts_[c].n); }

    double turning(std::size_t c, const Direction& n) const {
        const Contact& contact = contacts_[c];
        const Direction v = closing(y, c);
        const double bend = contact.closed ? contact.share * curvature_ : curvature_;
        return bend * (v.x * n.y - v.y * n.x) / (1.0 - curvature_ * contact.d);
    }

    void look() {
        for (std::size_t c = 0; c < contacts_.size(); ++c) contacts_[c].turn = turning(c, contacts_[c].n);
    }

    bool overlapping() const {
        return std::any_of(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.d > 0.0; });
    }

    // Whether a contact can change a speed by more than 1e-12 V.
    bool pressed(double time_left) const {
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            const double d = contacts_[c].d, opens = -rate(c);
            if (!(d > 0.0)) continue;
            const double F = force(contacts_[c], d);
            if (opens < -1e-12 || (F * time_left > 1e-12 && F * d > opens * 1e-12)) return true;
        }
        return false;
    }

    struct Way {
        double closing, across, speed2, gap;
    };

    Way way(std::size_t c, const Direction& n, double gap) const {
        const Direction v = closing(y, c);
        const double along = v.x * n.x + v.y * n.y, across = v.y * n.x - v.x * n.y;
        return {along, across, along * along + across * across, gap};
    }

    double touch(const Way& w) const {
        if (!(w.closing > 0.0)) return 1e300;
        const double apart = 1.0 + curvature_ * w.gap, q = w.gap * (2.0 + curvature_ * w.gap),
                     c = apart * w.closing, root2 = c * c - curvature_ * w.speed2 * q;
        return root2 < 0.0 ? 1e300 : q / (c + std::sqrt(root2));
    }

    Direction after(const Direction& n, const Way& w, double in) const {
        return turned(n, 1.0 + curvature_ * w.gap - curvature_ * w.closing * in, -curvature_ * w.across * in);
    }

    double next_touch() const {
        double first = 1e300;
        for (std::size_t c = 0; c < contacts_.size(); ++c)
            first = std::min(first, touch(way(c, contacts_[c].n, -contacts_[c].d)));
        return first;
    }

    void fly(double duration) {
        const double less = 1.0 - falling(duration, 0.5 * kLookAhead, kLookAhead);
        for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += duration * y[n / 2 * 5 + n % 2];
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            Contact& contact = contacts_[c];
            const Way w = way(c, contact.n, -contact.d);
            const double late = touch(w) - duration, apart = 1.0 + curvature_ * w.gap,
                         change = duration * (curvature_ * w.speed2 * duration - 2.0 * apart * w.closing);
            contact.d =
                std::min(0.0, -(w.gap + change / (std::sqrt(apart * apart + curvature_ * change) + apart)));
            if (late <= 0.0) contact.d = 0.0;
            contact.n = after(contact.n, w, duration);
            contact.share = start_[c].turn * (1.0 - less * falling(late, 0.0, 0.5));
            contact.closed = false;
        }
        look();
    }

    double settle(double longest) {
        double h = longest;
        bool changed = false;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            Contact& contact = contacts_[c];
            if (!(contact.share < 1.0) || curvature_ == 0.0) continue;
            if (contact.closed && (contact.d > 0.0 || rate(c) > 0.0)) continue;
            const bool open = !(contact.d > 0.0);
            const double in = open && !contact.closed ? touch(way(c, contact.n, -contact.d)) : 0.0;
            if (in > 1e-3 * longest) {
                h = std::min(h, in);
                continue;
            }
            changed = true;
            contact.closed = !contact.closed;
            if (contact.closed) close(c, in);
        }
        if (changed) look();
        return h;
    }

    void close(std::size_t c, double in) {
        Contact& contact = contacts_[c];
        const Direction own = after(contact.n, way(c, contact.n, std::max(0.0, -contact.d)), in),
                        first{start_[c].nx, start_[c].ny};
        const Way since = way(c, first, -start_[c].overlap);
        double met = touch(since);
        if (!(met < 1e300))
            met = since.closing > 0.0 && curvature_ > 0.0
                      ? (1.0 + curvature_ * since.gap) * since.closing / (curvature_ * since.speed2)
                      : 0.0;
        const Direction other = after(first, since, met);
        const double share = start_[c].turn, x = share * own.x + (1.0 - share) * other.x,
                     y_ = share * own.y + (1.0 - share) * other.y, length = std::sqrt(x * x + y_ * y_);
        contact.n = {x / length, y_ / length};
    }

    double force(const Contact& contact, double d) const {
        double share = d * (1.0 / contact.memory);
        if (!(share < 1.0)) return d * std::sqrt(d);
        for (int p = law_.p; p > 1; p /= 2) share *= share;
        return d * std::sqrt(d) * (law_.a + law_.b * share);
    }

    void push(const std::vector<double>& at, double d, std::size_t c, double nx, double ny,
              Slope& slope) const {
        const auto i = static_cast<std::size_t>(start_[c].i), j = static_cast<std::size_t>(start_[c].j);
        const double *yi = &at[5 * i], *yj = &at[5 * j];
        const double F = force(contacts_[c], d);
        const double sx = (yi[0] - yj[0]) * ny - (yi[1] - yj[1]) * nx - (yi[4] + yj[4]);
        const double sz = (yi[2] + yj[2]) * ny - (yi[3] + yj[3]) * nx;
        const double slip2 = sx * sx + sz * sz + law_.epsilon * law_.epsilon, slip = std::sqrt(slip2);
        const double mu = law_.mu_b_more > 0.0
                              ? law_.mu_b + law_.mu_b_more * falling_exponential(law_.mu_b_fall * slip)
                              : law_.mu_b;
        const double k = -mu * F / slip2 * slip;
        const double fx = k * sx, fz = k * sz;
        const double pushed[2] = {fx * ny - F * nx, -F * ny - fx * nx};
        const double torque[3] = {2.5 * fz * ny, -2.5 * fz * nx, -2.5 * fx};
        for (int n = 0; n < 2; ++n) {
            slope.y[5 * i + n] += pushed[n];
            slope.y[5 * j + n] -= pushed[n];
        }
        for (int n = 0; n < 3; ++n) {
            slope.y[5 * i + 2 + n] += torque[n];
            slope.y[5 * j + 2 + n] += torque[n];
        }
        slope.lift[i] += fz;
        slope.lift[j] -= fz;
        slope.limit[i] += k;
        slope.limit[j] += k;
    }

    /// e^-x by the kernel's series, with the same bits.
    static double falling_exponential(double x) {
        const double t = std::min(x / 64.0, 1.0);
        double power = 1.0 / 720.0;
        for (const double factor : {-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0})
            power = power * t + factor;
        EXPECT_NEAR(power, std::exp(-t), 2e-4);
        for (int doubling = 0; doubling < 6; ++doubling) power *= power;
        EXPECT_TRUE(x > 10.0 || std::abs(power - std::exp(-x)) < 4e-8 * std::exp(-x)) << x;
        return power;
    }

    // The slope of a state after its normals have turned for the time `in`.
    Slope slope_at(const std::vector<double>& at, const std::vector<double>& d, double in) const {
        const std::size_t balls = y.size() / 5;
        Slope s{std::vector<double>(y.size(), 0.0),
                {},
                std::vector<double>(balls, 0.0),
                std::vector<double>(balls, 0.0)};
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            const Direction n = predicted(c, in);
            s.d.push_back(rate(at, c, n));
            if (d[c] > 0.0) push(at, d[c], c, n.x, n.y, s);
        }
        return s;
    }

    Direction predicted(std::size_t c, double in) const {
        const Direction n = contacts_[c].n;
        const double angle = in * contacts_[c].turn;
        return {n.x - angle * n.y, n.y + angle * n.x};
    }

    // Applies the cloth's friction after a step: for half of the step's vertical impulse, `past`, plus half a
    // step of its last vertical force, `next`, less the impulse counted ahead.
    void drag(std::size_t b, double past, double next) {
        past = std::min(past, 0.0);
        next = std::min(next, 0.0);
        const double wanted = (past - ahead_[b]) + next, pressed = law_.mu_s * std::min(wanted, 0.0);
        ahead_[b] = wanted < 0.0 ? next : ahead_[b] - past;
        const double sign = law_.published_slip_sign ? 1.0 : -1.0;
        double* ball = &y[5 * b];
        const double ux = ball[0] + sign * ball[3], uy = ball[1] - sign * ball[2];
        const double slip2 = ux * ux + uy * uy, epsilon2 = law_.epsilon * law_.epsilon,
                     slip = std::sqrt(slip2 + epsilon2), half = slip / (slip - 1.75 * pressed);
        const double k = pressed / (std::sqrt(half * half * slip2 + epsilon2) - 1.75 * pressed);
        ball[0] += k * ux;
        ball[1] += k * uy;
        ball[2] += 2.5 * k * uy;
        ball[3] -= 2.5 * k * ux;
    }

    static double step_after(double before, double h, double error) {
        if (error <= 0.5e-4 / 16.0) return std::max(before, 2.0 * h);
        const double ratio = std::sqrt(std::sqrt(0.5e-4 / error));
        return ratio > 1.0 ? std::max(before, ratio * h) : std::max(0.5, ratio) * h;
    }

    bool has_friction() const { return law_.mu_b > 0.0 || law_.mu_b_more > 0.0; }

    // Factor by which steps may be longer if everything is slow.
    double slowness() const {
        double fastest = 0.0;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            Contact contact = contacts_[c];
            const double closes = rate(c);
            if (closes <= 0.0 && contact.d <= 0.0) continue;
            if (closes > 0.0) contact.memory = 0.0;
            const double energy = contact.d > 0.0 ? contact.d * force(contact, contact.d) : 0.0;
            fastest = std::max(fastest, closes * closes + energy);
        }
        return fastest < 1.0 ? std::min(16.0, 1.0 / std::sqrt(std::sqrt(fastest))) : 1.0;
    }

    double step(double longest, double shortest) {
        std::array<Slope, 4> k;
        std::vector<double> now;
        for (const Contact& contact : contacts_) now.push_back(contact.d);
        k[0] = slope_at(y, now, 0.0);
        double least = 0.0;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            if (now[c] > 0.0)
                least = std::min(least, k[0].limit[static_cast<std::size_t>(start_[c].i)] +
                                            k[0].limit[static_cast<std::size_t>(start_[c].j)]);
        }
        if (has_friction()) longest = std::min(longest, next_);
        // The classical method if nothing is stiff, otherwise Simpson's weights at 0, 1/2 and 1, and a node
        // below 1/2 with weight 0.
        const bool stiff = has_friction();
        const std::array<double, 4> weight = {1.0 / 6.0, stiff ? 0.0 : 1.0 / 3.0,
                                              stiff ? 2.0 / 3.0 : 1.0 / 3.0, 1.0 / 6.0};
        double h = longest;
        std::vector<bool> watched;  // contacts that may close within the step
        for (;; h *= 0.5) {
            // Four, six or eight stages.
            std::vector<double> inner = {stiff ? 0.25 : 0.5};
            if (stiff) {
                double reach = 4.8 / 3.5;
                if (1.5 * (4.8 / 3.5) < h * -least)
                    reach = 12.2 / 3.5, inner = {0.03309011, 0.09856416, 0.25};
                if (8.0 / 6.0 * (12.2 / 3.5) < h * -least)
                    reach = 24.0 / 3.5, inner = {0.01115974, 0.02860386, 0.05848906, 0.1168041, 0.25};
                if (reach < h * -least) h = reach / -least;
                stages.insert(inner.size() + 3);
            }
            for (std::size_t c = watched.size(); c < now.size(); ++c)
                watched.push_back(-now[c] < h * (std::max(k[0].d[c], 0.0) + h));
            const auto slope_after = [&](const Slope& before, double node) {
                std::vector<double> at = y, d = now;
                for (std::size_t n = 0; n < at.size(); ++n) at[n] += h * node * before.y[n];
                for (std::size_t c = 0; c < d.size(); ++c)
                    if (watched[c]) d[c] += h * node * before.d[c];
                return slope_at(at, d, h * node);
            };
            k[1] = k[0];
            for (const double node : inner) k[1] = slope_after(k[1], node);
            k[2] = slope_after(k[1], 0.5);
            k[3] = slope_after(k[2], 1.0);
            if (!stiff) break;
            double error = 0.0;
            for (std::size_t n = 0; n < y.size(); ++n)
                error = std::max(error, std::abs((k[0].y[n] + k[3].y[n]) - 2.0 * k[2].y[n]));
            error *= h / 6.0;
            next_ = step_after(next_, h, error);
            if (error <= 1e-4 || h <= shortest) break;
        }
        const auto mean = [&](double k0, double k1, double k2, double k3) {
            return (h * weight[0] * k0 + h * weight[1] * k1) + (h * weight[2] * k2 + h * weight[3] * k3);
        };
        const std::vector<double> before = y;
        for (std::size_t n = 0; n < y.size(); ++n) y[n] += mean(k[0].y[n], k[1].y[n], k[2].y[n], k[3].y[n]);
        for (std::size_t n = 0; n < moved.size(); ++n)
            moved[n] += 0.5 * h * (before[n / 2 * 5 + n % 2] + y[n / 2 * 5 + n % 2]);
        for (std::size_t b = 0; b < ahead_.size(); ++b)
            drag(b, mean(k[0].lift[b], k[1].lift[b], k[2].lift[b], k[3].lift[b]), 0.5 * h * k[3].lift[b]);
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            Contact& contact = contacts_[c];
            const Direction n = predicted(c, h);
            contact.d += watched[c] ? mean(k[0].d[c], k[1].d[c], k[2].d[c], k[3].d[c])
                                    : 0.5 * h * (k[0].d[c] + rate(y, c, n));
            remember(contact, now[c], h * k[0].d[c], h * rate(y, c, n));
            const double turn = turning(c, n), angle = 0.5 * h * (contact.turn + turn),
                         half = 0.5 * (angle * angle), shrink = 1.0 - half * (1.0 - 1.5 * half);
            contact.n = {(contact.n.x - angle * contact.n.y) * shrink,
                         (contact.n.y + angle * contact.n.x) * shrink};
            contact.turn = turn;
        }
        return h;
    }

    static void remember(Contact& contact, double before, double m0, double m1) {
        if (!(contact.d > 0.0)) {
            contact.memory = 0.0;
            return;
        }
        contact.memory = std::max(contact.memory, contact.d);
        if (!(m0 > 0.0 && m1 < 0.0)) return;
        const double rise = contact.d - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
        const double s = m0 / (std::sqrt(std::max(0.0, q2 * q2 - 3.0 * q3 * m0)) - q2);
        if (s > 0.0 && s < 1.0)
            contact.memory = std::max(contact.memory, before + s * (m0 + s * (q2 + s * q3)));
    }
};

}  // namespace
}  // namespace carom::kernel
