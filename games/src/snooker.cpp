// Snooker by the World Professional Billiards and Snooker Association, section 3. A miss is judged only if a
// straight path to a ball on was clear; a referee judges all others.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

constexpr int kLeastPenalty = 4, kRedPoints = 1, kMissesThatLose = 3;
// A foul after a red before a colour is nominated, and reds in successive strokes (3.10).
constexpr int kMostPenalty = 7;

int points_of(std::string_view ball) {
    if (number_of(ball) > 0) return kRedPoints;
    const auto colour = std::find(kColours.begin(), kColours.end(), ball);
    return colour == kColours.end() ? 0 : 7 - static_cast<int>(colour - kColours.begin());
}

bool is_colour(std::string_view ball) {
    return points_of(ball) > kRedPoints;
}

/// The balls that are on, ignoring a free ball.
std::vector<std::string> balls_on(BallOn on, const std::vector<std::string>& balls) {
    std::vector<std::string> list;
    for (const std::string& ball : balls) {
        const int points = points_of(ball);
        const bool any = on == BallOn::kColour && points > kRedPoints;
        if (any || (points > 0 && points == static_cast<int>(on))) list.push_back(ball);
    }
    return list;
}

/// The ball on after a miss or a foul, or after the colour that follows the last red.
BallOn lowest_on(const std::vector<std::string>& balls) {
    int least = static_cast<int>(BallOn::kBlack);
    for (const std::string& ball : balls)
        if (points_of(ball) > 0) least = std::min(least, points_of(ball));
    return static_cast<BallOn>(least);
}

/// Whether no ball on can be hit on both of its edges from this place.
bool snookered_at(const Vec2& from, double R, std::span<const Lying> on, std::span<const Lying> not_on) {
    return std::none_of(on.begin(), on.end(), [&](const Lying& ball) {
        const Vec2 to = ball.place - from;
        const double distance = length(to), both = R + ball.R;
        if (distance <= both) return true;
        const double way = std::sqrt(distance * distance - both * both);
        const double cos = way / distance, sin = both / distance;
        const Vec2 unit = to / distance;
        const std::array sides{sin, -sin};
        return std::all_of(sides.begin(), sides.end(), [&](double side) {
            const Vec2 edge(cos * unit.x() - side * unit.y(), side * unit.x() + cos * unit.y());
            return is_clear(from, from + way * edge, R, not_on);
        });
    });
}

/// A stroke: the ball on, the nomination, and the balls that fell.
class Stroke {
  public:
    explicit Stroke(const Facts& facts);

    int penalty() const { return fouls.empty() ? 0 : penalty_; }
    int points() const;
    std::vector<Respot> respots() const;
    BallOn next_on(const std::vector<std::string>& on_table) const;
    /// Whether no ball on was hit first, although a straight path to any part of one, or to a full ball, was
    /// clear (3.14).
    bool missed(bool full) const;

    std::vector<Foul> fouls;

  private:
    void add(Foul foul, int value) {
        fouls.push_back(foul);
        penalty_ = std::max(penalty_, value);
    }
    void add_first_fouls();
    bool touches_on() const;
    bool snookers_behind_free_ball() const;

    const Facts& facts_;
    std::vector<std::string> on_;  // balls on, with the free ball
    std::string free_;             // the free ball, or ""
    // Balls that touched the cue ball. A ball on counts as hit when the cue ball is played away from it (3,
    // touching ball).
    std::vector<std::string> touching_;
    int penalty_ = kLeastPenalty;
};

