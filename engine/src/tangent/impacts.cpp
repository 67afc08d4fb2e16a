#include "tangent/impacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"
#include "carom/engine/tolerances.h"
#include "physics/cushion/bounce.h"
#include "physics/motion.h"

namespace carom::tangent {
namespace {

// [-] Step sizes, relative to the speeds of the impact and to each coefficient. Larger ones may cross a
// corner of a model (a nose that sticks or slides; from 1e-3 on, one shot of 500 with `mathavan_2010` was
// right only to 1e-7), smaller ones lose digits.
constexpr double kFirstStep = 3e-4, kLastStep = 2e-8;
// [-] Two estimates agree if they differ by less; there is no derivative if the best ones differ by more.
constexpr double kAgree = 1e-9, kDisagree = 1e-5;
// Of a cluster whose derivatives are taken.
constexpr double kClusterTolerance = 1e-11;
// [R] Unit of the positions of balls in a cluster: a third of a millimetre, the range of a contact.
constexpr double kClusterReach = 1e-2;
// [of the velocities after the impact, per step] Errors of smaller derivatives count relative to this.
constexpr double kRounding = 1e-3;

using List = std::vector<double>;
using Map = std::function<List(const double*)>;

/// The numbers that an impact reads. Spins are R w, so that a rolling ball rolls at every step.
class Arguments {
  public:
    explicit Arguments(const Numbers& numbers) {
        values_.reserve(kMany);
        units_.reserve(kMany);
        for (const Dual& param : numbers.params) add(param, std::abs(param.x));
        add(numbers.gravity, numbers.gravity.x);
    }
    void add(const Dual& value, double unit) {
        values_.push_back(value);
        units_.push_back(unit > 0.0 ? unit : 1.0);
    }
    void add(const Numbers::Ball& ball) {
        add(ball.R, ball.R.x);
        add(ball.m, ball.m.x);
    }
    void add(const Dual3& list, double unit) {
        for (const Dual& value : list) add(value, unit);
    }
    void add(const State& s, const Dual& R, double speed) {
        add(s.v, speed);
        for (const Dual& w : s.w) add(R * w, speed);
    }
    const std::vector<Dual>& values() const { return values_; }
    const List& units() const { return units_; }

  private:
    static constexpr std::size_t kMany = kParams + 24;
    std::vector<Dual> values_;
    List units_;
};

double largest(const List& list) {
    double most = 0.0;
    for (const double x : list) most = std::max(most, std::abs(x));
    return most;
}

std::vector<Dual> differentiate(Laws& laws, const Arguments& in, const Map& map) {
    const std::vector<Dual>& values = in.values();
    List x(values.size());
    const auto at = [&](int lane, double by) {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = values[i].x + values[i].d[lane] * by;
        return map(x.data());
    };
    const List y = at(0, 0.0);
    std::vector<Dual> out(y.begin(), y.end());
    List now(y.size()), last(y.size());
    for (int lane = 0; lane < kLanes; ++lane) {
        double size = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i)
            size = std::max(size, std::abs(values[i].d[lane]) / in.units()[i]);
        if (size == 0.0) continue;
        double best = std::numeric_limits<double>::infinity();
        List below = at(lane, -2.0 * kFirstStep / size), above = at(lane, 2.0 * kFirstStep / size);
        for (double h = kFirstStep; h > kLastStep && !(best < kAgree); h *= 0.5) {
            // Half of the points are shared with the last step.
            List near_below = at(lane, -h / size), near_above = at(lane, h / size);
            double apart = 0.0;
            for (std::size_t i = 0; i < y.size(); ++i) {
                now[i] = (8.0 * (near_above[i] - near_below[i]) - (above[i] - below[i])) / (12.0 * h) * size;
                apart = std::max(apart, std::abs(now[i] - last[i]));
            }
            // Changes far smaller than the impact itself are rounding.
            const double scale = std::max({largest(now), largest(last), kRounding * size * largest(y)});
            const double error = scale > 0.0 ? apart / scale : 0.0;
            if (h < kFirstStep && error < best) {
                best = error;
                // Larger steps cause less rounding, as long as they agree with smaller ones.
                for (std::size_t i = 0; i < out.size(); ++i) out[i].d[lane] = last[i];
            }
            std::swap(last, now);
            std::swap(below, near_below);
            std::swap(above, near_above);
        }
        if (!(best < kDisagree))
            throw TangentError(fmt::format(
                "it lies at a corner of its model, between two laws (uncertain by {:.1g})", best));
        laws.error = std::max(laws.error, best);
    }
    return out;
}

struct Reader {
    Reader(const Laws& laws, const double* list)
        : next(list + kParams), balls(with_numbers(laws.plan.scene.balls, list)), gravity(*next++) {}
    double number() { return *next++; }
    Vec3 vec() {
        next += 3;
        return {next[-3], next[-2], next[-1]};
    }
    BallSize size() {
        const double R = number();
        return {R, number()};
    }
    Velocities velocities(double R) {
        const Vec3 v = vec();
        return {v, vec() / R};
    }
    const double* next;
    BallParams balls;
    double gravity;
};

List list_of(std::initializer_list<Velocities> balls) {
    List out;
    for (const Velocities& ball : balls)
        for (const Vec3* part : {&ball.v, &ball.w}) out.insert(out.end(), part->data(), part->data() + 3);
    return out;
}
void put(State& s, const Dual* from) {
    for (int i = 0; i < 3; ++i) s.v[i] = from[i], s.w[i] = from[3 + i];
}

double speed_of(const State& s, const Dual& R) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += s.v[i].x * s.v[i].x + R.x * R.x * s.w[i].x * s.w[i].x;
    return std::sqrt(sum);
}

