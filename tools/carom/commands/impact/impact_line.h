// One line of carom impact: JSON in, JSON out.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "carom/kernel/impact.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom::tools {

/// A longer line is an error: an impact takes less than one kilobyte.
inline constexpr std::size_t kLongestImpactLine = 1 << 20;

/// How ball-ball lines are computed.
struct ImpactSettings {
    enum class Method : unsigned char { kMathavan, kInelastic, kElastic };
    Method method = Method::kMathavan;
    std::optional<int> substeps;  ///< of the published march; empty: the impact is solved by tolerance
    double tolerance = 1e-6;
    kernel::ClothSlip cloth_slip = kernel::ClothSlip::kConsistent;
    kernel::MarchFunction march = nullptr;
    kernel::ToleranceFunction by_tolerance = nullptr;
};

struct ImpactAnswer {
    std::string json;  ///< one line, without its end
    bool ok = false;   ///< false: json is {"error": ...}
};

/// Computes one line. For any line, the answer is a result or an error.
ImpactAnswer answer_impact(std::string_view line, const ImpactSettings& settings);

/// The kinds of lines and their keys for people, one line each after a first line.
std::string impact_keys();

/// The answer to a line that could not be computed.
ImpactAnswer impact_error(const std::string& what);

}  // namespace carom::tools
