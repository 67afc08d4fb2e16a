#include "carom/render/mesh_cut.h"

#include <tuple>

namespace carom::render {

namespace {

float coordinate(const MeshVertex& vertex, Axis axis) {
    return axis == Axis::kX ? vertex.x : vertex.y;
}

MeshVertex between(const MeshVertex& a, const MeshVertex& b, Axis axis, float at) {
    // The neighbouring polygon passes the edge in the other
    // direction; a fixed order gives both the same rounding.
    if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) return between(b, a, axis, at);
    const float share = (at - coordinate(a, axis)) / (coordinate(b, axis) - coordinate(a, axis));
    const auto mix = [share](float from, float to) { return from + share * (to - from); };
    MeshVertex middle{mix(a.x, b.x),   mix(a.y, b.y), mix(a.z, b.z), mix(a.nx, b.nx), mix(a.ny, b.ny),
                      mix(a.nz, b.nz), mix(a.u, b.u), mix(a.v, b.v), a.material};
    (axis == Axis::kX ? middle.x : middle.y) = at;
    return middle;
}

}  // namespace

std::pair<Corners, Corners> cut(const Corners& polygon, Axis axis, float at) {
    Corners below, above;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const MeshVertex &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
        const float from = coordinate(here, axis) - at, to = coordinate(next, axis) - at;
        if (from <= 0.0F) below.push_back(here);
        if (from >= 0.0F) above.push_back(here);
        if ((from < 0.0F && to > 0.0F) || (from > 0.0F && to < 0.0F)) {
            below.push_back(between(here, next, axis, at));
            above.push_back(below.back());
        }
    }
    // A polygon that only touches the plane leaves a point or an edge on its other side.
    if (below.size() < 3) below.clear();
    if (above.size() < 3) above.clear();
    const auto flat = [&](const Corners& part) {
        for (const MeshVertex& corner : part) {
            if (coordinate(corner, axis) != at) return false;
        }
        return true;
    };
    // A polygon in the plane itself belongs to the lower side.
    if (flat(above)) above.clear();
    if (!above.empty() && flat(below)) below.clear();
    return {below, above};
}

}  // namespace carom::render
