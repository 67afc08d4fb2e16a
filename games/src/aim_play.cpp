// Aiming by playing the shot.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "carom/engine/simulate.h"
#include "carom/games/aim.h"
#include "carom/games/shot.h"
#include "carom/games/spots.h"
#include "lines.h"

namespace carom::games {
namespace {

using detail::missed;
using detail::next_stop;
using detail::off_line;

/// [-] Doubling steps that bracket the wanted aim, and steps that then narrow it down.
constexpr int kBrackets = 14, kNarrow = 40;
/// [-] Corrections of a strike that misses the ball.
constexpr int kCorrections = 3;
/// [-] Accept an aim that keeps the ball this near to the middle of its paths, as a fraction of their width.
constexpr double kNearMiddle = 1e-3;
/// [-] Aims tried for banks, from one edge of the ball to the other.
constexpr int kBankAims = 240;

/// The effect of one strike on the ball to be potted.
struct Played {
    /// Sine of its angle to the wanted direction, positive to the left; empty if the strike misses
    std::optional<double> off;
    bool potted = false;  ///< in the wanted pocket
    int cushion = -1;     ///< the only cushion that it hit before, or -1
    std::string why;      ///< why `off` is empty
};

/// A strike at one ball for one pocket, with any aim.
struct AimTrial {
    AimTrial(const Scene& played, const Cue& how, std::string_view object, std::string_view into)
        : scene(played),
          ball_id(object),
          pocket(static_cast<int>(&detail::pocket_of(played, into) - played.table.pockets.data())),
          cue_place(planar(detail::ball_of(played, how.ball).position)),
          place(planar(detail::ball_of(played, object).position)),
          R(played.size_of(detail::ball_of(played, object)).R),
          both(R + played.size_of(detail::ball_of(played, how.ball)).R) {
        scene.cue = how;
        if (object == how.ball)
            throw std::invalid_argument("the struck ball cannot be the one to pot; name another");
    }

    Record play(double aim_deg) {
        scene.cue->aim_deg = aim_deg;
        validate(scene);
        ++shots;
        return simulate(make_plan(scene, kernel::best_isa()));
    }

