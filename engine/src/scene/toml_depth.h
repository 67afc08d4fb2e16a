// toml++ bounds how deep values nest, but goes one call deeper for each part of a dotted key: a few kilobytes
// of text would overflow a thread's stack. What is deeper than any scene is found before it reads the text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "carom/engine/scene.h"

namespace carom::detail {

struct TooDeep {
    SourceLocation where;
    std::string what;  ///< what is wrong and what to do
};

/// The first key with more than kMaxKeyParts parts, or the first array or inline table that stands in
/// kMaxNesting others. Text that is not TOML gets an answer too; up to its first mistake it is the same.
std::optional<TooDeep> too_deep(std::string_view toml);

}  // namespace carom::detail
