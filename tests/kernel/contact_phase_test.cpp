// The contact phase of a cluster: every instruction set against a plain program for the same equations, bit
// for bit; its step rule against tiny steps; where it stops.
#include "carom/kernel/contact_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "reference/random_impacts.h"

namespace carom::kernel {
namespace {

using reference::Generator;

constexpr double kLookAhead = 2.0, kTimeLimit = 2000.0;

struct Cluster {
    std::vector<double> motion;
    std::vector<HertzContact> contacts;

    int balls() const { return static_cast<int>(motion.size() / 5); }
};

HertzLaw pool_law(double epsilon = 2e-3) {
    const double b = (1.0 - 0.95 * 0.95) * 0.4 / (0.4 - 1.0 / 3.5);
    return {1.0 - b, b, 1, 0.05, 0.2, epsilon, false};
}

long run(Isa isa, Cluster& c, const HertzLaw& law, double longest_step, double look_ahead = kLookAhead,
         double time_limit = kTimeLimit) {
    const int contacts = static_cast<int>(c.contacts.size());
    // Guards behind the scratch memory.
    std::vector<double> numbers(contact_phase_numbers(c.balls(), contacts) + 1, 7.0);
    std::vector<int> places(contact_phase_places(contacts) + 1, 7);
    const ContactPhase phase{c.balls(),         contacts,       c.motion.data(),
                             c.contacts.data(), numbers.data(), places.data()};
    const long steps = contact_phase_function(isa)(phase, law, longest_step, look_ahead, time_limit);
    EXPECT_EQ(numbers.back(), 7.0);
    EXPECT_EQ(places.back(), 7);
    return steps;
}

// The equations one contact at a time, in the order that contact_phase.h promises.
class Plain {
  public:
    Plain(const Cluster& c, const HertzLaw& law)
        : contacts_(c.contacts), law_(law), y(c.motion), memory_(contacts_.size(), 0.0) {
        for (const HertzContact& contact : contacts_) d_.push_back(contact.overlap);
    }

    long run(double longest_step) {
        double time = 0.0;
        for (long steps = 1; time < kTimeLimit; ++steps) {
            time += step(longest_step);
            if (finished()) return steps;
        }
        return -1;
    }

  private:
    const std::vector<HertzContact> contacts_;
    const HertzLaw law_;

  public:
    std::vector<double> y;

  private:
    struct Slope {
        std::vector<double> y, d, lift, limit;
    };

    double rate(const std::vector<double>& at, std::size_t c) const {
        const double *i = &at[5 * static_cast<std::size_t>(contacts_[c].i)],
                     *j = &at[5 * static_cast<std::size_t>(contacts_[c].j)];
        return (i[0] - j[0]) * contacts_[c].nx + (i[1] - j[1]) * contacts_[c].ny;
    }

    void contact(const std::vector<double>& at, double d, std::size_t c, Slope& slope) const {
        const double nx = contacts_[c].nx, ny = contacts_[c].ny;
        const auto i = static_cast<std::size_t>(contacts_[c].i), j = static_cast<std::size_t>(contacts_[c].j);
        const double *yi = &at[5 * i], *yj = &at[5 * j];
        double F = d * std::sqrt(d);
        if (d < memory_[c]) {
            double share = d / memory_[c];
            for (int p = law_.p; p > 1; p /= 2) share *= share;
            F *= law_.a + law_.b * share;
        }
        const double sx = (yi[0] - yj[0]) * ny - (yi[1] - yj[1]) * nx - (yi[4] + yj[4]);
        const double sz = (yi[2] + yj[2]) * ny - (yi[3] + yj[3]) * nx;
        const double slip = std::sqrt(sx * sx + sz * sz + law_.epsilon * law_.epsilon);
        const double mu =
            law_.mu_b_more > 0.0 ? law_.mu_b + law_.mu_b_more * falling(law_.mu_b_fall * slip) : law_.mu_b;
        const double k = -mu * F / slip;
        const double fx = k * sx, fz = k * sz;
        const double push[2] = {fx * ny - F * nx, -F * ny - fx * nx};
        const double torque[3] = {2.5 * fz * ny, -2.5 * fz * nx, -2.5 * fx};
        for (int n = 0; n < 2; ++n) {
            slope.y[5 * i + n] += push[n];
            slope.y[5 * j + n] -= push[n];
        }
        for (int n = 0; n < 3; ++n) {
            slope.y[5 * i + 2 + n] += torque[n];
            slope.y[5 * j + 2 + n] += torque[n];
        }
        slope.lift[i] += fz;
        slope.lift[j] -= fz;
        const double limit = std::max(8.0 * k, -(law_.mu_b + law_.mu_b_more) / law_.epsilon * F);
        slope.limit[i] += limit;
        slope.limit[j] += limit;
    }

