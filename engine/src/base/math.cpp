#include "carom/engine/math.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace carom {
namespace {

/// A value as the unevaluated sum hi + lo, |lo| <= ulp(hi) / 2.
struct Sum {
    double hi, lo;
};

/// a + b as an exact sum (Knuth).
Sum two_sum(double a, double b) {
    const double s = a + b;
    const double bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}

/// a * b as an exact sum (Dekker), for factors far from overflow.
Sum two_product(double a, double b) {
    constexpr double kSplit = 134217729.0;  // 2^27 + 1
    const double p = a * b;
    const double ta = kSplit * a;
    const double tb = kSplit * b;
    const double ah = ta - (ta - a), al = a - ah;
    const double bh = tb - (tb - b), bl = b - bh;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

/// Nearest integer, ties to even, for |x| < 2^51: the sum with kShift has no bits below 1.
double nearest(double x) {
    constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
    return (x + kShift) - kShift;
}

/// Sine of r for |r| up to slightly above pi/4. Taylor series in Horner form; the first omitted term is
/// r^19/19! < 1e-19.
double sin_near_zero(Sum r) {
    const double z = r.hi * r.hi;
    double p = 1.0 / 355687428096000.0;  // 1/17!
    p = p * z - 1.0 / 1307674368000.0;   // 1/15!
    p = p * z + 1.0 / 6227020800.0;      // 1/13!
    p = p * z - 1.0 / 39916800.0;        // 1/11!
    p = p * z + 1.0 / 362880.0;          // 1/9!
    p = p * z - 1.0 / 5040.0;            // 1/7!
    p = p * z + 1.0 / 120.0;             // 1/5!
    p = p * z - 1.0 / 6.0;               // 1/3!
    // The low part is multiplied by the derivative, cos r = 1 - r^2/2 + ...
    return r.hi + (r.hi * z * p + r.lo * (1.0 - 0.5 * z));
}

/// Cosine of r on the same range; the first omitted term is r^20/20! < 1e-20.
double cos_near_zero(Sum r) {
    const double z = r.hi * r.hi;
    double p = -1.0 / 6402373705728000.0;  // 1/18!
    p = p * z + 1.0 / 20922789888000.0;    // 1/16!
    p = p * z - 1.0 / 87178291200.0;       // 1/14!
    p = p * z + 1.0 / 479001600.0;         // 1/12!
    p = p * z - 1.0 / 3628800.0;           // 1/10!
    p = p * z + 1.0 / 40320.0;             // 1/8!
    p = p * z - 1.0 / 720.0;               // 1/6!
    p = p * z + 1.0 / 24.0;                // 1/4!
    // 1 - z/2 loses bits; the lost part and the rounding of z are added with the other terms.
    const Sum square = two_product(r.hi, r.hi);
    const double half = 0.5 * square.hi;
    const double top = 1.0 - half;
    const double lost = (1.0 - top) - half;
    return top + (lost + (z * z * p - 0.5 * square.lo - r.hi * r.lo));
}

/// Rotates the reduced angle by whole quadrants. Adding 0 changes -0 to +0.
SinCos in_quadrant(Sum r, int quadrant) {
    const double s = sin_near_zero(r);
    const double c = cos_near_zero(r);
    switch (quadrant & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s + 0.0};
        case 2:
            return {-s + 0.0, -c};
        default:
            return {-c, s + 0.0};
    }
}

constexpr SinCos kUndefined{std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::quiet_NaN()};

/// Remainder of x >= 0 by 360, exact because each subtraction is exact (Sterbenz). Angles in files are
/// usually small; the loops handle all others.
double remainder_360(double x) {
    while (x >= 360.0) {
        double part = 360.0;
        while (part <= 0.5 * x) part *= 2.0;
        x -= part;
    }
    return x;
}

}  // namespace

