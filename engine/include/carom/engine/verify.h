// The checker: laws that hold after every event, whatever the scene (hard cases, U1..U9).
#pragma once

#include <optional>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

/// Total energy of all balls on the table at time t, per ball mass [J/kg].
double energy_at(const Record& record, double t);

struct Violation {
    std::size_t event = 0;  ///< index into Record::events; their number for what concerns the whole record
    std::string law;        ///< "U1".."U9", or "E": an effect that the plan skips was needed
    std::string message;
};

/// Checks a record after every event, U3 and U4 between the events, too; the first violation, or nothing.
///   U1 every number finite                         U2 times never decrease
///   U3 no penetration deeper than 1e-12 m, and what the rounding of speeds has added up to
///   U4 energy never rises (slack 1e-12 of the first), and is kept where nothing takes any: without friction
///   and
///      pockets, with all restitutions 1, but for clusters and the march, which err by their steps
///   U5 a ball-ball impact keeps the pair's momentum up to the cloth's impulse and the tolerance to which the
///   impact is
///      solved; exactly where mu_s = 0
///   U6 w . n is kept, and the two spins change alike, where mu_s = 0
///   U7 a rolling ball does not slip                U8 no more than kEventCap events in kEventCapSpan
///   U9 a run to rest has no ball left that moves
///   E  nothing that the plan left out was needed
/// U4 is left out for the published cloth slip, and for the march below 100 substeps, which gain energy by
/// construction.
std::optional<Violation> verify(const Record& record, const Plan& plan);

}  // namespace carom
