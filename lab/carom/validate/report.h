// Reports of a validation: text, JSON, CSV and figures.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "report/table.h"
#include "validate/run.h"

namespace carom::tools {

/// One row per number and variant, with the keys of the JSON and the CSV.
Table validation_table(const std::vector<ValidationRow>& rows);

/// Readable text: case by case, with its source, and the totals.
std::string validation_text(const std::vector<ValidationRow>& rows);

/// {"cases": [...]}, one row per number and variant.
std::string validation_json(const std::vector<ValidationRow>& rows);

/// For one case the figure that its file describes, measured and computed; for several, or without a
/// described figure, every row's difference in units of its uncertainty.
Plot validation_plot(const std::vector<ValidationRow>& rows);

}  // namespace carom::tools