Stroke::Stroke(const Facts& facts) : facts_(facts) {
    const State& state = facts.state;
    on_ = balls_on(state.on, facts.ids());
    touching_ = facts.touching(facts.shot.struck, 0.0);
    const auto could_be_on = std::find_if(touching_.begin(), touching_.end(), [&](const std::string& ball) {
        return is_in(ball, on_) || (state.free_ball && points_of(ball) > 0);
    });
    const std::string first = !facts.shot.first_hits.empty()   ? facts.id(facts.shot.first_hits.front())
                              : could_be_on != touching_.end() ? *could_be_on
                                                               : "";
    const std::string nominated = facts.call.ball.empty() ? first : facts.call.ball;
    if (state.on == BallOn::kColour)
        on_ = is_colour(nominated) ? std::vector{nominated} : std::vector<std::string>();
    else if (state.free_ball && points_of(nominated) > 0 && !is_in(nominated, on_)) {
        free_ = nominated;
        on_.push_back(free_);
    }
    if (state.on != BallOn::kColour) penalty_ = std::max(penalty_, static_cast<int>(state.on));
    if (state.on == BallOn::kColour)
        penalty_ = std::max(penalty_, is_colour(nominated) ? points_of(nominated) : kMostPenalty);
    if (facts.shot.fell(facts.shot.struck)) add(Foul::kCueBallPocketed, 0);
    if (facts.shot.left(facts.shot.struck)) add(Foul::kCueBallOff, 0);
    add_first_fouls();
    for (const Shot::Fallen& f : facts.shot.pocketed)
        if (f.ball != facts.shot.struck && !is_in(facts.id(f.ball), on_))
            add(Foul::kWrongBallPocketed, points_of(facts.id(f.ball)));
    for (const int ball : facts.shot.out)
        if (ball != facts.shot.struck) add(Foul::kBallOff, points_of(facts.id(ball)));
    const Vec2 start = planar(facts.record.state_at(facts.shot.struck, 0.0).position);
    if (state.in_hand == InHand::kD && !in_area(facts.record.table, InHand::kD, start))
        add(Foul::kPlacedOutside, 0);
    if (facts.jumps()) add(Foul::kJumpShot, 0);
    if (fouls.empty() && snookers_behind_free_ball()) add(Foul::kBehindTheFreeBall, 0);
}

bool Stroke::touches_on() const {
    return std::any_of(touching_.begin(), touching_.end(),
                       [this](const auto& ball) { return is_in(ball, on_); });
}

/// Whether the free ball, as the nearest of all balls that are not on, hides all balls on from the other
/// player. With only pink and black left, this is no foul.
bool Stroke::snookers_behind_free_ball() const {
    if (free_.empty() || points() > 0 || facts_.gone(free_)) return false;
    std::vector<std::string> left;
    for (const std::string& ball : facts_.ids())
        if (points_of(ball) > 0 && !facts_.gone(ball)) left.push_back(ball);
    const std::vector<std::string> on = balls_on(lowest_on(left), left);
    if (is_in(free_, on) || (left.size() == 2 && is_in("pink", left) && is_in("black", left))) return false;
    const auto lying = [this](const std::string& ball) {
        const int i = index_of(facts_.record, ball);
        return Lying{planar(facts_.record.state_at(i, facts_.record.duration).position),
                     facts_.record.size(i).R, 0.0};
    };
    const Lying cue = lying(facts_.id(facts_.shot.struck));
    std::vector<Lying> targets;
    targets.reserve(on.size());
    for (const std::string& ball : on) targets.push_back(lying(ball));
    const auto away = [&](const std::string& ball) { return length(lying(ball).place - cue.place); };
    const auto hides = [&](const std::string& ball) {
        return snookered_at(cue.place, cue.R, targets, std::array{lying(ball)});
    };
    return hides(free_) && std::none_of(left.begin(), left.end(), [&](const std::string& ball) {
               return !is_in(ball, on) && ball != free_ && away(ball) < away(free_) && hides(ball);
           });
}

void Stroke::add_first_fouls() {
    const std::vector<int>& hits = facts_.shot.first_hits;
    if (touches_on()) return;
    if (hits.empty()) {
        add(Foul::kNoBallHit, 0);
        return;
    }
    int most = 0;
    bool all_on = true, free_hit = free_.empty();
    for (const int ball : hits) {
        most = std::max(most, points_of(facts_.id(ball)));
        all_on = all_on && is_in(facts_.id(ball), on_);
        free_hit = free_hit || facts_.id(ball) == free_;
    }
    // 3.12: the free ball is hit first, alone or at once with a ball on.
    if (all_on && free_hit) return;
    add(hits.size() > 1 ? Foul::kTwoBallsAtOnce : Foul::kWrongBallFirst, most);
}

