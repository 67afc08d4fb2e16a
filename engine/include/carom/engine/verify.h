// The checker: laws that every record keeps.
#pragma once

#include <optional>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

/// Total energy of all balls on the table at time t, per ball mass [J/kg].
double energy_at(const Record& record, double t);

struct Violation {
    std::size_t event = 0;  ///< index into Record::events; their count if it concerns the whole record
    std::string law;        ///< "U1".."U8", or "E": an effect that the plan skipped was needed
    std::string message;    ///< with the residual and its unit
};

/// Checks a record, perhaps another program's, against the scene of the plan. Places and times may be off by
/// 1e-9 m and s, rates by 1e-9 of their size. @return the first violation, or nothing
///   U1 every number is finite
///   U2 times never decrease
///   U3 no overlap deeper than 1e-12 m plus the accumulated rounding of the motion; no ball passes a cushion,
///      a round wall or the edge of a pocket without an event
///   U4 energy never rises (tolerance: 1e-12 of the initial energy), nor falls if nothing dissipates it (in a
///      cluster 1e-5)
///   U5 each impact, landing and strike, computed again, gives the motion after it, within 1e-9 of the
///      speeds, and two tolerances of the scene for two balls on the cloth (14 if they differ); a cluster
///      changes the momentum by the friction of the cloth at most
///   U6 each change of a motion has an event of that instant with this ball, which touches and approaches the
///      other body; each event has its change; places, and without an event velocities, are continuous
///   U7 each motion has the accelerations, the decay and the duration of its state; a rolling ball does not
///      slip
///   U8 the end is true: rest, duration, reason and pockets
///   E  no effect that the plan skipped was needed
/// U4 is not checked for the published sign of the cloth slip, nor below 100 substeps: both gain energy by
/// construction. In a resting contact only its places, its touch and its continuity are checked.
/// docs/design/hard_cases.md lists the limits of these laws.
std::optional<Violation> verify(const Record& record, const Plan& plan);

/// One sentence for people, with the event. @param record  that was checked
std::string describe(const Violation& violation, const Record& record);

/// Before verify() of a record from a file. @throws SceneError with the first difference, for the file
/// `name`, if the record repeats a table, balls or a gravity that differ from the plan
void require_scene(const Record& record, const Plan& plan, const std::string& name);

}  // namespace carom
