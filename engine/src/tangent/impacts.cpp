#include "tangent/impacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"
#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "physics/motion.h"
#include "physics/nose_reach.h"

namespace carom::tangent {
namespace {

// [-] Sizes of steps, relative to the speeds of the impact and to each coefficient. Larger ones may cross a
// corner of a model (a nose that sticks or slides; from 1e-3 on, one shot of 500 with `mathavan_2010` was
// right to 1e-7 only), smaller ones lose digits.
constexpr double kFirstStep = 3e-4, kLastStep = 2e-8;
// [-] Two estimates that differ by less agree; if the best ones differ by more, there is no derivative.
constexpr double kAgree = 1e-9, kDisagree = 1e-5;
// [-] The same of a cluster: its contacts open and close between two steps of its integration.
constexpr double kClusterDisagree = 1e-3;
// [R] Unit of the places of balls in a cluster: a third of a millimetre, within which a contact reaches.
constexpr double kClusterReach = 1e-2;
// [of the velocities after the impact, per step] A derivative below this is known no better than this.
constexpr double kRounding = 1e-3;
// [-] Most impacts at one nose in one bounce; loop/bounce.cpp has the reason.
constexpr int kMostImpacts = 200;

using List = std::vector<double>;
using Map = std::function<List(const double*)>;

/// The numbers that an impact reads. Spins are R w, so that a ball that rolls does so at every step.
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

std::vector<Dual> differentiate(Laws& laws, const Arguments& in, const Map& map,
                                double disagree = kDisagree) {
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
            // Half of the points are those of the last step.
            List near_below = at(lane, -h / size), near_above = at(lane, h / size);
            double apart = 0.0;
            for (std::size_t i = 0; i < y.size(); ++i) {
                now[i] = (8.0 * (near_above[i] - near_below[i]) - (above[i] - below[i])) / (12.0 * h) * size;
                apart = std::max(apart, std::abs(now[i] - last[i]));
            }
            // What is far below the size of the impact itself is rounding.
            const double scale = std::max({largest(now), largest(last), kRounding * size * largest(y)});
            const double error = scale > 0.0 ? apart / scale : 0.0;
            if (h < kFirstStep && error < best) {
                best = error;
                // Larger steps round less, as long as they agree with smaller ones.
                for (std::size_t i = 0; i < out.size(); ++i) out[i].d[lane] = last[i];
            }
            std::swap(last, now);
            std::swap(below, near_below);
            std::swap(above, near_above);
        }
        if (!(best < disagree))
            throw TangentError(fmt::format(
                "it lies at a corner of its model, between two laws (uncertain by {:.1g})", best));
        laws.error = std::max(laws.error, best);
    }
    return out;
}

/// Reads what Arguments holds.
struct Reader {
    explicit Reader(const double* list) : next(list) {
        balls = params_of(list);
        next += kParams;
        gravity = *next++;
    }
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

void add(List& out, const Velocities& ball) {
    for (const Vec3* part : {&ball.v, &ball.w}) out.insert(out.end(), part->data(), part->data() + 3);
}
void put(State& s, const Dual* from) {
    for (int i = 0; i < 3; ++i) s.v[i] = from[i], s.w[i] = from[3 + i];
}

double speed_of(const State& s, const Dual& R) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += s.v[i].x * s.v[i].x + R.x * R.x * s.w[i].x * s.w[i].x;
    return std::sqrt(sum);
}

/// [m/s] At which two balls approach.
double closing_speed(const Dual3& apart, const State& s1, const State& s2) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += apart[i].x * (s1.v[i].x - s2.v[i].x);
    return sum / length3(apart).x;
}

Arguments pair_arguments(const Laws& laws, int one, int two, const Dual3& apart, const State& s1,
                         const State& s2) {
    const Numbers::Ball &b1 = laws.numbers.balls[one], &b2 = laws.numbers.balls[two];
    Arguments in(laws.numbers);
    // In a thin hit the models bend within the closing speed.
    const double speed = std::abs(closing_speed(apart, s1, s2)), reach = length3(apart).x;
    const double most = std::max({speed_of(s1, b1.R), speed_of(s2, b2.R), speed});
    in.add(b1);
    in.add(b2);
    in.add(apart, most > 0.0 ? reach * speed / most : reach);
    in.add(s1, b1.R, speed);
    in.add(s2, b2.R, speed);
    return in;
}

