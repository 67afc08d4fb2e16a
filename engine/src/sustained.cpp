#include "sustained.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/engine/tolerances.h"
#include "detect.h"
#include "roots.h"

namespace carom {

namespace {

double dot(const Vec2& a, const Vec2& b) {
    return a.x() * b.x() + a.y() * b.y();
}
Vec2 planar(const Vec3& a) {
    return {a.x(), a.y()};
}

enum class Mode : unsigned char { kSliding, kRolling, kResting };

// A member with what the equations need. All forces are per mass.
struct Body {
    Mode mode = Mode::kResting;
    Vec2 direction =
        Vec2::Zero();  // sliding: of the slip; rolling: of the velocity, or of the push that starts it
    Vec2 push = Vec2::Zero();    // sum of contact forces
    Vec2 couple = Vec2::Zero();  // (T x z) / R of the contact torques
    double lift = 0.0;           // vertical contact force
    Vec2 a = Vec2::Zero();       // acceleration
    double mobility() const {
        return mode == Mode::kSliding ? 1.0 : (mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
    }
};

// A contact as the solver sees it; i, j index the bodies.
struct Link {
    int i, j;
    Vec2 n;
    double friction_z;  // f_z / N, on ball i
    double
        opening;  // what the gap's acceleration has besides n . (a_j - a_i): the turning of n, less a margin
    double diagonal;
    double N;
};

class Solver {
  public:
    Solver(HeldGroup& group, const Plan& plan, const MotionParams& motion, double now)
        : group_(group), plan_(plan), motion_(motion), now_(now) {}

    void run() {
        make_bodies();
        make_links();
        make_directions();
        solve_forces(0.0);  // which resting balls give way: the others take the capture like a wall
        project_velocities();
        settle();
        make_directions();
        solve_forces(0.0);
        // The normal turns while the balls move across each other; a margin keeps the third order from
        // penetrating.
        if (turning()) solve_forces(kHoldRefresh);
        write_segments();
        // Directions that turn are taken at the middle of the interval: second order.
        if (take_middle_directions()) {
            solve_forces(turning() ? kHoldRefresh : 0.0);
            write_segments();
        }
        release_open_contacts();
    }

  private:
    Vec2 velocity(int body) const { return planar(group_.balls[static_cast<std::size_t>(body)].v); }

    void make_bodies() {
        for (HeldBall& ball : group_.balls) {
            const Segment s = start_segment(now_, ball.r, ball.v, ball.w, motion_);
            ball.v = s.v;
            ball.w = s.w;  // a rolling ball's spin is exactly the rolling one
            Body body;
            body.mode = s.state == MotionState::kSliding   ? Mode::kSliding
                        : s.state == MotionState::kRolling ? Mode::kRolling
                                                           : Mode::kResting;
            bodies_.push_back(body);
            const double speed = length(planar(ball.v));
            const double spin = length(Vec2(length(planar(ball.w)), ball.w.z()));
            noise_ = std::max(noise_, 8.0 * kClosingUlp * std::numeric_limits<double>::epsilon() *
                                          (speed + motion_.R * spin));
        }
        settle();
    }

    // A rolling ball whose velocity is the rounding of its group's has stopped: the direction of such a
    // velocity means nothing, and rolling friction along it would drive the ball.
    void settle() {
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            HeldBall& ball = group_.balls[k];
            const double slowest = std::max(noise_, kHoldRest * motion_.roll);
            if (bodies_[k].mode != Mode::kRolling || length(planar(ball.v)) > slowest) continue;
            bodies_[k].mode = Mode::kResting;
            ball.v = Vec3::Zero();
            ball.w.x() = ball.w.y() = 0.0;
        }
    }

    int body_of(int ball) const {
        for (std::size_t k = 0; k < group_.balls.size(); ++k)
            if (group_.balls[k].ball == ball) return static_cast<int>(k);
        return -1;
    }

    void make_links() {
        for (HeldContact& c : group_.contacts) {
            Link link{body_of(c.i), c.j >= 0 ? body_of(c.j) : -1, c.n, 0.0, 0.0, 0.0, 0.0};
            links_.push_back(link);
        }
    }

    double gap_rate(const Link& link) const {
        const Vec2 other = link.j >= 0 ? velocity(link.j) : Vec2::Zero();
        return dot(link.n, other - velocity(link.i));
    }

