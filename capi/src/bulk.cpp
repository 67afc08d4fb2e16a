// The C interface: many shots, and much of a record at once.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/engine/printable.h"
#include "guard.h"
#include "handles.h"

using namespace carom::c;

namespace {

static_assert(CAROM_SHOT_AT_REST == static_cast<int>(carom::ShotStatus::kAtRest));
static_assert(CAROM_SHOT_TIME == static_cast<int>(carom::ShotStatus::kTime));
static_assert(CAROM_SHOT_EVENTS == static_cast<int>(carom::ShotStatus::kEvents));
static_assert(CAROM_SHOT_ENDLESS == static_cast<int>(carom::ShotStatus::kEndless));
static_assert(CAROM_SHOT_INVALID == static_cast<int>(carom::ShotStatus::kInvalid));
static_assert(CAROM_SHOT_FAILED == static_cast<int>(carom::ShotStatus::kFailed));
static_assert(sizeof(carom::ShotStatus) == sizeof(uint8_t));

static_assert(CAROM_STATIONARY == static_cast<int>(carom::MotionState::kStationary));
static_assert(CAROM_SPINNING == static_cast<int>(carom::MotionState::kSpinning));
static_assert(CAROM_SLIDING == static_cast<int>(carom::MotionState::kSliding));
static_assert(CAROM_ROLLING == static_cast<int>(carom::MotionState::kRolling));
static_assert(CAROM_POCKETED == static_cast<int>(carom::MotionState::kPocketed));
static_assert(CAROM_FALLING == static_cast<int>(carom::MotionState::kFalling));
static_assert(CAROM_AIRBORNE == static_cast<int>(carom::MotionState::kAirborne));
static_assert(CAROM_OUT == static_cast<int>(carom::MotionState::kOut));
static_assert(CAROM_COLLIDING == static_cast<int>(carom::MotionState::kColliding));

static_assert(CAROM_FLOAT64 == static_cast<int>(carom::NumberType::kFloat64));

// With the height and the speed of a fall, which the engine's segment keeps separately.
carom_segment segment_of(const carom::Segment& s, double gravity) {
    carom_segment out{};
    out.start = s.start;
    out.duration = s.duration;
    std::copy_n(s.r.data(), 3, out.r);
    std::copy_n(s.v.data(), 3, out.v);
    std::copy_n(s.w.data(), 3, out.w);
    std::copy_n(s.a.data(), 2, out.a);
    std::copy_n(s.dw.data(), 2, out.dw);
    if (s.state == carom::MotionState::kFalling) {
        out.r[2] -= s.v.z() * s.v.z() / (2.0 * gravity);
        out.a[2] = -gravity;
    }
    if (carom::flies(s.state)) out.a[2] = -gravity;
    out.spin_decay = s.spin_decay;
    out.state = static_cast<int32_t>(s.state);
    out.held = s.held ? 1 : 0;
    return out;
}

}  // namespace

carom_status carom_simulate_many(const carom_scene* scene, size_t shots, size_t key_count,
                                 const char* const* keys, const double* values, double until, int threads,
                                 int hashes, carom_batch** batch) {
    return made(batch, [&](carom_batch& b) {
        need({scene});
        if (key_count > 0) need({keys});
        if (key_count > 0 && shots > 0) need({values});
        if (std::isnan(until)) throw BadArgument("until is not a number");
        if (threads < 0) throw BadArgument("threads is negative; 0 uses one per core");
        carom::BatchOptions options;
        options.threads = threads;
        options.hash = hashes != 0;
        if (until >= 0.0) options.simulate.until = until;
        try {
            carom::check_shots(shots);  // the array may be missing
            std::vector<carom::BatchColumn> columns;
            for (size_t k = 0; k < key_count; ++k) {
                need({keys[k]});
                columns.push_back({keys[k], std::span(values + (shots > 0 ? k * shots : 0), shots)});
            }
            b.batch = carom::simulate_many(scene->scene, shots, columns, chosen_isa(), options);
        } catch (const std::invalid_argument& error) {
            throw BadArgument(error.what());
        }
    });
}

void carom_batch_free(carom_batch* batch) {
    delete batch;
}

size_t carom_batch_shot_count(const carom_batch* batch) {
    return batch != nullptr ? batch->batch.shots : 0;
}

size_t carom_batch_ball_count(const carom_batch* batch) {
    return batch != nullptr ? batch->batch.balls : 0;
}

const void* carom_batch_column(const carom_batch* batch, const char* name, carom_type* type, size_t* each) {
    const void* array = nullptr;
    guarded([&] {
        need({batch, name});
        std::string names;
        for (const carom::OutcomeColumn& column : carom::kOutcomeColumns) {
            names += (names.empty() ? "" : ", ") + std::string(column.name);
            if (column.name != std::string_view(name)) continue;
            array = column.array(batch->batch);
            if (array == nullptr)
                throw BadArgument(std::string(name) + " was not requested; set `hashes` to 1");
            if (type != nullptr) *type = static_cast<carom_type>(column.type);
            if (each != nullptr) *each = column.each(batch->batch.balls);
            return;
        }
        throw BadArgument("no column is called " + carom::in_quotes(name) + "; there are " + names);
    });
    return array;
}

const char* carom_batch_message(const carom_batch* batch, size_t shot) {
    if (batch == nullptr) return "";
    const auto& messages = batch->batch.messages;
    const auto found =
        std::lower_bound(messages.begin(), messages.end(), shot,
                         [](const carom::Batch::Message& m, size_t of) { return m.shot < of; });
    return found != messages.end() && found->shot == shot ? found->text.c_str() : "";
}

size_t carom_record_segment_count(const carom_record* record, size_t ball) {
    return ball < carom_record_ball_count(record) ? record->record.tracks[ball].segments.size() : 0;
}

carom_status carom_record_segments(const carom_record* record, size_t ball, carom_segment* segments) {
    return guarded([&] {
        need({record, segments});
        check_index(ball, record->record.tracks.size(), "ball");
        const auto& all = record->record.tracks[ball].segments;
        std::transform(all.begin(), all.end(), segments,
                       [record](const carom::Segment& s) { return segment_of(s, record->record.gravity); });
    });
}

carom_status carom_record_states(const carom_record* record, size_t count, const double* times, double* rvw,
                                 uint8_t* states) {
    return guarded([&] {
        need({record});
        if (count > 0) need({times, rvw});
        if (std::any_of(times, times + count, [](double t) { return std::isnan(t); }))
            throw BadArgument("a time is not a number");
        record->record.states_at({times, count}, rvw, states);
    });
}
