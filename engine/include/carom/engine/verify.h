// The checker: laws that hold after every event of any scene (docs/design/hard_cases.md, U1..U9).
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
    std::string law;        ///< "U1".."U9", or "E": an effect that the plan skipped was needed
    std::string message;
};

/// Checks a record after every event, and U3 and U4 also between events. @return the first violation, or
/// nothing
///   U1 every number is finite
///   U2 times never decrease
///   U3 no penetration deeper than 1e-12 m plus the accumulated rounding of the motion; every ball in play is
///      on the table's side of every wall that it has not flown over
///   U4 energy never rises (tolerance: 1e-12 of the initial energy), nor falls if nothing dissipates it (in a
///      cluster 1e-5)
///   U5 a ball-ball impact conserves the pair's momentum up to the cloth's impulse and the tolerance of the
///      solution, and exactly if mu_s = 0
///   U6 if mu_s = 0, w . n is conserved, and the two spins change equally
///   U7 a rolling ball does not slip
///   U8 there are no more than kEventCap events in kEventCapSpan
///   U9 after a run to rest no ball moves
///   E  no effect that the plan skipped was needed
/// U4 is not checked for the published sign of the cloth slip, nor below 100 substeps: both gain energy by
/// construction.
std::optional<Violation> verify(const Record& record, const Plan& plan);

}  // namespace carom
