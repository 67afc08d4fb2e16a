// Scenes: read, changed, written.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "carom/engine/scene_number.h"
#include "carom/engine/variation.h"
#include "native.h"

namespace carom::python {
namespace {

NativeScene parse(const std::string& text, const std::string& name) {
    return {std::make_shared<const Scene>(parse_scene(text, name)), text};
}

std::string changed(const NativeScene& scene,
                    const std::vector<std::pair<std::string, std::string>>& values) {
    std::vector<NewValue> list;
    for (const auto& [key, value] : values) list.push_back({key, value});
    try {
        return with_values(scene.source, scene.scene->file, list);
    } catch (const VariationError& error) {
        throw SceneError(scene.scene->file, {}, error.what());
    }
}

void positions(const NativeScene& scene, const Flat<double>& out) {
    double* at = out.data();
    for (const BallStart& ball : scene.scene->ball) at = std::copy_n(ball.position.data(), 2, at);
}

/// The measures of every preset, as `carom check` prints them.
nb::typed<nb::dict, nb::str, nb::any> tables() {
    nb::typed<nb::dict, nb::str, nb::any> all;
    for (const char* preset : kTablePresets) {
        const Table table = make_table(preset);
        const Measures of = measures_of(preset);
        const double R = make_ball_params(balls_for(preset)).R;
        nb::dict one;
        one["balls"] = balls_for(preset);
        one["size"] = std::pair(table.width, table.length);
        one["cushion_height"] = *of.cushion_height;
        if (of.rail_width) one["rail_width"] = *of.rail_width;
        for (const PocketSection& section : kPocketSections) {
            const PocketMeasures& pockets = of.*section.pockets;
            if (!pockets.mouth) continue;
            nb::dict measures;
            for (const Field<PocketMeasures>& f : kPocketMeasureFields)
                if (const FieldValue value = f.value(pockets); value.index() != 0)
                    measures[f.key] = std::get<double>(value);
            measures["cut_off_deg"] = cut_off_deg(*pockets.mouth, R);
            one[section.key] = measures;
        }
        all[preset] = one;
    }
    return all;
}

}  // namespace

void add_scenes(nb::module_& m) {
    nb::class_<NativeScene>(m, "Scene")
        .def_prop_ro("source", [](const NativeScene& s) { return s.source; })
        .def_prop_ro("file", [](const NativeScene& s) { return s.scene->file; })
        .def_prop_ro("text", [](const NativeScene& s) { return scene_text(*s.scene); })
        .def_prop_ro("ids", [](const NativeScene& s) { return ids_of(s.scene->ball); })
        .def_prop_ro("balls", [](const NativeScene& s) { return s.scene->ball.size(); })
        .def_prop_ro("table",
                     [](const NativeScene& s) {
                         const Table& table = s.scene->table;
                         return std::tuple(table.preset, table.width, table.length);
                     })
        .def_prop_ro("pockets", [](const NativeScene& s) { return ids_of(s.scene->table.pockets); })
        .def("number", [](const NativeScene& s,
                          const std::string& key) { return SceneNumber(*s.scene, key).value(*s.scene); })
        .def("positions", positions, nb::arg("out").noconvert())
        .def("changed", changed);
    m.def("read_scene_text", read_scene_text);
    m.def("parse_scene", parse);
    m.def("tables", tables);
}

}  // namespace carom::python
