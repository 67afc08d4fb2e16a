// Cushions and jaws joined to the lines that balls bounce off.
#pragma once

#include <vector>

#include "carom/engine/table.h"

namespace carom::render {

/// Cushion noses joined end to end, jaw arcs included.
struct Chain {
    std::vector<Vec2> points;     ///< a closed chain does not repeat its first point
    std::vector<double> heights;  ///< of the nose at each point [m]
    bool closed = false;
    bool has_jaw = false;
};

/// Joins cushions whose ends meet, or lie on the same jaw circle (by its shorter arc).
std::vector<Chain> join_outline(const Table& table);

/// Signed area of a polygon, positive when it runs counter-clockwise.
double signed_area(const std::vector<Vec2>& polygon);

bool contains(const std::vector<Vec2>& polygon, const Vec2& point);

/// Every vertex moved `distance` to the left of the line, mitred (the mitre limited to three times the distance).
std::vector<Vec2> offset_left(const std::vector<Vec2>& points, bool closed, double distance);

/// Triangles (index triples) of a simple polygon by ear clipping; runs counter-clockwise.
std::vector<int> triangulate(const std::vector<Vec2>& polygon);

void reverse(Chain& chain);

}  // namespace carom::render
