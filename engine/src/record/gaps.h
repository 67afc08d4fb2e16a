// Distances between balls, and from balls to noses, for the record checker.
#pragma once

#include <cstddef>

#include "carom/engine/ball_ball.h"
#include "carom/engine/geometry.h"
#include "carom/engine/record.h"
#include "carom/engine/vec.h"
#include "contact/roots.h"

namespace carom {

struct SeenBall {
    Vec3 r;
    double R;
    bool flies = false;     ///< or is out
    double fell = kNever;   ///< [s] when it began to fall into a pocket; kNever if it is not falling
    double flew = -kNever;  ///< [s] when its last flight ended
    double rounding = 0.0;  ///< [m] rounding_of()
    bool disc = false;
};

/// [m] How much too far a ball with these speeds may have moved in t [s]: closing speeds within rounding
/// (kClosingUlp) do not count as an approach, and times are rounded.
double rounding_of(const Vec3& v, const Vec3& w, double R, double t);
/// [m] Allowed overlap with another ball or the cloth, or with the wall at this position.
double allowed_depth(const SeenBall& ball);
double allowed_depth(const SeenBall& ball, const Vec2& wall);

/// A ball at the position `r`, in segment number `segment`.
/// @param flights  whether balls may leave the cloth
SeenBall see(const Record& record, std::size_t ball, std::size_t segment, const Vec3& r, double rounding,
             bool flights);

/// Whether two balls meet in space rather than in the plane: one flies, or has flown since the other began to
/// fall into a pocket.
bool in_space(const SeenBall& one, const SeenBall& two);
/// [m] Between two balls, in space or in the plane; negative if they overlap.
double gap_between(const SeenBall& one, const SeenBall& two);
/// [m] To the nose of a cushion; infinite if the ball is beyond its ends.
double gap_to(const CushionLine& line, const SeenBall& ball);
/// [m] To a jaw or the end of a cushion; infinite if the ball is not beside it.
double gap_to(const Nose& nose, const SeenBall& ball);
/// [m] To the cloth: 0 for a ball on it.
double gap_to_cloth(const SeenBall& ball);

}  // namespace carom
