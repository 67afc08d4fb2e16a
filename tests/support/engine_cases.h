// Scenes and states from the reference vectors in tests/data/engine, and small scenes made in code.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"

namespace carom::test {

inline nlohmann::json read_json(const std::string& file) {
    const std::string path = std::string(CAROM_TEST_DATA) + "/engine/" + file;
    std::ifstream stream(path);
    if (!stream) throw std::runtime_error("cannot read " + path);
    return nlohmann::json::parse(stream);
}

inline Vec3 vec3(const nlohmann::json& j) {
    return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

/// With one constant friction between balls, as in formulas and reference solutions.
inline BallParams pool_balls() {
    return make_ball_params("pool_classic");
}

/// Reads R, m, u_s, ... where given; the rest keeps the pool defaults.
inline BallParams balls_from(const nlohmann::json& p) {
    BallParams b = pool_balls();
    const auto take = [&p](const char* key, double& x) {
        if (p.contains(key)) x = p.at(key).get<double>();
    };
    take("R", b.R);
    take("m", b.m);
    take("u_s", b.mu_s);
    take("u_r", b.mu_r);
    take("u_sp", b.mu_sp);
    take("u_b", b.mu_b);
    take("e_b", b.e_b);
    take("e_c", b.e_c);
    take("f_c", b.f_c);
    return b;
}

/// A scene on an endless cloth with the pool defaults and no balls yet.
inline Scene empty_scene() {
    Scene scene;
    scene.file = "(test)";
    scene.balls = pool_balls();
    return scene;
}

/// The number of a list below which this share of it lies.
inline double share_of(std::vector<double> list, double share) {
    std::sort(list.begin(), list.end());
    return list[static_cast<std::size_t>(share * static_cast<double>(list.size() - 1))];
}

/// Impacts take no time, as in the textbooks' formulas.
inline Scene instant_scene() {
    Scene scene = empty_scene();
    scene.physics.clusters = ClusterModel::kSequential;
    return scene;
}

inline void add_ball(Scene& scene, const std::string& id, const Vec3& r, const Vec3& v = Vec3::Zero(),
                     const Vec3& w = Vec3::Zero()) {
    BallStart ball;
    ball.id = id;
    ball.position = r;
    ball.velocity = v;
    ball.spin = w;
    scene.ball.push_back(ball);
}

/// On the cloth at (x, y).
inline void add_ball(Scene& scene, const std::string& id, double x, double y, double vx = 0.0,
                     double vy = 0.0, const Vec3& w = Vec3::Zero()) {
    add_ball(scene, id, Vec3(x, y, scene.balls.R), Vec3(vx, vy, 0.0), w);
}

/// The spin of a ball rolling at this velocity.
inline Vec3 rolling_spin(double vx, double vy, double R) {
    return {-vy / R, vx / R, 0.0};
}

/// Four straight cushions around w x l.
inline Table box(double w, double l, double height) {
    Table table;
    table.width = w;
    table.length = l;
    table.cushions = {{"left", {0, 0}, {0, l}, height},
                      {"foot", {0, l}, {w, l}, height},
                      {"right", {w, l}, {w, 0}, height},
                      {"head", {w, 0}, {0, 0}, height}};
    return table;
}

inline Plan plan_of(const Scene& scene) {
    return make_plan(scene, kernel::best_isa());
}

/// Runs and checks the laws of verify().
inline Record run_verified(const Scene& scene) {
    const Plan plan = plan_of(scene);
    Record record = simulate(plan);
    const auto violation = verify(record, plan);
    EXPECT_FALSE(violation) << violation->law << " at event " << violation->event << ": "
                            << violation->message;
    return record;
}

inline int count(const Record& record, EventType type) {
    int n = 0;
    for (const Event& e : record.events) n += e.type == type ? 1 : 0;
    return n;
}

inline const Event* first(const Record& record, EventType type) {
    for (const Event& e : record.events)
        if (e.type == type) return &e;
    return nullptr;
}

}  // namespace carom::test
