// How long one solution of a group of resting contacts is accurate, and its segments.
#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/resting_group.h"
#include "physics/motion.h"

namespace carom::resting {

namespace {

// First time at which |x + t D| = S t: friction S has then cancelled the initial x and the contribution of D.
double time_gone(const Vec2& x, const Vec2& D, double S) {
    const double xx = dot(x, x), xD = dot(x, D), A = S * S - dot(D, D);
    const double root = std::sqrt(std::max(0.0, xD * xD + A * xx));
    const double time = root - xD > 0.0 ? xx / (root - xD) : kNever;
    return time > 0.0 ? time : kNever;
}

// Interval, reduced in steps of a tenth, for which an error that grows with the given power of it is at most
// `allowed`.
double allowed_interval(double h, double error, double allowed, int power) {
    if (!(error > allowed)) return kNever;
    const double falls =
        power == 1 ? kReduced : (power == 2 ? kReduced * kReduced : kReduced * kReduced * kReduced);
    while (error > allowed && h > kShortestInterval) {
        error *= falls;
        h *= kReduced;
    }
    return h;
}

// A slip or velocity at the start and at the end, opposed by friction of this strength.
struct Moving {
    Vec2 start, end;
    double strength;
};

Moving moving(const Group& g, const Body& b) {
    if (moves(b.u)) return {b.u, b.slip_end(), g.motion.slide * b.load};
    if (b.mode == Mode::kSliding) return {Vec2::Zero(), b.slip_end(), 0.0};
    return {b.v, b.v_end, g.motion.roll};
}

// Sine of the angle; 1 beyond a right angle.
double turn_of(const Vec2& from, const Vec2& to) {
    return dot(from, to) > 0.0 ? std::abs(cross(from, to)) / (length(from) * length(to)) : 1.0;
}

// Time at which the slip or the velocity of a ball has ended, if within the interval h.
double gone_within(const Group& g, const Body& b, double h) {
    if (moves(b.u)) return b.mode == Mode::kSliding ? kNever : slip_gone(g, b, h);
    if (b.mode != Mode::kResting || !moves(b.v)) return kNever;
    return time_gone(b.v, (5.0 / 7.0) * (b.push + b.couple) / h, g.motion.roll);
}

// Time at which the whole group rests, if within the interval h.
double time_of_rest(const Group& g, double h) {
    double last = 0.0;
    for (const Body& b : g.bodies) {
        if (b.mode != Mode::kResting || moves(b.u)) return kNever;
        if (moves(b.v)) last = std::max(last, gone_within(g, b, h));
    }
    return last > 0.0 ? last : kNever;
}

// [s] How far an interval may extend past a stop: its ball decelerates uniformly until the end of the
// interval, and so moves too far.
double after_stop(const Group& g, double speed) {
    return std::min(kStopsWithin, 2.0 * g.around.precision * kPlaceError / speed);
}

// Time at which the slip or velocity ends, if the interval has to end there.
double gone_fast(const Group& g, const Body& b, double h) {
    const double gone = gone_within(g, b, h);
    if (gone == kNever) return kNever;
    const double slack = after_stop(g, length(moving(g, b).start));
    return slack <= kSoon * gone && h > gone + slack ? gone : kNever;
}

// Time at which a fast slip or velocity will end if the interval h is continued.
double gone_later(const Group& g, const Body& b, double h) {
    const Moving m = moving(g, b);
    const double start = length(m.start), along = start > 0.0 ? dot(m.end, m.start) / start : 0.0;
    const bool goes =
        b.mode != Mode::kResting && along > 0.0 && along < start && after_stop(g, start) < kSoon * h;
    return goes ? h * start / (start - along) : kNever;
}

// Interval over which a ball's friction direction is accurate. A friction of strength S along a direction
// that turns by w, evaluated at the middle of the interval, has the error S w h^2 / 12; S h^2 / 2 is an upper
// bound of any error.
double friction_interval(const Group& g, const Body& b, double h) {
    const Moving m = moving(g, b);
    if (!moves(m.start)) return kNever;
    const double gone = gone_within(g, b, h);
    if (gone < kNever) {
        const double slack = after_stop(g, length(m.start));
        double limit = h <= gone + slack || slack <= kSoon * gone ? kNever : gone + slack;
        if (moves(b.u) && b.mode == Mode::kResting) {
            const double stop = time_gone(b.v, (5.0 / 7.0) * (b.push + b.couple) / h, g.motion.roll) +
                                after_stop(g, length(b.v));
            if (h > stop) limit = std::min(limit, stop);
        }
        return limit;
    }
    const double turn = turn_of(m.start, m.end);
    if (turn <= kSame) return kNever;
    if (turn > kTurnOfMiddle)
        return allowed_interval(h, 0.5 * m.strength * h * h, g.around.precision * kPlaceError, 2);
    return allowed_interval(h, m.strength * turn * h * h / 12.0, g.around.precision * kPlaceError, 3);
}

// Whether a gap stays within its allowed range until h.
bool stays(const Group& g, const Link& link, double h) {
    const auto [least, most] = GapCourse(g, link, h).range(h);
    return least >= std::min(link.gap, -kOverlapGrowth) - kNoGap &&
           !(link.J > 0.0 && most > std::max(link.gap, kGapLeft));
}

// Whether two balls slip on each other until the end of the interval.
bool slips_on(const Group& g, const Link& link) {
    return slip_ended(g, link) < length(contact_slip(g, link, false));
}

double link_interval(const Group& g, const Link& link, double h) {
    if (link.open) return kNever;
    const Body& b = g.bodies[link.i];
    double interval =
        time_past_end(g.around.geometry, link.contact,
                      {planar(g.group.balls[link.i].r), b.v, (b.v_end - b.v) / h, kNever, false, true});
    if (!stays(g, link, h)) interval = std::min(interval, kShorter * h);
    if (!(link.J > 0.0)) {
        const double rate = gap_rate(g, link);
        // A contact that opens is released once its rate exceeds rounding, and before its gap is visible.
        const double opening = 2.0 * (GapCourse(g, link, h).at(h) - link.gap - rate * h) / (h * h);
        if (opening > 0.0)
            interval = std::min(interval, std::max(std::sqrt(2.0 * kGapLeft / opening),
                                                   (4.0 * g.noise + std::max(0.0, -rate)) / opening));
        if (rate > g.noise) interval = std::min(interval, kGapLeft / rate);
        return interval;
    }
    const double force = link.J / h;
    if (link.j >= 0 && !g.smooth) {
        // The friction between two balls changes with their slip, until that has ended.
        const double change = force * std::abs(friction_at_start(g, link) - link.friction_z);
        const double share = std::min(1.0, length(contact_slip(g, link, false)) / slip_ended(g, link));
        interval = std::min(
            interval, allowed_interval(h, change * h * h * share / 8.0, g.around.precision * kFrictionError,
                                       slips_on(g, link) ? 3 : 2));
    }
    if (link.distance == 0.0) return interval;
    const Vec2 v = relative(g, link, &Body::v), v_end = relative(g, link, &Body::v_end);
    // [rad] Largest possible turn of the normal.
    const double turn = 0.5 * h / std::abs(link.distance) *
                        (std::abs(cross(link.first, v)) + std::abs(cross(link.first, v_end)));
    return std::min(interval,
                    allowed_interval(h, force * turn * h * h / 12.0, g.around.precision * kPlaceError, 3));
}

// First attempt: until friction alone would have stopped the first ball.
double first_attempt(const Group& g) {
    double h = kLongestInterval;
    for (const Body& b : g.bodies) {
        const bool slips = moves(b.u);
        const double strength = slips ? g.motion.slide : g.motion.roll, speed = length(slips ? b.u : b.v);
        if (speed > 0.0 && strength > 0.0)
            h = std::min(h, (slips ? 1.0 : 2.0) * speed / strength + after_stop(g, speed));
    }
    return h;
}

void unguide(Group& g) {
    for (Body& b : g.bodies) b.guided = false;
    for (Link& link : g.links) link.guide.reset();
}

// Second order: uses the mean friction over the interval; on the cloth its direction at the middle, and
// between balls the mean of start and end.
bool guide(Group& g) {
    bool any = false;
    unguide(g);
    for (Link& link : g.links) {
        if (link.j < 0 || !(link.J > 0.0) || !slips_on(g, link)) continue;
        const double mean = 0.5 * (friction_at_start(g, link) + link.friction_z);
        if (mean == link.friction_z) continue;
        link.guide = mean;
        any = true;
    }
    for (Body& b : g.bodies) {
        const Moving m = moving(g, b);
        if (!moves(m.start) || !moves(m.end) || (!moves(b.u) && b.mode != Mode::kRolling)) continue;
        if (moves(b.u) && b.mode != Mode::kSliding) continue;
        const double turn = turn_of(m.start, m.end);
        if (turn <= kSame || turn > kTurnOfMiddle) continue;
        const Vec2 middle = m.start / length(m.start) + m.end / length(m.end);
        b.guide = middle / length(middle);
        b.guided = any = true;
    }
    return any;
}

// Whether guided balls still move, and slip on each other, in the directions that their frictions oppose.
bool keeps_direction(const Group& g) {
    return std::all_of(g.bodies.begin(), g.bodies.end(),
                       [&g](const Body& b) { return !b.guided || dot(moving(g, b).end, b.guide) >= 0.0; }) &&
           std::all_of(g.links.begin(), g.links.end(), [&g](const Link& link) {
               return !link.guide || *link.guide * contact_slip(g, link, true).x() <= 0.0;
           });
}

// Solves the same interval again, guided; keeps the old solution if that fails.
void guide_friction(Group& g, double h) {
    g.bodies_before = g.bodies;
    g.links_before = g.links;
    const bool smooth = g.smooth;
    if (!guide(g)) return;
    const bool solved = step(g, h) && !g.smooth && keeps_direction(g);
    g.smooth = smooth;
    if (solved) return;
    g.bodies.swap(g.bodies_before);
    g.links.swap(g.links_before);
}

// A wall around a ball turns it and does no work, but its impulse along the first normal does some, which
// would accumulate along the wall. Corrected only for a ball that touches nothing else.
void run_along_walls(Group& g) {
    for (const Link& link : g.links) {
        if (!(link.distance < 0.0) || !(link.J > 0.0)) continue;
        Body& b = g.bodies[link.i];
        if (std::count_if(g.links.begin(), g.links.end(), [&](const Link& other) {
                return !other.open && (other.i == link.i || other.j == link.i);
            }) > 1)
            continue;
        const double rolls = b.mode == Mode::kRolling ? 1.0 + kInertia : 1.0;
        const double towards = dot(link.n, b.v_end);
        const Vec2 along = b.v_end - towards * link.n;
        const double work = -b.ease * link.J * dot(link.n, b.v + b.v_end) / rolls,
                     left = dot(along, along) - work;
        if (!(left > 0.0) || !moves(along)) continue;
        b.v_end = towards * link.n + std::sqrt(left / dot(along, along)) * along;
        if (b.mode == Mode::kRolling) b.s_end = b.v_end;
    }
}

void write_segments(Group& g, double h) {
    double interval = kNever;
    for (const Body& b : g.bodies)
        if (moves(b.v) || moves(b.u) || b.mode != Mode::kResting) interval = h;
    std::vector<double> spinning(g.bodies.size(), kNever);
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        const Body& b = g.bodies[k];
        RestingBall& ball = g.group.balls[k];
        Segment& s = ball.segment;
        s = start_segment(g.now, ball.r, ball.v, ball.w, *ball.motion);
        s.held = true;
        const bool slides = moves(b.u) || b.mode == Mode::kSliding;
        if (!slides && !moves(b.v) && b.mode == Mode::kResting) {
            spinning[k] = s.state == MotionState::kSpinning ? s.duration : kNever;
            interval = std::min(interval, spinning[k]);
            continue;
        }
        s.state = slides ? MotionState::kSliding : MotionState::kRolling;
        s.a = (b.v_end - b.v) / h;
        const Vec2 ds = (b.s_end - b.s) / h;
        s.dw = Vec2(-ds.y(), ds.x()) / b.R;
    }
    interval = std::max(interval, kClockTicks * kEpsilon * g.now);
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        const Body& b = g.bodies[k];
        Segment& s = g.group.balls[k].segment;
        s.duration = interval;
        const bool slid = b.mode != Mode::kSliding || length(b.slip_end()) <= kSame * length(b.u);
        s.ends = moves(b.u)
                     ? slid && interval == h
                     : (moves(b.v) ? b.mode == Mode::kResting && interval == h : spinning[k] <= interval);
    }
}

