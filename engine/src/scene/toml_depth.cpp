#include "scene/toml_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "carom/engine/tolerances.h"

namespace carom::detail {
namespace {

class DepthScan {
  public:
    explicit DepthScan(std::string_view text) : text_(text) {}

    std::optional<TooDeep> run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                skip_string(c);
                continue;
            }
            if (c == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size());
                continue;
            }
            if (c == '.' && ++parts_ > kMaxKeyParts)
                return found(
                    fmt::format("this key has more than {} parts; no key of a scene has as many, "
                                "take dots out of it",
                                kMaxKeyParts));
            step(c);
            if (depth_ > kMaxNesting)
                return found(
                    fmt::format("brackets are more than {} deep here; close those above, or write "
                                "fewer within each other",
                                kMaxNesting));
            ++at_;
        }
        return std::nullopt;
    }

  private:
    void step(char c) {
        switch (c) {
            case '=':
                in_value_ = true;
                parts_ = 1;
                break;
            case ',':
                parts_ = 1;
                break;
            case '[':
            case '{':
                ++depth_;
                parts_ = 1;
                break;
            case ']':
            case '}':
                depth_ = std::max(0, depth_ - 1);
                parts_ = 1;
                break;
            case '\n':
                // Only a value goes on in the next line. The bracket of a section that is not closed is a
                // mistake of its own, which toml++ names better.
                if (!in_value_) depth_ = 0;
                if (depth_ == 0) in_value_ = false;
                parts_ = 1;
                break;
            default:
                break;
        }
    }

    /// Goes behind the string that begins here. One that is not closed in its line is a mistake.
    void skip_string(char quote) {
        const bool many_lines = run_of(quote) >= 3;
        at_ += many_lines ? 3 : 1;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '\n' && !many_lines) return;
            if (c == quote && (!many_lines || run_of(quote) >= 3)) {
                // Up to two quotation marks may stand in front of the closing three.
                at_ += many_lines ? std::min<std::size_t>(run_of(quote), 5) : 1;
                return;
            }
            at_ += c == '\\' && quote == '"' ? 2 : 1;
        }
    }

    std::size_t run_of(char c) const { return std::min(text_.find_first_not_of(c, at_), text_.size()) - at_; }

    TooDeep found(std::string what) const {
        const std::string_view before = text_.substr(0, at_);
        const std::size_t line = before.rfind('\n') + 1;  // 0 where there is none
        const auto columns = std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line), before.end(),
                                           [](char c) { return (c & 0xC0) != 0x80; });
        return {{1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
                 1 + static_cast<int>(columns)},
                std::move(what)};
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int parts_ = 1, depth_ = 0;
    bool in_value_ = false;
};

}  // namespace

std::optional<TooDeep> too_deep(std::string_view toml) {
    return DepthScan(toml).run();
}

}  // namespace carom::detail
