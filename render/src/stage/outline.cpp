// Cushions and jaws joined to the outlines that balls bounce off.
#include "stage/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace carom::render {

namespace {

// [m] Ends closer than this are drawn as joined: far below
// a pixel, far above the rounding of given coordinates.
constexpr double kJoin = 1e-5;

// [m] An end lies on a jaw if it is this close to the jaw's circle; this includes tangent points given with
// four decimals.
constexpr double kOnJaw = 2e-4;

// [rad] Length of one straight piece of a drawn arc.
constexpr double kArcStep = 0.06;

struct Link {
    int end = -1;  // the linked end: 2 * cushion for `from`, 2 * cushion + 1 for `to`
    int jaw = -1;  // the jaw whose arc connects the two ends, or -1
};

const Vec2& point_of(const Table& table, int end) {
    const Cushion& cushion = table.cushions[end / 2];
    return end % 2 == 0 ? cushion.from : cushion.to;
}

int jaw_at(const Table& table, const Vec2& point) {
    for (std::size_t j = 0; j < table.jaws.size(); ++j) {
        if (std::abs((point - table.jaws[j].center).norm() - table.jaws[j].radius) < kOnJaw)
            return static_cast<int>(j);
    }
    return -1;
}

std::vector<Link> link_ends(const Table& table) {
    const int ends = 2 * static_cast<int>(table.cushions.size());
    std::vector<Link> links(static_cast<std::size_t>(ends));
    const auto join = [&](int a, int b, int jaw) {
        links[a] = {b, jaw};
        links[b] = {a, jaw};
    };
    const auto free = [&](int a) { return links[a].end < 0; };
    for (int a = 0; a < ends; ++a) {
        for (int b = a + 1; b < ends && free(a); ++b) {
            if (free(b) && b / 2 != a / 2 && (point_of(table, a) - point_of(table, b)).norm() < kJoin)
                join(a, b, -1);
        }
    }
    std::vector<int> jaws(static_cast<std::size_t>(ends), -1);  // on which a free end lies
    for (int a = 0; a < ends; ++a)
        if (free(a)) jaws[a] = jaw_at(table, point_of(table, a));
    for (int a = 0; a < ends; ++a) {
        for (int b = a + 1; b < ends && jaws[a] >= 0 && free(a); ++b)
            if (free(b) && b / 2 != a / 2 && jaws[b] == jaws[a]) join(a, b, jaws[a]);
    }
    return links;
}

// Appends the inner points of the shorter arc from a to b.
void append_arc(Chain& chain, const Jaw& jaw, const Vec2& a, const Vec2& b) {
    const Vec2 start = a - jaw.center, stop = b - jaw.center;
    const double angle = std::atan2(cross(start, stop), start.dot(stop));
    const int pieces = std::max(2, static_cast<int>(std::ceil(std::abs(angle) / kArcStep)));
    for (int i = 1; i < pieces; ++i) {
        const double turn = angle * i / pieces, c = std::cos(turn), s = std::sin(turn);
        chain.points.push_back(jaw.center +
                               Vec2(c * start.x() - s * start.y(), s * start.x() + c * start.y()));
        chain.heights.push_back(jaw.height);
    }
    chain.has_jaw = true;
}

Chain walk(const Table& table, const std::vector<Link>& links, int first_end, std::vector<char>& used) {
    Chain chain;
    int end = first_end;
    while (true) {
        const int cushion = end / 2, other = end ^ 1;
        used[cushion] = 1;
        const double height = table.cushions[cushion].height;
        // A joint without a jaw has already been added as the end of the previous cushion.
        if (chain.points.empty() || (chain.points.back() - point_of(table, end)).norm() >= kJoin) {
            chain.points.push_back(point_of(table, end));
            chain.heights.push_back(height);
        }
        chain.points.push_back(point_of(table, other));
        chain.heights.push_back(height);
        const Link next = links[other];
        if (next.end < 0) return chain;
        if (next.jaw >= 0) {
            append_arc(chain, table.jaws[next.jaw], point_of(table, other), point_of(table, next.end));
        }
        if (used[next.end / 2]) {
            chain.closed = true;
            if ((chain.points.back() - chain.points.front()).norm() < kJoin) {
                chain.points.pop_back();
                chain.heights.pop_back();
            }
            return chain;
        }
        end = next.end;
    }
}

}  // namespace