/// The planar impact of Resolver::collide, at the tightest tolerance. Friction that a plan skips has no
/// effect, so none is skipped.
List collide_at(const Plan& plan, bool equal, const double* list) {
    Reader in(list);
    const BallSize size1 = in.size(), size2 = in.size();
    const BallParams& balls = in.balls;
    Vec2 apart = planar(in.vec());
    apart *= contact_distance(size1.R, size2.R, balls.discs()) / length(apart);
    const Velocities a = in.velocities(size1.R), b = in.velocities(size2.R);
    const Vec2 y = apart / length(apart), x(y.y(), -y.x());
    const Vec3 w = a.w + b.w;
    const double along = dot(x, planar(a.v - b.v)) - size1.R * w.z();
    const Vec2 slip(along, size1.R * dot(x, planar(w)));
    const BallBallModelInfo& model = *plan.ball_ball;
    kernel::ImpactParams params{.R = size1.R,
                                .m = size1.m,
                                .mu_s1 = balls.mu_s,
                                .mu_s2 = balls.mu_s,
                                .mu_b = model.reads_friction ? balls.ball_friction()(length(slip)) : 0.0,
                                .e_b = model.reads_restitution ? balls.e_b : 1.0,
                                .cloth_slip = plan.scene.physics.cloth_slip == ClothSlipSign::kAsPublished
                                                  ? kernel::ClothSlip::kAsPublished
                                                  : kernel::ClothSlip::kConsistent};
    const auto ball = [](const Vec2& r, double z, const Velocities& at) {
        return kernel::Ball{{r.x(), r.y(), z}, {at.v.x(), at.v.y(), 0.0}, {at.w.x(), at.w.y(), at.w.z()}};
    };
    const kernel::Ball ball1 = ball(Vec2::Zero(), size1.R, a), ball2 = ball(apart, size2.R, b);
    kernel::ImpactResult result;
    const bool integrated =
        model.reads_tolerance && (equal || params.mu_b != 0.0 || (params.mu_s1 != 0.0 && size1.R != size2.R));
    if (equal && !integrated && size1 == size2) {
        model.collide(plan.impact, ball1, ball2, params, result);
    } else if (integrated) {
        params.mass_ratio = size2.m / size1.m;
        params.radius_ratio = size2.R / size1.R;
        BallBallSettings settings = plan.impact;
        settings.tolerance = kernel::kTightestTolerance;
        model.collide(settings, ball1, ball2, params, result);
    } else {
        collide_unequal(size1, size2, ball1, ball2, params, result);
    }
    if (result.status != kernel::ImpactStatus::kOk)
        throw TangentError("its model has no solution nearby, as at the edge of a miss");
    List out;
    for (const double* part : {result.v1, result.w1, result.v2, result.w2})
        out.insert(out.end(), part, part + 3);
    return out;
}

}  // namespace

void collide(Laws& laws, int one, int two, const Dual3& apart, State& s1, State& s2) {
    const Plan& plan = laws.plan;
    if (plan.impact.march != nullptr && plan.ball_ball->reads_tolerance)
        throw TangentError(
            "physics.substeps makes it a step function of its input; use physics.tolerance instead");
    const Dual fall1 = s1.v[2], fall2 = s2.v[2];
    s1.v[2] = s2.v[2] = 0.0;
    const bool equal = plan.sizes[one] == plan.sizes[two];
    const std::vector<Dual> out =
        differentiate(laws, pair_arguments(laws, one, two, apart, s1, s2),
                      [&](const double* list) { return collide_at(plan, equal, list); });
    put(s1, out.data());
    put(s2, out.data() + 6);
    s1.v[2] = fall1;
    s2.v[2] = fall2;
}

void collide_free(Laws& laws, int one, int two, const Dual3& apart, bool slow, Lies lies, State& s1,
                  State& s2) {
    const BallBallModelInfo& model = *laws.plan.ball_ball;
    const std::vector<Dual> out =
        differentiate(laws, pair_arguments(laws, one, two, apart, s1, s2), [&](const double* list) {
            Reader in(list);
            FreePair pair{in.size(), in.size(), in.balls};
            if (!model.reads_restitution) pair.balls.e_b = 1.0;
            if (!model.reads_friction) pair.balls.mu_b = pair.balls.mu_b_more = 0.0;
            const Vec3 r = in.vec(), n = r / length3(r);
            Velocities a = in.velocities(pair.size1.R), b = in.velocities(pair.size2.R);
            const double parting = parting_speed(std::max(pair.size1.R, pair.size2.R), in.gravity);
            if (slow) {
                part_slowly(pair, n, lies.one, lies.two, parting, a, b);
            } else {
                pair.balls.e_b = std::max(pair.balls.e_b, parting / dot3(a.v - b.v, n));
                hit_ball(pair, n, a, b);
            }
            List after;
            add(after, a);
            add(after, b);
            return after;
        });
    put(s1, out.data());
    put(s2, out.data() + 6);
}

