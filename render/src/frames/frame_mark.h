// Of which picture a frame is: a line of text in the PNG
// file itself, that anyone can read and that no copy loses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carom/render/sequence.h"

namespace carom::render {

/// What stands for all that decides the pixels of the frames of a run, but for the time of each: the record,
/// the table, the view, the overlay and the size. 16 digits.
std::string picture_of(const Record& record, const SequenceOptions& options);

/// The mark of the frame at this time [s].
std::string mark_at(const std::string& picture, double time);

/// Adds a comment with the mark to the bytes of a PNG file.
void add_mark(std::vector<std::uint8_t>& png, const std::string& mark);

/// The mark of a frame; "" where the file is no whole frame with a mark.
std::string mark_of(const std::string& path);

}  // namespace carom::render
