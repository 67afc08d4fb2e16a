// Format and version of record files, for the writer and the reader.
#pragma once

namespace carom {

inline constexpr char kRecordFormat[] = "carom-record";
/// The written version. It may gain keys, as long as a reader that ignores them still draws the same shot
/// (docs/reference/record_format.md, "Versions").
inline constexpr int kRecordVersion = 4;
inline constexpr int kOldestVersion = 2;

}  // namespace carom
