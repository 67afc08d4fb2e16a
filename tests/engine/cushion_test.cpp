// Cushion models against reference vectors and exact statements.
#include "carom/engine/cushion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "physics/cushion/mathavan_laws.h"

#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

const auto kCushionModels = all_of(&kHan2005);

struct Case {
    CushionContact contact;
    Vec2 normal;
    Vec3 v, w;
};

Case case_from(const nlohmann::json& c) {
    const auto& p = c.at("params");
    const auto get = [&p](const char* key) { return p.at(key).get<double>(); };
    return {
        {get("R"), get("m"), get("u_s"), get("e_c"), get("f_c"), c.at("cushion").at("height").get<double>()},
        Vec2(c.at("normal_into_table").at(0).get<double>(), c.at("normal_into_table").at(1).get<double>()),
        vec3(c.at("in").at("v")),
        vec3(c.at("in").at("w"))};
}

// The largest difference of v and R w from the reference, and the number of cases.
struct Worst {
    double off = 0.0;
    int id = -1, checked = 0;
};

template <class Skip>
Worst compare(const CushionModelInfo* model, const char* key, Skip skip) {
    Worst worst;
    const auto data = read_json("cushion.json");
    for (const auto& c : data.at("cases")) {
        Case x = case_from(c);
        if (skip(x.contact)) continue;
        // For jaws, the reference derives the inclined normal of these two models from the jaw's centre
        // instead of its nose.
        const bool from_nose = model == cushion_model("impulse") || model == cushion_model("stronge");
        if (from_nose && c.at("cushion").at("type") == "circular") {
            const double R = x.contact.R;
            x.contact.height =
                R + (x.contact.height - R) * R / (R + c.at("cushion").at("radius").get<double>());
        }
        model->resolve(x.contact, x.normal, x.v, x.w);
        const auto& out = c.at("out").at(key);
        const double off = std::max((x.v - vec3(out.at("v"))).cwiseAbs().maxCoeff(),
                                    x.contact.R * (x.w - vec3(out.at("w"))).cwiseAbs().maxCoeff());
        if (!(off <= worst.off)) worst = {off, c.at("id").get<int>(), worst.checked};
        ++worst.checked;
    }
    std::printf("%s: worst %.2g (case %d of %d)\n", key, worst.off, worst.id, worst.checked);
    return worst;
}

TEST(Cushion, ReferenceVectorsOfTheClosedForms) {
    const auto none = [](const CushionContact&) { return false; };
    const Worst han = compare(&kHan2005, "han_2005", none);
    EXPECT_LE(han.off, 1e-9 * 0.028575) << "case " << han.id;  // 1e-9 rad/s in w
    EXPECT_EQ(han.checked, 40);
    const Worst impulse = compare(cushion_model("impulse"), "impulse_frictional_inelastic", none);
    EXPECT_LE(impulse.off, 1e-9 * 0.028575) << "case " << impulse.id;
    EXPECT_EQ(impulse.checked, 40);
}

TEST(Cushion, ReferenceVectorsOfStronge) {
    const Worst worst =
        compare(cushion_model("stronge"), "stronge_compliant", [](const CushionContact&) { return false; });
    EXPECT_LE(worst.off, 1e-6) << "case " << worst.id;
    EXPECT_EQ(worst.checked, 40);
}

// If f_c > tan(theta), the reference does not clamp the cloth's load and lets the cloth pull, so those cases
// are excluded.
TEST(Cushion, ReferenceVectorsOfMathavan2010) {
    const Worst worst =
        compare(cushion_model("mathavan_2010"), "mathavan_2010_fine", [](const CushionContact& p) {
            const double s = (p.height - p.R) / p.R;
            return p.f_c > s / std::sqrt(1.0 - s * s);
        });
    EXPECT_LE(worst.off, 2e-4) << "case " << worst.id;
    EXPECT_GE(worst.checked, 28);
}

TEST(Cushion, SmoothReversesTheNormalVelocityOnly) {  // T17
    const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.0365};
    const Vec2 normal(0.6, 0.8);
    Vec3 v(-1.2, -0.4, 0.0), w(10.0, -20.0, 30.0);
    const double v_n = normal.x() * v.x() + normal.y() * v.y(),
                 v_t = -normal.y() * v.x() + normal.x() * v.y();
    kSmooth.resolve(contact, normal, v, w);
    EXPECT_NEAR(normal.x() * v.x() + normal.y() * v.y(), -0.85 * v_n, 1e-15);
    EXPECT_NEAR(-normal.y() * v.x() + normal.x() * v.y(), v_t, 1e-15);
    EXPECT_EQ(w, Vec3(10.0, -20.0, 30.0));
}