/// [m/s] Speed at which two balls approach.
double closing_speed(const Dual3& apart, const State& s1, const State& s2) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += apart[i].x * (s1.v[i].x - s2.v[i].x);
    return sum / length3(apart).x;
}

/// Differentiates a law of two balls. law(in, pair, ball1, ball2) gets the shared numbers, the sizes and the
/// vector from centre to centre, and the velocities, which it replaces.
struct Pair {
    BallSize size1, size2;
    Vec3 apart;
};
template <class Law>
void meet_pair(Laws& laws, int one, int two, const Dual3& apart, State& s1, State& s2, const Law& law) {
    const Numbers::Ball &b1 = laws.numbers.balls[one], &b2 = laws.numbers.balls[two];
    Arguments arguments(laws.numbers);
    // In a thin hit the models bend within a range of the closing speed.
    const double speed = std::abs(closing_speed(apart, s1, s2)), reach = length3(apart).x;
    const double most = std::max({speed_of(s1, b1.R), speed_of(s2, b2.R), speed});
    arguments.add(b1);
    arguments.add(b2);
    arguments.add(apart, most > 0.0 ? reach * speed / most : reach);
    arguments.add(s1, b1.R, speed);
    arguments.add(s2, b2.R, speed);
    const std::vector<Dual> out = differentiate(laws, arguments, [&](const double* list) {
        Reader in(laws, list);
        const Pair pair{in.size(), in.size(), in.vec()};
        Velocities ball1 = in.velocities(pair.size1.R), ball2 = in.velocities(pair.size2.R);
        law(in, pair, ball1, ball2);
        return list_of({ball1, ball2});
    });
    put(s1, out.data());
    put(s2, out.data() + 6);
}

/// The same for one ball. law(in, size, about, ball)
/// @param about  three more numbers that the law reads, in this unit
template <class Law>
void meet_table(Laws& laws, int ball, const Dual3& about, double unit, double speed, State& s,
                const Law& law) {
    const Numbers::Ball& numbers = laws.numbers.balls[ball];
    Arguments arguments(laws.numbers);
    arguments.add(numbers);
    arguments.add(about, unit);
    arguments.add(s, numbers.R, speed);
    const std::vector<Dual> out = differentiate(laws, arguments, [&](const double* list) {
        Reader in(laws, list);
        const BallSize size = in.size();
        const Vec3 more = in.vec();
        Velocities at = in.velocities(size.R);
        law(in, size, more, at);
        return list_of({at});
    });
    put(s, out.data());
}

}  // namespace