int Stroke::points() const {
    if (!fouls.empty()) return 0;
    int points = 0;
    const BallOn on = facts_.state.on;
    for (const Shot::Fallen& f : facts_.shot.pocketed) {
        const std::string& ball = facts_.id(f.ball);
        if (on == BallOn::kRed)
            points += kRedPoints;
        else if (on == BallOn::kColour)
            points = points_of(ball);
        else
            points = static_cast<int>(on);
    }
    return points;
}

/// Respots the colours, except the one that is on in its turn and falls fairly: first those with free spots,
/// then the highest.
std::vector<Respot> Stroke::respots() const {
    const BallOn on = facts_.state.on;
    std::vector<std::string> back;
    for (const std::string_view colour : kColours) {
        const bool stays_down = fouls.empty() && points_of(colour) == static_cast<int>(on) && colour != free_;
        if (facts_.gone(colour) && !stays_down) back.emplace_back(colour);
    }
    std::vector<Respot> respots;
    std::vector<Lying> others = facts_.lying(kSpotGap, kSpotGap);
    const Table& table = facts_.record.table;
    for (const bool own_spots : {true, false}) {
        for (const std::string& colour : back) {
            const bool done = is_in(colour, respots);
            const double R = facts_.radius(colour);
            if (done || (own_spots && !is_free(snooker_spot(table, colour), R, others))) continue;
            respots.push_back({colour, spot_snooker(table, colour, R, others)});
            others.push_back({respots.back().place, R, kSpotGap});
        }
    }
    return respots;
}

BallOn Stroke::next_on(const std::vector<std::string>& on_table) const {
    return facts_.state.on == BallOn::kRed && points() > 0 ? BallOn::kColour : lowest_on(on_table);
}

bool Stroke::missed(bool full) const {
    const bool hit = std::none_of(fouls.begin(), fouls.end(), [](Foul foul) {
        return foul == Foul::kNoBallHit || foul == Foul::kWrongBallFirst;
    });
    if (hit) return false;
    const std::vector<std::string> on = on_.empty() ? balls_on(facts_.state.on, facts_.ids()) : on_;
    const auto at = [&](int ball) { return planar(facts_.record.state_at(ball, 0.0).position); };
    std::vector<Lying> not_on, balls;
    for (int ball = 0; ball < static_cast<int>(facts_.record.tracks.size()); ++ball)
        if (ball != facts_.shot.struck)
            (is_in(facts_.id(ball), on) ? balls : not_on)
                .push_back({at(ball), facts_.record.size(ball).R, 0.0});
    const double R = facts_.record.size(facts_.shot.struck).R;
    const Vec2 from = at(facts_.shot.struck);
    return std::any_of(balls.begin(), balls.end(), [&](const Lying& ball) {
        const Vec2 to = (ball.place - from) / length(ball.place - from);
        constexpr int kParts = 20;  // of half a ball
        for (int part = full ? 0 : 1 - kParts; part <= (full ? 0 : kParts - 1); ++part) {
            // The cue ball's place when it hits this part.
            const double sin = static_cast<double>(part) / kParts, cos = std::sqrt(1.0 - sin * sin);
            const Vec2 back(-cos * to.x() - sin * to.y(), sin * to.x() - cos * to.y());
            if (is_clear(from, ball.place + (R + ball.R) * back, R, not_on)) return true;
        }
        return false;
    });
}

/// Points that are left on the table.
int points_left(BallOn on, const std::vector<std::string>& balls) {
    int points = on == BallOn::kColour ? points_of("black") : 0;
    for (const std::string& ball : balls)
        points += number_of(ball) > 0 ? kRedPoints + points_of("black") : points_of(ball);
    return points;
}

