// What a validation says: text, JSON, CSV and figures.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "report/table.h"
#include "validate/run.h"

namespace carom::tools {

/// A row a number and variant; the keys are those of the JSON and of the CSV.
Table validation_table(const std::vector<ValidationRow>& rows);

/// For people: case by case, with its source, and the sums.
std::string validation_text(const std::vector<ValidationRow>& rows);

/// {"cases": [...]}, a row a number and variant.
std::string validation_json(const std::vector<ValidationRow>& rows);

/// Of one case what its file says, measured and computed; of several, or where
/// the file says nothing, every row's difference in units of its uncertainty.
Plot validation_plot(const std::vector<ValidationRow>& rows);

}  // namespace carom::tools
