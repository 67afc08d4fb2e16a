// The costs of the frames of a shot as a chart.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/margin.h"
#include "page/chart.h"

namespace carom::tools {

Plot margin_plot(const Margin& margin, const MarginRun& last, const std::string& scene);

/// The chart for a page, with the worst frame marked.
nlohmann::ordered_json margin_chart(const Margin& margin, const MarginRun& last, const std::string& scene);

}  // namespace carom::tools