std::vector<Chain> join_outline(const Table& table) {
    const std::vector<Link> links = link_ends(table);
    std::vector<char> used(table.cushions.size(), 0);
    std::vector<Chain> chains;
    // Open chains start at a free end; the remaining cushions form closed chains.
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t end = 0; end < links.size(); ++end) {
            const bool start = pass == 1 || links[end].end < 0;
            if (start && !used[end / 2]) chains.push_back(walk(table, links, static_cast<int>(end), used));
        }
    }
    return chains;
}

double signed_area(const std::vector<Vec2>& polygon) {
    double sum = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return 0.5 * sum;
}

bool contains(const std::vector<Vec2>& polygon, const Vec2& point) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2 &a = polygon[i], &b = polygon[j];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) inside = !inside;
    }
    return inside;
}

std::vector<Vec2> offset_left(const std::vector<Vec2>& points, bool closed, double distance) {
    const std::size_t n = points.size();
    const auto left = [&](std::size_t a, std::size_t b) -> std::optional<Vec2> {
        const Vec2 along = points[b] - points[a];
        if (along.norm() == 0.0) return std::nullopt;
        return Vec2(-along.y(), along.x()).normalized();
    };
    std::vector<Vec2> moved(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::optional<Vec2> before, after;
        if (closed || i > 0) before = left((i + n - 1) % n, i);
        if (closed || i + 1 < n) after = left(i, (i + 1) % n);
        if (!before) before = after;
        if (!after) after = before;
        if (!before) {
            moved[i] = points[i];
            continue;
        }
        const Vec2 middle = *before + *after;
        // |middle|^2 / 2 = 1 + cos(turn); a shift by distance * middle / (1 + cos) moves both edges by the
        // distance.
        const double spread = std::max(0.5 * middle.squaredNorm(), 0.3);
        moved[i] = points[i] + middle * (distance / spread);
    }
    return moved;
}

std::vector<int> triangulate(const std::vector<Vec2>& polygon) {
    std::vector<int> left(polygon.size()), triangles;
    for (std::size_t i = 0; i < polygon.size(); ++i) left[i] = static_cast<int>(i);
    const auto at = [&](int i) -> const Vec2& { return polygon[i]; };
    const auto is_ear = [&](int a, int b, int c) {
        if (cross(at(b) - at(a), at(c) - at(b)) <= 0.0) return false;
        for (int p : left) {
            if (p == a || p == b || p == c) continue;
            if (cross(at(b) - at(a), at(p) - at(a)) >= 0.0 && cross(at(c) - at(b), at(p) - at(b)) >= 0.0 &&
                cross(at(a) - at(c), at(p) - at(c)) >= 0.0) {
                return false;
            }
        }
        return true;
    };
    // A point that is not an ear becomes one only through a cut next to it. As long as its triangle is the
    // same, the innermost point inside it is not convex, so it is not cut off. An outline of n points takes
    // n^2 steps, instead of n^3 if every point were checked again.
    std::vector<char> no_ear(polygon.size(), 0);
    while (left.size() >= 3) {
        const std::size_t n = left.size();
        std::size_t ear = n;
        for (std::size_t i = 0; i < n && ear == n; ++i) {
            if (no_ear[left[i]] != 0) continue;
            if (is_ear(left[(i + n - 1) % n], left[i], left[(i + 1) % n]))
                ear = i;
            else
                no_ear[left[i]] = 1;
        }
        if (ear == n) {
            // No ear: the remaining points are collinear, or the outline crosses itself. Any cut then ends
            // the loop.
            ear = 0;
            std::fill(no_ear.begin(), no_ear.end(), 0);
        }
        const int before = left[(ear + n - 1) % n], after = left[(ear + 1) % n];
        for (const int corner : {before, left[ear], after}) triangles.push_back(corner);
        no_ear[before] = no_ear[after] = 0;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

void reverse(Chain& chain) {
    std::reverse(chain.points.begin(), chain.points.end());
    std::reverse(chain.heights.begin(), chain.heights.end());
}

}  // namespace carom::render