    /// e^-x by the series of the kernel, whose bits it has.
    static double falling(double x) {
        const double t = std::min(x / 64.0, 1.0);
        double power = 1.0 / 720.0;
        for (const double factor : {-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0})
            power = power * t + factor;
        EXPECT_NEAR(power, std::exp(-t), 2e-4);
        for (int doubling = 0; doubling < 6; ++doubling) power *= power;
        EXPECT_TRUE(x > 10.0 || std::abs(power - std::exp(-x)) < 4e-8 * std::exp(-x)) << x;
        return power;
    }

    Slope slope_at(const std::vector<double>& at, const std::vector<double>& d) const {
        const std::size_t balls = y.size() / 5;
        Slope s{std::vector<double>(y.size(), 0.0),
                {},
                std::vector<double>(balls, 0.0),
                std::vector<double>(balls, 0.0)};
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            s.d.push_back(rate(at, c));
            if (d[c] > 0.0) contact(at, d[c], c, s);
        }
        const double sign = law_.published_slip_sign ? 1.0 : -1.0;
        for (std::size_t b = 0; b < balls; ++b) {
            if (!(s.lift[b] < 0.0)) continue;
            const double ux = at[5 * b] + sign * at[5 * b + 3], uy = at[5 * b + 1] - sign * at[5 * b + 2];
            const double k =
                law_.mu_s * s.lift[b] / std::sqrt(ux * ux + uy * uy + law_.epsilon * law_.epsilon);
            s.y[5 * b] += k * ux;
            s.y[5 * b + 1] += k * uy;
            s.y[5 * b + 2] += 2.5 * k * uy;
            s.y[5 * b + 3] -= 2.5 * k * ux;
            s.limit[b] += 0.5 * k;
        }
        return s;
    }

    double step(double longest) {
        std::array<Slope, 4> k;
        k[0] = slope_at(y, d_);
        const double least = *std::min_element(k[0].limit.begin(), k[0].limit.end());
        const double h = 2.0 / 7.0 < longest * -least ? 2.0 / 7.0 / -least : longest;
        const double share[4] = {0.0, 0.5 * h, 0.5 * h, h};
        for (std::size_t stage = 1; stage < 4; ++stage) {
            std::vector<double> at = y, d = d_;
            for (std::size_t n = 0; n < at.size(); ++n) at[n] += share[stage] * k[stage - 1].y[n];
            for (std::size_t c = 0; c < d.size(); ++c) d[c] += share[stage] * k[stage - 1].d[c];
            k[stage] = slope_at(at, d);
        }
        for (std::size_t n = 0; n < y.size(); ++n)
            y[n] += h / 6.0 * ((k[0].y[n] + k[3].y[n]) + 2.0 * (k[1].y[n] + k[2].y[n]));
        for (std::size_t c = 0; c < d_.size(); ++c) {
            const double before = d_[c];
            d_[c] += h / 6.0 * ((k[0].d[c] + k[3].d[c]) + 2.0 * (k[1].d[c] + k[2].d[c]));
            remember(c, before, h * k[0].d[c], h * rate(y, c));
        }
        return h;
    }

