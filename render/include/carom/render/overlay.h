// The overlays that can be drawn over the picture, independently of each other.
#pragma once

#include <string_view>

namespace carom::render {

struct Overlay {
    bool trails = false;       ///< the path of every ball so far, coloured by its motion state
    bool ball_trails = false;  ///< in the colours of the balls instead
    bool events = false;  ///< a dot at each impact, with a ring around it for the first third of a second
    /// An arrow for the velocity that spin gives the top of a ball, and an arc for the spin about the
    /// vertical
    bool spin = false;
    bool ghost = false;   ///< position of a moving ball at its next collision with another ball
    bool clock = false;   ///< time of the shot [s]
    bool margin = false;  ///< computing time of the frame compared with the available time, 1 / fps

    bool diamonds = false;  ///< their numbers; not one of "all", because they belong to the table

    bool any() const { return trails || events || spin || ghost || clock || margin || diamonds; }
};

/// "trails,clock" ("trails=ball": in the colours of the balls), "all", or "" (none). @throws RenderError for
/// an unknown overlay, listing the known ones
Overlay parse_overlay(std::string_view list);

}  // namespace carom::render
