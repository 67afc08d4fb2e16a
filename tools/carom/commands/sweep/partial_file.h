// A text file that grows line by line and survives being killed.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

namespace carom::tools {

/// Lines are appended to `path`.<id>.part, and commit() renames it to `path`.
/// Whoever opens the same path and id again continues after the complete lines;
/// another id is another file. A lock keeps two programs from writing one file.
///
/// If `path` is not a regular file (/dev/null, a pipe, the process's own
/// stream), it is written to directly, and the work cannot be continued later.
/// Every failure is a std::runtime_error that names the file and the reason.
class PartialFile {
  public:
    /// Called with every complete line that was found, without its end, and its number.
    using Seen = std::function<void(long, std::string_view)>;
    PartialFile(const std::string& path, std::uint64_t id, const Seen& seen = {});
    ~PartialFile();  ///< does not remove the partial file
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    long lines() const { return lines_; }                   ///< complete ones that were found
    const std::string& last_line() const { return last_; }  ///< of those, without its end
    const std::string& name() const { return name_; }       ///< of the file that grows
    bool can_be_taken_up() const { return name_ != target_; }

    void append(std::string_view text);  ///< whole lines
    void flush();  ///< what was appended survives a kill from here on, and a power cut some seconds later
    void commit();

  private:
    [[noreturn]] void fail(const std::string& what) const;
    void open(bool direct);
    void take_up(const Seen& seen);
    void sync();

    std::string path_;    // as asked for, for messages
    std::string target_;  // symbolic links followed
    std::string name_;
    std::FILE* file_ = nullptr;
    long lines_ = 0;
    std::string last_;
    std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

}  // namespace carom::tools
