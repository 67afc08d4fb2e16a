#include "player/lie.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "facts.h"
#include "lines.h"
#include "player/worth.h"

namespace carom::games::detail {
namespace {

// For the chance of a pot: the factor by which a pocket is wider than its straight paths because balls that
// rub a jaw still fall [-], and the error of the object ball that does not come from the aim [rad]. Both were
// fitted to simulated pots.
constexpr double kForgives = 1.4, kOtherError = 0.006;
/// [rad] Narrower paths are ignored.
constexpr double kNarrowest = 0.005;
/// [-] Cosine of the thinnest cut tried: 83 degrees.
constexpr double kThinnest = 0.12;
// A good place of the cue ball: its distance from the ghost ball [m], and the sine and cosine of its largest
// angle to the line, 35 degrees. Its chance is that of a pot at 0.4 m with a cosine of 0.85.
constexpr double kGoodDistance = 0.3, kGoodSin = 0.574, kGoodCos = 0.819;
constexpr double kIdealDistance = 0.4, kIdealStraight = 0.85;

/// Error function, within 3e-7 (Abramowitz, Stegun, Handbook of mathematical functions, 7.1.28), for x >= 0.
double error_function(double x) {
    const double sum =
        1.0 + x * (0.0705230784 +
                   x * (0.0422820123 +
                        x * (0.0092705272 + x * (0.0001520143 + x * (0.0002765672 + x * 0.0000430638)))));
    const double square = sum * sum, fourth = square * square, eighth = fourth * fourth;
    return 1.0 - 1.0 / (eighth * eighth);
}

/// [-] Balls of a group in eight-ball.
constexpr int kGroup = 7;
/// [-] Estimated chance to get from one ball to a good place for the next.
constexpr double kGetsThere = 0.9;
/// [-] Of the chance from a good place, the share that a miss leaves the opponent.
constexpr double kLeft = 0.5;

/// The ball that wins the game.
int money_ball(Game game) {
    return game == &kEightBall ? 8 : game == &kNineBall ? 9 : 10;
}

/// The chances to win [-] from a good place for the ball after this one, and of the opponent who shoots from
/// where a miss at this one leaves the cue ball.
struct Race {
    double after = 1.0, passed = 0.5;
};

/// From a good place for a ball with this chance.
double good_place(double ideal, const Race& race) {
    return kGetsThere * ideal * race.after + (1.0 - kGetsThere * ideal) * (1.0 - race.passed);
}

/// Both players need balls of their own. @param own  how many, and the mean chance from a good place
Race race_of(const std::pair<int, double>& own, const std::pair<int, double>& others) {
    // From a good place, by the number of the shooter's balls and the other player's.
    std::array<std::array<double, kGroup + 2>, kGroup + 2> mine{}, theirs{};
    mine[0].fill(1.0);
    theirs[0].fill(1.0);
    const double p = std::max(kLeft * own.second, 1e-3), q = std::max(kLeft * others.second, 1e-3);
    Race race;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(own.first); ++k)
        for (std::size_t m = 1; m <= static_cast<std::size_t>(others.first); ++m) {
            // After a miss, both miss in turns until one pots a ball.
            const double next = mine[k - 1][m], other = theirs[m - 1][k], both = 1.0 - (1.0 - p) * (1.0 - q);
            race = {next, (q * other + (1.0 - q) * p * (1.0 - next)) / both};
            mine[k][m] = good_place(own.second, race);
            theirs[m][k] =
                good_place(others.second, {other, (p * next + (1.0 - p) * q * (1.0 - other)) / both});
        }
    return race;
}

Numbers all_of(const Lie& lie) {
    Numbers all = 0;
    for (const Lie::Ball& ball : lie.balls) all |= only(ball.number);
    return all;
}

State of_other(State state) {
    state.turn = 1 - state.turn;
    return state;
}

}  // namespace