    // Takes the relative normal velocity out of every contact, in the metric of the masses: what capture does
    // plastically. Rates within the rounding of the projection are none: they would set a resting ball
    // rolling.
    void project_velocities() {
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            bool done = true;
            for (const Link& link : links_) {
                const double mi = bodies_[static_cast<std::size_t>(link.i)].mobility();
                const double mj = link.j < 0 ? 0.0 : bodies_[static_cast<std::size_t>(link.j)].mobility();
                if (mi + mj == 0.0) continue;
                const double rate = gap_rate(link);
                if (std::abs(rate) <= noise_) continue;
                done = false;
                const double J = -rate / (mi + mj);
                kick(link.i, -J * mi * link.n);
                if (link.j >= 0) kick(link.j, J * mj * link.n);
            }
            if (done) break;
        }
        // Normals that nearly agree (round a jaw onto the cushion) do not meet that way: in the end none may
        // close, and one may open.
        for (Link& link : links_) link.N = 0.0;
        for (int sweep = 0; sweep < kCaptureSweeps; ++sweep) {
            bool done = true;
            for (Link& link : links_) {
                const double mi = bodies_[static_cast<std::size_t>(link.i)].mobility();
                const double mj = link.j < 0 ? 0.0 : bodies_[static_cast<std::size_t>(link.j)].mobility();
                const double rate = gap_rate(link);
                if (mi + mj == 0.0 || (rate >= 0.0 && link.N == 0.0) || std::abs(rate) <= noise_) continue;
                const double next = std::max(0.0, link.N - rate / (mi + mj)), J = next - link.N;
                link.N = next;
                done = false;
                kick(link.i, -J * mi * link.n);
                if (link.j >= 0) kick(link.j, J * mj * link.n);
            }
            if (done) break;
        }
        for (Link& link : links_) link.N = 0.0;
    }

    void kick(int index, const Vec2& dv) {
        if (dv.x() == 0.0 && dv.y() == 0.0) return;
        Body& body = bodies_[static_cast<std::size_t>(index)];
        HeldBall& ball = group_.balls[static_cast<std::size_t>(index)];
        ball.v.x() += dv.x();
        ball.v.y() += dv.y();
        if (body.mode == Mode::kRolling) {
            ball.w.x() = -ball.v.y() / motion_.R;
            ball.w.y() = ball.v.x() / motion_.R;
        }
    }

    void make_directions() {
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const HeldBall& ball = group_.balls[k];
            const Vec2 along =
                bodies_[k].mode == Mode::kSliding ? cloth_slip(ball.v, ball.w, motion_.R) : planar(ball.v);
            const double size = length(along);
            if (size > 0.0) bodies_[k].direction = along / size;  // else: that of the push, if any
        }
        for (std::size_t c = 0; c < links_.size(); ++c) {
            Link& link = links_[c];
            if (link.j < 0) continue;
            const HeldBall &bi = group_.balls[static_cast<std::size_t>(link.i)],
                           &bj = group_.balls[static_cast<std::size_t>(link.j)];
            const Vec2 t(link.n.y(), -link.n.x());
            const double s_x = dot(planar(bi.v) - planar(bj.v), t) - motion_.R * (bi.w.z() + bj.w.z());
            const double s_z = motion_.R * (dot(planar(bi.w), t) + dot(planar(bj.w), t));
            const double slip = length(Vec2(s_x, s_z));
            link.friction_z = slip > 0.0 ? -ball_friction(plan_.balls, slip) * s_z / slip : 0.0;
        }
    }

