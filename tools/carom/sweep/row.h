// The table that a sweep writes: its header, and a row a shot.
#pragma once

#include <cstdint>
#include <string>

#include "carom/engine/variation.h"
#include "carom/kernel/isa.h"

namespace carom::tools {

/// How a shot ended.
enum class ShotOutcome : unsigned char { kAtRest, kTime, kEvents, kEndless, kInvalid, kRunFailed };
inline constexpr int kShotOutcomes = 6;
const char* name(ShotOutcome outcome);

struct SweepRow {
    std::string text;  ///< with its line end
    ShotOutcome outcome;
};

/// `shot,KEY...,outcome,duration,events,first_contact,pocketed,ID.x,ID.y,ID.pocket...,message`, with a line end.
std::string sweep_header(const Variation& variation);

/// Runs one shot. Invalid values and a failing simulation make a row too, with empty results and a message.
/// @throws Interrupted
SweepRow sweep_row(const Variation& variation, std::uint64_t shot, kernel::Isa isa);

}  // namespace carom::tools
