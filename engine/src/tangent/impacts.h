// The derivatives of impacts. The models themselves are evaluated at states that differ along the derivatives
// of the incoming state: differences of four points, with a step that adapts until two sizes of it agree.
#pragma once

#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/cushion.h"
#include "tangent/leg.h"

namespace carom::tangent {

struct Laws {
    const Plan& plan;
    const Numbers& numbers;
    double error = 0.0;  ///< the largest disagreement so far, relative to the largest derivative

    bool flights() const { return plan.in_force(Effect::kAirborne); }
};

/// Two balls in the plane. `apart`: from the centre of ball 1 to that of ball 2. v_z is not read.
/// @throws TangentError if the impact has no derivative
void collide(Laws& laws, int one, int two, const Dual3& apart, State& s1, State& s2);

/// Two balls as free bodies.
void collide_free(Laws& laws, int one, int two, const Dual3& apart, bool slow, Lies lies, State& s1,
                  State& s2);

/// Balls on the cloth that collide at once, because two of them, `hit` and `met`, do.
/// @param duration  of the cluster [s]; the `states` are computed at its end; 0: instantaneous
void collide_cluster(Laws& laws, const std::vector<int>& balls, int hit, int met, double duration,
                     std::vector<State>& states);

/// A ball on the cloth hits a nose; it may hop.
/// @param normal  into the table
void meet_cushion(Laws& laws, int ball, const CushionModelInfo& model, const Dual2& normal,
                  const Dual& height, bool hops, State& s);

/// A flying ball hits a nose. `apart`: from the nose to the centre.
void meet_nose_in_air(Laws& laws, int ball, const CushionModelInfo& model, const Dual3& apart, State& s);

/// A ball hits the cloth from above.
void meet_cloth(Laws& laws, int ball, State& s);

}  // namespace carom::tangent