TEST(Cushion, ARecedingBallIsLeftAlone) {
    const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.0365};
    for (const CushionModelInfo* model : kCushionModels) {
        for (const double v_x : {1.0, 0.0}) {
            Vec3 v(v_x, 0.3, 0.0), w(1.0, 2.0, 3.0);
            model->resolve(contact, Vec2(1.0, 0.0), v, w);
            EXPECT_EQ(v, Vec3(v_x, 0.3, 0.0)) << name(model);
            EXPECT_EQ(w, Vec3(1.0, 2.0, 3.0)) << name(model);
        }
    }
}

double energy(const CushionContact& p, const Vec3& v, const Vec3& w) {
    return 0.5 * v.squaredNorm() + 0.2 * p.R * p.R * w.squaredNorm();
}

// Random impacts: sliding, rolling (no slip at the cloth), straight in, hardly approaching.
Case random_case(reference::Generator& rng, int kind) {
    Case x;
    const double R = 0.028575;
    x.contact = {R,
                 0.17,
                 rng.uniform(0.0, 0.4),
                 rng.uniform(0.3, 1.0),
                 rng.uniform(0.0, 0.35),
                 R * rng.uniform(1.0, 1.42)};
    x.normal = Vec2(1.0, 0.0);
    const double speed = rng.uniform(0.05, 6.0), angle = kind == 2 ? 0.0 : rng.uniform(-1.5, 1.5);
    x.v = Vec3(-speed * std::cos(angle), speed * std::sin(angle), 0.0);
    if (kind == 3) x.v.x() *= 1e-6;
    x.w = Vec3{rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0)};
    if (kind == 1 || kind == 2) x.w = Vec3(-x.v.y() / R, x.v.x() / R, kind == 1 ? x.w.z() : 0.0);
    return x;
}

TEST(Cushion, EnergyFallsTheBallLeavesAndMirrorsAgree) {
    reference::Generator rng(7);
    for (int i = 0; i < 4000; ++i) {
        const Case x = random_case(rng, i % 4);
        for (const CushionModelInfo* model : kCushionModels) {
            Vec3 v = x.v, w = x.w;
            model->resolve(x.contact, x.normal, v, w);
            SCOPED_TRACE(std::string(name(model)) + " " + std::to_string(i));
            ASSERT_TRUE(v.allFinite() && w.allFinite());
            EXPECT_LE(energy(x.contact, v, w), energy(x.contact, x.v, x.w) * (1.0 + 1e-13));
            // Han's restitution along the inclined normal ignores the speed that strong topspin adds; the
            // ball may keep moving into the cushion slightly.
            EXPECT_GE(v.x(), model == &kHan2005 ? -0.1 * x.v.norm() : 0.0);
            EXPECT_EQ(v.z(), 0.0);
            // Mirror in x: a polar vector's y changes sign, an axial vector's x and z.
            Vec3 vm(x.v.x(), -x.v.y(), 0.0), wm(-x.w.x(), x.w.y(), -x.w.z());
            model->resolve(x.contact, x.normal, vm, wm);
            EXPECT_EQ(vm, Vec3(v.x(), -v.y(), 0.0));
            EXPECT_EQ(wm, Vec3(-w.x(), w.y(), -w.z()));
        }
    }
}

// Doubling all velocities doubles the results: no model has a speed scale.
TEST(Cushion, EveryModelIsHomogeneous) {
    reference::Generator rng(8);
    for (int i = 0; i < 400; ++i) {
        const Case x = random_case(rng, i % 4);
        for (const CushionModelInfo* model : kCushionModels) {
            Vec3 v = x.v, w = x.w, v2 = 2.0 * x.v, w2 = 2.0 * x.w;
            model->resolve(x.contact, x.normal, v, w);
            model->resolve(x.contact, x.normal, v2, w2);
            EXPECT_EQ(v2, Vec3(2.0 * v)) << name(model) << " " << i;
            EXPECT_EQ(w2, Vec3(2.0 * w)) << name(model) << " " << i;
        }
    }
}