    bool take_middle_directions() {
        bool turned = false;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            Body& b = bodies_[k];
            const HeldBall& ball = group_.balls[k];
            const Segment& s = ball.segment;
            if (b.mode == Mode::kResting || !(s.duration < kNever)) continue;
            const bool sliding = b.mode == Mode::kSliding;
            const Vec2 x = sliding ? cloth_slip(ball.v, ball.w, motion_.R) : planar(ball.v);
            const Vec2 dx =
                sliding ? Vec2(s.a.x() - motion_.R * s.dw.y(), s.a.y() + motion_.R * s.dw.x()) : s.a;
            if (std::abs(cross(x, dx)) <= kHoldStraight * length(x) * length(dx)) continue;
            const Vec2 middle = x + 0.5 * s.duration * dx;
            const double size = length(middle);
            // Near its end the direction may turn over: then the one at the start stays.
            if (!(size > 0.0) || middle.dot(x) <= 0.0) continue;
            b.direction = middle / size;
            turned = true;
        }
        return turned;
    }

    // Relative motion across the normal, and the distance over which the normal turns (0: a straight
    // cushion).
    double across(std::size_t c, Vec2& velocity_across) const {
        const HeldContact& contact = group_.contacts[c];
        const Link& link = links_[c];
        const Vec2 t(link.n.y(), -link.n.x());
        const Vec2 other = link.j >= 0 ? velocity(link.j) : Vec2::Zero();
        const Vec2 other_a = link.j >= 0 ? bodies_[static_cast<std::size_t>(link.j)].a : Vec2::Zero();
        velocity_across = Vec2(dot(other - velocity(link.i), t),
                               dot(other_a - bodies_[static_cast<std::size_t>(link.i)].a, t));
        if (contact.cushion >= 0) return 0.0;
        return contact.j >= 0 ? 2.0 * motion_.R
                              : motion_.R + plan_.noses[static_cast<std::size_t>(contact.nose)].radius;
    }

    bool turning() const {
        for (std::size_t c = 0; c < links_.size(); ++c) {
            Vec2 t;
            if (across(c, t) == 0.0) continue;
            const Link& link = links_[c];
            const double speeds = length(velocity(link.i)) + (link.j >= 0 ? length(velocity(link.j)) : 0.0);
            const double pulls = length(bodies_[static_cast<std::size_t>(link.i)].a) +
                                 (link.j >= 0 ? length(bodies_[static_cast<std::size_t>(link.j)].a) : 0.0);
            if (std::abs(t.x()) > kHoldStraight * speeds || std::abs(t.y()) > kHoldStraight * pulls)
                return true;
        }
        return false;
    }

    void accelerate() {
        const double g = plan_.gravity;
        for (Body& b : bodies_) {
            switch (b.mode) {
                case Mode::kSliding:
                    b.a = b.push - motion_.slide * std::max(0.0, 1.0 - b.lift / g) * b.direction;
                    break;
                case Mode::kRolling:
                    b.a = (5.0 / 7.0) * (b.push + b.couple) - motion_.roll * b.direction;
                    break;
                case Mode::kResting:
                    b.a = Vec2::Zero();
                    break;
            }
        }
    }

    void sum_forces() {
        for (Body& b : bodies_) {
            b.push = b.couple = Vec2::Zero();
            b.lift = 0.0;
        }
        for (const Link& link : links_) {
            Body& bi = bodies_[static_cast<std::size_t>(link.i)];
            bi.push -= link.N * link.n;
            bi.couple -= link.friction_z * link.N * link.n;
            bi.lift += link.friction_z * link.N;
            if (link.j < 0) continue;
            Body& bj = bodies_[static_cast<std::size_t>(link.j)];
            bj.push += link.N * link.n;
            bj.couple -= link.friction_z * link.N * link.n;
            bj.lift -= link.friction_z * link.N;
        }
    }

    // Acceleration of the gap with the present forces.
    double gap_acceleration(const Link& link) const {
        const Vec2 other = link.j >= 0 ? bodies_[static_cast<std::size_t>(link.j)].a : Vec2::Zero();
        return dot(link.n, other - bodies_[static_cast<std::size_t>(link.i)].a) + link.opening;
    }

    // Projected Gauss-Seidel on N >= 0, gap acceleration >= 0, N * gap acceleration = 0.
    void solve_complementarity() {
        for (Link& link : links_) {
            const Body& bi = bodies_[static_cast<std::size_t>(link.i)];
            link.diagonal = bi.mobility();
            if (link.j >= 0) link.diagonal += bodies_[static_cast<std::size_t>(link.j)].mobility();
        }
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            double change = 0.0, largest = 0.0;
            for (Link& link : links_) {
                if (link.diagonal == 0.0) {
                    link.N = 0.0;
                    continue;
                }
                sum_forces();
                accelerate();
                const double N = std::max(0.0, link.N - gap_acceleration(link) / link.diagonal);
                change = std::max(change, std::abs(N - link.N));
                largest = std::max(largest, N);
                link.N = N;
            }
            if (change <= 2e-16 * largest) break;
        }
        sum_forces();
        accelerate();
    }

    // Whether every ball can do what its mode says; where not, the mode changes.
    bool modes_hold() {
        const double g = plan_.gravity;
        for (Body& b : bodies_) {
            if (b.mode == Mode::kResting) {
                const Vec2 push = b.push + b.couple;
                const double size = length(push);
                if ((5.0 / 7.0) * size > motion_.roll) {  // starts to roll along the push
                    b.mode = Mode::kRolling;
                    b.direction = push / size;
                    return false;
                }
            } else if (b.mode == Mode::kRolling) {
                const Vec2 cloth = b.a - b.push;  // what the cloth has to give
                const double size = length(cloth);
                if (size > motion_.slide * std::max(0.0, 1.0 - b.lift / g) + motion_.roll) {  // it slips
                    b.mode = Mode::kSliding;
                    b.direction = -cloth / size;
                    return false;
                }
            }
        }
        return true;
    }

    void solve_forces(double interval) {
        for (std::size_t c = 0; c < links_.size(); ++c) {
            Vec2 t;
            const double distance = across(c, t);
            // |r|'' has (v_t^2) / |r| from the turning normal; its own rate, 3 v_t a_t / |r|, must not close
            // the gap.
            links_[c].opening =
                distance > 0.0 ? t.x() * t.x() / distance -
                                     (interval > 0.0 ? 1.5 * interval * std::abs(t.x() * t.y()) / distance +
                                                           interval * interval * t.y() * t.y() / distance
                                                     : 0.0)
                               : 0.0;
        }
        for (std::size_t tries = 0; tries < 2 * bodies_.size() + 1; ++tries) {
            solve_complementarity();
            if (modes_hold()) break;
        }
    }

    // Time until `x`, changing at the rate `dx`, is gone or turns too far; `gone` says which.
    double time_of(const Vec2& x, const Vec2& dx, bool& gone) const {
        gone = false;
        const double size = length(x), rate = length(dx);
        if (size == 0.0 || rate == 0.0) return kNever;
        const double toward = -dot(x, dx) / rate;
        if (std::abs(cross(x, dx)) <= kHoldStraight * size * rate) {
            gone = toward > 0.0;
            return gone ? size / rate : kNever;
        }
        const double limit = std::max(kHoldShortest, std::min(kHoldRefresh, 0.25 * size / rate));
        const double nearest = toward / rate;
        gone = nearest > 0.0 && nearest <= limit;
        return gone ? nearest : limit;
    }

    Vec2 spin_rate(std::size_t k) const {
        const Body& b = bodies_[k];
        const double R = motion_.R;
        if (b.mode == Mode::kRolling) return {-b.a.y() / R, b.a.x() / R};
        if (b.mode == Mode::kResting) return Vec2::Zero();
        const double load = std::max(0.0, 1.0 - b.lift / plan_.gravity);
        const double turn = 2.5 * motion_.slide * load / R;
        // T / I with (T x z) / R = couple: T = R z x couple.
        return {-turn * b.direction.y() - 2.5 * b.couple.y() / R,
                turn * b.direction.x() + 2.5 * b.couple.x() / R};
    }

    double line_end_time(const HeldContact& contact, const Segment& s) const {
        return time_to_line_end(plan_.cushions[static_cast<std::size_t>(contact.cushion)], s);
    }

    void write_segments() {
        double interval = turning() ? kHoldRefresh : kNever;
        std::vector<double> ends(bodies_.size(), kNever);
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            const Body& b = bodies_[k];
            HeldBall& ball = group_.balls[k];
            Segment& s = ball.segment;
            s = start_segment(now_, ball.r, ball.v, ball.w, motion_);
            s.held = true;
            s.a = b.a;
            s.dw = spin_rate(k);
            bool gone = false;
            double time = kNever;
            if (b.mode == Mode::kSliding) {
                s.state = MotionState::kSliding;
                time = time_of(cloth_slip(ball.v, ball.w, motion_.R),
                               Vec2(s.a.x() - motion_.R * s.dw.y(), s.a.y() + motion_.R * s.dw.x()), gone);
            } else if (b.mode == Mode::kRolling) {
                s.state = MotionState::kRolling;
                time = time_of(planar(ball.v), s.a, gone);
            } else if (s.state == MotionState::kSpinning) {
                time = s.duration;
                gone = true;
            }
            interval = std::min(interval, time);
            if (gone) ends[k] = time;
        }
        for (std::size_t c = 0; c < links_.size(); ++c) {
            const HeldContact& contact = group_.contacts[c];
            const Link& link = links_[c];
            if (contact.cushion >= 0)
                interval = std::min(
                    interval, line_end_time(contact, group_.balls[static_cast<std::size_t>(link.i)].segment));
            if (link.j >= 0) interval = std::min(interval, friction_flip(link));
        }
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            group_.balls[k].segment.duration = interval;
            group_.balls[k].segment.ends = ends[k] <= interval;
        }
    }

    // The vertical friction keeps its direction until the slip s_z changes sign.
    double friction_flip(const Link& link) const {
        if (link.friction_z == 0.0 || link.N == 0.0) return kNever;
        const Segment &si = group_.balls[static_cast<std::size_t>(link.i)].segment,
                      &sj = group_.balls[static_cast<std::size_t>(link.j)].segment;
        const Vec2 t(link.n.y(), -link.n.x());
        const double s_z = dot(planar(si.w) + planar(sj.w), t), rate = dot(si.dw + sj.dw, t);
        if (!(s_z * rate < 0.0)) return kNever;
        return std::max(kHoldShortest, -s_z / rate);
    }

    void release_open_contacts() {
        for (std::size_t c = 0; c < links_.size(); ++c) {
            HeldContact& contact = group_.contacts[c];
            contact.force = links_[c].N;
            const Link& link = links_[c];
            contact.released =
                link.N == 0.0 && (gap_acceleration(link) > 0.0 || link.diagonal == 0.0 || all_rest(link));
        }
    }

    bool all_rest(const Link& link) const {
        const auto rests = [this](int k) {
            const Body& b = bodies_[static_cast<std::size_t>(k)];
            return b.mode == Mode::kResting || (length(b.a) == 0.0 && velocity(k) == Vec2::Zero());
        };
        return rests(link.i) && (link.j < 0 || rests(link.j));
    }

    static constexpr int kSweeps = 2000;
    static constexpr int kCaptureSweeps = 200000;  // a wedge of 1 degree closes by 3e-4 per sweep

    HeldGroup& group_;
    const Plan& plan_;
    const MotionParams& motion_;
    double now_;
    std::vector<Body> bodies_;
    std::vector<Link> links_;
    double noise_ = 0.0;  // m/s: what rounding makes of the group's speeds in a few sums of eight
};

}  // namespace

