// Whether the hits that a record lists for a cluster explain the motion of its balls.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "physics/motion.h"

namespace carom {

/// A ball of a cluster, just before it and at its end.
struct ClusterMove {
    int ball;
    Placed before, end;
    double spin;  ///< R |w| before [m/s]
};

struct HitFault {
    const char* law;
    std::string message;
};

/// Each impulse acts along the line of centres of its first touch, friction adds at most its share, and a
/// ball that nobody hit keeps its velocity. Together the balls keep their momentum, except for cushions and
/// the cloth (law "U5"). The hits are of these balls and this time ("U6").
/// @param lasts  [s] 0: only the sum over the balls is known, and balls that nobody hit
/// @param time  [s] in which the balls slide and pass each other
/// @param known  whether nothing else happens to these balls, and all stay on the cloth; false: only "U6"
std::optional<HitFault> verify_hits(const Record& record, const Plan& plan, const Event& cluster,
                                    std::span<const ClusterMove> moves, double lasts, double time,
                                    bool known);

}  // namespace carom