// Each model has one row, and a scene file can select it.
TEST(Cushion, TheTableHasEveryModelOnce) {
    EXPECT_GE(kCushionModels.size(), 5u);
    for (const CushionModelInfo* model : kCushionModels) {
        EXPECT_EQ(std::count(kCushionModels.begin(), kCushionModels.end(), model), 1);
        EXPECT_EQ(cushion_model(model->name), model);
        const std::string scene = std::string("[[ball]]\n[physics]\ncushion = \"") + name(model) + "\"\n";
        EXPECT_EQ(parse_scene(scene, "x").physics.cushion, model);
    }
}

// A model's result does not change with the cloth or height if the model does not read them.
TEST(Cushion, ResultsDependOnlyOnDeclaredParameters) {
    reference::Generator rng(9);
    for (const CushionModelInfo* model : kCushionModels) {
        const CushionModelInfo& info = *model;
        bool cloth = false, height = false, friction = false, spin = false;
        for (int i = 0; i < 200; ++i) {
            const Case x = random_case(rng, i % 3);
            const auto after = [&](const CushionContact& p, const Vec3& w0, Vec3& dw) {
                Vec3 v = x.v, w = w0;
                model->resolve(p, x.normal, v, w);
                dw = w - w0;
                return v;
            };
            Vec3 dw, dw_other;
            const Vec3 v = after(x.contact, x.w, dw);
            const auto differs = [&](const CushionContact& p, const Vec3& w0) {
                const Vec3 other = after(p, w0, dw_other);
                return other != v || dw_other != dw;
            };
            CushionContact p = x.contact;
            p.mu_s = p.mu_s + 0.1;
            cloth = cloth || differs(p, x.w);
            p = x.contact;
            p.height *= 0.99;
            height = height || differs(p, x.w);
            p = x.contact;
            p.f_c += 0.05;
            friction = friction || differs(p, x.w);
            spin = spin || differs(x.contact, Vec3(x.w + Vec3(5.0, -3.0, 8.0))) || dw != Vec3::Zero();
        }
        EXPECT_EQ(cloth, info.reads_cloth) << info.name;
        EXPECT_EQ(height, info.reads_friction) << info.name;
        EXPECT_EQ(friction, info.reads_friction) << info.name;
        EXPECT_EQ(spin, info.reads_friction) << info.name;
    }
}

// With the nose at ball height and no friction, every model reduces to the smooth one (T17), with its own
// meaning of e_c.
TEST(Cushion, WithoutFrictionAtBallHeightEveryModelReflects) {
    reference::Generator rng(10);
    for (int i = 0; i < 400; ++i) {
        Case x = random_case(rng, i % 4);
        x.contact.f_c = 0.0;
        x.contact.mu_s = 0.0;
        x.contact.height = x.contact.R;
        for (const CushionModelInfo* model : kCushionModels) {
            Vec3 v = x.v, w = x.w;
            model->resolve(x.contact, x.normal, v, w);
            EXPECT_NEAR(v.x(), -x.contact.e_c * x.v.x(), 1e-12 * x.v.norm()) << name(model) << " " << i;
            EXPECT_NEAR(v.y(), x.v.y(), 1e-12 * x.v.norm()) << name(model);
            EXPECT_LE((w - x.w).norm(), 1e-10 * x.w.norm()) << name(model);
        }
    }
}

// The closed forms then equal the smooth model bit for bit, for any nose direction.
TEST(Cushion, WithoutFrictionAtBallHeightTheClosedFormsAreSmoothBitForBit) {
    reference::Generator rng(14);
    for (int i = 0; i < 4000; ++i) {
        Case x = random_case(rng, i % 4);
        x.contact.f_c = 0.0;
        x.contact.height = x.contact.R;
        const double angle = rng.uniform(0.0, 6.2831853);
        x.normal = Vec2(std::cos(angle), std::sin(angle));
        const Vec2 v(x.v.x(), x.v.y());
        x.v = Vec3(v.x() * x.normal.x() - v.y() * x.normal.y(), v.x() * x.normal.y() + v.y() * x.normal.x(),
                   0.0);
        Vec3 v_s = x.v, w_s = x.w;
        kSmooth.resolve(x.contact, x.normal, v_s, w_s);
        for (const CushionModelInfo* model : kCushionModels) {
            if (!model->reflects_when_level) continue;
            Vec3 w = x.w, u = x.v;
            model->resolve(x.contact, x.normal, u, w);
            EXPECT_EQ(u, v_s) << name(model) << " " << i;
            EXPECT_EQ(w, w_s) << name(model) << " " << i;
        }
    }
}

