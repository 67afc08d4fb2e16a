// What the writer and the reader of record files agree on.
#pragma once

namespace carom {

inline constexpr char kRecordFormat[] = "carom-record";
/// What is written. It stays 2 until release 0.2.0: until then keys may be added, as long as whoever leaves
/// them out still draws the same shot (docs/reference/record_format.md, "Versions").
inline constexpr int kRecordVersion = 2;

}  // namespace carom
