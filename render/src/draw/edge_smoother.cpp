#include "draw/edge_smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "draw/mean_picture.h"

namespace carom::render {

namespace {

// Integral of clamp(z, 0, 1).
float integral(float z) {
    if (z <= 0.0F) return 0.0F;
    return z < 1.0F ? 0.5F * z * z : z - 0.5F;
}

// Mean of clamp(z, 0, 1) over the values that are within `half` of z.
float mean_clamped(float z, float half) {
    if (half < 1e-4F) return std::clamp(z, 0.0F, 1.0F);
    return (integral(z + half) - integral(z - half)) / (2.0F * half);
}

struct Clip {
    float x, y, w;
};

float determinant(const Clip& a, const Clip& b, const Clip& c) {
    return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

class Smoother {
  public:
    Smoother(Image& image, const View& view, const std::vector<PixelBox>& skip)
        : image_(image), view_(view), skip_(skip) {}

    void look_at(const TableEdge& edge) {
        Clip a = project(edge.a), b = project(edge.b);
        const float near = view_.planes[0];
        if (std::max(a.w, b.w) <= near) return;
        // The faces on each side of the edge, as seen: below[0] for the left-hand side of the direction from
        // a to b.
        faces_ = {};
        for (const TableEdge::Side& side : edge.sides) {
            if (side.face == 0) continue;
            auto& seen = faces_[determinant(a, b, project(side.corner)) > 0.0F ? 1 : 0];
            (seen[0] == 0 ? seen[0] : seen[1]) = side.face;
        }
        // A curved surface that continues across the edge does not end there.
        if (edge.smooth && faces_[0][0] != 0 && faces_[1][0] != 0) return;
        if (a.w < near) a = toward(a, b, near);
        if (b.w < near) b = toward(b, a, near);
        const float width = static_cast<float>(image_.size.width),
                    height = static_cast<float>(image_.size.height);
        const float ax = (0.5F + 0.5F * a.x / a.w) * width, ay = (0.5F + 0.5F * a.y / a.w) * height;
        const float bx = (0.5F + 0.5F * b.x / b.w) * width, by = (0.5F + 0.5F * b.y / b.w) * height;
        if (std::abs(bx - ax) >= std::abs(by - ay))
            walk({ax, ay, bx, by, image_.size.width, image_.size.height, 1, image_.size.width, false});
        else
            walk({ay, ax, by, bx, image_.size.height, image_.size.width, image_.size.width, 1, true});
    }

    void apply() {
        const auto& linear = radiance_of_screen();
        for (const Fix& fix : fixes_) {
            std::uint8_t* pixel = image_.rgbx.data() + 4 * fix.pixel;
            for (std::size_t k = 0; k < 3; ++k) {
                const float here = linear[pixel[k]], there = linear[fix.other[k]];
                pixel[k] = screen_of_radiance(here + fix.share * (there - here));
            }
        }
    }

  private:
    // A pixel that gets a share of another colour.
    struct Fix {
        std::size_t pixel;
        std::array<std::uint8_t, 3> other;
        float share;
    };

    // A line in the picture that advances by more in u than in v; u and v are x and y, or y and x.
    struct Line {
        float u0, v0, u1, v1;
        int u_size, v_size, u_step, v_step;  // extent [pixels], and pixels from one to the next in memory
        bool swapped;
    };

    Clip project(const std::array<float, 3>& p) const {
        const float* m = view_.view_projection;
        const auto row = [&](int i) { return m[i] * p[0] + m[i + 4] * p[1] + m[i + 8] * p[2] + m[i + 12]; };
        return {row(0), row(1), row(3)};
    }

    static Clip toward(const Clip& behind, const Clip& front, float near) {
        const float share = (near - behind.w) / (front.w - behind.w);
        return {behind.x + share * (front.x - behind.x), behind.y + share * (front.y - behind.y), near};
    }

    void walk(Line line) {
        // Exchanging u and v, or the two ends, exchanges the sides of the line.
        bool exchanged = line.swapped;
        if (line.u1 < line.u0) {
            std::swap(line.u0, line.u1);
            std::swap(line.v0, line.v1);
            exchanged = !exchanged;
        }
        const std::array<std::uint8_t, 2>&before = faces_[exchanged ? 1 : 0],
                                       &beyond = faces_[exchanged ? 0 : 1];
        const float slope = line.u1 > line.u0 ? (line.v1 - line.v0) / (line.u1 - line.u0) : 0.0F;
        const float half = 0.5F * std::abs(slope);
        const int first = static_cast<int>(std::ceil(std::clamp(line.u0 - 0.5F, 0.0F, 1e6F)));
        const int last =
            std::min(static_cast<int>(std::ceil(std::clamp(line.u1 - 0.5F, 0.0F, 1e6F))), line.u_size);
        for (int u = first; u < last; ++u) {
            const float v = line.v0 + slope * (static_cast<float>(u) + 0.5F - line.u0);
            if (!(v > -1.0F && v < static_cast<float>(line.v_size) + 1.0F)) continue;
            // The last pixel with its centre before the line, and the first one with its centre beyond.
            const int j = static_cast<int>(std::floor(v - 0.5F));
            if (j < 0 || j + 1 >= line.v_size) continue;
            const std::size_t at = index(line, u, j), next = index(line, u, j + 1);
            const std::uint8_t a = image_.rgbx[4 * at + 3], b = image_.rgbx[4 * next + 3];
            if (a == b || !(is_one_of(a, before) || is_one_of(b, beyond))) continue;
            for (int k = static_cast<int>(std::floor(v - half)); k <= static_cast<int>(std::floor(v + half));
                 ++k) {
                if (k < 0 || k >= line.v_size) continue;
                const float share_beyond = mean_clamped(static_cast<float>(k + 1) - v, half);
                if (k <= j)
                    add(index(line, u, k), next, share_beyond);
                else
                    add(index(line, u, k), at, 1.0F - share_beyond);
            }
        }
    }

    static bool is_one_of(std::uint8_t face, const std::array<std::uint8_t, 2>& faces) {
        return face != 0 && (face == faces[0] || face == faces[1]);
    }

    static std::size_t index(const Line& line, int u, int v) {
        return static_cast<std::size_t>(u) * static_cast<std::size_t>(line.u_step) +
               static_cast<std::size_t>(v) * static_cast<std::size_t>(line.v_step);
    }

    void add(std::size_t pixel, std::size_t other, float share) {
        if (share < 1.0F / 256.0F) return;
        const int x = static_cast<int>(pixel % static_cast<std::size_t>(image_.size.width)),
                  y = static_cast<int>(pixel / static_cast<std::size_t>(image_.size.width));
        for (const PixelBox& box : skip_) {
            if (box.meets({x, y, x + 1, y + 1})) return;
        }
        const std::uint8_t* color = image_.rgbx.data() + 4 * other;
        fixes_.push_back({pixel, {color[0], color[1], color[2]}, share});
    }

    Image& image_;
    const View& view_;
    const std::vector<PixelBox>& skip_;
    std::array<std::array<std::uint8_t, 2>, 2> faces_{};  // of the current edge, on both sides
    std::vector<Fix> fixes_;
};

}  // namespace

void smooth_edges(Image& image, const std::vector<TableEdge>& edges, const View& view,
                  const std::vector<PixelBox>& skip) {
    Smoother smoother(image, view, skip);
    for (const TableEdge& edge : edges) smoother.look_at(edge);
    // All colours were taken from the picture as drawn, so that an edge does not spread along another one.
    smoother.apply();
}

}  // namespace carom::render
