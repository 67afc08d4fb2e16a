// Shots of one player's game, judged by its rules: what environments of more than one shot are made of.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"
#include "native.h"

namespace carom::python {
namespace {

/// One table before its shot and what comes of it. Arrays of the caller's, of n or of n x balls (x and y alternate).
struct JudgedArrays {
    Flat<const double> cues;  ///< n x 5, in the order of STRIKE in carom.games
    Flat<double> xy;          ///< before, then behind the shot [m]; NaN for a ball that is not on the table
    Flat<const std::uint8_t> rows;  ///< n: which shots are judged
    Flat<std::int32_t> group;       ///< n: eight-ball, the player's: 0 open, 1 solids, 2 stripes; changes
    Flat<std::int32_t> foul;        ///< n: the first foul's number, or -1
    Flat<std::int32_t>
        points;  ///< n: balls of a game of pool that fell in a fair shot, otherwise what the rules count
    Flat<std::uint8_t> goes_on, won;  ///< n: whether it is still the player's turn; whether the game is won
};

games::State state_of(games::Game game, int group) {
    games::State state = games::new_game(game);
    state.opening = false;
    state.in_hand = games::InHand::kNo;
    state.group[0] = static_cast<games::Group>(group);
    if (group == 1) state.group[1] = games::Group::kStripes;
    if (group == 2) state.group[1] = games::Group::kSolids;
    return state;
}

/// What a player would have called who knew what falls: the first ball of those that count.
games::Call called(const games::State& state, const Scene& scene, const Record& record) {
    std::vector<std::string> ids;
    for (const BallStart& ball : scene.ball) ids.push_back(ball.id);
    const std::vector<std::string> callable = games::legal(state, ids).callable;
    for (const Event& event : record.events) {
        if (event.type != EventType::kBallPocket) continue;
        const std::string& ball = record.tracks[static_cast<std::size_t>(event.a)].id;
        if (std::find(callable.begin(), callable.end(), ball) != callable.end())
            return {.ball = ball, .pocket = record.table.pockets[static_cast<std::size_t>(event.b)].id};
    }
    return {};
}

class Judge {
  public:
    Judge(const Scene& base, games::Game game, const JudgedArrays& arrays)
        : base_(base), game_(game), arrays_(arrays), planner_(base, chosen_isa()) {}

    void shot(std::size_t row) {
        const std::size_t balls = base_.ball.size();
        double* const xy = arrays_.xy.data() + row * 2 * balls;
        const Scene scene = planner_.scene() = table(row, xy);
        const Record record = simulate(planner_.plan(), buffers_);
        const games::State before = state_of(game_, arrays_.group.data()[row]);
        const games::Verdict verdict = games::judge(before, record, called(before, scene, record));
        const games::State& next = verdict.next();
        arrays_.foul.data()[row] = verdict.fouls.empty() ? -1 : static_cast<int>(verdict.fouls.front());
        arrays_.won.data()[row] = next.over && next.winner == 0;
        // A game of one player: a turn that passes is over, and the choices of the other player are nobody's.
        arrays_.goes_on.data()[row] = !next.over && next.turn == 0;
        arrays_.group.data()[row] = static_cast<int>(next.group[0]);
        int fallen = 0;
        for (std::size_t i = 0; i < balls; ++i) {
            const int track = games::index_of(record, base_.ball[i].id);
            if (track < 0) continue;
            fallen += put(record, track, xy + 2 * i) && base_.ball[i].id != base_.cue->ball;
        }
        for (const games::Respot& back : verdict.respots()) put(back, xy);
        const bool pool = game_ == games::Game::kEightBall || game_ == games::Game::kNineBall;
        arrays_.points.data()[row] = !pool ? verdict.points : verdict.fouls.empty() ? fallen : 0;
    }

  private:
    Scene table(std::size_t row, const double* xy) const {
        Scene scene = base_;
        std::vector<BallStart> left;
        for (std::size_t i = 0; i < base_.ball.size(); ++i) {
            if (std::isnan(xy[2 * i])) continue;
            scene.ball[i].position.x() = xy[2 * i];
            scene.ball[i].position.y() = xy[2 * i + 1];
            left.push_back(scene.ball[i]);
        }
        scene.ball = std::move(left);
        const double* cue = arrays_.cues.data() + 5 * row;
        scene.cue->speed = cue[0];
        scene.cue->aim_deg = cue[1];
        scene.cue->elevation_deg = cue[2];
        scene.cue->side = cue[3];
        scene.cue->height = cue[4];
        validate(scene);
        return scene;
    }

