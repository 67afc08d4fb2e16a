// Keys with dots, as written in sweeps and batches: cue.offset.side, ball.1.position.x,
// table.pocket.p1.radius.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace carom::detail {

/// A key in its parts, which name the same value in a file and in a scene.
struct KeyPath {
    std::string section;                 ///< "cue", "ball", "table"
    std::string list;                    ///< inside [table]: "cushion", "corner_pockets"; "" for none
    std::optional<std::size_t> index;    ///< of the ball, or of the part in its list
    std::string name;                    ///< of the value in its section
    std::optional<std::size_t> element;  ///< of the value, if it is a list

    /// Whether one key names the other's value, or a part of it.
    bool overlaps(const KeyPath& other) const;
};

/// @param ids  of the balls that a key may name, in order
/// @throws std::invalid_argument
KeyPath parse_key(std::string_view key, const std::vector<std::string>& ids);

}  // namespace carom::detail
