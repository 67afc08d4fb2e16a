// A table that grows in parts and survives being killed.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/file_lock.h"
#include "base/output_file.h"

namespace carom::tools {

/// The table appears when it is complete. Until then its rows are kept in a folder, `path`.<id>.parts, by the
/// rules of all sweeps (docs/guide/clusters.md, "What a resumed sweep relies on"). A part has the name of its
/// first shot. Behind its rows it says what it holds, and the last line is the hash of all before. The next
/// run with this path and id goes on behind them. A lock keeps two programs from doing the same work.
///
/// If `path` is not a regular file (/dev/null, a pipe, the process's own stream), rows are written there at
/// once, and nothing is kept. Every failure is a std::runtime_error that names the file and the reason.
class TableInParts {
  public:
    /// @param first  number of the first shot
    TableInParts(const std::string& path, std::uint64_t id, std::string_view header, std::uint64_t first);
    ~TableInParts();  ///< keeps the parts
    TableInParts(const TableInParts&) = delete;
    TableInParts& operator=(const TableInParts&) = delete;

    const std::string& folder() const { return folder_; }  ///< empty: nothing is kept
    std::uint64_t next() const { return next_; }           ///< the first shot that is missing
    std::uint64_t failed() const { return failed_; }       ///< shots before it
    /// Whether the parts that were found end with this row.
    bool ends_with(std::string_view row) const { return found_.ends_with(row); }

    /// Rows of the next shots, with their line ends.
    void add(std::string_view rows, std::uint64_t shots, std::uint64_t failed);
    /// Makes a part of what was added since the last one. add() does it now and then.
    void keep();
    void commit();

  private:
    using Clock = std::chrono::steady_clock;
    bool take_up();
    std::string part(std::uint64_t first) const;

    OutputFile whole_;
    std::string folder_, found_, rows_;
    std::optional<FileLock> lock_;
    std::uint64_t next_, kept_, failed_ = 0, failed_kept_ = 0;
    Clock::time_point kept_at_ = Clock::now();
    Clock::duration wait_;
};

}  // namespace carom::tools
