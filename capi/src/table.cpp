// The C interface: tables and balls of a scene, and the data of a record that a game needs.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"
#include "carom/games/spots.h"
#include "cue.h"
#include "guard.h"
#include "handles.h"
#include "text.h"

using namespace carom::c;

namespace {

constexpr double kDegrees = 57.295779513082321;

carom_part part_of(const carom::Cushion& c) {
    return {c.id.c_str(),
            c.name.c_str(),
            {c.from.x(), c.from.y()},
            {c.to.x(), c.to.y()},
            0.0,
            c.height,
            0.0,
            0.0,
            0};
}

template <class Round>
carom_part part_of(const Round& r, double height) {
    return {r.id.c_str(),
            r.name.c_str(),
            {r.center.x(), r.center.y()},
            {r.center.x(), r.center.y()},
            r.radius,
            height,
            0.0,
            0.0,
            0};
}

carom_part part_of(const carom::Jaw& jaw) {
    carom_part part = part_of(jaw, jaw.height);
    if (!jaw.is_arc()) return part;
    part.from_deg = jaw.from_deg.value_or(0.0);
    part.to_deg = jaw.to_deg.value_or(part.from_deg + 360.0);
    part.inside = jaw.around() ? 1 : 0;
    return part;
}

carom_part part_of(const carom::Table& table, carom_partner kind, size_t index) {
    const auto of = [index](const auto& list, const char* what) -> const auto& {
        check_index(index, list.size(), what);
        return list[index];
    };
    switch (kind) {
        case CAROM_CUSHION:
            return part_of(of(table.cushions, "cushion"));
        case CAROM_JAW:
            return part_of(of(table.jaws, "jaw"));
        case CAROM_POCKET:
            return part_of(of(table.pockets, "pocket"), 0.0);
        case CAROM_NO_PARTNER:
        case CAROM_BALL:
            break;
    }
    throw BadArgument("a part is a cushion, a jaw or a pocket");
}

/// A record that was read, with the scene that was played.
void keep(carom_record& r, carom::Record record, const carom::Scene& scene) {
    if (!same_balls(scene, record))
        throw BadArgument("the scene and the record have different balls; give the scene that was played");
    r.record = std::move(record);
    r.scene = scene;
}

carom::Vec2 spot_of(const carom::Table& table, std::string_view name) {
    if (name == "head") return carom::games::head_spot(table);
    if (name == "center") return carom::games::center_spot(table);
    if (name == "foot") return carom::foot_spot(table);
    return carom::games::snooker_spot(table, name);
}

}  // namespace

carom_status carom_scene_set(carom_scene* scene, const char* key, const char* value) {
    return guarded([&] {
        need({scene, key, value});
        try {
            const carom::Scene& s = scene->scene;
            scene->scene =
                carom::parse_scene(carom::with_values(carom::scene_text(s), s.file, {{key, value}}), s.file);
        } catch (const carom::VariationError& error) {
            throw BadArgument(error.what());
        }
    });
}

carom_status carom_scene_cue(const carom_scene* scene, carom_cue* cue, const char** ball) {
    return guarded([&] {
        need({scene, cue});
        if (!scene->scene.cue) throw BadArgument("the scene has no cue; set one with carom_scene_set_cue");
        for (const auto& [theirs, ours] : kCueNumbers) cue->*theirs = *scene->scene.cue.*ours;
        if (ball != nullptr) *ball = scene->scene.cue->ball.c_str();
    });
}

size_t carom_scene_ball_count(const carom_scene* scene) {
    return scene != nullptr ? scene->scene.ball.size() : 0;
}

carom_status carom_scene_ball(const carom_scene* scene, size_t index, const char** id, double rvw[9],
                              double* radius) {
    return guarded([&] {
        need({scene});
        check_index(index, scene->scene.ball.size(), "ball");
        const carom::BallStart& ball = scene->scene.ball[index];
        if (id != nullptr) *id = ball.id.c_str();
        if (rvw != nullptr) {
            std::copy_n(ball.position.data(), 3, rvw);
            std::copy_n(ball.velocity.data(), 3, rvw + 3);
            std::copy_n(ball.spin.data(), 3, rvw + 6);
        }
        if (radius != nullptr) *radius = scene->scene.size_of(ball).R;
    });
}

