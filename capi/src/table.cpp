// The C interface: places on a table, and the data of a record that a game needs.
#include <algorithm>
#include <cmath>
#include <span>
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

carom_status carom_record_events(const carom_record* record, size_t columns, const char* const* names,
                                 double* numbers) {
    return guarded([&] {
        need({record});
        if (columns > 0) need({names});
        if (columns > 0 && !record->record.events.empty()) need({numbers});
        const std::span<const carom::EventColumn> all = carom::event_columns();
        std::vector<std::size_t> wanted;
        for (size_t k = 0; k < columns; ++k) {
            need({names[k]});
            const std::string_view name = names[k];
            const auto found =
                std::find_if(all.begin(), all.end(), [&](const auto& column) { return column.name == name; });
            if (found == all.end())
                throw BadArgument("no column \"" + std::string(name) +
                                  "\"; `carom describe events` lists them");
            wanted.push_back(static_cast<std::size_t>(found - all.begin()));
        }
        std::vector<double> row(all.size());
        for (std::size_t event = 0; event < record->record.events.size(); ++event) {
            carom::event_row(record->record, event, row);
            for (const std::size_t column : wanted) *numbers++ = row[column];
        }
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
                *hits++ = {hit.time, hit.impulse, static_cast<int32_t>(k), hit.a, name(hit.partner), hit.b};
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
