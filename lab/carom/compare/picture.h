// The ways of two shots in one picture.
#pragma once

#include <string>

#include "carom/engine/record.h"
#include "report/plot.h"

namespace carom::tools {

/// The table of `a` from above, its longer side across, and the way of every ball:
/// that of `a` solid, that of `b` dashed, of one colour where the ball has the same
/// name. A dot is the last place. The title names `a` and `b` by `name_a`, `name_b`.
Plot ways_plot(const Record& a, const std::string& name_a, const Record& b, const std::string& name_b);

}  // namespace carom::tools