SinCos sin_cos(double radians) {
    constexpr double kLimit = 1125899906842624.0;  // 2^50
    if (!(radians > -kLimit && radians < kLimit)) return kUndefined;
    // pi/2 in four parts; the first three have 33 bits, so that k times a part is exact for |k| < 2^20.
    constexpr double kPart1 = 0x1.921fb544p+0;
    constexpr double kPart2 = 0x1.0b4611a6p-34;
    constexpr double kPart3 = 0x1.3198a2e0p-69;
    constexpr double kPart4 = 0x1.b839a252049c1p-104;
    constexpr double kQuadrantsPerRadian = 0x1.45f306dc9c883p-1;  // 2 / pi
    const double k = nearest(radians * kQuadrantsPerRadian);
    const double first = radians - k * kPart1;  // exact: both have the same leading bits
    const Sum second = two_sum(first, -k * kPart2);
    const Sum third = two_sum(second.hi, -k * kPart3);
    const Sum r = two_sum(third.hi, third.lo + second.lo - k * kPart4);
    return in_quadrant(r, static_cast<int>(static_cast<std::int64_t>(k) & 3));
}

SinCos sin_cos_deg(double degrees) {
    if (!(degrees - degrees == 0.0)) return kUndefined;
    const bool negative = degrees < 0.0;
    const double turn = remainder_360(negative ? -degrees : degrees);
    const double k = nearest(turn / 90.0);
    const double rest = turn - 90.0 * k;  // in [-45, 45], exact (Sterbenz)
    // pi/180 in two parts.
    constexpr double kRadiansHigh = 0x1.1df46a2529d39p-6;
    constexpr double kRadiansLow = 0x1.5c1d8becdd291p-62;
    const Sum product = two_product(rest, kRadiansHigh);
    const SinCos a = in_quadrant(two_sum(product.hi, product.lo + rest * kRadiansLow), static_cast<int>(k));
    return {negative ? -a.sin + 0.0 : a.sin, a.cos};
}

double tan_deg(double degrees) {
    const SinCos a = sin_cos_deg(degrees);
    return a.sin / a.cos;
}

double arc_cos(double x) {
    constexpr double kPi = 3.141592653589793;
    if (!(x >= -1.0 && x <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
    if (x < 0.0) return kPi - arc_cos(-x);
    // Half the angle, y in [0, pi/4], from sin y = sqrt((1 - x) / 2) by Newton's method. The arc sine series
    // gives a start value with an error below 6e-3, and every step squares the error.
    const double s = __builtin_sqrt(0.5 * (1.0 - x));
    const double z = s * s;
    double y = s * (1.0 + z * (1.0 / 6.0 + z * (3.0 / 40.0)));
    for (int i = 0; i < 3; ++i) {
        const SinCos at = sin_cos(y);
        y -= (at.sin - s) / at.cos;
    }
    return 2.0 * y;
}

double direction_deg(double x, double y) {
    const double size = __builtin_sqrt(x * x + y * y);
    if (!(size > 0.0)) return size;
    // The smaller of cosine and sine determines the angle: there the arc cosine is as accurate as its
    // argument. Below 1e-154 squares lose digits, and a quotient may exceed 1.
    const double cosine = std::clamp(x / size, -1.0, 1.0), sine = std::clamp(y / size, -1.0, 1.0);
    if (std::abs(x) <= std::abs(y)) return std::copysign(arc_cos(cosine) * kDegrees, y);
    const double off = 90.0 - arc_cos(sine) * kDegrees;
    return x > 0.0 ? off : std::copysign(180.0, y) - off;
}

double exponential(double x) {
    if (x != x) return x;
    if (x > 709.8) return std::numeric_limits<double>::infinity();
    if (x < -745.2) return 0.0;
    // e^x = 2^k e^r with |r| <= ln 2 / 2. ln 2 is split in two parts, so that k ln 2 is exact except for the
    // last bits.
    constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
    const double k = nearest(x * 1.4426950408889634);
    const double high = x - k * kLn2High, low = k * kLn2Low;
    const double r = high - low;
    // Taylor series; the first omitted term is r^14/14! < 5e-18.
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    const double tail = (high - r) - low;  // the rounding error of r
    const double value = 1.0 + (r + (r * r * p + tail));
    // 2^k as two factors: the result may be representable (perhaps as subnormal) even if 2^k is not.
    const auto power = [](int n) {
        const std::uint64_t bits = static_cast<std::uint64_t>(n + 1023) << 52;
        double out;
        __builtin_memcpy(&out, &bits, sizeof out);
        return out;
    };
    const int n = static_cast<int>(k), half = n / 2;
    return value * power(half) * power(n - half);
}

}  // namespace carom