carom_status carom_scene_table(const carom_scene* scene, carom_table* table) {
    return guarded([&] {
        need({scene, table});
        const carom::Table& t = scene->scene.table;
        *table = {{t.corner.x(), t.corner.y()},
                  t.width,
                  t.length,
                  t.cushions.size(),
                  t.jaws.size(),
                  t.pockets.size()};
    });
}

carom_status carom_scene_part(const carom_scene* scene, carom_partner kind, size_t index, carom_part* part) {
    return guarded([&] {
        need({scene, part});
        *part = part_of(scene->scene.table, kind, index);
    });
}

carom_status carom_scene_diamond(const carom_scene* scene, const char* rail, double number, double place[2]) {
    return guarded([&] {
        need({scene, rail, place});
        if (!std::isfinite(number)) throw BadArgument("the number of a diamond must be finite");
        const auto at = carom::diamond_place(scene->scene.table, rail, number);
        if (!at)
            throw BadArgument("no diamonds on rail \"" + std::string(rail) +
                              "\"; use head, foot, left or right of a table");
        std::copy_n(at->data(), 2, place);
    });
}

carom_status carom_scene_spot(const carom_scene* scene, const char* name, double place[2]) {
    return guarded([&] {
        need({scene, name, place});
        try {
            std::copy_n(spot_of(scene->scene.table, name).data(), 2, place);
        } catch (const std::invalid_argument&) {
            throw BadArgument("no spot \"" + std::string(name) +
                              "\"; use head, center, foot or a colour of snooker");
        }
    });
}

carom_status carom_record_orientations(const carom_record* record, size_t count, const double* times,
                                       double* xyzw) {
    return guarded([&] {
        need({record});
        if (count > 0) need({times, xyzw});
        for (size_t k = 0; k < count; ++k)
            if (std::isnan(times[k])) throw BadArgument("a time is not a number");
        const int balls = static_cast<int>(record->record.tracks.size());
        for (size_t k = 0; k < count; ++k)
            for (int ball = 0; ball < balls; ++ball)
                xyzw = std::copy_n(record->record.orientation_at(ball, times[k]).coeffs().data(), 4, xyzw);
    });
}

carom_status carom_record_event_details(const carom_record* record, size_t index,
                                        carom_event_details* details) {
    return guarded([&] {
        need({record, details});
        check_index(index, record->record.events.size(), "event");
        const carom::Event& e = record->record.events[index];
        const carom::EventDetails d = carom::details_of(record->record, index);
        *details = {e.time,    static_cast<int32_t>(e.type),
                    e.a,       static_cast<int32_t>(kind(e.type).partner),
                    e.b,       {},
                    {},        d.cut * kDegrees,
                    d.closing, d.impulse,
                    d.lost,    d.diamond};
        std::copy_n(d.point.data(), 3, details->point);
        std::copy_n(d.normal.data(), 3, details->normal);
    });
}

size_t carom_record_hit_count(const carom_record* record) {
    size_t count = 0;
    if (record)
        for (const carom::Event& e : record->record.events)
            carom::each_hit(e, record->record.hits(e), [&](const carom::Hit&) { ++count; });
    return count;
}

carom_status carom_record_hits(const carom_record* record, carom_hit* hits) {
    return guarded([&] {
        need({record});
        const std::vector<carom::Event>& events = record->record.events;
        if (carom_record_hit_count(record) > 0) need({hits});
        for (std::size_t k = 0; k < events.size(); ++k)
            carom::each_hit(events[k], record->record.hits(events[k]), [&](const carom::Hit& hit) {
                *hits++ = {
                    hit.time, hit.impulse, static_cast<int32_t>(k), hit.a, static_cast<int32_t>(hit.partner),
                    hit.b};
            });
    });
}

carom_status carom_record_write(const carom_record* record, const char* path) {
    return guarded([&] {
        need({record, path});
        carom::write_record(record->record, path);
    });
}

size_t carom_record_text(const carom_record* record, char* text, size_t size) {
    return written(text, size, [&] {
        need({record});
        return carom::record_json(record->record);
    });
}

carom_status carom_record_read(const char* path, const carom_scene* scene, carom_record** record) {
    return made(record, [&](carom_record& r) {
        need({path, scene});
        keep(r, carom::read_record(path), scene->scene);
    });
}

carom_status carom_record_parse(const char* text, const carom_scene* scene, carom_record** record) {
    return made(record, [&](carom_record& r) {
        need({text, scene});
        keep(r, carom::parse_record(text, "record"), scene->scene);
    });
}