Lie lie_of(const Scene& scene) {
    Lie lie;
    lie.string = head_string(scene.table);
    for (const BallStart& ball : scene.ball) {
        const Vec2 place = planar(ball.position);
        if (const int number = number_of(ball.id); number > 0)
            lie.balls.push_back({number, place});
        else
            lie.cue = place;
    }
    return lie;
}

Lie lie_of(const Record& record, const Option& option) {
    Lie lie;
    lie.string = head_string(record.table);
    for (int b = 0; b < static_cast<int>(record.tracks.size()); ++b) {
        const std::string& id = record.tracks[static_cast<std::size_t>(b)].id;
        const auto back = std::find_if(option.respots.begin(), option.respots.end(),
                                       [&](const Respot& respot) { return respot.ball == id; });
        Vec2 place;
        if (back != option.respots.end()) {
            place = back->place;
        } else {
            const BallState end = record.state_at(b, record.duration);
            if (is_gone(end.state)) continue;
            place = planar(end.position);
        }
        if (const int number = number_of(id); number > 0)
            lie.balls.push_back({number, place});
        else
            lie.cue = place;
    }
    return lie;
}

Numbers targets(const State& state, const Lie& lie) {
    std::vector<std::string> ids, behind;
    for (const Lie::Ball& ball : lie.balls) {
        ids.push_back(std::to_string(ball.number));
        if (is_behind_string(state, lie.string, ball.place.y())) behind.push_back(ids.back());
    }
    const Legal allowed = legal(state, ids, behind);
    Numbers first = 0, callable = 0;
    for (const std::string& id : allowed.first) first |= only(number_of(id));
    for (const std::string& id : allowed.callable) callable |= only(number_of(id));
    return allowed.callable.empty() ? first : first & callable;
}

Potting::Potting(const Scene& scene, double sd_aim)
    : R_(scene.balls.R), both_(scene.balls.R), sd_aim_(std::max(sd_aim, 1e-5)) {
    for (const BallStart& ball : scene.ball)
        if (number_of(ball.id) == 0) both_ = R_ + scene.size_of(ball).R;
    const Table& table = scene.table;
    const double R = both_ - R_;
    const Vec2 size(table.width, table.length);
    noses_ << table.corner.x() + R, table.corner.y() + R, table.corner.x() + size.x() - R,
        table.corner.y() + size.y() - R;
    const Vec2 middle = table.corner + 0.5 * size;
    for (const Pocket& pocket : table.pockets) {
        Mouth mouth;
        // A pocket without jaws has no direct pots here; the search finds pots into it by playing.
        if (const auto jaws = jaws_of(table, pocket)) {
            const auto& [a, b] = *jaws;
            const Vec2 way = pocket.center - middle;
            const bool a_left = cross(way, a->center - middle) > cross(way, b->center - middle);
            const Jaw &left = a_left ? *a : *b, &right = a_left ? *b : *a;
            mouth = {true, left.center, right.center, R_ + left.radius, R_ + right.radius};
        }
        mouths_.push_back(mouth);
    }
}

Potting::Path Potting::path(int pocket, const Vec2& from) const {
    const Mouth& mouth = mouths_[static_cast<std::size_t>(pocket)];
    if (!mouth.there) return {};
    const Vec2 to_left = mouth.left - from, to_right = mouth.right - from;
    const double left_far = length(to_left), right_far = length(to_right);
    if (!(left_far > mouth.left_reach) || !(right_far > mouth.right_reach)) return {};
    // The outermost paths touch the jaws: tangents of the circles that the ball's centre must not enter.
    const auto turned = [](const Vec2& way, double far, double sin) {
        const double cos = std::sqrt(1.0 - sin * sin);
        return Vec2((cos * way.x() - sin * way.y()) / far, (sin * way.x() + cos * way.y()) / far);
    };
    const Vec2 leftmost = turned(to_left, left_far, -mouth.left_reach / left_far),
               rightmost = turned(to_right, right_far, mouth.right_reach / right_far);
    if (cross(rightmost, leftmost) <= 0.0 || dot(rightmost, leftmost) <= 0.0) return {};
    Path path;
    const Vec2 sum = leftmost + rightmost;
    path.towards = sum / length(sum);
    const Vec2 across = mouth.right - mouth.left;
    const double turn = cross(path.towards, across);
    if (std::abs(turn) < kSteepest * length(across)) return {};
    const double way = cross(to_left, across) / turn;
    if (!(way > 0.0)) return {};
    path.end = from + way * path.towards;
    path.width = length(leftmost - rightmost);
    return path;
}

