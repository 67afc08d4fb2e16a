// The table that a sweep writes: its header, and a row for each shot.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/variation.h"
#include "carom/kernel/isa.h"
#include "report/table.h"

namespace carom::tools {

/// How a shot ended: a reason to stop, or why there is no record.
enum class ShotOutcome : unsigned char { kAtRest, kTime, kEvents, kEndless, kInvalid, kRunFailed };
inline constexpr int kShotOutcomes = 6;
static_assert(static_cast<int>(ShotOutcome::kEndless) == static_cast<int>(StopReason::kEndless));
const char* name(ShotOutcome outcome);

/// What became of one shot.
struct SweptShot {
    std::uint64_t index = 0;
    VariedShot varied;
    ShotOutcome outcome = ShotOutcome::kInvalid;
    std::optional<Record> record;  ///< of a shot that was simulated to its end
    std::vector<BallState> end;    ///< of its balls
    std::string message;           ///< why there is no record
};

/// Runs one shot; several threads may do so at the same time. Invalid values and a failing simulation are outcomes, too.
/// @throws Interrupted
SweptShot swept_shot(const Variation& variation, std::uint64_t index, kernel::Isa isa);

struct SweepColumn {
    std::string key;
    std::function<Cell(const SweptShot&)> value;
};

/// `shot,KEY...,outcome,duration,events,first_contact,pocketed,ID.x,ID.y,ID.pocket...,message`; results are empty for a shot
/// without a record. A sweep writes its rows one by one, and so needs little memory however long it is.
std::vector<SweepColumn> sweep_columns(const Variation& variation);

}  // namespace carom::tools
