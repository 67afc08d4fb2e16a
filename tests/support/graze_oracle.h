// The time when two balls meet, by a derivative cascade in __float128 independent of the engine's: the roots
// of f'' split f', those of f' split f; each piece is bisected to 2^-110 of the horizon.
#pragma once

#include <array>
#include <vector>

#include "carom/engine/vec.h"

namespace carom::test {

#if __LDBL_MANT_DIG__ == 113
typedef long double Quad;  // aarch64 has it by this name only
#else
__extension__ typedef __float128 Quad;
#endif

struct FirstMeeting {
    bool hit = false;
    double time = 0.0;
    double depth = 0.0;  ///< m: how far within reach the centres get before the horizon (from the distance;
                         ///< negative: the gap left)
};

class GrazeOracle {
  public:
    /// Relative motion r + v t + a t^2 / 2 with all inputs exact doubles.
    GrazeOracle(const Vec2& r1, const Vec2& v1, const Vec2& a1, const Vec2& r2, const Vec2& v2,
                const Vec2& a2, double reach, double horizon)
        : reach_(reach), T_(horizon) {
        const Quad rx = Quad(r2.x()) - Quad(r1.x()), ry = Quad(r2.y()) - Quad(r1.y());
        const Quad vx = Quad(v2.x()) - Quad(v1.x()), vy = Quad(v2.y()) - Quad(v1.y());
        const Quad ax = Quad(a2.x()) - Quad(a1.x()), ay = Quad(a2.y()) - Quad(a1.y());
        f_ = {rx * rx + ry * ry - reach_ * reach_, 2 * (rx * vx + ry * vy),
              vx * vx + vy * vy + rx * ax + ry * ay, vx * ax + vy * ay, (ax * ax + ay * ay) / 4};
    }

    FirstMeeting meet() const {
        const Poly d1 = derivative(f_), d2 = derivative(d1), d3 = derivative(d2);
        std::vector<Quad> cuts = roots(d3, {});
        cuts = roots(d2, cuts);
        cuts = roots(d1, cuts);
        FirstMeeting result;
        Quad least = value(f_, 0), from = 0;
        cuts.push_back(T_);
        for (const Quad& to : cuts) {
            const Quad y = value(f_, to);
            if (y < least) least = y;
            if (!result.hit && y <= 0 && value(f_, from) > 0) {
                result.hit = true;
                result.time = static_cast<double>(bisect(f_, from, to));
            }
            from = to;
        }
        // f = (d - reach)(d + reach)
        result.depth = static_cast<double>(-least / (2 * reach_));
        return result;
    }

  private:
    using Poly = std::array<Quad, 5>;
    static Quad value(const Poly& p, const Quad& t) {
        return p[0] + t * (p[1] + t * (p[2] + t * (p[3] + t * p[4])));
    }
    static Poly derivative(const Poly& p) { return {p[1], 2 * p[2], 3 * p[3], 4 * p[4], 0}; }
    static Quad bisect(const Poly& p, Quad lo, Quad hi) {
        const bool positive = value(p, lo) > 0;
        for (int i = 0; i < 110; ++i) {
            const Quad middle = (lo + hi) / 2;
            ((value(p, middle) > 0) == positive ? lo : hi) = middle;
        }
        return hi;
    }
    std::vector<Quad> roots(const Poly& p, std::vector<Quad> cuts) const {
        std::vector<Quad> found;
        cuts.push_back(T_);
        Quad from = 0;
        for (const Quad& to : cuts) {
            if ((value(p, from) > 0) != (value(p, to) > 0)) found.push_back(bisect(p, from, to));
            from = to;
        }
        return found;
    }

    Quad reach_, T_;
    Poly f_;
};

}  // namespace carom::test