double Potting::chance(double distance, double straight, double width) const {
    const double spread = length(Vec2(distance * sd_aim_ / (both_ * straight), kOtherError));
    return error_function(0.5 * kForgives * width / (std::sqrt(2.0) * spread));
}

bool Potting::inside(const Vec2& place) const {
    return is_inside(noses_, place);
}

bool Potting::clear(const Lie& lie, int number, const Vec2& from, const Vec2& to, double apart,
                    Numbers without) const {
    return std::all_of(lie.balls.begin(), lie.balls.end(), [&](const Lie::Ball& ball) {
        return ball.number == number || (without & only(ball.number)) != 0 ||
               dot(ball.place - from, to - from) <= 0.0 || distance_to_segment(ball.place, from, to) >= apart;
    });
}

bool Potting::reachable(const Lie& lie, int number, const Vec2& ghost, const Vec2& towards,
                        Numbers without) const {
    for (const double side : {0.0, -kGoodSin, kGoodSin}) {
        const double ahead = side == 0.0 ? 1.0 : kGoodCos;
        const Vec2 way(ahead * towards.x() - side * towards.y(), side * towards.x() + ahead * towards.y());
        const Vec2 from = ghost - kGoodDistance * way;
        if (inside(from) && clear(lie, number, from, ghost, both_, without)) return true;
    }
    return false;
}

std::vector<Pot> Potting::pots(const Lie& lie, Numbers balls, double least) const {
    std::vector<Pot> pots;
    if (!lie.cue) return pots;
    for (const Lie::Ball& ball : lie.balls) {
        for (int p = 0; (balls & only(ball.number)) != 0 && p < static_cast<int>(mouths_.size()); ++p) {
            const Path path = this->path(p, ball.place);
            if (path.width <= kNarrowest) continue;
            const Vec2 ghost = ball.place - both_ * path.towards, way = ghost - *lie.cue;
            const double distance = length(way);
            if (!inside(ghost) || !(distance > 0.0)) continue;
            const double straight = dot(way, path.towards) / distance;
            if (straight < kThinnest) continue;
            const double chance = this->chance(distance, straight, path.width);
            if (chance < least || !clear(lie, ball.number, ball.place, path.end, 2.0 * R_) ||
                !clear(lie, ball.number, *lie.cue, ghost, both_))
                continue;
            pots.push_back({ball.number, p, ghost, path.towards, distance, straight, chance});
        }
    }
    return pots;
}

std::array<Potting::Chance, kNumbers> Potting::chances(const Lie& lie, Numbers now, bool in_order) const {
    std::array<Chance, kNumbers> chances{};
    for (const Lie::Ball& ball : lie.balls) {
        // The lower balls are gone when this one is the next.
        const Numbers without = in_order ? only(ball.number) - 1 : 0;
        Chance& best = chances[static_cast<std::size_t>(ball.number)];
        for (int p = 0; p < static_cast<int>(mouths_.size()); ++p) {
            const Path path = this->path(p, ball.place);
            if (path.width <= kNarrowest) continue;
            const Vec2 ghost = ball.place - both_ * path.towards;
            if (!inside(ghost)) continue;
            const double ideal = chance(kIdealDistance, kIdealStraight, path.width);
            double from_here = 0.0;
            if (lie.cue && (now & only(ball.number)) != 0) {
                const Vec2 way = ghost - *lie.cue;
                const double distance = length(way),
                             straight = distance > 0.0 ? dot(way, path.towards) / distance : 0.0;
                if (straight >= kThinnest) from_here = chance(distance, straight, path.width);
            }
            if ((ideal <= best.ideal && from_here <= best.now) ||
                !clear(lie, ball.number, ball.place, path.end, 2.0 * R_, without))
                continue;
            if (ideal > best.ideal && reachable(lie, ball.number, ghost, path.towards, without))
                best.ideal = ideal;
            if (from_here > best.now && clear(lie, ball.number, *lie.cue, ghost, both_)) best.now = from_here;
        }
    }
    return chances;
}

