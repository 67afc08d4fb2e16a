// Shots as a drawing for a printed page: the table to scale, the initial positions of the balls, and their
// paths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/shown_units.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom::tools {

/// The spread of a ball's final positions by errors of the hand.
struct DiagramSpread {
    int ball;
    Vec2 center;
    Vec2 along, across;      ///< [m] half axes of an ellipse of one standard deviation
    std::vector<Vec2> ends;  ///< [m] of played shots
};

struct DiagramShot {
    std::string title;
    Record record;
    std::optional<Cue> cue;  ///< empty if only the record is known
    std::vector<DiagramSpread> spreads = {};
};

struct DiagramStyle {
    bool color = true;
    bool diamond_numbers = false;
    Units units = Units::kMetric;
};

/// The formats, by file extension.
inline constexpr const char* kDiagramFormats[] = {".svg", ".pdf", ".png"};

/// The format of a file. @throws UsageError for another ending, and in a build without cairo
std::string diagram_format(const std::string& path);

/// @param format  one of kDiagramFormats  @return the file's bytes  @throws std::runtime_error
std::string draw_diagram(const std::vector<DiagramShot>& shots, const DiagramStyle& style,
                         const std::string& format);

}  // namespace carom::tools
