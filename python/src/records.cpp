// Records: views of their memory, and their contents.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/event_details.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "carom/render/draw_list.h"
#include "native.h"
#include "page/shot_page.h"

namespace carom::python {
namespace {

using Bytes = nb::ndarray<nb::numpy, const std::uint8_t, nb::ndim<1>>;
/// A member of a struct as numpy knows it: name, type, offset.
using Member = std::tuple<std::string, std::string, std::size_t>;

/// The memory of a list as bytes, which keep `owner` alive.
template <class T>
Bytes bytes_of(const std::vector<T>& list, nb::handle owner) {
    static const T kNone{};
    const T* data = list.empty() ? &kNone : list.data();
    return {reinterpret_cast<const std::uint8_t*>(data), {list.size() * sizeof(T)}, owner};
}

static_assert(sizeof(EventType) == 1 && sizeof(MotionState) == 1 && sizeof(bool) == 1 && sizeof(int) == 4);

std::vector<Member> event_members() {
    return {{"time", "<f8", offsetof(Event, time)},     {"type", "u1", offsetof(Event, type)},
            {"a", "<i4", offsetof(Event, a)},           {"b", "<i4", offsetof(Event, b)},
            {"detail", "<i4", offsetof(Event, detail)}, {"slow", "?", offsetof(Event, slow)}};
}

std::vector<Member> segment_members() {
    return {{"start", "<f8", offsetof(Segment, start)},
            {"r", "(3,)<f8", offsetof(Segment, r)},
            {"v", "(3,)<f8", offsetof(Segment, v)},
            {"w", "(3,)<f8", offsetof(Segment, w)},
            {"a", "(2,)<f8", offsetof(Segment, a)},
            {"dw", "(2,)<f8", offsetof(Segment, dw)},
            {"spin_decay", "<f8", offsetof(Segment, spin_decay)},
            {"duration", "<f8", offsetof(Segment, duration)},
            {"state", "u1", offsetof(Segment, state)},
            {"held", "?", offsetof(Segment, held)},
            {"ends", "?", offsetof(Segment, ends)}};
}

int ball_count(const NativeRecord& r) {
    return static_cast<int>(r.record->tracks.size());
}

/// Nine numbers and a kind of motion for every ball at every time. Empty outputs are skipped.
void states(const NativeRecord& r, const Flat<const double>& times, const Flat<double>& rvw,
            const Flat<std::uint8_t>& kinds) {
    const nb::gil_scoped_release no_gil;
    r.record->states_at({times.data(), times.size()}, rvw.size() > 0 ? rvw.data() : nullptr,
                        kinds.size() > 0 ? kinds.data() : nullptr);
}

void orientations(const NativeRecord& r, const Flat<const double>& times, const Flat<double>& out) {
    double* at = out.data();
    const nb::gil_scoped_release no_gil;
    for (std::size_t k = 0; k < times.size(); ++k)
        for (int ball = 0; ball < ball_count(r); ++ball)
            at = std::copy_n(r.record->orientation_at(ball, times.data()[k]).coeffs().data(), 4, at);
}

/// The scene for the next shot, with the physics of `scene`, and with `cue`, a section of a scene file or
/// nothing.
/// @throws nb::value_error for another scene's balls, SceneError
NativeScene scene_after_record(const NativeRecord& r, const NativeScene* other, const std::string& cue) {
    return with_cue(cue, scene_after(scene_of(r, other), *r.record));
}

std::vector<std::tuple<double, std::string, std::string, std::string>> event_list(const NativeRecord& r) {
    std::vector<std::tuple<double, std::string, std::string, std::string>> list;
    for (const Event& e : r.record->events)
        list.emplace_back(e.time, name(e.type), r.record->tracks.at(static_cast<std::size_t>(e.a)).id,
                          r.record->partner_id(e));
    return list;
}

std::vector<std::tuple<double, std::string, std::string, double>> hit_list(const NativeRecord& r) {
    std::vector<std::tuple<double, std::string, std::string, double>> list;
    const Record& record = *r.record;
    for (const Event& e : record.events)
        each_hit(e, record.hits(e), [&](const Hit& hit) {
            list.emplace_back(hit.time, record.tracks.at(static_cast<std::size_t>(hit.a)).id,
                              record.partner_id(hit.partner, hit.b), hit.impulse);
        });
    return list;
}

/// Cushions as (from, to), jaws and pockets as (centre,
/// radius), with their ids: what a plan of the table draws.
nb::typed<nb::dict, nb::str, nb::any> table_of(const NativeRecord& r) {
    const Table table = without_arcs(r.record->table);
    nb::list cushions, jaws, pockets;
    for (const Cushion& c : table.cushions)
        cushions.append(nb::make_tuple(c.id, c.from.x(), c.from.y(), c.to.x(), c.to.y()));
    for (const Jaw& j : table.jaws) jaws.append(nb::make_tuple(j.id, j.center.x(), j.center.y(), j.radius));
    for (const Pocket& p : table.pockets)
        pockets.append(nb::make_tuple(p.id, p.center.x(), p.center.y(), p.radius));
    nb::typed<nb::dict, nb::str, nb::any> all;
    all["preset"] = table.preset;
    all["corner"] = nb::make_tuple(table.corner.x(), table.corner.y());
    all["width"] = table.width;
    all["length"] = table.length;
    all["cushions"] = cushions;
    all["jaws"] = jaws;
    all["pockets"] = pockets;
    return all;
}

/// Red, green and blue of a ball in pictures.
std::tuple<double, double, double> color(const NativeRecord& r, int ball) {
    const std::string& id = r.record->tracks.at(static_cast<std::size_t>(ball)).id;
    const auto [red, green, blue] = render::ball_style(id, r.record->table.preset, ball).color;
    return {red, green, blue};
}

std::vector<std::string> event_names() {
    std::vector<std::string> names;
    for (const EventKind& kind : kEventKinds) names.emplace_back(kind.name);
    return names;
}

}  // namespace

const Scene& scene_of(const NativeRecord& r, const NativeScene* other) {
    const Scene* scene = other != nullptr ? other->scene.get() : r.scene.get();
    if (scene == nullptr)
        throw nb::value_error("a record from a file has no physics; give the scene that was played");
    if (!same_balls(*scene, *r.record))
        throw nb::value_error("the scene and the record have different balls");
    return *scene;
}

NativeScene with_cue(const std::string& section, Scene scene) {
    // Sections of a file may come in any order.
    std::string source = section + scene_text(scene);
    if (!section.empty()) scene.cue = parse_cue(section, scene);
    validate(scene);
    return {std::make_shared<const Scene>(std::move(scene)), std::move(source)};
}

void add_records(nb::module_& m) {
    nb::class_<NativeRecord>(m, "Record")
        .def_prop_ro("duration", [](const NativeRecord& r) { return r.record->duration; })
        .def_prop_ro("stopped", [](const NativeRecord& r) { return words(r.record->stopped).word; })
        .def_prop_ro("ids", [](const NativeRecord& r) { return ids_of(r.record->tracks); })
        .def_prop_ro("balls", ball_count)
        .def_prop_ro("table", table_of)
        .def_prop_ro("fps", [](const NativeRecord& r) { return r.record->render.fps; })
        .def_prop_ro(
            "picture_size",
            [](const NativeRecord& r) { return std::tuple(r.record->render.width, r.record->render.height); })
        .def_prop_ro("has_scene", [](const NativeRecord& r) { return r.scene != nullptr; })
        .def_prop_ro("clusters",
                     [](const NativeRecord& r) {
                         std::vector<std::vector<int>> lists;
                         for (const Cluster& cluster : r.record->clusters) lists.push_back(cluster.balls);
                         return lists;
                     })
        .def("hit_list", hit_list)
        .def("radius", [](const NativeRecord& r, int ball) { return r.record->size(ball).R; })
        .def("mass", [](const NativeRecord& r, int ball) { return r.record->size(ball).m; })
        .def("color", color)
        .def("event_list", event_list)
        .def("hash", [](const NativeRecord& r) { return r.record->hash(); })
        .def("states", states, nb::arg("times"), nb::arg("rvw").noconvert(), nb::arg("kinds").noconvert())
        .def("orientations", orientations, nb::arg("times"), nb::arg("out").noconvert())
        .def("scene_after", scene_after_record, nb::arg("scene").none(), nb::arg("cue"))
        .def("text",
             [](const NativeRecord& r) {
                 const nb::gil_scoped_release no_gil;
                 return record_json(*r.record);
             })
        .def(
            "page",
            [](const NativeRecord& r, const NativeRecord* second) {
                const nb::gil_scoped_release no_gil;
                return tools::shot_page(*r.record, second == nullptr ? nullptr : second->record.get(),
                                        nullptr, {"a shot", "record.page()", CAROM_VERSION});
            },
            nb::arg("second").none())
        .def_prop_ro("scene",
                     [](const NativeRecord& r) -> std::optional<NativeScene> {
                         if (r.scene == nullptr) return std::nullopt;
                         return NativeScene{r.scene, scene_text(*r.scene)};
                     })
        .def(
            "verify",
            [](const NativeRecord& r, const NativeScene* other) -> std::optional<std::string> {
                const nb::gil_scoped_release no_gil;
                const Plan plan = make_plan(scene_of(r, other), chosen_isa());
                require_scene(*r.record, plan, "record");
                const auto violation = verify(*r.record, plan);
                return violation ? std::optional(describe(*violation, *r.record)) : std::nullopt;
            },
            nb::arg("scene").none())
        .def("save", [](const NativeRecord& r, const std::string& path) { write_record(*r.record, path); });
    // Functions, because only they receive the object itself, which the views keep alive.
    m.def("events_of", [](nb::handle_t<NativeRecord> r) {
        return bytes_of(nb::cast<const NativeRecord&>(r).record->events, r);
    });
    m.def("segments_of", [](nb::handle_t<NativeRecord> r, int ball) {
        return bytes_of(
            nb::cast<const NativeRecord&>(r).record->tracks.at(static_cast<std::size_t>(ball)).segments, r);
    });
    m.def("load_record", [](const std::string& path) {
        const nb::gil_scoped_release no_gil;
        return NativeRecord{std::make_shared<const Record>(read_record(path)), nullptr};
    });
    m.def(
        "parse_record",
        [](const std::string& text, const NativeScene* scene) {
            const nb::gil_scoped_release no_gil;
            return NativeRecord{std::make_shared<const Record>(parse_record(text, "record")),
                                scene == nullptr ? nullptr : scene->scene};
        },
        nb::arg("text"), nb::arg("scene").none());
    m.attr("EVENT_SIZE") = sizeof(Event);
    m.attr("SEGMENT_SIZE") = sizeof(Segment);
    m.def("event_members", event_members);
    m.def("segment_members", segment_members);
    m.def("event_names", event_names);
    m.def("motion_names", names_in_files<MotionState>);
    m.def("status_names", names_in_files<ShotStatus>);
}

}  // namespace carom::python
