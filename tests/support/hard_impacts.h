// The impacts that broke the published code, H22 to H31 of tests/README.md, and the status that every march
// must return.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "carom/kernel/impact.h"

namespace carom::test {

enum class Expect {
    kComputed,        ///< kOk, finite, bounded
    kNotApproaching,  ///< unchanged, no event
    kBadState,        ///< unchanged, flagged
    kBadParameter,    ///< unchanged, flagged
};

struct HardImpact {
    std::string name;
    kernel::Ball ball1, ball2;
    kernel::ImpactParams params;
    int n;
    Expect expect;
};

/// Pool constants D; ball 1 at the origin, ball 2 at (0, 2R), so that y is the line of centres.
inline HardImpact plain_hard_impact(const std::string& name, double v_x, double v_n,
                                    Expect expect = Expect::kComputed) {
    HardImpact impact{};
    impact.name = name;
    impact.params = {0.028575, 0.170097, 0.2, 0.2, 0.05, 0.95};
    impact.ball2.r[1] = 2.0 * impact.params.R;
    impact.ball1.v[0] = v_x;
    impact.ball1.v[1] = v_n;
    impact.n = 1000;
    impact.expect = expect;
    return impact;
}

inline void roll(kernel::Ball& ball, double R) {
    ball.w[0] = -ball.v[1] / R;
    ball.w[1] = ball.v[0] / R;
}

inline std::vector<HardImpact> hard_impacts() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     inf = std::numeric_limits<double>::infinity();
    std::vector<HardImpact> list;
    const auto add = [&list](HardImpact impact) -> HardImpact& {
        list.push_back(impact);
        return list.back();
    };
    add(plain_hard_impact("H22 tangential touch", 1.0, 0.0, Expect::kNotApproaching));
    add(plain_hard_impact("H22 both at rest", 0.0, 0.0, Expect::kNotApproaching));
    add(plain_hard_impact("H23 separating", 0.3, -1.0, Expect::kNotApproaching));
    add(plain_hard_impact("H23 separating slowly", 0.0, -1e-12, Expect::kNotApproaching));
    for (int n : {1, 2, 3, 10, 40, 100}) {
        add(plain_hard_impact("H24 N = " + std::to_string(n) + " head on", 0.0, 1.0)).n = n;
        add(plain_hard_impact("H24 N = " + std::to_string(n) + " cut", 0.7, 1.0)).n = n;
    }
    for (int n : {0, -1, -1000000, std::numeric_limits<int>::min()})
        add(plain_hard_impact("H24 N = " + std::to_string(n), 0.1, 1.0, Expect::kBadParameter)).n = n;
    add(plain_hard_impact("zero slip: head-on stun", 0.0, 1.0));
    add(plain_hard_impact("H25 slip that nearly ends", 1e-4, 1.0));
    add(plain_hard_impact("H25 slip of one ulp", 2.3e-16, 1.0));
    add(plain_hard_impact("H26 slip below the cutoff", 0.9e-16, 1.0));
    for (double scale : {1e-17, 1e-100, 1e-140}) {
        HardImpact& tiny = add(plain_hard_impact("H26 all speeds tiny", 0.7 * scale, scale));
        tiny.ball1.w[0] = 20.0 * scale;
    }
    {  // H27: the cloth slip of both balls is zero at the start
        HardImpact& rolling = add(plain_hard_impact("H27 rolling into a resting ball", 0.4, 1.0));
        roll(rolling.ball1, rolling.params.R);
        HardImpact& head_on = add(plain_hard_impact("H27 rolling head on", 0.0, 1.0));
        roll(head_on.ball1, head_on.params.R);
        HardImpact& both = add(plain_hard_impact("H27 both rolling", 0.4, 1.0));
        both.ball2.v[0] = 0.2;
        both.ball2.v[1] = -0.3;
        roll(both.ball1, both.params.R);
        roll(both.ball2, both.params.R);
        HardImpact& chase = add(plain_hard_impact("H27 both rolling along the line of centres", 0.0, 1.0));
        chase.ball2.v[1] = 0.5;
        roll(chase.ball1, chase.params.R);
        roll(chase.ball2, chase.params.R);
        HardImpact& draw = add(plain_hard_impact("straight draw", 0.0, 1.0));
        draw.ball1.w[0] = 30.0;
        HardImpact& side = add(plain_hard_impact("only side spin", 0.0, 1.0));
        side.ball1.w[2] = 40.0;
        HardImpact& flip = add(plain_hard_impact("vertical slip next to nothing", 0.3, 1.0));
        flip.ball1.w[0] = 1e-15;
        HardImpact& opposite = add(plain_hard_impact("vertical slip that cancels", 0.3, 1.0));
        opposite.ball1.w[0] = 35.0;
        opposite.ball2.w[0] = -35.0;
    }
    {
        HardImpact& spin =
            add(plain_hard_impact("H28 spin in place, touching", 0.0, 0.0, Expect::kNotApproaching));
        spin.ball1.w[2] = 100.0;
    }
    for (double w : {1000.0, 3000.0}) {
        HardImpact& fast = add(plain_hard_impact("H29 40 m/s, strong spin", 20.0, 40.0));
        fast.ball1.w[0] = w;
        fast.ball1.w[1] = -w;
        fast.ball1.w[2] = w;
        fast.ball2.w[0] = -0.5 * w;
        HardImpact& spin = add(plain_hard_impact("H29 slow, strong spin", 0.0, 1e-3));
        spin.ball1.w[0] = w;
        spin.ball1.w[2] = w;
    }
    {
        HardImpact& rolling = add(plain_hard_impact("H29 40 m/s rolling head on", 0.0, 40.0));
        roll(rolling.ball1, rolling.params.R);
    }
    add(plain_hard_impact("H30 approach 1e-160", 0.0, 1e-160, Expect::kNotApproaching));
    add(plain_hard_impact("H30 approach 1e-310", 1e-310, 1e-310, Expect::kNotApproaching));
    add(plain_hard_impact("H30 approach below 1e-150 of the speed", 1e10, 1e-145, Expect::kNotApproaching));
    add(plain_hard_impact("H30 glancing at 1e-9 of the speed", 1.0, 1e-9));
    for (double e : {0.0, 1.0}) {
        for (double mu : {0.0, 0.05, 1.0}) {
            for (double mu_s : {0.0, 0.2, 1.0}) {
                HardImpact& limit =
                    add(plain_hard_impact("H31 e = " + std::to_string(e) + ", mu_b = " + std::to_string(mu) +
                                              ", mu_s = " + std::to_string(mu_s),
                                          0.4, 1.0));
                limit.params.e_b = e;
                limit.params.mu_b = mu;
                limit.params.mu_s1 = limit.params.mu_s2 = mu_s;
                limit.ball1.w[0] = -10.0;
            }
        }
    }
    for (double bad : {nan, inf, -inf}) {
        for (int k = 0; k < 3; ++k) {
            add(plain_hard_impact("not finite: r", 0.1, 1.0, Expect::kBadState)).ball1.r[k] = bad;
            add(plain_hard_impact("not finite: v", 0.1, 1.0, Expect::kBadState)).ball1.v[k] = bad;
            add(plain_hard_impact("not finite: w", 0.1, 1.0, Expect::kBadState)).ball2.w[k] = bad;
        }
        add(plain_hard_impact("not finite: R", 0.1, 1.0, Expect::kBadParameter)).params.R = bad;
        add(plain_hard_impact("not finite: m", 0.1, 1.0, Expect::kBadParameter)).params.m = bad;
        add(plain_hard_impact("not finite: mu_s1", 0.1, 1.0, Expect::kBadParameter)).params.mu_s1 = bad;
        add(plain_hard_impact("not finite: mu_s2", 0.1, 1.0, Expect::kBadParameter)).params.mu_s2 = bad;
        add(plain_hard_impact("not finite: mu_b", 0.1, 1.0, Expect::kBadParameter)).params.mu_b = bad;
        add(plain_hard_impact("not finite: e_b", 0.1, 1.0, Expect::kBadParameter)).params.e_b = bad;
    }
    add(plain_hard_impact("R = 0", 0.1, 1.0, Expect::kBadParameter)).params.R = 0.0;
    add(plain_hard_impact("m < 0", 0.1, 1.0, Expect::kBadParameter)).params.m = -1.0;
    add(plain_hard_impact("mu_b < 0", 0.1, 1.0, Expect::kBadParameter)).params.mu_b = -0.1;
    add(plain_hard_impact("e_b > 1", 0.1, 1.0, Expect::kBadParameter)).params.e_b = 1.5;
    add(plain_hard_impact("coincident centres", 0.1, 1.0, Expect::kBadState)).ball2.r[1] = 0.0;
    {
        HardImpact& stacked = add(plain_hard_impact("centres above each other", 0.1, 1.0, Expect::kBadState));
        stacked.ball2.r[1] = 0.0;
        stacked.ball2.r[2] = 2.0 * stacked.params.R;
        HardImpact& lifted =
            add(plain_hard_impact("centres at different heights", 0.1, 1.0, Expect::kBadState));
        lifted.ball2.r[2] = lifted.params.R;
    }
    add(plain_hard_impact("overflowing speed", 1e200, 1e200, Expect::kBadState));
    return list;
}

}  // namespace carom::test
