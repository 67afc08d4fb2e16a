#include "contact/roots.h"

#include <cmath>
#include <utility>

namespace carom {

namespace {

// A quartic on the unit interval; b[k] is the coefficient of s^k.
double value(const double (&b)[5], double s) {
    return b[0] + s * (b[1] + s * (b[2] + s * (b[3] + s * b[4])));
}
double slope(const double (&b)[5], double s) {
    return b[1] + s * (2.0 * b[2] + s * (3.0 * b[3] + s * (4.0 * b[4])));
}
double curvature(const double (&b)[5], double s) {
    return 2.0 * b[2] + s * (6.0 * b[3] + s * (12.0 * b[4]));
}

// The sign change of g in [lo, hi]: Newton steps inside the bracket; bisection if a step would leave it or
// exceeds half of the last one. The caller refines the result with the distance itself.
template <class G, class D>
double bracketed_root(G g, D dg, double lo, double hi, bool positive_at_lo) {
    double s = 0.5 * (lo + hi);
    double last_step = hi - lo;
    for (int i = 0; i < 200; ++i) {
        const double y = g(s);
        if (y == 0.0) return s;
        if ((y > 0.0) == positive_at_lo)
            lo = s;
        else
            hi = s;
        double next = s - y / dg(s);
        if (!(next > lo && next < hi) || std::abs(next - s) > 0.5 * last_step) next = lo + 0.5 * (hi - lo);
        last_step = std::abs(next - s);
        s = next;
        if (last_step <= 1e-16 * s || s <= lo || s >= hi) break;
    }
    return s;
}

// Roots in (0, 1) of c0 + c1 s + c2 s^2, in order.
int unit_roots(double c0, double c1, double c2, double (&roots)[2]) {
    double candidates[2];
    int found = 0;
    if (c2 == 0.0) {
        if (c1 != 0.0) candidates[found++] = -c0 / c1;
    } else {
        const double discriminant = c1 * c1 - 4.0 * c2 * c0;
        if (discriminant <= 0.0) return 0;  // no sign change
        const double q = -0.5 * (c1 + (c1 < 0.0 ? -1.0 : 1.0) * std::sqrt(discriminant));
        candidates[found++] = q / c2;
        if (q != 0.0) candidates[found++] = c0 / q;
        if (found == 2 && candidates[1] < candidates[0]) std::swap(candidates[0], candidates[1]);
    }
    int inside = 0;
    for (int i = 0; i < found; ++i) {
        if (candidates[i] > 0.0 && candidates[i] < 1.0) roots[inside++] = candidates[i];
    }
    return inside;
}

void to_unit(const double (&c)[5], double T, double (&b)[5]) {
    double power = 1.0;
    for (int k = 0; k < 5; ++k) {
        b[k] = c[k] * power;
        power *= T;
    }
}

// Calls visit(s, is_maximum) for every extremum in (0, 1), in order, until it returns true.
template <class Visit>
bool each_extremum(const double (&b)[5], const Visit& visit) {
    double bends[2];
    const int bend_count = unit_roots(2.0 * b[2], 6.0 * b[3], 12.0 * b[4], bends);
    double left = 0.0, slope_left = b[1];
    for (int i = 0; i <= bend_count; ++i) {
        const double right = i < bend_count ? bends[i] : 1.0;
        const double slope_right = slope(b, right);
        if ((slope_left > 0.0 && slope_right < 0.0) || (slope_left < 0.0 && slope_right > 0.0)) {
            const double extremum =
                bracketed_root([&b](double s) { return slope(b, s); },
                               [&b](double s) { return curvature(b, s); }, left, right, slope_left > 0.0);
            if (visit(extremum, slope_left > 0.0)) return true;
        }
        left = right;
        if (slope_right != 0.0) slope_left = slope_right;
    }
    return false;
}

// Follows f over its monotone pieces, which end at its critical points, to the first descent.
class Descent {
  public:
    explicit Descent(const double (&b)[5]) : b_(b), above_(b[0] > 0.0) {}

    // Advances to the next end of a monotone piece; true if the result has been found.
    bool piece(double end, bool is_maximum) {
        const double y = value(b_, end);
        if (above_ && !(y > 0.0)) {
            found_ = bracketed_root([this](double s) { return value(b_, s); },
                                    [this](double s) { return slope(b_, s); }, at_, end, true);
            return true;
        }
        if (!above_ && is_maximum && !(y > 0.0)) {  // in contact since the start and now closing
            found_ = end;
            return true;
        }
        above_ = y > 0.0;
        at_ = end;
        return false;
    }
    double found() const { return found_; }

  private:
    const double (&b_)[5];
    bool above_;
    double at_ = 0.0;
    double found_ = kNever;
};

}  // namespace

double first_descent(const double (&c)[5], double T) {
    if (!(T > 0.0)) return kNever;
    double b[5];
    to_unit(c, T, b);
    if (b[0] > 0.0) {
        // If f never decreases, or all Bernstein coefficients are positive, there is no root on [0, 1].
        if (b[1] >= 0.0 && b[2] >= 0.0 && b[3] >= 0.0 && b[4] >= 0.0) return kNever;
        const double b1 = b[0] + b[1] / 4.0, b2 = b[0] + b[1] / 2.0 + b[2] / 6.0;
        const double b3 = b[0] + 0.75 * b[1] + 0.5 * b[2] + 0.25 * b[3],
                     b4 = b[0] + b[1] + b[2] + b[3] + b[4];
        if (b1 > 0.0 && b2 > 0.0 && b3 > 0.0 && b4 > 0.0) return kNever;
    }
    Descent descent(b);
    if (each_extremum(b, [&](double s, bool is_maximum) { return descent.piece(s, is_maximum); }))
        return descent.found() * T;
    if (descent.piece(1.0, false)) return descent.found() * T;
    return kNever;
}

int extrema(const double (&c)[5], double T, double (&times)[3]) {
    double b[5];
    to_unit(c, T, b);
    int count = 0;
    each_extremum(b, [&](double s, bool) {
        times[count++] = s * T;
        return false;
    });
    return count;
}

double first_descent_quadratic(double h0, double h1, double h2, double T) {
    const double discriminant = h1 * h1 - 2.0 * h2 * h0;
    double t = kNever;
    if (h1 < 0.0) {
        if (discriminant >= 0.0 && h0 > 0.0) t = 2.0 * h0 / (-h1 + std::sqrt(discriminant));
    } else if (h2 < 0.0) {
        if (discriminant > 0.0) t = (h1 + std::sqrt(discriminant)) / -h2;  // rises first
    }
    return t <= T ? t : kNever;
}

}  // namespace carom
