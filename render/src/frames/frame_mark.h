// The mark of a frame: a line of text in the PNG file that identifies its picture. Anyone can read it, and
// every copy keeps it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carom/render/sequence.h"

namespace carom::render {

/// Identifies everything that determines the pixels of a run's frames except their times: the record, the
/// table, the view, the overlay and the size. 16 digits.
std::string picture_of(const Record& record, const SequenceOptions& options);

/// The mark of the frame at this time [s].
std::string mark_at(const std::string& picture, double time);

/// Adds a comment with the mark to the bytes of a PNG file.
void add_mark(std::vector<std::uint8_t>& png, const std::string& mark);

/// The mark of a frame; "" if the file is not a complete frame with a mark.
std::string mark_of(const std::string& path);

}  // namespace carom::render
