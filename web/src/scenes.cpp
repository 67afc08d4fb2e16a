// Scenes: read, changed, described.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/strike.h"
#include "carom/render/table_bytes.h"
#include "carom/render/table_mesh.h"
#include "page/ball_styles.h"
#include "page/table_shape.h"
#include "web.h"

namespace carom::web {
namespace {

/// Replaces the values of keys, or adds them.
void keep(std::vector<NewValue>& changed, const std::vector<NewValue>& values) {
    std::unordered_map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < changed.size(); ++i) places.emplace(changed[i].key, i);
    for (const NewValue& value : values) {
        const auto [place, added] = places.try_emplace(value.key, changed.size());
        if (added)
            changed.push_back(value);
        else
            changed[place->second].value = value.value;
    }
}

/// The file of a scene with all its changes. Racked balls cannot be changed in a file; then every ball is
/// placed on its own.
std::string source_of(const WebScene& scene) {
    if (scene.changed.empty()) return scene.source;
    try {
        return with_values(scene.source, scene.scene.file, scene.changed);
    } catch (const VariationError&) {
        return scene_text(scene.scene);
    }
}

/// Sets numbers without reading the file again. @return whether all keys are numbers of the scene
bool put_numbers(WebScene& scene, const Json& changes) {
    Change most = Change::kNumbers;
    for (const auto& [key, value] : changes.items()) {
        if (!value.is_number()) return false;
        try {
            const SceneNumber number(scene.scene, key);
            most = std::max(most, number.put(scene.scene, value.get<double>()));
        } catch (const std::invalid_argument&) {
            return false;
        } catch (const SceneError&) {
            return false;
        }
    }
    if (most == Change::kAnything) return false;
    validate_change(scene.scene, most);
    return true;
}

WebScene changed(const WebScene& before, const Json& changes) {
    WebScene after = before;
    std::vector<NewValue> values;
    // JSON writes numbers, truth values, texts and lists as TOML does.
    for (const auto& [key, value] : changes.items()) values.push_back({key, value.dump()});
    if (put_numbers(after, changes)) {
        keep(after.changed, values);
        return after;
    }
    std::string text;
    try {
        text = with_values(source_of(before), before.scene.file, values);
    } catch (const VariationError&) {
        text = with_values(scene_text(before.scene), before.scene.file, values);
    }
    return {parse_scene(text, before.scene.file), text, {}};
}

Json place(const Vec2& p) {
    return {p.x(), p.y()};
}

Json described(const Scene& scene) {
    Json balls = Json::array(), pockets = Json::array();
    for (const BallStart& ball : scene.ball) {
        const BallSize size = scene.size_of(ball);
        balls.push_back({{"id", ball.id},
                         {"x", ball.position.x()},
                         {"y", ball.position.y()},
                         {"radius", size.R},
                         {"mass", size.m}});
    }
    for (const Pocket& pocket : scene.table.pockets)
        pockets.push_back({{"id", pocket.id}, {"name", pocket.name}, {"center", place(pocket.center)}});
    Json cue = nullptr;
    if (scene.cue) {
        const Cue& c = *scene.cue;
        cue = {{"ball", c.ball},       {"speed", c.speed},
               {"aim_deg", c.aim_deg}, {"elevation_deg", c.elevation_deg},
               {"side", c.side},       {"height", c.height}};
        const CueRoom room = room_for(scene, c);
        cue["in"] = room.in;
        cue["clears_deg"] = room.clears_deg ? Json(*room.clears_deg) : Json();
    }
    // By the keys of [balls].
    Json material;
    for (const Field<BallParams>& f : kBallFields)
        if (f.kind == Key::Kind::kNumber) material[f.key] = std::get<double>(f.get(scene.balls));
    return {{"balls", balls},
            {"cue", cue},
            {"table",
             {{"preset", scene.table.preset},
              {"cloth", scene.table.cloth.value_or("")},
              {"width", scene.table.width},
              {"length", scene.table.length},
              {"corner", place(scene.table.corner)},
              {"pockets", pockets}}},
            {"ball_preset", scene.ball_preset},
            {"material", material}};
}

render::TableMesh mesh_of(const Scene& scene) {
    std::vector<Vec2> places;
    for (const BallStart& ball : scene.ball) places.push_back(ball.position.head<2>());
    return render::make_table_mesh(scene.table, scene.balls.R, places, render::Edges::kRounded);
}

/// Data to draw the scene: the shape of the table, and the look of each ball.
Json look(const Scene& scene) {
    return {{"shape", tools::table_shape(scene.table, mesh_of(scene))},
            {"styles", tools::ball_styles(ids_of(scene.ball), scene.table.preset)}};
}

}  // namespace

CAROM_WEB int carom_scene_parse(const char* text, std::size_t size, const char* name, std::size_t name_size) {
    return guarded([&] {
        const std::string source(text, size);
        const std::string file(name, name_size);
        give(new WebScene{parse_scene(source, file), source, {}}, "");
    });
}
CAROM_WEB void carom_free_scene(WebScene* scene) {
    delete scene;
}
/// @param changes JSON: an object of keys with dots, and their values
CAROM_WEB int carom_scene_change(const WebScene* scene, const char* changes, std::size_t size) {
    return guarded([&] {
        const auto json = Json::parse(changes, changes + size);
        give(new WebScene(changed(*scene, json)), "");
    });
}
CAROM_WEB int carom_scene_source(const WebScene* scene) {
    return guarded([&] { give(nullptr, source_of(*scene)); });
}
/// Every value written out, and every ball placed on its own.
CAROM_WEB int carom_scene_text(const WebScene* scene) {
    return guarded([&] { give(nullptr, scene_text(scene->scene)); });
}
CAROM_WEB int carom_scene_describe(const WebScene* scene) {
    return guarded([&] { give(nullptr, dumped(described(scene->scene))); });
}
/// As table_bytes.h describes.
CAROM_WEB int carom_scene_mesh(const WebScene* scene) {
    return guarded([&] { give(nullptr, render::table_bytes(mesh_of(scene->scene))); });
}
CAROM_WEB int carom_scene_look(const WebScene* scene) {
    return guarded([&] { give(nullptr, dumped(look(scene->scene))); });
}

}  // namespace carom::web
