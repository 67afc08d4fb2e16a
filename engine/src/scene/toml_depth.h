// toml++ limits how deep values nest, but recurses for each part of a dotted key: a few kilobytes of text
// would overflow a thread's stack. So anything deeper than any scene is found before toml++ reads the text.
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

/// The first key with more than kMaxKeyParts parts, or the first array or inline table inside kMaxNesting
/// others. For text that is not TOML, the result is right up to its first mistake.
std::optional<TooDeep> too_deep(std::string_view toml);

}  // namespace carom::detail
