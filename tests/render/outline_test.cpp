// The outline of a table as triangles.
#include "stage/mesh_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "reference/random_impacts.h"

namespace carom::render {
namespace {

// A lane that winds inwards, counter-clockwise: out along its outer side and back along the inner one.
std::vector<Vec2> spiral(int sides) {
    const auto at = [](int i, double inwards) {
        const double angle = 0.1 * i, radius = 10.0 - 0.01 * i - inwards;
        return Vec2(radius * std::cos(angle), radius * std::sin(angle));
    };
    std::vector<Vec2> points;
    for (int i = 0; i < sides / 2; ++i) points.push_back(at(i, 0.0));
    for (int i = sides / 2 - 1; i >= 0; --i) points.push_back(at(i, 0.3));
    return points;
}

TEST(Outline, TrianglesCoverAWindingLane) {
    for (const int sides : {4, 40, 900}) {
        const std::vector<Vec2> points = spiral(sides);
        ASSERT_GT(signed_area(points), 0.0);
        const std::vector<int> corners = triangulate(points);
        ASSERT_EQ(corners.size(), 3 * (points.size() - 2)) << sides;
        double area = 0.0;
        for (std::size_t k = 0; k < corners.size(); k += 3) {
            const std::vector<Vec2> triangle{points[corners[k]], points[corners[k + 1]],
                                             points[corners[k + 2]]};
            const double part = signed_area(triangle);
            EXPECT_GE(part, 0.0) << sides << ", triangle " << k / 3;
            area += part;
        }
        EXPECT_NEAR(area, signed_area(points), 1e-12 * area) << sides;
    }
}

// Textbook ear clipping, restarted at the first point each time.
std::vector<int> ears_in_order(const std::vector<Vec2>& points) {
    std::vector<int> left(points.size()), triangles;
    std::iota(left.begin(), left.end(), 0);
    while (left.size() >= 3) {
        const std::size_t n = left.size();
        std::size_t ear = 0;
        for (bool found = false; ear < n && !found; ear += found ? 0 : 1) {
            const int a = left[(ear + n - 1) % n], b = left[ear], c = left[(ear + 1) % n];
            const auto inside = [&](int p) {
                return p != a && p != b && p != c && signed_area({points[a], points[b], points[p]}) >= 0.0 &&
                       signed_area({points[b], points[c], points[p]}) >= 0.0 &&
                       signed_area({points[c], points[a], points[p]}) >= 0.0;
            };
            found = signed_area({points[a], points[b], points[c]}) > 0.0 &&
                    std::none_of(left.begin(), left.end(), inside);
        }
        if (ear == n) ear = 0;
        for (const std::size_t k : {(ear + n - 1) % n, ear, (ear + 1) % n}) triangles.push_back(left[k]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

TEST(Outline, TrianglesMatchPlainEarClipping) {
    reference::Generator rng(7);
    for (int k = 0; k < 400; ++k) {
        // A lane that goes up and down, so that its corners lie in other corners' triangles.
        const int bends = 3 + static_cast<int>(rng.uniform(0.0, 40.0));
        std::vector<double> height;
        for (int i = 0; i < bends; ++i) height.push_back(rng.uniform(-3.0, 3.0));
        std::vector<Vec2> points;
        for (int i = 0; i < bends; ++i) points.emplace_back(i, height[i]);
        for (int i = bends - 1; i >= 0; --i) points.emplace_back(i, height[i] + rng.uniform(0.05, 1.0));
        EXPECT_EQ(triangulate(points), ears_in_order(points)) << k;
    }
}

}  // namespace
}  // namespace carom::render
