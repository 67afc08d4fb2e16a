// Cushion models against reference vectors and exact statements.
#include "carom/engine/cushion.h"

#include <gtest/gtest.h>

#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

TEST(Cushion, ReferenceVectors) {
    const auto data = read_json("cushion.json");
    int checked = 0;
    for (const auto& c : data.at("cases")) {
        const auto& p = c.at("params");
        const CushionContact contact{p.at("R").get<double>(),   p.at("m").get<double>(),   p.at("u_s").get<double>(),
                                     p.at("e_c").get<double>(), p.at("f_c").get<double>(), c.at("cushion").at("height").get<double>()};
        const Vec2 normal(c.at("normal_into_table").at(0).get<double>(), c.at("normal_into_table").at(1).get<double>());
        Vec3 v = vec3(c.at("in").at("v")), w = vec3(c.at("in").at("w"));
        resolve_cushion(CushionModel::kHan2005, contact, normal, v, w);
        const auto& out = c.at("out").at("han_2005");
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(v[k], vec3(out.at("v"))[k], 1e-9) << "case " << c.at("id") << " v" << k;
            EXPECT_NEAR(w[k], vec3(out.at("w"))[k], 1e-9) << "case " << c.at("id") << " w" << k;
        }
        ++checked;
    }
    EXPECT_EQ(checked, 40);
}

TEST(Cushion, SmoothReversesTheNormalVelocityOnly) {  // T17
    const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.0365};
    const Vec2 normal(0.6, 0.8);
    Vec3 v(-1.2, -0.4, 0.0), w(10.0, -20.0, 30.0);
    const double v_n = normal.x() * v.x() + normal.y() * v.y(), v_t = -normal.y() * v.x() + normal.x() * v.y();
    resolve_cushion(CushionModel::kSmooth, contact, normal, v, w);
    EXPECT_NEAR(normal.x() * v.x() + normal.y() * v.y(), -0.85 * v_n, 1e-15);
    EXPECT_NEAR(-normal.y() * v.x() + normal.x() * v.y(), v_t, 1e-15);
    EXPECT_EQ(w, Vec3(10.0, -20.0, 30.0));
}

TEST(Cushion, ARecedingBallIsLeftAlone) {
    const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.0365};
    for (const CushionModel model : {CushionModel::kSmooth, CushionModel::kHan2005}) {
        Vec3 v(1.0, 0.3, 0.0), w(1.0, 2.0, 3.0);
        resolve_cushion(model, contact, Vec2(1.0, 0.0), v, w);
        EXPECT_EQ(v, Vec3(1.0, 0.3, 0.0));
        EXPECT_EQ(w, Vec3(1.0, 2.0, 3.0));
    }
}

TEST(Cushion, EnergyFallsAndMirrorsAgree) {
    const CushionContact contact{0.028575, 0.17, 0.2, 0.85, 0.2, 0.036576};
    const auto energy = [&](const Vec3& v, const Vec3& w) {
        return 0.5 * v.squaredNorm() + 0.2 * contact.R * contact.R * w.squaredNorm();
    };
    for (int i = 0; i < 500; ++i) {
        const double a = 0.011 * i;
        const Vec3 v0(-std::cos(a) * (0.1 + 0.01 * i), std::sin(a), 0.0), w0(50 * std::sin(3 * a), 40 * std::cos(5 * a), 60 * std::sin(7 * a));
        if (!(v0.x() < 0.0)) continue;
        Vec3 v = v0, w = w0;
        resolve_cushion(CushionModel::kHan2005, contact, Vec2(1.0, 0.0), v, w);
        EXPECT_LE(energy(v, w), energy(v0, w0) * (1.0 + 1e-14));
        EXPECT_GT(v.x(), 0.0);
        // Mirror in x: a polar vector turns its y, an axial one its x and z.
        Vec3 vm(v0.x(), -v0.y(), 0.0), wm(-w0.x(), w0.y(), -w0.z());
        resolve_cushion(CushionModel::kHan2005, contact, Vec2(1.0, 0.0), vm, wm);
        EXPECT_EQ(vm, Vec3(v.x(), -v.y(), 0.0));
        EXPECT_EQ(wm, Vec3(-w.x(), w.y(), -w.z()));
    }
}

}  // namespace
}  // namespace carom