    /// Where a ball lies behind the shot. @return whether a pocket has it
    static bool put(const Record& record, int track, double* place) {
        const BallState end = record.state_at(track, record.duration);
        place[0] = end.position.x();
        place[1] = end.position.y();
        bool fell = false;
        for (const Event& event : record.events) {
            if (event.a != track) continue;
            fell = fell || event.type == EventType::kBallPocket;
            if (event.type == EventType::kBallPocket || event.type == EventType::kBallOut)
                place[0] = place[1] = std::numeric_limits<double>::quiet_NaN();
        }
        return fell;
    }

    void put(const games::Respot& back, double* xy) const {
        for (std::size_t i = 0; i < base_.ball.size(); ++i) {
            if (base_.ball[i].id != back.ball) continue;
            xy[2 * i] = back.place.x();
            xy[2 * i + 1] = back.place.y();
        }
    }

    const Scene& base_;
    games::Game game_;
    const JudgedArrays& arrays_;
    Planner planner_;
    RunBuffers buffers_;
};

games::Game game_of(const std::string& name) {
    const auto names = names_of(games::Game());
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw nb::value_error(("there is no game " + name).c_str());
    return static_cast<games::Game>(at - names.begin());
}

/// Plays and judges the shots of `rows`, without the GIL. All of them have a result: they were played before, without a record.
void judge_many(const NativeScene& native, const std::string& game, const Flat<const double>& cues,
                const Flat<double>& xy, const Flat<const std::uint8_t>& rows, const Flat<std::int32_t>& group,
                const Flat<std::int32_t>& foul, const Flat<std::int32_t>& points,
                const Flat<std::uint8_t>& goes_on, const Flat<std::uint8_t>& won) {
    const std::size_t n = rows.size();
    for (const std::size_t size : {group.size(), foul.size(), points.size(), goes_on.size(), won.size(),
                                   cues.size() / 5, xy.size() / (2 * native.scene->ball.size())})
        if (size != n) throw nb::value_error("expected arrays of as many shots");
    const JudgedArrays arrays = {cues, xy, rows, group, foul, points, goes_on, won};
    Judge judge(*native.scene, game_of(game), arrays);
    SignalWatch watch;
    try {
        const nb::gil_scoped_release no_gil;
        for (std::size_t row = 0; row < n; ++row) {
            if (watch.stopped()) throw BatchStopped("");
            if (rows.data()[row] != 0) judge.shot(row);
        }
    } catch (const BatchStopped&) {
        throw nb::python_error();
    }
}

/// Which balls may be hit first: out is n x balls, 0 everywhere where no ball is left to play at.
void legal_many(const NativeScene& native, const std::string& game, const Flat<const double>& xy,
                const Flat<const std::int32_t>& group, const Flat<std::uint8_t>& out) {
    const std::vector<BallStart>& balls = native.scene->ball;
    const games::Game of = game_of(game);
    if (xy.size() != 2 * out.size() || out.size() != group.size() * balls.size())
        throw nb::value_error("expected arrays of as many tables");
    std::fill_n(out.data(), out.size(), std::uint8_t{0});
    std::vector<std::string> ids;
    for (std::size_t row = 0; row < group.size(); ++row) {
        const std::size_t at = row * balls.size();
        ids.clear();
        for (std::size_t i = 0; i < balls.size(); ++i)
            if (!std::isnan(xy.data()[2 * (at + i)])) ids.push_back(balls[i].id);
        std::vector<std::string> first;
        try {
            first = games::legal(state_of(of, group.data()[row]), ids).first;
        } catch (const std::invalid_argument&) {
            continue;
        }
        for (std::size_t i = 0; i < balls.size(); ++i)
            out.data()[at + i] = std::find(first.begin(), first.end(), balls[i].id) != first.end();
    }
}

std::vector<std::string> foul_names() {
    const auto names = names_of(games::Foul());
    return {names.begin(), names.end()};
}

}  // namespace

void add_judged(nb::module_& m) {
    m.def("judge_many", judge_many, nb::arg("scene"), nb::arg("game"), nb::arg("cues").noconvert(),
          nb::arg("xy").noconvert(), nb::arg("rows").noconvert(), nb::arg("group").noconvert(),
          nb::arg("foul").noconvert(), nb::arg("points").noconvert(), nb::arg("goes_on").noconvert(),
          nb::arg("won").noconvert());
    m.def("legal_many", legal_many, nb::arg("scene"), nb::arg("game"), nb::arg("xy").noconvert(),
          nb::arg("group").noconvert(), nb::arg("out").noconvert());
    m.def("foul_names", foul_names);
}

}  // namespace carom::python
