// Format and version of record files, for the writer and the reader.
#pragma once

namespace carom {

inline constexpr char kRecordFormat[] = "carom-record";
/// The version that is written. Keys may be added to it, as long as a reader that ignores them still draws
/// the same shot (docs/reference/record_format.md, "Versions").
inline constexpr int kRecordVersion = 3;
/// The oldest version that is read.
inline constexpr int kOldestVersion = 2;

}  // namespace carom
