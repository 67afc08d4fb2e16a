// Carom games: three-cushion, one-cushion and straight rail by the Union Mondiale de Billard, four-ball as in
// Korea; and sum to three.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/tolerances.h"
#include "facts.h"

namespace carom::games::detail {
namespace {

const std::string kRed = "red";

/// A carom game: the cue ball must meet two balls, with cushions before the second one.
struct CaromGame {
    Game game;
    int cushions;
    bool all_back;  ///< whether all balls are spotted if one must be
};
constexpr CaromGame kCaromGames[] = {
    {&kThreeCushion, 3, false}, {&kStraightRail, 0, true}, {&kOneCushion, 1, true}, {&kFourBall, 0, false}};

const CaromGame& carom_game(Game game) {
    return *std::find_if(std::begin(kCaromGames), std::end(kCaromGames),
                         [game](const CaromGame& row) { return row.game == game; });
}

bool is_red(std::string_view ball) {
    return ball.starts_with(kRed);
}

/// Where a ball is respotted for the next player. Three-cushion: the red on the foot spot, the cue ball on
/// the head spot, the other one in the centre. Straight rail and one-cushion: as at the start, and as
/// four-ball.
Vec2 own_spot(const Table& table, Game game, const std::string& ball, int shooter) {
    const bool own = ball == own_ball(shooter);
    if (ball == "red1") return head_spot(table);
    if (is_red(ball)) return foot_spot(table);
    if (game == &kThreeCushion) return own ? head_spot(table) : center_spot(table);
    if (own) return opening_spot(table);
    return game == &kFourBall ? center_spot(table) : head_spot(table);
}

/// A ball whose spot is occupied goes to the spot of the ball in the way, or as near as possible to its own.
std::vector<Respot> spotted(const Facts& facts, const std::vector<std::string>& balls, int shooter) {
    std::vector<Respot> respots;
    const Table& table = facts.record.table;
    const Game game = facts.state.game;
    std::vector<std::string> ids;
    std::vector<Lying> lying;
    for (const std::string& ball : facts.ids()) {
        if (is_in(ball, balls)) continue;
        ids.push_back(ball);
        lying.push_back({facts.rest(ball), facts.radius(ball), 0.0});
    }
    for (const std::string& ball : balls) {
        const double R = facts.radius(ball);
        Vec2 place = own_spot(table, game, ball, shooter);
        for (int tries = 0; tries < 3; ++tries) {
            const auto masked = std::find_if(lying.begin(), lying.end(), [&](const Lying& there) {
                return !is_free(place, R, std::span(&there, 1));
            });
            if (masked == lying.end()) break;
            place = own_spot(table, game, ids[static_cast<std::size_t>(masked - lying.begin())], shooter);
        }
        if (!is_free(place, R, lying)) place = spot_on_long_string(table, place, R, lying);
        respots.push_back({ball, place});
        ids.push_back(ball);
        lying.push_back({place, R, 0.0});
    }
    return respots;
}

/// A player's cue ball and the balls touching it; empty if none does.
std::vector<std::string> touching(const Facts& facts, int shooter) {
    const int own = index_of(facts.record, own_ball(shooter));
    std::vector<std::string> list = facts.touching(own, facts.record.duration);
    if (!list.empty()) list.insert(list.begin(), facts.id(own));
    return list;
}

/// Whether the cue ball touches a ball and is driven into it.
bool plays_into_touching(const Facts& facts) {
    const int cue = facts.shot.struck;
    const std::vector<Segment>& segments = facts.record.tracks[static_cast<std::size_t>(cue)].segments;
    const auto struck = std::find_if(segments.begin(), segments.end(),
                                     [](const Segment& segment) { return segment.v != Vec3::Zero(); });
    const std::vector<std::string> list = facts.touching(cue, 0.0);
    return struck != segments.end() && std::any_of(list.begin(), list.end(), [&](const std::string& ball) {
               const Vec3 place = facts.record.state_at(index_of(facts.record, ball), 0.0).position;
               return dot(planar(place - struck->r), planar(struck->v)) > kTouchTolerance;
           });
}

/// Whether the other player's ball counts as a red.
bool opponents_counts(const State& state) {
    return state.game != &kFourBall || rule(state, "opponents_ball") == "counts";
}

/// Whether the cue ball met two balls that count, the second one after the game's cushions.
bool made_carom(const Facts& facts) {
    int cushions = 0;
    std::vector<int> met;
    for (const BallContact& touch : facts.shot.touches) {
        if (touch.ball != facts.shot.struck) continue;
        if (touch.cushion()) {
            cushions += touch.driven ? 1 : 0;
        } else if ((is_red(facts.id(touch.other)) || opponents_counts(facts.state)) &&
                   std::find(met.begin(), met.end(), touch.other) == met.end()) {
            met.push_back(touch.other);
            if (met.size() == 2) return cushions >= carom_game(facts.state.game).cushions;
        }
    }
    return false;
}

/// After a point, or without one.
State after(const State& before, bool point) {
    State next = before;
    next.opening = false;
    next.in_hand = InHand::kNo;
    return point ? scored(next, before.turn, 1) : other_players(next, InHand::kNo);
}

std::vector<Foul> carom_fouls(const Facts& facts) {
    const State& state = facts.state;
    std::vector<Foul> fouls;
    if (!facts.struck(own_ball(state.turn))) fouls.push_back(Foul::kWrongCueBall);
    if (!facts.shot.out.empty()) fouls.push_back(Foul::kBallOff);
    const bool hits = !facts.shot.first_hits.empty();
    const bool first_is_red = std::any_of(facts.shot.first_hits.begin(), facts.shot.first_hits.end(),
                                          [&](int ball) { return is_red(facts.id(ball)); });
    if (state.opening && hits && !first_is_red) fouls.push_back(Foul::kOpeningNotRed);
    if (state.game != &kFourBall && plays_into_touching(facts)) fouls.push_back(Foul::kIntoTouchingBall);
    if (state.game != &kFourBall) return fouls;
    if (!hits) fouls.push_back(Foul::kNoBallHit);
    const bool opponents =
        std::any_of(facts.shot.touches.begin(), facts.shot.touches.end(), [&](const BallContact& touch) {
            return touch.ball == facts.shot.struck && !touch.cushion() && !is_red(facts.id(touch.other));
        });
    if (opponents && !opponents_counts(state)) fouls.push_back(Foul::kOpponentsBall);
    return fouls;
}

Legal legal_carom(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {own_ball(state.turn)};
    for (const std::string& ball : balls)
        if (ball != legal.cue_balls[0] && (is_red(ball) || (!state.opening && opponents_counts(state))))
            legal.first.push_back(ball);
    return legal;
}

Verdict judge_carom(const Facts& facts) {
    const State& state = facts.state;
    std::vector<Foul> fouls = carom_fouls(facts);
    const bool point = fouls.empty() && made_carom(facts);
    const bool loses = !fouls.empty() && state.game == &kFourBall;
    State next = after(state, point);
    if (loses) --next.points[static_cast<std::size_t>(state.turn)];
    const auto back = [&](std::vector<std::string> balls) {
        if (!balls.empty() && carom_game(state.game).all_back) balls = facts.ids();
        return spotted(facts, balls, next.turn);
    };
    std::vector<std::string> off;
    for (const int ball : facts.shot.out) off.push_back(facts.id(ball));
    Verdict verdict = one_way(fouls, {Decision::kPlayOn, next, back(off)});
    verdict.points = point ? 1 : loses ? -1 : 0;
    const std::vector<std::string> against = off.empty() && !next.over && state.game != &kFourBall
                                                 ? touching(facts, next.turn)
                                                 : std::vector<std::string>();
    if (!against.empty()) {
        verdict.options.push_back({Decision::kSpotTouching, next, back(against)});
        verdict.chooser = next.turn;
    }
    return verdict;
}

Legal legal_sum_to_three(const State&, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    for (const std::string& ball : balls)
        if (ball != "cue") legal.first.push_back(ball);
    return legal;
}

Verdict judge_sum_to_three(const Facts& facts) {
    constexpr int kSum = 3;
    const auto cushions = std::count_if(facts.shot.touches.begin(), facts.shot.touches.end(),
                                        [](const BallContact& touch) { return touch.cushion(); });
    std::vector<Foul> fouls;
    if (!facts.shot.out.empty()) fouls.push_back(Foul::kBallOff);
    const bool point = fouls.empty() && !facts.shot.first_hits.empty() && cushions == kSum;
    // The game has no rule for lost balls: the cue ball returns behind the head spot, the other one behind
    // the foot spot.
    Option next = {Decision::kPlayOn, after(facts.state, point), {}};
    for (int ball = 0; ball < static_cast<int>(facts.record.tracks.size()); ++ball) {
        if (!facts.shot.gone(ball)) continue;
        std::vector<Lying> others = facts.lying(0.0, 0.0);
        for (const Respot& done : next.respots) others.push_back({done.place, facts.radius(done.ball), 0.0});
        const Table& table = facts.record.table;
        const Vec2 spot = facts.id(ball) == "cue" ? head_spot(table) : foot_spot(table);
        next.respots.push_back(
            {facts.id(ball), spot_on_long_string(table, spot, facts.record.size(ball).R, others)});
    }
    Verdict verdict = one_way(fouls, next);
    verdict.points = point ? 1 : 0;
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

namespace {

constexpr FoulRule kCaromFouls[] = {{Foul::kBallOff, "UMB, fouls"},
                                    {Foul::kWrongCueBall, "UMB, fouls"},
                                    {Foul::kOpeningNotRed, "UMB, starting position"},
                                    {Foul::kIntoTouchingBall, "UMB, fouls"}};
constexpr FoulRule kFourBallFouls[] = {{Foul::kNoBallHit, "four-ball, no ball hit"},
                                       {Foul::kBallOff, "four-ball, ball off"},
                                       {Foul::kWrongCueBall, "four-ball, cue balls"},
                                       {Foul::kOpeningNotRed, "four-ball, starting position"},
                                       {Foul::kOpponentsBall, "four-ball, opponent's ball"}};

GameRules umb_game(const char* name, const char* title, const char* chapter) {
    return {
        .info = {.name = name,
                 .title = title,
                 .book = std::string("Union Mondiale de Billard, World rules of carom billiard") + chapter,
                 .usual_target = 15,
                 .balls = 2,
                 .table = "carom",
                 .start = detail::start_of(
                     "", {{"white", 0.6289, 0.25}, {"yellow", 0.5, 0.25}, {"red", 0.5, 0.75}}, "white", 4,
                     98.5)},
        .legal = detail::legal_carom,
        .judge = detail::judge_carom,
        .balls = {"white", "yellow", "red"},
        .fouls = kCaromFouls,
        .struck = GameRules::Struck::kOwn};
}

}  // namespace

const GameRules kThreeCushion = umb_game("three_cushion", "three-cushion", "");
const GameRules kStraightRail = umb_game("straight_rail", "straight rail", ": free game");
const GameRules kOneCushion = umb_game("one_cushion", "one-cushion", ": one cushion");
const GameRules kFourBall = {
    .info =
        {.name = "four_ball",
         .title = "four-ball",
         .book = "the Korean game of Wikipedia, Four-ball billiards, read in November 2026",
         .usual_target = 15,
         .balls = 3,
         .table = "carom",
         .start = detail::start_of("game = \"four_ball\"", {}, "white", 3, 85),
         .options = {{&kFourBall,
                      "opponents_ball",
                      {"foul", "counts"},
                      "Effect of hitting the other player's cue ball: a foul, as in Korea, or the same as "
                      "hitting a red, as in Japan."}}},
    .legal = detail::legal_carom,
    .judge = detail::judge_carom,
    .balls = {"white", "yellow", "red1", "red2"},
    .fouls = kFourBallFouls,
    .struck = GameRules::Struck::kOwn,
    .below_zero = true};
const GameRules kSumToThree = {
    .info = {.name = "sum_to_three",
             .title = "sum to three",
             .book = "pooltool 0.6.0 and LightZero's zoo",
             .usual_target = 15,
             .balls = 1,
             .table = "carom",
             .start = detail::start_of("", {{"cue", 0.6, 0.25}, {"red", 0.5, 0.7}}, "cue", 3, 98)},
    .legal = detail::legal_sum_to_three,
    .judge = detail::judge_sum_to_three,
    .balls = {"cue"},
    .fouls = kCaromFouls};

}  // namespace carom::games