    Scene scene;
    const std::string ball_id;
    const int pocket;
    const Vec2 cue_place, place;
    const double R, both;
    int shots = 0;
};

Vec2 place_at(const Record& record, int ball, double time) {
    return planar(record.state_at(ball, time).position);
}

bool fell_into(const Shot& shot, int ball, int pocket) {
    return std::find(shot.pocketed.begin(), shot.pocketed.end(), Shot::Fallen{ball, pocket}) !=
           shot.pocketed.end();
}

/// One strike. @param towards  the ball should run along it; null: into the pocket after its first cushion
Played played_at(AimTrial& trial, double aim_deg, const Vec2* towards) {
    const Record record = trial.play(aim_deg);
    const Shot shot = shot_of(record);
    const int ball = index_of(record, trial.ball_id);
    Played played;
    played.why = missed(record, shot, ball);
    if (!played.why.empty()) return played;
    double from = shot.first_time;
    const Event* stop = next_stop(record, ball, from);
    PocketLine line;
    if (towards == nullptr) {
        if (stop == nullptr || stop->type != EventType::kBallCushion) return played;
        played.cushion = stop->b;
        from = stop->time;
        const Pocket& pocket = record.table.pockets[static_cast<std::size_t>(trial.pocket)];
        line = detail::line_from(record.table, pocket, place_at(record, ball, from), trial.R);
        if (line.width_deg == 0.0) return played;
        stop = next_stop(record, ball, from);
        towards = &line.towards;
    }
    played.off = off_line(record, ball, from, stop, *towards);
    if (!played.off) played.why = "the ball does not move";
    played.potted = fell_into(shot, ball, trial.pocket);
    return played;
}

/// An aim, and the resulting path of the ball.
struct Tried {
    double aim_deg = 0.0;
    double off = 0.0;
};

/// Narrows two aims of opposite sign down to one that is near enough (regula falsi, Illinois).
template <class Play>
Tried narrowed(Tried a, Tried b, double near, const Play& play) {
    Tried best = std::abs(a.off) < std::abs(b.off) ? a : b;
    double weight_a = a.off, weight_b = b.off;
    for (int k = 0; k < kNarrow && std::abs(best.off) > near; ++k) {
        const double aim = (a.aim_deg * weight_b - b.aim_deg * weight_a) / (weight_b - weight_a);
        const std::optional<double> off = play(aim);
        if (!off) break;
        const Tried tried = {aim, *off};
        if (std::abs(tried.off) < std::abs(best.off)) best = tried;
        if ((tried.off > 0.0) == (a.off > 0.0)) {
            a = tried;
            weight_a = tried.off;
            weight_b *= 0.5;
        } else {
            b = tried;
            weight_b = tried.off;
            weight_a *= 0.5;
        }
    }
    return best;
}

/// Half of the angle under which the cue ball sees the ball that it should hit [degrees].
double half_view_deg(const AimTrial& trial) {
    const double distance = length(trial.place - trial.cue_place);
    return 90.0 - arc_cos(std::min(1.0, trial.both / distance)) * kDegrees;
}

/// Deviation of a cue ball that misses from its path to the ghost ball, by squirt and swerve [degrees];
/// positive to the left.
double strays_deg(const AimTrial& trial, const Record& record, const Vec2& ghost) {
    const Vec2 way = ghost - trial.cue_place;
    const int cue_ball = shot_of(record).struck;
    const Event* stop = next_stop(record, cue_ball, 0.0);
    double late = stop != nullptr ? stop->time : record.duration, early = 0.0;
    // At the distance of the ghost ball, or as far as it gets.
    for (int k = 0; k < kNarrow; ++k) {
        const double middle = 0.5 * (early + late);
        (length(place_at(record, cue_ball, middle) - trial.cue_place) < length(way) ? early : late) = middle;
    }
    const Vec2 went = place_at(record, cue_ball, late) - trial.cue_place;
    return direction_deg({dot(way, went), cross(way, went)});
}

/// Why geometry rules out the aim, or "".
std::string refused(const AimTrial& trial, const PocketLine& line, double cut_deg) {
    const std::string& id = trial.ball_id;
    if (line.width_deg == 0.0) return "no straight path of ball " + id + " into the pocket clears the jaws";
    if (!line.in_the_way.empty()) return "ball " + line.in_the_way + " is in the way of ball " + id;
    if (!(cut_deg < 90.0)) return "the cut would be 90 degrees or more";
    return "";
}

}  // namespace

namespace detail {

std::string missed(const Record& record, const Shot& shot, int ball) {
    if (shot.first_hits.empty()) return "the cue ball meets no ball";
    if (shot.first_hits.size() > 1) return "the cue ball meets two balls at once";
    if (shot.first_hits[0] != ball)
        return "the cue ball meets ball " + record.tracks[static_cast<std::size_t>(shot.first_hits[0])].id +
               " first";
    for (const BallContact& t : shot.touches)
        if (t.cushion() && t.ball == shot.struck && t.time < shot.first_time)
            return "the cue ball meets a cushion first";
    return "";
}

const Event* next_stop(const Record& record, int ball, double time) {
    for (const Event& e : record.events) {
        const EventKind& of = kind(e.type);
        const bool other = of.partner == Partner::kBall && e.b == ball;
        const bool mine = e.a == ball && (of.partner != Partner::kNone || e.type == EventType::kBallOut);
        if (e.time > time && (mine || other)) return &e;
    }
    return nullptr;
}

std::optional<double> off_line(const Record& record, int ball, double from, const Event* stop,
                               const Vec2& towards) {
    const Vec2 way =
        place_at(record, ball, stop != nullptr ? stop->time : record.duration) - place_at(record, ball, from);
    const double size = length(way);
    if (!(size > 0.0)) return std::nullopt;
    return cross(towards, way) / size;
}

}  // namespace detail

Aim aim_pot(const Scene& scene, const Cue& how, std::string_view ball, std::string_view pocket) {
    AimTrial trial(scene, how, ball, pocket);
    const PocketLine line = pocket_lines(scene, ball, how.ball)[static_cast<std::size_t>(trial.pocket)];
    const Vec2& ghost = line.ghost;
    Aim aim;
    aim.geometric_deg = direction_deg(ghost - trial.cue_place);
    aim.cut_deg = cut_angle_deg(trial.cue_place, ghost, line.towards);
    aim.why = refused(trial, line, aim.cut_deg);
    if (!aim.why.empty()) return aim;
    const double near = kNearMiddle * line.width_deg / kDegrees;
    const auto off_at = [&](double aim_deg) {
        const Played played = played_at(trial, aim_deg, &line.towards);
        aim.why = played.why;
        return played.off;
    };
    // Squirt and swerve may make the cue ball miss the ball; the aim moves back by the same angle.
    Tried start = {aim.geometric_deg, 0.0};
    std::optional<double> first = off_at(start.aim_deg);
    for (int k = 0; k < kCorrections && !first; ++k) {
        start.aim_deg -= strays_deg(trial, trial.play(start.aim_deg), ghost);
        first = off_at(start.aim_deg);
    }
    // A ball that runs too far to the left was hit too far on its right: the aim moves left, in doubling
    // steps.
    if (first) {
        start.off = *first;
        Tried a = start, b = a;
        double step = 0.02 * half_view_deg(trial) * (a.off > 0.0 ? 1.0 : -1.0);
        std::optional<double> miss;  // an aim that misses the ball: the wanted one is before it
        for (int k = 0; k < kBrackets && (a.off > 0.0) == (b.off > 0.0) && std::abs(b.off) > near; ++k) {
            const double next = miss ? 0.5 * (b.aim_deg + *miss) : b.aim_deg + step;
            const std::optional<double> off = off_at(next);
            if (off) {
                a = b;
                b = {next, *off};
                step *= 2.0;
            } else {
                miss = next;
            }
        }
        const bool between = (a.off > 0.0) != (b.off > 0.0);
        const Tried best = between ? narrowed(a, b, near, off_at) : b;
        const Played played = played_at(trial, best.aim_deg, &line.towards);
        aim.why = played.why;
        if (played.potted)
            aim.aim_deg = trial.scene.cue->aim_deg;
        else if (aim.why.empty())
            aim.why = std::abs(best.off) > near ? "no aim sends the ball there"
                                                : "the ball runs towards the pocket but does not fall";
    }
    if (aim.aim_deg) aim.why.clear();
    aim.shots = trial.shots;
    return aim;
}

std::vector<Aim> bank_routes(const Scene& scene, const Cue& how, std::string_view ball,
                             std::string_view pocket) {
    AimTrial trial(scene, how, ball, pocket);
    const double middle = direction_deg(trial.place - trial.cue_place), half = half_view_deg(trial);
    std::vector<Aim> routes;
    std::optional<Tried> last;
    int last_cushion = -1;
    for (int k = 0; k <= kBankAims; ++k) {
        const double aim_deg = middle + half * (2.0 * k / kBankAims - 1.0);
        const Played played = played_at(trial, aim_deg, nullptr);
        const std::optional<Tried> here =
            played.off ? std::optional(Tried{aim_deg, *played.off}) : std::nullopt;
        const bool crossed =
            here && last && last_cushion == played.cushion && (here->off > 0.0) != (last->off > 0.0);
        const std::string cushion =
            played.cushion < 0 ? "" : scene.table.cushions[static_cast<std::size_t>(played.cushion)].id;
        const bool known =
            std::any_of(routes.begin(), routes.end(), [&](const Aim& r) { return r.cushion == cushion; });
        if (crossed && !known) {
            const Tried best = narrowed(*last, *here, 1e-6, [&](double aim) {
                const Played next = played_at(trial, aim, nullptr);
                return next.cushion == played.cushion ? next.off : std::nullopt;
            });
            if (played_at(trial, best.aim_deg, nullptr).potted) {
                Aim route;
                route.aim_deg = trial.scene.cue->aim_deg;
                route.cushion = cushion;
                routes.push_back(route);
            }
        }
        last = here;
        last_cushion = played.cushion;
    }
    for (Aim& route : routes) route.shots = trial.shots;
    return routes;
}

}  // namespace carom::games
