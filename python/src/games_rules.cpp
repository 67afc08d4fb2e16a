// Games: rules. Structs are passed as tuples in the order of the package's named tuples, enumerations by
// their names.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "carom/games/spots.h"
#include "native.h"

namespace carom::python {
namespace {

template <class T>
using Two = std::pair<T, T>;
using Place = Two<double>;
/// In the order of carom.games.State.
using StateRow = std::tuple<std::string, int, bool, std::string, Two<int>, int, bool, int, Two<std::string>,
                            bool, Two<int>, std::string, bool, std::vector<std::string>>;
using CallRow = std::tuple<std::string, std::string, bool, bool>;
using RespotRow = std::pair<std::string, Place>;
using OptionRow = std::tuple<std::string, StateRow, std::vector<RespotRow>>;
/// Fouls with their rules, points, penalty, options, chooser.
using VerdictRow = std::tuple<std::vector<Two<std::string>>, int, int, std::vector<OptionRow>, int>;
/// Cue balls, balls that may be hit first, balls that may be called, area of the cue ball in hand, push out.
using LegalRow = std::tuple<std::vector<std::string>, std::vector<std::string>, std::vector<std::string>,
                            std::string, bool>;

StateRow row_of(const games::State& s) {
    return {name(s.game),
            s.turn,
            s.opening,
            name(s.in_hand),
            {s.points[0], s.points[1]},
            s.target,
            s.over,
            s.winner,
            {name(s.group[0]), name(s.group[1])},
            s.may_push_out,
            {s.fouls[0], s.fouls[1]},
            name(s.on),
            s.free_ball,
            s.rules};
}

games::State state_of(const StateRow& row) {
    games::State s;
    std::string game, in_hand, on;
    Two<int> points, fouls;
    Two<std::string> group;
    std::vector<std::string> rules;
    std::tie(game, s.turn, s.opening, in_hand, points, s.target, s.over, s.winner, group, s.may_push_out,
             fouls, on, s.free_ball, rules) = row;
    s.game = value_of<games::Game>("game", game);
    s.in_hand = value_of<games::InHand>("place in hand", in_hand);
    s.points = {points.first, points.second};
    s.group = {value_of<games::Group>("group", group.first), value_of<games::Group>("group", group.second)};
    s.fouls = {fouls.first, fouls.second};
    s.on = value_of<games::BallOn>("ball on", on);
    for (const std::string& option : rules) games::set_rule(s, option);
    return s;
}

OptionRow row_of(const games::Option& option) {
    std::vector<RespotRow> respots;
    for (const games::Respot& r : option.respots) respots.push_back({r.ball, {r.place.x(), r.place.y()}});
    return {name(option.decision), row_of(option.state), respots};
}

games::Option option_of(const OptionRow& row) {
    games::Option option;
    option.decision = value_of<games::Decision>("decision", std::get<0>(row));
    option.state = state_of(std::get<1>(row));
    for (const auto& [ball, place] : std::get<2>(row))
        option.respots.push_back({ball, {place.first, place.second}});
    return option;
}

LegalRow legal(const StateRow& state, const std::vector<std::string>& balls) {
    const games::Legal l = games::legal(state_of(state), balls);
    return {l.cue_balls, l.first, l.callable, name(l.in_hand), l.may_push_out};
}

VerdictRow judge(const StateRow& state, const NativeRecord& record, const CallRow& call) {
    const games::State before = state_of(state);
    const games::Verdict v = games::judge(
        before, *record.record, {std::get<0>(call), std::get<1>(call), std::get<2>(call), std::get<3>(call)});
    std::vector<Two<std::string>> fouls;
    for (const games::CalledFoul& called : v.fouls) fouls.emplace_back(name(called.foul), called.rule);
    std::vector<OptionRow> options;
    for (const games::Option& option : v.options) options.push_back(row_of(option));
    return {fouls, v.points, v.penalty, options, v.chooser};
}

std::optional<Vec2> vec2(const std::optional<Place>& place) {
    return place ? std::optional(Vec2(place->first, place->second)) : std::nullopt;
}

bool may_place(const NativeRecord& record, const OptionRow& option, const Place& place) {
    return games::may_place(*record.record, option_of(option), {place.first, place.second});
}

Place free_place(const NativeRecord& record, const OptionRow& option, const Place& wanted) {
    const Vec2 place = games::free_place(*record.record, option_of(option), {wanted.first, wanted.second});
    return {place.x(), place.y()};
}

/// The table before the next shot, with `cue`: a section of a scene file, or nothing. Without a cue, a ball
/// in hand may lie on the free place nearest to the head spot, as in carom next.
NativeScene next_table(const NativeRecord& record, const NativeScene* other, const OptionRow& option,
                       const std::optional<Place>& place, const std::string& cue) {
    const Scene& scene = scene_of(record, other);
    const games::Option taken = option_of(option);
    std::optional<Vec2> at = vec2(place);
    if (!at && cue.empty() && taken.state.in_hand != games::InHand::kNo)
        at = games::free_place(*record.record, taken, head_spot(record.record->table));
    return with_cue(cue, games::table_after(scene, *record.record, taken, at));
}

using ShareRow = std::tuple<double, double, double>;
using CueRow = std::tuple<double, double, double, double, double>;
/// In the order of carom.games.Advice.
using AdviceRow = std::tuple<std::string, std::string, std::string, std::string, double, CueRow, CallRow,
                             std::optional<Place>, ShareRow, ShareRow, double, std::vector<std::string>>;

std::vector<AdviceRow> advise(const StateRow& state, const NativeScene& scene, const std::string& skill,
                              std::uint64_t seed, std::size_t best, std::size_t fresh, int threads) {
    const Scene& table = *scene.scene;
    games::AdviceOptions options;
    options.seed = seed;
    options.best = best;
    options.fresh = fresh;
    options.threads = threads;
    const games::State before = state_of(state);
    const nb::gil_scoped_release no_gil;
    const games::Skill level = games::skill_by_name(skill, table.balls.R);
    std::vector<AdviceRow> rows;
    for (const games::Advice& a : games::advise(before, table, level, kernel::best_isa(), options)) {
        const auto share = [](const games::Share& s) { return ShareRow(s.value, s.low, s.high); };
        std::optional<Place> place;
        if (a.place) place = {a.place->x(), a.place->y()};
        rows.emplace_back(games::words_of(a, table.table), name(a.kind), a.ball, a.pocket, a.cut_deg,
                          CueRow(a.cue.speed, a.cue.aim_deg, a.cue.elevation_deg, a.cue.side, a.cue.height),
                          CallRow(a.call.ball, a.call.pocket, a.call.safety, a.call.push_out), place,
                          share(a.makes), share(a.fouls), a.worth, a.leaves);
    }
    return rows;
}

std::vector<std::pair<std::string, Place>> spots(const NativeRecord& record) {
    const Table& table = record.record->table;
    std::vector<std::pair<std::string, Vec2>> list = {
        {"head", games::head_spot(table)}, {"center", games::center_spot(table)}, {"foot", foot_spot(table)}};
    for (const std::string_view colour : games::kColours)
        list.emplace_back(colour, games::snooker_spot(table, colour));
    std::vector<std::pair<std::string, Place>> out;
    for (const auto& [of, at] : list) out.push_back({of, {at.x(), at.y()}});
    return out;
}

}  // namespace

void add_games_rules(nb::module_& m) {
    m.def("new_game",
          [](const std::string& game, int first, int target, const std::vector<std::string>& rules) {
              games::State state = games::new_game(value_of<games::Game>("game", game), first, target);
              for (const std::string& option : rules) games::set_rule(state, option);
              return row_of(state);
          });
    m.def("rule_options", [] {
        std::vector<std::tuple<std::string, std::string, std::vector<std::string>, std::string>> rows;
        for (const games::RuleOption& o : games::rule_options())
            rows.emplace_back(name(o.game), o.key, std::vector<std::string>(o.values.begin(), o.values.end()),
                              o.what);
        return rows;
    });
    m.def("legal", legal);
    m.def("judge", judge);
    m.def("book_of", [](const std::string& game) {
        return std::string(games::book_of(value_of<games::Game>("game", game)));
    });
    m.def("cue_ball", [](const StateRow& state) { return std::string(games::cue_ball(state_of(state))); });
    m.def("may_place", may_place);
    m.def("free_place", free_place);
    m.def("next_table", next_table, nb::arg("record"), nb::arg("scene").none(), nb::arg("option"),
          nb::arg("place").none(), nb::arg("cue"));
    m.def("spots", spots);
    m.def("advise", advise);
    // The table with a strike, and the cue ball at a place.
    m.def(
        "struck",
        [](const NativeScene& scene, const std::optional<Place>& place, const std::string& cue) {
            games::Advice advice;
            advice.place = vec2(place);
            return with_cue(cue, games::scene_with(*scene.scene, advice));
        },
        nb::arg("scene"), nb::arg("place").none(), nb::arg("cue"));
    m.def("skills", [] { return std::vector<std::string>(games::kSkills.begin(), games::kSkills.end()); });
    m.def("noise_of_skill", [](const std::string& skill, double radius) {
        const games::Noise sd = games::skill_by_name(skill, radius).noise;
        return CueRow(sd.speed, sd.aim_deg, sd.elevation_deg, sd.side, sd.height);
    });
}

}  // namespace carom::python
