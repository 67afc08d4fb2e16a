// Reasons of a plan in words, where somebody asks for them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace carom {

/// Writes a text as fmt::format does, or nothing, which takes no memory.
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
