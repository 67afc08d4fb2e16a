// Files that are complete or absent (written under a temporary name, then renamed), and locks of files.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace carom {

/// The reader of an output has gone away (`carom ... | head -1`). The program ends with exit status 1, and
/// prints no message.
class BrokenPipe : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A new stream for the process's own stream that /dev/stdout, /dev/stderr or /dev/fd/N names, continuing at
/// its position. Null for every other path, and with errno set if the process has no such stream. Opening the
/// name would open a file to which the shell has redirected it a second time: the file would be emptied,
/// replaced, or overwritten by printed output.
std::FILE* own_stream(const std::string& path);

/// The file to which a path refers, whether it exists or not: follows all links, and the resulting folder
/// contains no links. Returns the path itself if the folder does not exist.
std::string file_of(const std::string& path);

/// All errors are std::runtime_error and name the file and the reason.
///
/// A path that is not a regular file (/dev/null, a named pipe) is written directly: renaming would replace
/// the device itself. The same applies to the process's own streams (own_stream), wherever the shell has
/// redirected them.
class OutputFile {
  public:
    explicit OutputFile(std::string path);
    ~OutputFile();  ///< removes the temporary file unless commit() was called
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);

    /// The name that is written until commit(), for another program that writes the file instead.
    const std::string& written() const { return temporary_.empty() ? target_ : temporary_; }

    /// Whether the target is written without a temporary file.
    bool is_direct() const { return temporary_.empty(); }

    /// Closes and renames; before this call no file has the requested name.
    /// @param durable  the file survives a power cut from here on, at a cost of milliseconds or more
    void commit(bool durable = false);

  private:
    void open_temporary();
    [[noreturn]] void fail(const char* what);

    std::string path_;       ///< as requested, for messages
    std::string target_;     ///< after following symbolic links
    std::string temporary_;  ///< empty if the target is written directly
    std::FILE* file_ = nullptr;
    /// of the temporary file, until it is renamed: unlocked temporary files may be removed
    int lock_ = -1;
};

/// Locks files for its own lifetime, by means of an empty file next to them. The lock file is removed at the
/// end; one left by a killed program is reused.
class FileLock {
  public:
    /// @param alone  false: other users with `alone` false may also use the files
    /// @throws std::runtime_error naming the file, also if another program has the lock
    FileLock(std::string name, bool alone);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::string name_;
    int fd_ = -1;
};

}  // namespace carom
