#include "carom/engine/batch.h"

#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <utility>

namespace carom {

static_assert(static_cast<int>(ShotStatus::kEndless) == static_cast<int>(StopReason::kEndless));
static_assert(static_cast<std::size_t>(ShotStatus::kInvalid) == kStopWords.size());

Simulator::Simulator(const Scene& scene, kernel::Isa isa) : planner_(scene, isa) {}

ShotStatus Simulator::refuse(std::string why) {
    message_ = std::move(why);
    return ShotStatus::kInvalid;
}

ShotStatus Simulator::play(Change change, const SimulateOptions& options) {
    try {
        validate_change(scene(), checked_ ? change : Change::kAnything);
        checked_ = true;
    } catch (const SceneError& error) {
        std::string why = error.message();
        try {
            validate(scene());  // finds the mistake that a reader would report first
        } catch (const SceneError& first) {
            why = first.message();
        }
        return refuse(std::move(why));
    }
    return run(change < Change::kTable, options);
}

ShotStatus Simulator::play(const Scene& scene, const SimulateOptions& options) {
    planner_.scene() = scene;
    checked_ = true;
    return run(false, options);
}

ShotStatus Simulator::play(const Variation& variation, std::uint64_t index, std::span<DrawnValue> values,
                           const SimulateOptions& options) {
    variation.draw(index, values);
    if (const auto change = variation.put(values, scene())) return play(*change, options);
    VariedShot shot = variation.shot(index);
    return shot.scene ? play(*shot.scene, options) : refuse(std::move(shot.error));
}

ShotStatus Simulator::run(bool same_table, const SimulateOptions& options) {
    try {
        const Plan& plan = planner_.plan(same_table);
        if (records_)
            simulate(plan, buffers_, outcome_, record_, options);
        else
            simulate(plan, buffers_, outcome_, options);
    } catch (const SceneError& error) {  // [effects] excludes what these values need
        return refuse(error.message());
    } catch (const SimulationError& error) {
        message_ = error.what();
        return ShotStatus::kFailed;
    }
    message_.clear();
    return static_cast<ShotStatus>(outcome_.stopped);
}

}  // namespace carom
