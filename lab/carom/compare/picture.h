// The paths of two shots in one picture.
#pragma once

#include <string>

#include "carom/engine/record.h"
#include "report/plot.h"

namespace carom::tools {

/// The table of `a` from above, its longer side across, and the path of every ball: solid for `a`, dashed for
/// `b`, in one colour for balls with the same name. A dot marks the final position. The title names the shots
/// `name_a` and `name_b`.
Plot ways_plot(const Record& a, const std::string& name_a, const Record& b, const std::string& name_b);

}  // namespace carom::tools