double time_to_line_end(const CushionLine& line, const Segment& s) {
    const double x = dot(line.direction, planar(s.r) - line.from);
    const double v = dot(line.direction, planar(s.v)), a = dot(line.direction, s.a);
    const auto leaves = [](double left, double rate, double pull) {
        if (left <= 0.0 && (rate < 0.0 || (rate == 0.0 && pull < 0.0))) return 0.0;
        return first_descent_quadratic(left, rate, pull, kNever);
    };
    return std::min(leaves(x, v, a), leaves(line.length - x, -v, -a));
}

EventType HeldContact::hold_type() const {
    return j >= 0             ? EventType::kBallBallHold
           : nose >= 0 && jaw ? EventType::kBallJawHold
                              : EventType::kBallCushionHold;
}
EventType HeldContact::release_type() const {
    return j >= 0             ? EventType::kBallBallRelease
           : nose >= 0 && jaw ? EventType::kBallJawRelease
                              : EventType::kBallCushionRelease;
}

bool holds(double v_n, double a_c, double restitution) {
    if (!(a_c > 0.0)) return false;
    const double x = 2.0 * std::max(restitution, kLeastRestitution) * v_n / a_c;  // duration of the bounce
    const double x2 = x * x, f2 = kContactTimeFactor * kContactTimeFactor;
    return x2 * x2 * x * v_n <= f2 * f2 * kContactTimeFactor / (kContactStiffness * kContactStiffness);
}

void solve_held(HeldGroup& group, const Plan& plan, const MotionParams& motion, double now) {
    Solver(group, plan, motion, now).run();
}

void end_transition(HeldBall& member, MotionState state, double R) {
    switch (state) {
        case MotionState::kSliding: {
            const Vec2 u = cloth_slip(member.v, member.w, R);
            member.v.x() -= u.x() * (2.0 / 7.0);
            member.v.y() -= u.y() * (2.0 / 7.0);
            member.w.x() = -member.v.y() / R;
            member.w.y() = member.v.x() / R;
            break;
        }
        case MotionState::kRolling:
            member.v = Vec3::Zero();
            member.w.x() = member.w.y() = 0.0;
            break;
        case MotionState::kSpinning:
            member.w.z() = 0.0;
            break;
        case MotionState::kStationary:
        case MotionState::kPocketed:
            break;
    }
}

}  // namespace carom
