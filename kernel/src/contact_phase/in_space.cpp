// The contact phase in space, one contact at a time: clusters with a flying ball are rare and small.
#include <cstdint>

#include "carom/kernel/contact_phase.h"
#include "contact_phase/law.h"
#include "numbers.h"

namespace carom::kernel {
namespace {

constexpr int kPerState = 9;   // numbers per ball in a state: displacement [L], v and R w [V]
constexpr int kPerMotion = 6;  // in ContactPhaseInSpace::motion: without the displacement
constexpr double kNever = 1e300;

struct Vector {
    double x, y, z;
};

Vector at(const double* from) {
    return {from[0], from[1], from[2]};
}
Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vector operator*(double s, const Vector& a) {
    return {s * a.x, s * a.y, s * a.z};
}
double dot(const Vector& a, const Vector& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
void add(double* to, const Vector& a) {
    to[0] += a.x;
    to[1] += a.y;
    to[2] += a.z;
}

struct Now {
    Vector n;              // from i to j
    double overlap, rate;  // and its rate
};

class InSpace {
  public:
    InSpace(const ContactPhaseInSpace& phase, const HertzLaw& law)
        : phase_(phase),
          law_(law),
          unlike_(phase.unlike),
          held_(unlike_ != nullptr && unlike_->held),
          cloth_sign_(law.published_slip_sign ? -1.0 : 1.0),
          size_(kPerState * phase.balls) {
        double* next = phase.numbers;
        const auto take = [&next](int count) {
            double* taken = next;
            next += count;
            for (int n = 0; n < count; ++n) taken[n] = 0.0;
            return taken;
        };
        y_ = take(size_);
        stage_ = take(size_);
        for (double*& slope : slope_) slope = take(size_);
        stiffness_ = take(phase.balls);
        down_ = take(phase.balls);
        apart_ = take(3 * phase.contacts);
        memory_ = take(phase.contacts);
        before_ = take(phase.contacts);
        rate_ = take(phase.contacts);
        for (int b = 0; b < phase.balls; ++b) {
            for (int k = 0; k < kPerMotion; ++k) y_[kPerState * b + 3 + k] = phase.motion[kPerMotion * b + k];
        }
        for (int c = 0; c < phase.contacts; ++c) {
            const HertzContactInSpace& contact = phase.contact[c];
            for (int k = 0; k < 3; ++k) apart_[3 * c + k] = (diameter(c) - contact.overlap) * contact.n[k];
        }
    }

    std::int64_t run(double longest_step, double look_ahead, double time_limit) {
        next_ = longest_step;
        double time = 0.0, braked = 0.0;
        for (std::int64_t steps = 1; time < time_limit; ++steps) {
            time += step(longest_step);
            if (time - braked > kBrakes) {
                brake_all(time - braked);
                braked = time;
            }
            if (presses(time_limit - time)) continue;
            const double flight = next_touch();
            const bool closes = flight < look_ahead;
            if (closes && overlaps()) continue;
            if (!closes || time > kLongPhase) {
                brake_all(time - braked);
                for (int b = 0; b < phase_.balls; ++b) {
                    for (int k = 0; k < kPerMotion; ++k)
                        phase_.motion[kPerMotion * b + k] = y_[kPerState * b + 3 + k];
                    if (phase_.moved == nullptr) continue;
                    for (int k = 0; k < 2; ++k) phase_.moved[2 * b + k] = y_[kPerState * b + k];
                }
                if (phase_.time != nullptr) *phase_.time = time;
                return steps;
            }
            for (int b = 0; b < phase_.balls; ++b) add(y_ + kPerState * b, flight * at(velocity(y_, b)));
            time += flight;
            brake_all(time - braked);
            braked = time;
        }
        return -1;
    }

  private:
    void brake_all(double time) {
        for (int b = 0; b < phase_.balls && held_; ++b) {
            double* y = y_ + kPerState * b;
            brake(law_.slide * time, y[3], y[4], y[6], y[7]);
        }
    }

    // [1/L] Curvature by which a contact's normal turns, and its inverse, the distance of touching centres.
    double curvature(int c) const { return unlike_ == nullptr ? phase_.curvature : unlike_->curvature[c]; }
    bool turns(int c) const { return curvature(c) > 0.0; }
    double diameter(int c) const { return turns(c) ? 1.0 / curvature(c) : 0.0; }
    double mobility(int ball) const { return unlike_ == nullptr ? 1.0 : unlike_->inverse_mass[ball]; }

    static const double* velocity(const double* y, int ball) { return y + kPerState * ball + 3; }
    static const double* spin(const double* y, int ball) { return y + kPerState * ball + 6; }

    Vector apart(const double* y, int c) const {
        const HertzContactInSpace& contact = phase_.contact[c];
        return at(apart_ + 3 * c) + (at(y + kPerState * contact.j) - at(y + kPerState * contact.i));
    }
    Vector closing(const double* y, int c) const {
        const HertzContactInSpace& contact = phase_.contact[c];
        return at(velocity(y, contact.i)) - at(velocity(y, contact.j));
    }
    Now contact_at(const double* y, int c) const {
        if (!turns(c)) {
            const HertzContactInSpace& contact = phase_.contact[c];
            const Vector n = at(contact.n);
            const Vector moved = at(y + kPerState * contact.i) - at(y + kPerState * contact.j);
            return {n, contact.overlap + dot(moved, n), dot(closing(y, c), n)};
        }
        const Vector z = apart(y, c);
        const double distance = square_root(dot(z, z));
        const Vector n = (1.0 / distance) * z;
        return {n, diameter(c) - distance, dot(closing(y, c), n)};
    }

    double force(int c, const Now& now) const {
        const double inverse = memory_[c] > 0.0 ? 1.0 / memory_[c] : kNoMemory;
        const double F = normal_force(law_.a, law_.b, law_.p, now.overlap, inverse);
        return unlike_ == nullptr ? F : unlike_->stiffness[c] * F;
    }

    // Adds the forces of a contact to the slopes of its balls: (3.1) to (3.3) with springs.
    void push(const double* y, int c, const Now& now, double* slope) {
        const int i = phase_.contact[c].i, j = phase_.contact[c].j;
        const double F = force(c, now);
        const Vector v = closing(y, c), spins = at(spin(y, i)) + at(spin(y, j));
        const Vector slip = (v - now.rate * now.n) + cross(spins, now.n);
        const double size = square_root(dot(slip, slip) + law_.epsilon * law_.epsilon);
        double mu_b = law_.mu_b;
        if (law_.mu_b_more > 0.0) mu_b += law_.mu_b_more * falling_exponential(law_.mu_b_fall * size);
        const double k = mu_b * F / size;
        const Vector friction = -k * slip;  // on ball i
        const Vector force = friction - F * now.n, torque = 2.5 * cross(now.n, friction);
        const double light_i = mobility(i), light_j = mobility(j);
        add(slope + kPerState * i + 3, light_i * force);
        add(slope + kPerState * j + 3, -light_j * force);
        add(slope + kPerState * i + 6, light_i * torque);
        add(slope + kPerState * j + 6, light_j * torque);
        stiffness_[i] += light_i * k;
        stiffness_[j] += light_j * k;
        if (!held_) return;
        down_[i] -= force.z;
        down_[j] += force.z;
    }

    // A ball that stays on the cloth does not move vertically. If it is pressed down, the cloth brakes its
    // slip.
    void hold(const double* y, int b, double* slope) {
        double* to = slope + kPerState * b;
        to[5] = 0.0;
        if (!(down_[b] > 0.0) || law_.mu_s == 0.0) return;
        const double *v = velocity(y, b), *w = spin(y, b), sign = cloth_sign_;
        const double x = v[0] - sign * w[1], z = v[1] + sign * w[0];
        const double k =
            mobility(b) * law_.mu_s * down_[b] / square_root((x * x + z * z) + law_.epsilon * law_.epsilon);
        to[3] -= k * x;
        to[4] -= k * z;
        to[6] -= 2.5 * (k * z);
        to[7] += 2.5 * (k * x);
        stiffness_[b] += k;
    }

    void slopes(const double* y, double* slope) {
        for (int b = 0; b < phase_.balls; ++b) {
            stiffness_[b] = down_[b] = 0.0;
            double* to = slope + kPerState * b;
            for (int k = 0; k < 3; ++k) to[k] = velocity(y, b)[k];
            for (int k = 3; k < kPerState; ++k) to[k] = 0.0;
        }
        for (int c = 0; c < phase_.contacts; ++c) {
            const Now now = contact_at(y, c);
            if (now.overlap > 0.0) push(y, c, now, slope);
        }
        if (!held_) return;
        for (int b = 0; b < phase_.balls; ++b) hold(y, b, slope);
    }

    // The slopes of the stages of a step of length h, except the first.
    void stages(const RungeKutta& method, double h) {
        for (int n = 0; n < method.stages(); ++n) {
            const double time = h * method.node[n], *from = slope_[method.slope(n)];
            for (int k = 0; k < size_; ++k) stage_[k] = y_[k] + time * from[k];
            slopes(stage_, slope_[method.slope(n + 1)]);
        }
    }

    // One Runge-Kutta step; returns its length.
    double step(double longest) {
        for (int c = 0; c < phase_.contacts; ++c) {
            const Now now = contact_at(y_, c);
            before_[c] = now.overlap;
            rate_[c] = now.rate;
        }
        slopes(y_, slope_[0]);
        double most = 0.0;
        for (int c = 0; c < phase_.contacts; ++c) {
            if (before_[c] > 0.0)
                most = largest(most, stiffness_[phase_.contact[c].i] + stiffness_[phase_.contact[c].j]);
        }
        const bool friction = has_friction(law_) || (held_ && law_.mu_s > 0.0);
        const double wanted = longest * slowness(fastest_squared());
        Plan plan = friction ? plan_step(most, smallest(wanted, next_)) : Plan{&kClassical, wanted};
        for (;;) {
            stages(*plan.method, plan.h);
            if (!friction) break;
            const double error = difference(plan.h);
            next_ = step_after(next_, plan.h, error);
            if (!(error > kStepError && plan.h > kShortest * longest)) break;
            plan = plan_step(most, 0.5 * plan.h);
        }
        const double h = plan.h, *w = plan.method->weight;
        for (int n = 0; n < size_; ++n)
            y_[n] += h * ((w[0] * slope_[0][n] + w[1] * slope_[1][n]) +
                          (w[2] * slope_[2][n] + w[3] * slope_[3][n]));
        for (int c = 0; c < phase_.contacts; ++c) remember(c, h);
        return h;
    }

    // The square of the fastest contact's speed before the step (slowness()).
    double fastest_squared() const {
        double most = 0.0;
        for (int c = 0; c < phase_.contacts; ++c) {
            const double d = largest(0.0, before_[c]), rate = d > 0.0 ? rate_[c] : largest(0.0, rate_[c]);
            const double inverse = rate <= 0.0 && memory_[c] > 0.0 ? 1.0 / memory_[c] : kNoMemory;
            const double F = normal_force(law_.a, law_.b, law_.p, d, inverse);
            most = largest(most, rate * rate + d * (unlike_ == nullptr ? F : unlike_->stiffness[c] * F));
        }
        return most;
    }

    // The largest difference of a velocity or spin from the midpoint rule.
    double difference(double h) const {
        double most = 0.0;
        for (int n = 0; n < size_; ++n) {
            if (n % kPerState >= 3)
                most = largest(most, absolute((slope_[0][n] + slope_[3][n]) - 2.0 * slope_[2][n]));
        }
        return h / 6.0 * most;
    }

    void remember(int c, double h) {
        const Now now = contact_at(y_, c);
        memory_[c] = now.overlap > 0.0 ? largest(memory_[c], now.overlap) : 0.0;
        if (now.overlap > 0.0 && rate_[c] > 0.0 && now.rate < 0.0)
            memory_[c] = largest(memory_[c], peak(before_[c], now.overlap, h * rate_[c], h * now.rate));
    }

    bool overlaps() const {
        for (int c = 0; c < phase_.contacts; ++c) {
            if (contact_at(y_, c).overlap > 0.0) return true;
        }
        return false;
    }

    // Whether a contact overlaps and still acts.
    bool presses(double time_left) const {
        for (int c = 0; c < phase_.contacts; ++c) {
            const Now now = contact_at(y_, c);
            if (now.overlap > 0.0 && !is_over(force(c, now), now.overlap, now.rate, time_left)) return true;
        }
        return false;
    }

    // Time at which the next contact closes, without forces: |z - v s| = 2 R, without subtracting nearly
    // equal numbers.
    double next_touch() const {
        double first = kNever;
        for (int c = 0; c < phase_.contacts; ++c) {
            if (!turns(c)) {
                const Now now = contact_at(y_, c);
                if (now.rate > kNothing) first = smallest(first, -now.overlap / now.rate);
                continue;
            }
            const Vector z = apart(y_, c), v = closing(y_, c);
            const double towards = dot(v, z), distance = square_root(dot(z, z));
            const double q = (distance - diameter(c)) * (distance + diameter(c)),
                         root2 = towards * towards - dot(v, v) * q;
            if (towards > kNothing * distance && root2 >= 0.0)
                first = smallest(first, q / (towards + square_root(root2)));
        }
        return first;
    }

    const ContactPhaseInSpace phase_;
    const HertzLaw law_;
    const UnlikeBalls* const unlike_;
    const bool held_;
    const double cloth_sign_;
    const int size_;
    double *y_, *stage_, *slope_[kStages];
    double next_;        // limit of the next step by the last error
    double* stiffness_;  // per ball: the sum of friction over slip
    double* down_;       // per ball: load on the cloth, if all are held
    // Per contact: the vector between the centres at the start (3 numbers); the largest overlap since it
    // opened; overlap and its slope before the step.
    double *apart_, *memory_, *before_, *rate_;
};

}  // namespace

std::int64_t contact_phase_in_space(const ContactPhaseInSpace& phase, const HertzLaw& law,
                                    double longest_step, double look_ahead, double time_limit) noexcept {
    return InSpace(phase, law).run(longest_step, look_ahead, time_limit);
}

}  // namespace carom::kernel
