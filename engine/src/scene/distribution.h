// Distributions of a variation: reading and drawing.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <memory>
#include <string_view>
#include <variant>

#include "base/splitmix64.h"

namespace carom::detail {

/// A drawn value; a node belongs to the distribution.
using Drawn = std::variant<double, std::int64_t, const toml::node*>;

class Distribution {
  public:
    /// @param text  "uniform(0,1)" and the like
    /// @param own  the number that the file has, null where there is none; normal(sd) is around it
    /// @throws std::invalid_argument saying what is wrong
    static Distribution parse(std::string_view text, const toml::node* own);

    Drawn draw(SplitMix64& random) const;

  private:
    enum class Kind : unsigned char { kUniform, kNormal, kInteger, kList };
    Kind kind_ = Kind::kUniform;
    double first_ = 0.0, second_ = 0.0;  // uniform: from, to; normal: mean, standard deviation
    std::int64_t low_ = 0, high_ = 0;    // integer
    std::shared_ptr<const toml::array> list_;
};

/// Standard normal, by the ratio of uniforms: Kinderman, Monahan, "Computer generation of random variables
/// using the ratio of uniform deviates", ACM TOMS 3, 1977.
double standard_normal(SplitMix64& random);

}  // namespace carom::detail
