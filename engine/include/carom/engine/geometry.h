// The table as the loop sees it: lines, round noses and pockets in final form.
#pragma once

#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/table.h"
#include "carom/engine/vec.h"

namespace carom {

/// A straight cushion in final form; index as in scene.table.cushions.
struct CushionLine {
    Vec2 from;
    Vec2 direction;  ///< unit
    double length;
    double height;
    double inset = 0.0;  ///< [m] a ball touches it with its centre at R - inset (cushion_touch)
};

/// A round nose: a jaw, or the end of a cushion that no jaw rounds off (radius 0).
struct Nose {
    Vec2 center;
    double radius;
    double height;
    EventType type;      ///< kBallJaw or kBallCushion
    int index;           ///< of the jaw or cushion in scene.table
    double inset = 0.0;  ///< [m] a ball touches it with its centre at R + radius - inset
};

/// [m] By how much less than its radius the centre of a
/// ball is away from a nose of this height that it touches.
double nose_inset(CushionTouch touch, double R, double height);

/// All parts of a table that a ball can meet.
struct Geometry {
    std::vector<CushionLine> cushions;
    std::vector<Nose> noses;
    std::vector<Pocket> pockets;
};

}  // namespace carom
