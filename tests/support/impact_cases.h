// Reference impacts from tests/data/kernel, and how far apart two results are.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/kernel/impact.h"

namespace carom::test {

struct ReferenceImpact {
    int id;
    kernel::Ball ball1, ball2;
    kernel::ImpactParams params;                          // with the published cloth slip, like the vectors
    std::map<std::string, kernel::ImpactResult> outputs;  // by the name of the model in the file
};

inline void read_vector(const nlohmann::json& json, double (&out)[3]) {
    for (int k = 0; k < 3; ++k) out[k] = json.at(static_cast<std::size_t>(k)).get<double>();
}

inline kernel::ImpactResult read_result(const nlohmann::json& json) {
    kernel::ImpactResult result{};
    read_vector(json.at("v1"), result.v1);
    read_vector(json.at("w1"), result.w1);
    read_vector(json.at("v2"), result.v2);
    read_vector(json.at("w2"), result.w2);
    return result;
}

inline std::vector<ReferenceImpact> reference_impacts(const std::string& file) {
    const std::string path = std::string(CAROM_TEST_DATA) + "/kernel/" + file;
    std::ifstream stream(path);
    if (!stream) throw std::runtime_error("cannot read " + path);
    const nlohmann::json json = nlohmann::json::parse(stream);
    std::vector<ReferenceImpact> impacts;
    for (const auto& item : json.at("cases")) {
        ReferenceImpact impact{};
        impact.id = item.at("id").get<int>();
        const auto &in = item.at("in"), &p = item.at("params");
        read_vector(in.at("r1"), impact.ball1.r);
        read_vector(in.at("v1"), impact.ball1.v);
        read_vector(in.at("w1"), impact.ball1.w);
        read_vector(in.at("r2"), impact.ball2.r);
        read_vector(in.at("v2"), impact.ball2.v);
        read_vector(in.at("w2"), impact.ball2.w);
        impact.params = {p.at("R").get<double>(),        p.at("m").get<double>(),
                         p.at("u_s1").get<double>(),     p.at("u_s2").get<double>(),
                         p.at("u_b").get<double>(),      p.at("e_b").get<double>(),
                         kernel::ClothSlip::kAsPublished};
        if (item.contains("out_N1000")) {
            impact.outputs["frictional_mathavan_N1000"] = read_result(item.at("out_N1000"));
        } else {
            for (const auto& [name, out] : item.at("out").items()) impact.outputs[name] = read_result(out);
        }
        impacts.push_back(impact);
    }
    return impacts;
}

/// Largest difference of any component [m/s]; spins count as R w.
inline double difference(const kernel::ImpactResult& a, const kernel::ImpactResult& b, double R) {
    double most = 0.0;
    const auto take = [&most](double x) { most = std::isnan(x) ? INFINITY : std::max(most, std::fabs(x)); };
    for (int k = 0; k < 3; ++k) {
        take(a.v1[k] - b.v1[k]);
        take(a.v2[k] - b.v2[k]);
        take(R * (a.w1[k] - b.w1[k]));
        take(R * (a.w2[k] - b.w2[k]));
    }
    return most;
}

/// Speed of approach along the line of centres [m/s].
inline double approach_speed(const kernel::Ball& b1, const kernel::Ball& b2) {
    const double dx = b2.r[0] - b1.r[0], dy = b2.r[1] - b1.r[1];
    return ((b1.v[0] - b2.v[0]) * dx + (b1.v[1] - b2.v[1]) * dy) / std::sqrt(dx * dx + dy * dy);
}

/// Kinetic energy of both balls per unit mass, J = 2/5 m R^2.
inline double energy(const double (&v1)[3], const double (&w1)[3], const double (&v2)[3],
                     const double (&w2)[3], double R) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += v1[k] * v1[k] + v2[k] * v2[k] + 0.4 * R * R * (w1[k] * w1[k] + w2[k] * w2[k]);
    return 0.5 * sum;
}

inline bool same_bits(const kernel::ImpactResult& a, const kernel::ImpactResult& b) {
    for (int k = 0; k < 3; ++k) {
        if (a.v1[k] != b.v1[k] || a.w1[k] != b.w1[k] || a.v2[k] != b.v2[k] || a.w2[k] != b.w2[k])
            return false;
    }
    return a.steps == b.steps && a.status == b.status;
}

}  // namespace carom::test