bool accelerates(const Group& g) {
    constexpr double kRounding = kChangeUlp * kEpsilon;
    return std::any_of(g.bodies.begin(), g.bodies.end(), [](const Body& b) {
        return length(b.v_end - b.v) > kRounding * length(b.v) ||
               length(b.s_end - b.s) > kRounding * length(b.s);
    });
}

}  // namespace

double slip_gone(const Group& g, const Body& b, double h) {
    return time_gone(b.u, (b.push - 2.5 * b.couple) / h,
                     (g.motion.rolls ? 3.5 : 1.0) * g.motion.slide * b.load);
}

double accurate_interval(const Group& g, double h) {
    double accurate = kNever;
    for (const Body& b : g.bodies) accurate = std::min(accurate, friction_interval(g, b, h));
    for (const Link& link : g.links) accurate = std::min(accurate, link_interval(g, link, h));
    return accurate;
}

void solve_interval(Group& g) {
    unguide(g);
    const double shortest = std::max(kShortestInterval, kClockTicks * kEpsilon * g.now);
    double h = std::max(shortest, std::min(first_attempt(g), kGrowth * g.group.last));
    int longer = 0;
    double gone_before = 0.0;  // something ended before this time, but not within the last interval
    for (int attempt = 1;; ++attempt) {
        const bool solved = step(g, h);
        double accurate = accurate_interval(g, h), gone = kNever, later = kNever;
        if (!solved) accurate = std::min(accurate, 0.25 * h);
        for (const Body& b : g.bodies) {
            gone = std::min(gone, gone_fast(g, b, h));
            later = std::min(later, gone_later(g, b, h));
        }
        if (attempt == kAttempts) break;  // the bodies hold the solution of this h
        if (std::min(accurate, gone) < h * (1.0 - kSame) && h > shortest) {
            gone_before = gone <= accurate ? h : 0.0;
            h = std::max(shortest, std::min(accurate, gone * (1.0 + 0.5 * kSame)));
        } else if (later < std::max(gone_before, (1.0 + kSoon) * h) && longer < kLonger) {
            h = later * (1.0 + 0.5 * kSame);
            ++longer;
        } else if (const double rest = std::max(shortest, time_of_rest(g, h));
                   rest < h * (1.0 - kSame) && longer < kLonger) {
            h = rest * (1.0 + 0.5 * kSame);
            ++longer;
        } else {
            // If everything moves straight and uniformly, continue until something ends it.
            if (solved && !accelerates(g)) h = std::max(shortest, std::min(accurate, gone));
            guide_friction(g, h);
            const bool all_stay = std::all_of(g.links.begin(), g.links.end(), [&](const Link& link) {
                return link.open || stays(g, link, h);
            });
            if (h <= shortest || all_stay) break;
            unguide(g);
            h = std::max(shortest, kShorter * h);
            longer = kLonger;
        }
    }
    run_along_walls(g);
    keep_energy(g, h);
    write_segments(g, h);
}

}  // namespace carom::resting
