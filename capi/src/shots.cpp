// The C interface: scenes and records.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "carom/engine/next_scene.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "cue.h"
#include "guard.h"
#include "handles.h"
#include "text.h"

using namespace carom::c;

namespace {

/// The field of a ball parameter.
const carom::Field<carom::BallParams>& ball_field(std::string_view name) {
    std::string known;
    for (const auto& f : carom::kBallFields) {
        if (f.kind != carom::Key::Kind::kNumber) continue;
        if (name == f.key) return f;
        known += (known.empty() ? "" : ", ") + std::string(f.key);
    }
    throw BadArgument("unknown ball parameter \"" + std::string(name) + "\"; use " +
                      known.replace(known.rfind(", "), 2, " or "));
}

}  // namespace

carom_status carom_scene_read(const char* path, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({path});
        s.scene = carom::read_scene(path);
    });
}

carom_status carom_scene_parse(const char* text, const char* name, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({text, name});
        s.scene = carom::parse_scene(text, name);
    });
}

carom_status carom_scene_create(const char* table, const char* balls, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({table, balls});
        if (*table != '\0') s.scene.table = carom::make_table(table);
        carom::use_balls(s.scene, balls);
        s.scene.file = "scene";
    });
}

void carom_scene_free(carom_scene* scene) {
    delete scene;
}

carom_status carom_scene_set_ball_param(carom_scene* scene, const char* name, double value) {
    return guarded([&] {
        need({scene, name});
        ball_field(name).set(scene->scene.balls, value);
        for (carom::BallStart& ball : scene->scene.ball) ball.position.z() = scene->scene.size_of(ball).R;
    });
}

carom_status carom_scene_get_ball_param(const carom_scene* scene, const char* name, double* value) {
    return guarded([&] {
        need({scene, name, value});
        *value = std::get<double>(ball_field(name).get(scene->scene.balls));
    });
}

carom_status carom_scene_set_ball(carom_scene* scene, const char* id, const double rvw[9]) {
    return guarded([&] {
        need({scene, id, rvw});
        carom::BallStart start;
        start.id = id;
        start.position = {rvw[0], rvw[1], rvw[2]};
        start.velocity = {rvw[3], rvw[4], rvw[5]};
        start.spin = {rvw[6], rvw[7], rvw[8]};
        std::vector<carom::BallStart>& balls = scene->scene.ball;
        if (const int i = index_of(balls, start.id); i >= 0) {
            start.own = balls[i].own;  // its own radius and mass
            balls[i] = start;
        } else {
            balls.push_back(start);
        }
    });
}

void carom_cue_init(carom_cue* cue) {
    if (cue != nullptr) *cue = cue_of(carom::Cue{});
}

carom_status carom_scene_set_cue(carom_scene* scene, const char* id, const carom_cue* cue) {
    return guarded([&] {
        need({scene});
        if (cue == nullptr) {
            scene->scene.cue.reset();
            return;
        }
        need({id});
        scene->scene.cue = cue_of(id, *cue);
    });
}

size_t carom_scene_text(const carom_scene* scene, char* text, size_t size) {
    return written(text, size, [&] {
        need({scene});
        return carom::scene_text(scene->scene);
    });
}

carom_status carom_simulate(const carom_scene* scene, double until, carom_record** record) {
    return made(record, [&](carom_record& r) {
        need({scene});
        if (std::isnan(until)) throw BadArgument("until is not a number");
        carom::validate(scene->scene);
        carom::SimulateOptions options;
        if (until >= 0.0) options.until = until;
        r.record = carom::simulate(carom::make_plan(scene->scene, chosen_isa()), options);
        r.scene = scene->scene;
    });
}

void carom_record_free(carom_record* record) {
    delete record;
}

double carom_record_duration(const carom_record* record) {
    return record ? record->record.duration : 0.0;
}

size_t carom_record_ball_count(const carom_record* record) {
    return record ? record->record.tracks.size() : 0;
}

size_t carom_record_event_count(const carom_record* record) {
    return record ? record->record.events.size() : 0;
}

const char* carom_record_ball_id(const carom_record* record, size_t ball) {
    return ball < carom_record_ball_count(record) ? record->record.tracks[ball].id.c_str() : nullptr;
}

carom_status carom_record_event(const carom_record* record, size_t index, carom_event* event) {
    return guarded([&] {
        need({record, event});
        check_index(index, record->record.events.size(), "event");
        const carom::Event& e = record->record.events[index];
        *event = {e.time,
                  carom::name(e.type),
                  record->record.tracks.at(static_cast<std::size_t>(e.a)).id.c_str(),
                  {}};
        const std::string partner = record->record.partner_id(e);
        std::memcpy(event->b, partner.data(), std::min(partner.size(), sizeof event->b - 1));
    });
}

carom_status carom_record_state(const carom_record* record, size_t ball, double t, double rvw[9],
                                const char** state) {
    return guarded([&] {
        need({record, rvw});
        check_index(ball, record->record.tracks.size(), "ball");
        if (std::isnan(t)) throw BadArgument("t is not a number");
        const carom::BallState s = record->record.state_at(static_cast<int>(ball), t);
        std::copy_n(s.position.data(), 3, rvw);
        std::copy_n(s.velocity.data(), 3, rvw + 3);
        std::copy_n(s.spin.data(), 3, rvw + 6);
        if (state) *state = carom::name(s.state);
    });
}

carom_status carom_record_hash(const carom_record* record, char hash[17]) {
    return guarded([&] {
        need({record, hash});
        const std::string text = record->record.hash();
        std::memcpy(hash, text.c_str(), 17);
    });
}

size_t carom_record_verify(const carom_record* record, char* broken, size_t size) {
    return written(broken, size, [&]() -> std::string {
        need({record});
        const carom::Plan plan = carom::make_plan(record->scene, chosen_isa());
        carom::require_scene(record->record, plan, "record");
        const auto violation = carom::verify(record->record, plan);
        return violation ? carom::describe(*violation, record->record) : "";
    });
}

carom_status carom_scene_from_record(const carom_record* record, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({record});
        s.scene = carom::scene_after(record->scene, record->record);
    });
}

carom_status carom_next_scene(const carom_record* record, const char* id, const carom_cue* cue,
                              carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({record, id, cue});
        s.scene = carom::next_scene(record->scene, record->record, cue_of(id, *cue));
    });
}