void collide(Laws& laws, int one, int two, const Dual3& apart, State& s1, State& s2) {
    const Plan& plan = laws.plan;
    if (plan.impact.march != nullptr && plan.ball_ball->reads_tolerance)
        throw TangentError(
            "physics.substeps makes it a step function of its input; use physics.tolerance instead");
    const Dual fall1 = s1.v[2], fall2 = s2.v[2];
    s1.v[2] = s2.v[2] = 0.0;
    BallBallSettings settings = plan.impact;
    settings.tolerance = kernel::kTightestTolerance;
    meet_pair(laws, one, two, apart, s1, s2,
              [&](const Reader& in, const Pair& pair, Velocities& ball1, Velocities& ball2) {
                  const auto& [size1, size2, r] = pair;
                  const Vec2 level =
                      planar(r) * (contact_distance(size1.R, size2.R, in.balls.discs()) / length(planar(r)));
                  // A skipped friction has no effect, but may have derivatives: skip none.
                  const PairImpact impact =
                      carom::collide({*plan.ball_ball, settings, in.balls, plan.contact_time}, size1, size2,
                                     {0.0, 0.0, size1.R}, {level.x(), level.y(), size2.R}, ball1, ball2);
                  if (impact.status != kernel::ImpactStatus::kOk)
                      throw TangentError("its model has no solution nearby, as at the edge of a miss");
              });
    s1.v[2] = fall1;
    s2.v[2] = fall2;
}

void collide_free(Laws& laws, int one, int two, const Dual3& apart, bool slow, Lies lies, State& s1,
                  State& s2) {
    const BallBallModelInfo& model = *laws.plan.ball_ball;
    meet_pair(
        laws, one, two, apart, s1, s2,
        [&](const Reader& in, const Pair& pair, Velocities& ball1, Velocities& ball2) {
            FreePair free{pair.size1, pair.size2, model.friction(in.balls), model.restitution(in.balls)};
            const Vec3 n = pair.apart / length3(pair.apart);
            if (slow) return part_slowly(free, n, lies, in.gravity, ball1, ball2);
            const double parting = parting_speed(std::max(pair.size1.R, pair.size2.R), in.gravity);
            free.e_b = restitution_in_air(free.e_b, dot3(ball1.v - ball2.v, n), parting).value_or(free.e_b);
            hit_ball(free, n, ball1, ball2);
        });
}