// The loop resolves the cluster again, in a scene that contains nothing else.
void collide_cluster(Laws& laws, const std::vector<int>& balls, int hit, int met,
                     std::vector<State>& states) {
    const auto member = [&](int ball) {
        return static_cast<std::size_t>(std::find(balls.begin(), balls.end(), ball) - balls.begin());
    };
    const std::size_t one = member(hit), two = member(met);
    const double speed = std::abs(closing_speed(states[two].r - states[one].r, states[one], states[two]));
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
    // Without the table, other effects may be needed than those that the scene excludes.
    std::erase_if(scene.effects, [](const EffectOverride& effect) { return !effect.in_force; });
    if (laws.flights()) scene.effects.push_back({"airborne", true, {}});
    scene.stop.events = 1;
    // The one that moves is put to touch, so that what touches at rest still does, to the last bit.
    const std::size_t moves = speed_of(states[one], 1.0) < speed_of(states[two], 1.0) ? two : one;
    const Map resolve = [&](const double* list) {
        Reader read(list);
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
        const Record record = simulate(make_plan(scene, laws.plan.isa));
        if (record.events.empty() || record.events[0].type != EventType::kBallCluster ||
            record.clusters[0].size() != balls.size())
            throw TangentError("more balls, or fewer, touch if it happens a little otherwise");
        List after;
        for (const BallTrack& track : record.tracks)
            add(after, {track.segments.back().v, track.segments.back().w});
        return after;
    };
    const std::vector<Dual> out = differentiate(laws, in, resolve, kClusterDisagree);
    for (std::size_t k = 0; k < balls.size(); ++k) put(states[k], out.data() + 6 * k);
}

void meet_cushion(Laws& laws, int ball, const CushionModelInfo& model, const Dual2& normal,
                  const Dual& height, bool hops, State& s) {
    const Numbers::Ball& numbers = laws.numbers.balls[ball];
    const Dual fall = s.v[2];
    s.v[2] = 0.0;
    const double speed = std::abs(normal[0].x * s.v[0].x + normal[1].x * s.v[1].x);
    const double most = std::max(speed_of(s, numbers.R), speed);
    Arguments in(laws.numbers);
    in.add(numbers);
    in.add({normal[0], normal[1], height}, most > 0.0 ? speed / most : 1.0);
    in.add(s, numbers.R, speed);
    const std::vector<Dual> out = differentiate(laws, in, [&](const double* list) {
        Reader read(list);
        const BallSize size = read.size();
        const Vec3 nose = read.vec();
        const Vec2 n = planar(nose) / length(planar(nose));
        const Velocities came = read.velocities(size.R);
        Velocities at = came;
        const CushionContact contact = cushion_contact(read.balls, size, nose.z(), n, at.v, at.w);
        const double noise = kClosingUlp * kEpsilon * (length(planar(at.v)) + size.R * at.w.norm());
        for (int k = 0; k < kMostImpacts && -dot(n, planar(at.v)) > noise; ++k)
            if (!model.resolve(contact, n, at.v, at.w))
                throw TangentError("its model has no solution nearby");
        if (hops && read.balls.e_h > 0.0 && model.grip != nullptr) {
            const double up = size.R - nose.z(), reach = nose_reach(size.R, nose.z(), 0.0);
            const MotionParams motion = motion_params(read.balls, read.gravity, size.R);
            const double hop = hop_speed(read.balls, motion, model,
                                         {size.R / reach * n.x(), size.R / reach * n.y(), up / reach}, came);
            const auto energy = [&size](const Velocities& v) {
                return v.v.squaredNorm() + kInertia * size.R * size.R * v.w.squaredNorm();
            };
            at.v.z() = std::min(hop, std::sqrt(std::max(0.0, energy(came) - energy(at))));
        }
        List after;
        add(after, at);
        return after;
    });
    put(s, out.data());
    if (!hops) s.v[2] = fall;
}

void meet_nose_in_air(Laws& laws, int ball, const CushionModelInfo& model, const Dual3& apart, State& s) {
    const Numbers::Ball& numbers = laws.numbers.balls[ball];
    double speed = 0.0;
    for (int i = 0; i < 3; ++i) speed += apart[i].x * s.v[i].x;
    const double reach = length3(apart).x, most = speed_of(s, numbers.R);
    speed = std::abs(speed) / reach;
    Arguments in(laws.numbers);
    in.add(numbers);
    in.add(apart, most > 0.0 ? reach * speed / most : reach);
    in.add(s, numbers.R, speed);
    const std::vector<Dual> out = differentiate(laws, in, [&](const double* list) {
        Reader read(list);
        const BallSize size = read.size();
        const Vec3 r = read.vec();
        Velocities at = read.velocities(size.R);
        hit_nose(read.balls, size.R, model, r / length3(r), parting_speed(size.R, read.gravity), at);
        List after;
        add(after, at);
        return after;
    });
    put(s, out.data());
}

void meet_cloth(Laws& laws, int ball, State& s) {
    const Numbers::Ball& numbers = laws.numbers.balls[ball];
    Arguments in(laws.numbers);
    in.add(numbers);
    in.add(s, numbers.R, std::abs(s.v[2].x));
    const std::vector<Dual> out = differentiate(laws, in, [](const double* list) {
        Reader read(list);
        const BallSize size = read.size();
        Velocities at = read.velocities(size.R);
        hit_cloth(read.balls, motion_params(read.balls, read.gravity, size.R), at);
        List after;
        add(after, at);
        return after;
    });
    put(s, out.data());
}

}  // namespace carom::tangent
