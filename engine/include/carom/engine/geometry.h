// The table as the event loop uses it: lines, round noses and pockets.
#pragma once

#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/table.h"
#include "carom/engine/vec.h"

namespace carom {

/// A straight cushion; index as in scene.table.cushions.
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

/// [m] How much closer to a nose of this height than its radius the centre of a touching ball is.
double nose_inset(CushionTouch touch, double R, double height);

/// All parts of a table that a ball can meet.
struct Geometry {
    std::vector<CushionLine> cushions;
    std::vector<Nose> noses;
    std::vector<Pocket> pockets;
};

}  // namespace carom
