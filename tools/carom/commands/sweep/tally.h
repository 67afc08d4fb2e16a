// Sums over the shots of a sweep: shares with their intervals, means and spreads.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "carom/games/measures.h"

namespace carom::tools {

/// Counts the values of one measure.
class Tally {
  public:
    explicit Tally(const games::Measure& measure)
        : name_(measure.text()), number_(measure.is_number()), truth_(measure.is_truth()) {}

    void add(const games::MeasureValue& value);
    /// One or a few lines.
    std::string text() const;
    nlohmann::ordered_json json() const;

  private:
    std::string name_;
    bool number_, truth_;
    std::size_t shots_ = 0, counted_ = 0;
    double mean_ = 0.0, squares_ = 0.0, least_ = 0.0, most_ = 0.0;
    std::map<std::string, std::size_t> texts_;
};

}  // namespace carom::tools
