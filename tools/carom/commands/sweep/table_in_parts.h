// A table that grows in parts and survives being killed.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <string_view>

#include "base/output_file.h"

namespace carom::tools {

/// The table appears when it is complete. Until then its rows are kept in a folder, `path`.<id>.parts, by the
/// rules of all sweeps (docs/guide/clusters.md). The name of a part is its first shot. Its rows are followed
/// by a description, and the last line is the hash of everything before. The next run with this path and id
/// continues after them. A lock prevents two programs from doing the same work.
class TableInParts {
  public:
    /// @param first  number of the first shot
    /// @param found  called with the rows of each part of an earlier run
    TableInParts(const std::string& path, std::uint64_t id, std::string_view header, std::uint64_t first,
                 const std::function<void(std::string_view)>& found = {});
    ~TableInParts();  ///< keeps the parts
    TableInParts(const TableInParts&) = delete;
    TableInParts& operator=(const TableInParts&) = delete;

    const std::string& folder() const { return folder_; }  ///< empty: nothing is kept
    std::uint64_t next() const { return next_; }           ///< the first missing shot
    std::uint64_t failed() const { return failed_; }       ///< failed shots before it
    /// Whether the existing parts end with this row.
    bool ends_with(std::string_view row) const { return found_.ends_with(row); }

    /// Rows of the next shots, with their line ends.
    void add(std::string_view rows, std::uint64_t shots, std::uint64_t failed);
    /// Writes the rows added since the last part as a new part. add() also does so from time to time.
    void keep();
    void commit();

  private:
    using Clock = std::chrono::steady_clock;
    bool take_up();
    std::string part(std::uint64_t first) const;
    void begin_part();

    OutputFile whole_;
    std::string folder_, found_, rows_;
    std::optional<FileLock> lock_;
    std::uint64_t next_, kept_, failed_ = 0, failed_kept_ = 0;
    Clock::time_point kept_at_ = Clock::now();
    Clock::duration wait_;
    std::future<void> writing_;  // the last part
};

}  // namespace carom::tools