// The loop resolves the cluster again, in a scene without anything else. The positions at the end depend on
// the integration steps; the positions at a fixed time afterwards do not.
void collide_cluster(Laws& laws, const std::vector<int>& balls, int hit, int met, double duration,
                     std::vector<State>& states) {
    const auto member = [&](int ball) {
        return static_cast<std::size_t>(std::find(balls.begin(), balls.end(), ball) - balls.begin());
    };
    const std::size_t one = member(hit), two = member(met);
    const double speed = std::abs(closing_speed(states[two].r - states[one].r, states[one], states[two]));
    // [s] Scales lengths to the size of speeds.
    const double unit = laws.numbers.balls[hit].R.x / speed;
    Arguments in(laws.numbers);
    for (std::size_t k = 0; k < balls.size(); ++k) {
        const Numbers::Ball& ball = laws.numbers.balls[balls[k]];
        in.add(ball);
        in.add(states[k].r, kClusterReach * ball.R.x);
        in.add(states[k], ball.R, speed);
    }
    Scene scene = laws.plan.scene;
    scene.table = Table();
    scene.cue.reset();
    scene.ball.clear();
    for (const int ball : balls) scene.ball.push_back(laws.plan.scene.ball[ball]);
    // Without the table, the scene may need effects that it excludes.
    std::erase_if(scene.effects, [](const EffectOverride& effect) { return !effect.in_force; });
    if (laws.flights()) scene.effects.push_back({"airborne", true, {}});
    scene.stop.events = 1;
    // Moves the moving ball into contact, so that resting balls still touch, to the last bit.
    const std::size_t moves = speed_of(states[one], 1.0) < speed_of(states[two], 1.0) ? two : one;
    const auto resolve = [&](const double* list, double tolerance) {
        Reader read(laws, list);
        scene.balls = read.balls;
        scene.physics.gravity = read.gravity;
        for (BallStart& ball : scene.ball) {
            ball.own = read.size();
            ball.position = read.vec();
            const Velocities at = read.velocities(ball.own->R);
            ball.velocity = Vec3(at.v.x(), at.v.y(), 0.0);
            ball.spin = at.w;
        }
        BallStart& moving = scene.ball[moves];
        const BallStart& other = scene.ball[one + two - moves];
        const Vec2 apart = planar(moving.position - other.position);
        moving.position.head<2>() =
            planar(other.position) +
            apart * contact_distance(moving.own->R, other.own->R, scene.balls.discs()) / length(apart);
        Plan plan = make_plan(scene, laws.plan.isa);
        plan.cluster_tolerance = tolerance;
        const Record record = simulate(plan);
        if (record.events.empty() || record.events[0].type != EventType::kBallCluster ||
            record.clusters[0].balls.size() != balls.size())
            throw TangentError("a small change makes more or fewer balls touch");
        List after;
        for (const BallTrack& track : record.tracks) {
            const Segment& end = track.segments.back();
            const double tau = duration - end.start;
            if ((end.start > 0.0) != (duration > 0.0))
                throw TangentError("its balls meet something else during the impact");
            const List ball = list_of({{velocity_at(end, tau), spin_at(end, tau, track.own->R)}});
            after.insert(after.end(), ball.begin(), ball.end());
            const Vec2 from = planar(position_at(end, tau)) - planar(track.segments.front().r);
            for (const double x : from) after.push_back(x / unit);
        }
        return after;
    };
    // The result is smooth only to the tolerance.
    std::vector<Dual> out =
        differentiate(laws, in, [&](const double* list) { return resolve(list, kClusterTolerance); });
    List values;
    for (const Dual& value : in.values()) values.push_back(value.x);
    const List usual = resolve(values.data(), laws.plan.cluster_tolerance);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].x = usual[k];
    for (std::size_t k = 0; k < balls.size(); ++k) {
        put(states[k], out.data() + 8 * k);
        for (std::size_t i = 0; i < 2; ++i) states[k].r[i] = states[k].r[i] + unit * out[8 * k + 6 + i];
    }
}

void meet_cushion(Laws& laws, int ball, const CushionModelInfo& model, const Dual2& normal,
                  const Dual& height, bool hops, State& s) {
    const Dual fall = s.v[2];
    s.v[2] = 0.0;
    const double speed = std::abs(normal[0].x * s.v[0].x + normal[1].x * s.v[1].x);
    const double most = std::max(speed_of(s, laws.numbers.balls[ball].R), speed);
    meet_table(laws, ball, {normal[0], normal[1], height}, most > 0.0 ? speed / most : 1.0, speed, s,
               [&](const Reader& in, const BallSize& size, const Vec3& nose, Velocities& at) {
                   const NoseTouch touch{planar(nose) / length(planar(nose)), nose.z(), &model};
                   if (!bounce(in.balls, size, {&touch, 1}, hops ? std::optional(in.gravity) : std::nullopt,
                               laws.plan.impact.tolerance, at))
                       throw TangentError("its model has no solution nearby");
               });
    if (!hops) s.v[2] = fall;
}

void meet_nose_in_air(Laws& laws, int ball, const CushionModelInfo& model, const Dual3& apart, State& s) {
    double speed = 0.0;
    for (int i = 0; i < 3; ++i) speed += apart[i].x * s.v[i].x;
    const double reach = length3(apart).x, most = speed_of(s, laws.numbers.balls[ball].R);
    speed = std::abs(speed) / reach;
    meet_table(laws, ball, apart, most > 0.0 ? reach * speed / most : reach, speed, s,
               [&](const Reader& in, const BallSize& size, const Vec3& r, Velocities& at) {
                   hit_nose(in.balls, size.R, model, r / length3(r), parting_speed(size.R, in.gravity), at);
               });
}

void meet_cloth(Laws& laws, int ball, State& s) {
    meet_table(laws, ball, {}, 1.0, std::abs(s.v[2].x), s,
               [](const Reader& in, const BallSize& size, const Vec3&, Velocities& at) {
                   hit_cloth(in.balls, motion_params(in.balls, in.gravity, size.R), at);
               });
}

}  // namespace carom::tangent
