// The plot of a sweep: its first measure, over the first two numbers that vary if there are two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "carom/games/sweep.h"
#include "report/sweep_plot.h"

namespace carom::tools {

class PlottedSweep {
  public:
    /// @param file  "": nothing is plotted  @throws UsageError
    PlottedSweep(const games::Sweep& sweep, const std::string& file);

    void add(const games::SweptShots& shots);
    /// Rows that were written before.
    void add(std::string_view rows);
    /// @throws std::runtime_error
    void write() const;

  private:
    void add(std::uint64_t shot, double value);

    const games::Sweep& sweep_;
    std::string file_;
    SweepPlot plot_;
    std::vector<std::size_t> keys_;
    std::vector<DrawnValue> values_;
};

}  // namespace carom::tools