// Signs for every model with friction (tests/README.md): running side widens the rebound, check side narrows
// it; topspin keeps a rolling ball from returning at e times its speed.
TEST(Cushion, RunningAndCheckSide) {
    for (const CushionModelInfo* model : kCushionModels) {
        if (!model->reads_friction) continue;
        const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.036576};
        const double R = contact.R, speed = 1.5;
        const auto rebound = [&](double side) {
            Vec3 v(-speed * std::sqrt(0.5), speed * std::sqrt(0.5), 0.0);
            Vec3 w(-v.y() / R, v.x() / R, side);
            model->resolve(contact, Vec2(1.0, 0.0), v, w);
            return v.y() / v.x();  // tangent of the angle from the normal
        };
        // At the nose the surface of a ball with w_z > 0 moves towards -y; the reaction drives the ball to
        // +y.
        EXPECT_GT(rebound(30.0), rebound(0.0) * 1.02) << name(model) << " running side";
        EXPECT_LT(rebound(-30.0), rebound(0.0) * 0.98) << name(model) << " check side";
        Vec3 v(-1.0, 0.0, 0.0), w(0.0, -1.0 / R, 0.0);
        model->resolve(contact, Vec2(1.0, 0.0), v, w);
        EXPECT_LT(v.x(), 0.85) << name(model);
        EXPECT_GT(v.x(), 0.3) << name(model);
        EXPECT_EQ(v.y(), 0.0) << name(model);
    }
}

// An independent integration of the 2010 equations: Euler steps as in the published code, ten times finer
// than its default. It agrees to its first-order error and converges towards ours.
TEST(Cushion, Mathavan2010IsTheLimitOfTheMarch) {
    const auto march = [](const Case& x, int n, Vec3& v, Vec3& w) {
        const CushionContact& p = x.contact;
        const double R = p.R, s = (p.height - R) / R, c = std::sqrt(1.0 - s * s);
        // Frame: y into the cushion (-x of the table), z up, x = y x z (+y of the table).
        double v_x = x.v.y(), v_y = -x.v.x(), w_x = x.w.y(), w_y = -x.w.x(), w_z = x.w.z();
        const double dP = v_y / n;
        double work = 0.0, target = 0.0;
        bool compressing = true;
        for (int k = 0; k < 100 * n && (compressing || work < target); ++k) {
            const double ix = v_x + R * w_y * s - R * w_z * c, iy = -v_y * s + R * w_x;
            const double cx = v_x - R * w_y, cy = v_y + R * w_x;
            const double i = std::hypot(ix, iy), cl = std::hypot(cx, cy);
            const double ci = i > 0 ? ix / i : 0.0, si = i > 0 ? iy / i : 0.0, cc = cl > 0 ? cx / cl : 0.0,
                         sc = cl > 0 ? cy / cl : 0.0;
            const double N = std::max(0.0, s + p.f_c * si * c), before = v_y;
            v_x -= dP * (p.f_c * ci + p.mu_s * cc * N);
            v_y -= dP * (c - p.f_c * s * si + p.mu_s * sc * N);
            w_x -= dP * 2.5 / R * (p.f_c * si + p.mu_s * sc * N);
            w_y -= dP * 2.5 / R * (p.f_c * ci * s - p.mu_s * cc * N);
            w_z += dP * 2.5 / R * p.f_c * ci * c;
            work += 0.5 * dP * std::abs(before + v_y);
            if (compressing && v_y <= 0.0) {
                compressing = false;
                target = p.e_c * p.e_c * work;
                work = 0.0;
            }
        }
        v = Vec3(-v_y, v_x, 0.0);
        w = Vec3(-w_y, w_x, w_z);
    };
    reference::Generator rng(11);
    for (int i = 0; i < 60; ++i) {
        Case x = random_case(rng, i % 3);
        // Beyond f = tan(theta) a stuck nose and a clamped cloth load have no common limit (data/README).
        const double s = x.contact.height / x.contact.R - 1.0;
        x.contact.f_c = std::min(x.contact.f_c, 0.95 * s);
        Vec3 v = x.v, w = x.w, v_c, w_c, v_f, w_f;
        cushion_model("mathavan_2010")->resolve(x.contact, x.normal, v, w);
        march(x, 2000, v_c, w_c);
        march(x, 200000, v_f, w_f);
        const double approach = -x.v.x();
        EXPECT_LE((v - v_c).norm() + 0.028575 * (w - w_c).norm(), 1e-2 * approach) << i;
        EXPECT_LE((v - v_f).norm() + 0.028575 * (w - w_f).norm(), 1e-4 * approach) << i;
    }
}

