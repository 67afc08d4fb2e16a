// What can be drawn over the picture, each on its own.
#pragma once

#include <string_view>

namespace carom::render {

struct Overlay {
    bool trails = false;  ///< every ball's way so far, coloured by its motion state
    bool events = false;  ///< a dot where an impact was; a ring shows it for a third of a second
    /// Arrows: the way the top of a ball turns, and an arc for the spin about the vertical
    bool spin = false;
    bool ghost = false;   ///< where a moving ball will stand when it next meets another
    bool clock = false;   ///< s of the shot
    bool margin = false;  ///< the frame's cost against its 1 / fps

    bool any() const { return trails || events || spin || ghost || clock || margin; }
};

/// "trails,clock", or "all" or "" (none). @throws RenderError naming an unknown one and those there are
Overlay parse_overlay(std::string_view list);

}  // namespace carom::render