std::pair<int, double> Potting::surest(const State& state, const Lie& lie) const {
    const bool in_hand = state.in_hand != InHand::kNo;
    const Numbers mine = targets(state, lie);
    const std::array<Chance, kNumbers> chances = this->chances(lie, mine);
    std::pair<int, double> best{0, 0.0};
    for (int n = 1; n < kNumbers; ++n) {
        const Chance& chance = chances[static_cast<std::size_t>(n)];
        const double now = in_hand ? chance.ideal : chance.now;
        if ((mine & only(n)) != 0 && now > best.second) best = {n, now};
    }
    return best;
}

std::array<double, Potting::kFeatures> Potting::features(const State& state, const Lie& lie) const {
    const bool eight = state.game == &kEightBall, in_hand = state.in_hand != InHand::kNo;
    const Numbers mine = targets(state, lie), all = all_of(lie), money = only(money_ball(state.game));
    const std::array<Chance, kNumbers> chances = this->chances(lie, in_hand ? Numbers{0} : mine, !eight);
    double best = 0.0;
    for (int n = 1; n < kNumbers; ++n) {
        const Chance& chance = chances[static_cast<std::size_t>(n)];
        if ((mine & only(n)) != 0) best = std::max(best, in_hand ? chance.ideal : chance.now);
    }
    Race race;
    int left = std::popcount(all);
    if (eight) {
        const auto side = [&](int player, Numbers may) {
            const Numbers needed = may | (all & money);
            double mean = 0.0;
            for (int n = 1; n < kNumbers; ++n)
                if ((needed & only(n)) != 0)
                    mean += chances[static_cast<std::size_t>(n)].ideal / std::popcount(needed);
            const bool open = state.group[static_cast<std::size_t>(player)] == Group::kOpen;
            return std::pair(open ? kGroup + 1 : std::popcount(needed), mean);
        };
        const auto own = side(state.turn, mine);
        left = own.first;
        race = race_of(own, side(1 - state.turn, targets(of_other(state), lie)));
    } else {
        // Both need the same balls, from the last one to the next.
        double good = 1.0;
        for (int n = money_ball(state.game); n > 0; --n)
            if ((all & only(n)) != 0) {
                const double ideal = chances[static_cast<std::size_t>(n)].ideal, may = kLeft * ideal;
                race = {good, (may * good + 1.0 - may) / (2.0 - may)};
                good = good_place(ideal, race);
            }
    }
    const double wins = best * race.after + (1.0 - best) * (1.0 - race.passed) - 0.5;
    return {1.0, wins, wins * wins * wins, best, left == 1 ? best : 0.0, in_hand ? 1.0 : 0.0};
}

double Potting::value(const State& state, const Lie& lie) const {
    if (lie.balls.empty()) return 0.0;
    const std::array<double, kFeatures> features = this->features(state, lie);
    const auto& weights = state.game == &kEightBall ? kWorthEightBall : kWorthRotation;
    double x = 0.0;
    for (std::size_t k = 0; k < kFeatures; ++k) x += weights[k] * features[k];
    return 1.0 / (1.0 + exponential(-x));
}

double Potting::worth(const Option& option, const Record& record, int player) const {
    const State& next = option.state;
    if (next.over) return next.winner == player ? 1.0 : 0.0;
    if (option.rerack()) return 0.5;
    const double chance = value(next, lie_of(record, option));
    return next.turn == player ? chance : 1.0 - chance;
}

}  // namespace carom::games::detail