// Errors of the 2010 model at its tolerance, against the same impact solved ten thousand times finer, for
// impacts whose cloth load has a limit (as above). Every impact ends.
TEST(Cushion, Mathavan2010KeepsItsTolerance) {
    reference::Generator rng(12);
    std::vector<double> off;
    for (int i = 0; i < 20000; ++i) {
        Case x = random_case(rng, i % 4);
        const double s = x.contact.height / x.contact.R - 1.0;
        x.contact.f_c = std::min(x.contact.f_c, 0.95 * s);
        ASSERT_TRUE(cushion_model("mathavan_2010")->accepts(x.contact)) << i;
        Vec3 v = x.v, w = x.w, v_f = x.v, w_f = x.w;
        ASSERT_TRUE(cushion_model("mathavan_2010")->resolve(x.contact, x.normal, v, w)) << i;
        ASSERT_TRUE(detail::cushion_mathavan_2010_to(x.contact, x.normal, v_f, w_f, 1e-11)) << i;
        off.push_back(std::max((v - v_f).cwiseAbs().maxCoeff(), 0.028575 * (w - w_f).cwiseAbs().maxCoeff()) /
                      -x.v.x());
    }
    std::sort(off.begin(), off.end());
    // Half of these impacts are straight in or hardly approaching: constant forces, no error.
    std::printf("mathavan_2010: error of 75 %% below %.2g, 99 %% %.2g, 99.9 %% %.2g, worst %.2g\n",
                off[15000], off[19800], off[19980], off.back());
    EXPECT_LE(off[15000], 2e-8);
    EXPECT_LE(off[19800], 1e-6);
    EXPECT_LE(off.back(), 5e-5);
}

// One ball with spin around a snooker table: no other step depends on the tolerance.
TEST(Cushion, Mathavan2010FollowsTheTolerance) {
    reference::Generator rng(21);
    double coarse = 0.0, fine = 0.0;
    for (int k = 0; k < 20; ++k) {
        Scene scene = empty_scene();
        scene.balls = make_ball_params("snooker");
        scene.table = make_table("snooker");
        scene.table.pockets.clear();
        scene.physics.cushion = cushion_model("mathavan_2010");
        add_ball(scene, "cue", Vec3(0.8, 1.5, scene.balls.R),
                 Vec3(rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), 0.0),
                 Vec3(rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0)));
        scene.stop.events = 6;
        const auto end = [&](double tolerance) {
            scene.physics.tolerance = tolerance;
            const Record record = simulate(plan_of(scene));
            return record.tracks[0].segments.back().v;
        };
        const Vec3 truth = end(1e-11);
        coarse = std::max(coarse, (end(1e-4) - truth).norm());
        fine = std::max(fine, (end(1e-8) - truth).norm());
    }
    EXPECT_GT(coarse, 1e-7);
    EXPECT_LT(fine, 1e-2 * coarse);
}

// For any scene that the reader accepts, the model ends or reports failure and changes nothing.
TEST(Cushion, Mathavan2010EndsOrReportsFailure) {
    reference::Generator rng(13);
    int solved = 0, refused = 0;
    for (int i = 0; i < 30000; ++i) {
        Case x = random_case(rng, i % 4);
        const double R = x.contact.R;
        x.contact.mu_s = rng.uniform(0.0, 1.0);
        x.contact.f_c = rng.uniform(0.0, 1.0);
        x.contact.e_c = i % 7 ? rng.uniform(0.0, 1.0) : 0.0;
        x.contact.height = R * rng.uniform(0.6, 1.9);
        if (!cushion_model("mathavan_2010")->accepts(x.contact)) continue;
        Vec3 v = x.v, w = x.w;
        if (cushion_model("mathavan_2010")->resolve(x.contact, x.normal, v, w)) {
            ++solved;
            ASSERT_TRUE(v.allFinite() && w.allFinite()) << i;
        } else {
            ++refused;
            EXPECT_EQ(v, x.v);
            EXPECT_EQ(w, x.w);
        }
    }
    std::printf("%d solved, %d said that they were not\n", solved, refused);
    EXPECT_GT(solved, 8000);
    EXPECT_LE(refused, 10);
}

}  // namespace
}  // namespace carom