/// 3.14: adds the consequences of a miss. The other player may have the balls replaced. The third miss in a
/// row with a clear path to a full ball loses the frame.
void add_miss(const Facts& facts, const Stroke& stroke, const std::vector<std::string>& on_table,
              Verdict& verdict) {
    const State& state = facts.state;
    const auto me = static_cast<std::size_t>(state.turn);
    const auto needs_fouls = [](const State& at, const std::vector<std::string>& balls) {
        return std::abs(at.points[0] - at.points[1]) >= points_left(at.on, balls);
    };
    const bool excused = state.fouls[me] == 0 &&
                         (needs_fouls(state, facts.ids()) || needs_fouls(verdict.options[0].state, on_table));
    if (rule(state, "miss") == "false" || excused || !stroke.missed(false)) return;
    verdict.fouls.push_back({Foul::kMiss});
    Option replay{Decision::kReplace, state, {}};
    replay.state.points = verdict.options[0].state.points;
    replay.state.in_hand = InHand::kNo;
    replay.state.fouls[me] = stroke.missed(true) ? state.fouls[me] + 1 : 0;
    if (replay.state.fouls[me] >= kMissesThatLose) {
        verdict.fouls.push_back({Foul::kThirdFoul});
        verdict.options = {{Decision::kPlayOn, won_by(replay.state, 1 - state.turn), {}}};
        verdict.chooser = -1;
        return;
    }
    for (int ball = 0; ball < static_cast<int>(facts.record.tracks.size()); ++ball)
        replay.respots.push_back({facts.id(ball), planar(facts.record.state_at(ball, 0.0).position)});
    verdict.options.push_back(replay);
}

/// Whether the cue ball ends snookered: no ball on can be hit on both edges. In hand: from no place of a
/// lattice in the D.
bool is_snookered(const Facts& facts, const State& next, const std::vector<Respot>& respots,
                  const std::vector<std::string>& on_table) {
    const std::vector<std::string> on_ids = balls_on(next.on, on_table);
    std::vector<Lying> on, not_on;
    const auto add = [&](const std::string& ball, const Vec2& place) {
        if (!facts.struck(ball))
            (is_in(ball, on_ids) ? on : not_on).push_back({place, facts.radius(ball), 0.0});
    };
    for (const Respot& r : respots) add(r.ball, r.place);
    for (const std::string& ball : on_table) {
        const bool back = is_in(ball, respots);
        if (!back) add(ball, facts.rest(ball));
    }
    const double R = facts.record.size(facts.shot.struck).R;
    if (next.in_hand != InHand::kD) {
        const Vec2 cue = facts.rest(facts.shot.struck);
        return snookered_at(cue, R, on, not_on);
    }
    constexpr int kAcross = 12;  // lattice steps from the middle of the D to its edge
    const Table& table = facts.record.table;
    const double step = radius_of_d(table) / kAcross;
    for (int i = -kAcross; i <= kAcross; ++i)
        for (int j = 0; j <= kAcross; ++j) {
            const Vec2 place = snooker_spot(table, "brown") + Vec2(i * step, -j * step);
            if (!in_area(table, InHand::kD, place) || !is_free(place, R, on) || !is_free(place, R, not_on))
                continue;
            if (!snookered_at(place, R, on, not_on)) return false;
        }
    return true;
}

/// With only the black left, the first score or foul ends the frame. If the points are equal, the black is
/// respotted, and lots decide who plays it.
Verdict end_of_frame(const Facts& facts, const Stroke& stroke, State next) {
    Verdict verdict;
    verdict.fouls = called(stroke.fouls);
    if (next.points[0] != next.points[1]) {
        verdict.options = {{Decision::kPlayOn, won_by(next, next.points[0] > next.points[1] ? 0 : 1), {}}};
        return verdict;
    }
    next.on = BallOn::kBlack;
    next.in_hand = InHand::kD;
    std::vector<Respot> black;
    black.push_back({"black", snooker_spot(facts.record.table, "black")});
    verdict.options = {{Decision::kPlayOn, other_players(next, InHand::kD), black},
                       {Decision::kPassBack, next, black}};
    return verdict;
}

