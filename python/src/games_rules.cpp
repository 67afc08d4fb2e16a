// Games: rules.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "carom/games/spots.h"
#include "native.h"
#include "values.h"

namespace carom::python {
namespace {

using Place = std::pair<double, double>;

Vec2 vec2(const Place& place) {
    return {place.first, place.second};
}

games::State state_from(nb::handle state) {
    return taken<games::State>(state, "state");
}

games::Option option_from(nb::handle option) {
    return taken<games::Option>(option, "option");
}

/// The table before the next shot, with `cue`: a section of a scene file, or nothing. Without a cue, a ball
/// in hand may lie on the free place nearest to the head spot, as in carom next.
NativeScene next_table(const NativeRecord& record, const NativeScene* other, nb::handle option,
                       const std::optional<Place>& place, const std::string& cue) {
    const Scene& scene = scene_of(record, other);
    const games::Option chosen = option_from(option);
    std::optional<Vec2> at;
    if (place)
        at = vec2(*place);
    else if (cue.empty() && chosen.state.in_hand != games::InHand::kNo)
        at = games::free_place(*record.record, chosen);
    return with_cue(cue, games::table_after(scene, *record.record, chosen, at));
}

nb::any advise(nb::handle state, const NativeScene& scene, const std::string& skill, std::uint64_t seed,
               std::size_t best, std::size_t fresh, int threads) {
    games::AdviceOptions options;
    options.seed = seed;
    options.best = best;
    options.fresh = fresh;
    options.threads = threads;
    const games::State before = state_from(state);
    return given(unlocked([&] {
        const games::Skill level = games::skill_by_name(skill, scene.scene->balls.R);
        return games::advise(before, *scene.scene, level, kernel::best_isa(), options);
    }));
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
    // A new game with the game, the turn, the target and the rules of a state.
    m.def("new_game", [](nb::handle state) {
        const games::State asked = state_from(state);
        games::State made = games::new_game(asked.game, asked.turn, asked.target);
        made.rules = asked.rules;
        return given(made);
    });
    m.def("games", [] { return given(games::all_games()); });
    m.def("legal", [](nb::handle state, const std::vector<std::string>& balls) {
        return given(games::legal(state_from(state), balls));
    });
    m.def("legal_on", [](nb::handle state, const NativeScene& on) {
        return given(games::legal(state_from(state), *on.scene));
    });
    m.def("judge", [](nb::handle state, const NativeRecord& record, nb::handle call) {
        games::Verdict verdict =
            games::judge(state_from(state), *record.record, taken<games::Call>(call, "call"));
        name_record(verdict, *record.record);
        return given(verdict);
    });
    m.def("cue_ball", [](nb::handle state) { return std::string(games::cue_ball(state_from(state))); });
    m.def("may_place", [](const NativeRecord& record, nb::handle option, const Place& place) {
        return games::may_place(*record.record, option_from(option), vec2(place));
    });
    m.def("free_place", [](const NativeRecord& record, nb::handle option, const Place& wanted) {
        const Vec2 place = games::free_place(*record.record, option_from(option), vec2(wanted));
        return Place(place.x(), place.y());
    });
    m.def("next_table", next_table, nb::arg("record"), nb::arg("scene").none(), nb::arg("option"),
          nb::arg("place").none(), nb::arg("cue"));
    m.def("spots", spots);
    m.def("advise", advise);
    // The table with a strike, and the cue ball at a place.
    m.def(
        "struck",
        [](const NativeScene& scene, const std::optional<Place>& place, const std::string& cue) {
            games::Advice advice;
            if (place) advice.place = vec2(*place);
            return with_cue(cue, games::scene_with(*scene.scene, advice));
        },
        nb::arg("scene"), nb::arg("place").none(), nb::arg("cue"));
    m.def("skills", [] { return std::vector<std::string>(games::kSkills.begin(), games::kSkills.end()); });
    m.def("noise_of_skill", [](const std::string& skill, double radius) {
        return given(games::skill_by_name(skill, radius).noise);
    });
}

}  // namespace carom::python