    void remember(std::size_t c, double before, double m0, double m1) {
        if (!(d_[c] > 0.0)) {
            memory_[c] = 0.0;
            return;
        }
        memory_[c] = std::max(memory_[c], d_[c]);
        if (!(m0 > 0.0 && m1 < 0.0)) return;
        const double rise = d_[c] - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
        const double s = m0 / (std::sqrt(std::max(0.0, q2 * q2 - 3.0 * q3 * m0)) - q2);
        if (s > 0.0 && s < 1.0) memory_[c] = std::max(memory_[c], before + s * (m0 + s * (q2 + s * q3)));
    }

    bool finished() const {
        for (std::size_t c = 0; c < d_.size(); ++c) {
            const double closing = rate(y, c);
            if (d_[c] > 0.0 || (closing > 0.0 && -d_[c] < kLookAhead * closing)) return false;
        }
        return true;
    }

    std::vector<double> d_, memory_;
};

// Some balls of a triangular lattice, with small gaps, some of them 0; one runs into the others.
Cluster random_cluster(reference::Generator& rng) {
    Cluster c;
    std::vector<std::array<double, 2>> places;
    const double density = rng.uniform(0.3, 1.0);
    for (int row = 0; row < 5; ++row) {
        for (int k = 0; k < 4; ++k) {
            if (rng.uniform() < density) places.push_back({2.0 * k + row % 2, std::sqrt(3.0) * row});
        }
    }
    const double most = rng.uniform() < 0.3 ? 0.0 : rng.uniform(0.0, 0.5);
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = i + 1; j < places.size(); ++j) {
            const double x = places[j][0] - places[i][0], y = places[j][1] - places[i][1];
            const double distance = std::sqrt(x * x + y * y);
            if (distance < 2.1)
                c.contacts.push_back({static_cast<int>(i), static_cast<int>(j), x / distance, y / distance,
                                      -rng.uniform(0.0, most)});
        }
    }
    for (std::size_t b = 0; b < places.size(); ++b) {
        const double speed = b == 0 ? 1.0 : rng.uniform(0.0, 0.3);
        for (int n = 0; n < 5; ++n) c.motion.push_back(speed * rng.uniform(b == 0 ? 0.0 : -1.0, 1.0));
    }
    return c;
}

HertzLaw random_law(reference::Generator& rng) {
    const int p = 1 << static_cast<int>(rng.uniform(0.0, 4.0));
    const double b = rng.uniform();
    return {1.0 - b,
            b,
            p,
            rng.uniform() < 0.2 ? 0.0 : rng.uniform(0.0, 0.2),
            rng.uniform() < 0.3 ? 0.0 : rng.uniform(0.0, 0.5),
            rng.uniform(1e-3, 1e-2),
            rng.uniform() < 0.3,
            rng.uniform() < 0.5 ? 0.0 : rng.uniform(0.0, 0.2),
            rng.uniform(0.0, 20.0)};
}

TEST(ContactPhase, EveryInstructionSetIsThePlainProgram) {
    reference::Generator rng(3);
    std::set<std::size_t> sizes;
    for (int k = 0; k < 300; ++k) {
        const Cluster start = random_cluster(rng);
        const HertzLaw law = random_law(rng);
        sizes.insert(start.contacts.size());
        if (start.balls() == 0) continue;
        Plain plain(start, law);
        const long steps = plain.run(1.0 / 16.0);
        for (const Isa isa : {Isa::kScalar, Isa::kV3, Isa::kV4}) {
            if (!available(isa)) continue;
            Cluster c = start;
            EXPECT_EQ(run(isa, c, law, 1.0 / 16.0), steps) << "cluster " << k << " " << name(isa);
            EXPECT_EQ(c.motion, plain.y) << "cluster " << k << " " << name(isa);
        }
    }
    EXPECT_LE(*sizes.begin(), 2u);
    EXPECT_GE(*sizes.rbegin(), 40u);
    EXPECT_GE(sizes.size(), 25u) << "all ways to fill the last register";
}

