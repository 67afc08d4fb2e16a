// The reasons of a plan in words, if wanted.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace carom {

/// Formats a text like fmt::format, or returns "" without allocating memory.
class Words {
  public:
    explicit Words(bool wanted) : wanted_(wanted) {}

    template <class... Values>
    std::string operator()(fmt::format_string<Values...> text, Values&&... values) const {
        return wanted_ ? fmt::format(text, std::forward<Values>(values)...) : std::string();
    }
    bool wanted() const { return wanted_; }

  private:
    bool wanted_;
};

}  // namespace carom
