// Reference impacts from tests/data/kernel.
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
#include "support/impact_numbers.h"

namespace carom::test {

struct ReferenceImpact {
    int id;
    kernel::Ball ball1, ball2;
    kernel::ImpactParams params;                          // with the published cloth slip, as in the vectors
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

inline bool same_bits(const kernel::ImpactResult& a, const kernel::ImpactResult& b) {
    for (int k = 0; k < 3; ++k) {
        if (a.v1[k] != b.v1[k] || a.w1[k] != b.w1[k] || a.v2[k] != b.v2[k] || a.w2[k] != b.w2[k])
            return false;
    }
    return a.steps == b.steps && a.status == b.status;
}

}  // namespace carom::test