Legal legal_snooker(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    legal.first = balls_on(state.on, balls);
    if (state.free_ball) {
        legal.first.clear();
        for (const std::string& ball : balls)
            if (points_of(ball) > 0) legal.first.push_back(ball);
    }
    if (state.on == BallOn::kColour || state.free_ball) legal.callable = legal.first;
    return legal;
}

Verdict judge_snooker(const Facts& facts) {
    const State& state = facts.state;
    const Stroke stroke(facts);
    const auto me = static_cast<std::size_t>(state.turn);
    State next = state;
    next.opening = next.free_ball = false;
    next.fouls = {0, 0};
    next.in_hand = facts.shot.gone(facts.shot.struck) ? InHand::kD : InHand::kNo;
    next.points[me] += stroke.points();
    next.points[1 - me] += stroke.penalty();
    Verdict verdict;
    if (state.on == BallOn::kBlack && (stroke.points() > 0 || !stroke.fouls.empty())) {
        verdict = end_of_frame(facts, stroke, next);
    } else {
        const std::vector<Respot> respots = stroke.respots();
        std::vector<std::string> on_table;
        for (const std::string& ball : facts.ids())
            if (!facts.gone(ball) || is_in(ball, respots)) on_table.push_back(ball);
        next.on = stroke.next_on(on_table);
        verdict.fouls = called(stroke.fouls);
        const State other = other_players(next, next.in_hand);
        verdict.options = {{Decision::kPlayOn, stroke.points() > 0 ? next : other, respots}};
        if (!stroke.fouls.empty()) {
            verdict.options[0].state.free_ball = is_snookered(facts, other, respots, on_table);
            verdict.options.push_back({Decision::kPassBack, next, respots});
            verdict.chooser = other.turn;
            add_miss(facts, stroke, on_table, verdict);
        }
    }
    verdict.points = stroke.points();
    verdict.penalty = stroke.penalty();
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

namespace {

constexpr const char* kPenalty = "WPBSA 3, penalties";
constexpr FoulRule kSnookerFouls[] = {{Foul::kCueBallPocketed, kPenalty},
                                      {Foul::kCueBallOff, kPenalty},
                                      {Foul::kNoBallHit, kPenalty},
                                      {Foul::kWrongBallFirst, kPenalty},
                                      {Foul::kBallOff, kPenalty},
                                      {Foul::kPlacedOutside, kPenalty},
                                      {Foul::kThirdFoul, "WPBSA 3.14"},
                                      {Foul::kWrongBallPocketed, kPenalty},
                                      {Foul::kTwoBallsAtOnce, kPenalty},
                                      {Foul::kJumpShot, kPenalty},
                                      {Foul::kBehindTheFreeBall, "WPBSA 3, free ball"},
                                      {Foul::kMiss, "WPBSA 3.14"}};

}  // namespace

const GameRules kSnooker = {
    .info =
        {.name = "snooker",
         .title = "snooker",
         .book = "World Professional Billiards and Snooker Association, Official rules: section 3",
         .calls = "the nominated colour or free ball; by default the ball that is hit first",
         .balls = 21,
         .table = "snooker",
         .start = detail::start_of("game = \"snooker\"", {{"cue", 0.58, 0.2}}, "cue", 3.2, 90),
         .options = {{&kSnooker,
                      "miss",
                      {"false", "true"},
                      "A foul that hits no ball on first, although a straight path to one was clear, is a "
                      "miss: the other player may have the balls replaced."}}},
    .legal = detail::legal_snooker,
    .judge = detail::judge_snooker,
    .start = InHand::kD,
    .balls = {"cue", "black"},
    .fouls = kSnookerFouls,
    .words = [](const State& state) {
        const std::string on = state.on == BallOn::kColour ? "any colour" : name(state.on);
        return ", " + on + " on" + (state.free_ball ? ", free ball" : "");
    }};

}  // namespace carom::games