// Two rows of a rack and the cue ball, with spin: slips that turn into stick.
Cluster small_rack() {
    const double h = std::sqrt(0.75);
    return {{0.1, 1.0, -0.6, 0.2, 0.3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
            {{0, 1, 0.0, 1.0, 0.0}, {1, 2, -0.5, h, 0.0}, {1, 3, 0.5, h, 0.0}, {2, 3, 1.0, 0.0, 0.0}}};
}

double difference(const Cluster& a, const Cluster& b) {
    double most = 0.0;
    for (std::size_t n = 0; n < a.motion.size(); ++n)
        most = std::max(most, std::abs(a.motion[n] - b.motion[n]));
    return most;
}

TEST(ContactPhase, StepsFollowTheFriction) {
    for (const double epsilon : {1e-2, 2e-3, 5e-4}) {
        for (const double V :
             {0.0, 0.3, 1.0, 10.0}) {  // [m/s] of the impact; 0: the same friction at every slip
            HertzLaw law = pool_law(epsilon);
            if (V > 0.0) law.mu_b = 0.009951, law.mu_b_more = 0.108, law.mu_b_fall = 1.088 * V;
            Cluster fine = small_rack(), coarse = small_rack();
            const long many = run(Isa::kScalar, fine, law, epsilon / 4.0),
                       few = run(Isa::kScalar, coarse, law, 1.0 / 16.0);
            EXPECT_LT(difference(fine, coarse), 1e-4) << epsilon << " " << V;
            EXPECT_LT(3 * few, many) << epsilon << " " << V;
        }
    }
}

// With a fit that does not fall, friction is one number.
TEST(ContactPhase, AFitThatDoesNotFallIsOneFriction) {
    HertzLaw one = pool_law(), fit = pool_law();
    fit.mu_b = 0.02;
    fit.mu_b_more = 0.03;
    Cluster a = small_rack(), b = small_rack();
    run(best_isa(), a, one, 1.0 / 16.0);
    run(best_isa(), b, fit, 1.0 / 16.0);
    EXPECT_LT(difference(a, b), 1e-15);
    EXPECT_GT(difference(a, small_rack()), 0.1);
}

TEST(ContactPhase, NeverGainsEnergy) {
    const auto energy = [](const Cluster& c) {
        double sum = 0.0;
        for (std::size_t n = 0; n < c.motion.size(); ++n)
            sum += (n % 5 < 2 ? 0.5 : 0.2) * c.motion[n] * c.motion[n];
        return sum;
    };
    reference::Generator rng(8);
    for (int k = 0; k < 200; ++k) {
        Cluster c = random_cluster(rng);
        if (c.contacts.empty()) continue;
        const double before = energy(c);
        ASSERT_GT(run(best_isa(), c, pool_law(), 1.0 / 16.0), 0);
        EXPECT_LE(energy(c), before) << k;
    }
}

// A contact lasts about 2.5 L/V. Nothing is computed after the last one, and nothing of one that comes later
// than the look-ahead.
TEST(ContactPhase, StopsWhenNothingCloses) {
    HertzLaw law = pool_law();
    law.mu_b = 0.0;
    const auto three = [](double gap) {
        return Cluster{{0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                       {{0, 1, 0.0, 1.0, 0.0}, {1, 2, 0.0, 1.0, -gap}}};
    };
    Cluster near = three(3.0), far = three(6.0);
    EXPECT_LE(run(best_isa(), far, law, 1.0 / 16.0), 41);
    EXPECT_EQ(far.motion[11], 0.0) << "comes in 4.8 L/V";
    EXPECT_GT(run(best_isa(), near, law, 1.0 / 16.0), 80);
    EXPECT_NEAR(near.motion[11], 0.950625, 1e-4) << "comes in 1.7 L/V";
}

TEST(ContactPhase, SaysWhenItsTimeIsOver) {
    Cluster c = small_rack();
    EXPECT_EQ(run(best_isa(), c, pool_law(), 1.0 / 16.0, kLookAhead, 1.0), -1);
}

}  // namespace
}  // namespace carom::kernel
