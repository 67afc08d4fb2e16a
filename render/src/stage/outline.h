// Cushions and jaws joined to the outlines that balls bounce off.
#pragma once

#include <vector>

#include "carom/engine/table.h"

namespace carom::render {

/// Cushion noses joined end to end, including the arcs of jaws.
struct Chain {
    std::vector<Vec2> points;     ///< a closed chain does not repeat its first point
    std::vector<double> heights;  ///< height of the nose at each point [m]
    bool closed = false;
    bool has_jaw = false;
};

/// Joins cushions whose ends coincide or lie on the same jaw circle (along its shorter arc).
std::vector<Chain> join_outline(const Table& table);

/// Signed area of a polygon; positive if it is counter-clockwise.
double signed_area(const std::vector<Vec2>& polygon);

bool contains(const std::vector<Vec2>& polygon, const Vec2& point);

/// Moves every vertex by `distance` to the left of the line
/// with mitred corners (mitre at most about three times that).
std::vector<Vec2> offset_left(const std::vector<Vec2>& points, bool closed, double distance);

/// Triangulates a simple counter-clockwise polygon by ear clipping; returns index triples.
std::vector<int> triangulate(const std::vector<Vec2>& polygon);

void reverse(Chain& chain);

}  // namespace carom::render
