// Keys with dots, as sweeps and batches write them:
// cue.offset.side, ball.1.position.x, table.pocket.p1.radius.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace carom::detail {

/// Removes "name." from the front of a key; false if the key does not begin with it.
bool take(std::string_view& key, std::string_view name);

/// Removes the name of a part of the table from the front of a key ("c2" in the list "cushion"), and returns
/// its index in the list. @throws std::invalid_argument
std::size_t take_part(std::string_view& key, const std::string& list);

/// Returns the index in an array of "x", "side" or "0". @throws std::invalid_argument
std::size_t element_index(std::string_view name);

}  // namespace carom::detail
