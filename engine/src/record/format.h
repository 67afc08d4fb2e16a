// What the writer and the reader of record files agree on.
#pragma once

namespace carom {

inline constexpr char kRecordFormat[] = "carom-record";
inline constexpr int kRecordVersion = 1;

}  // namespace carom
