// Stands in for drawing.cpp in a build without cairo.
#include <stdexcept>
#include <string>
#include <vector>

#include "commands/diagram/drawing.h"

namespace carom::tools {

bool can_draw_diagrams() {
    return false;
}

std::string draw_diagram(const std::vector<DiagramShot>&, const DiagramStyle&, const std::string&) {
    throw std::runtime_error("this build cannot draw diagrams");
}

}  // namespace carom::tools
