// A file that is complete or absent: written under a temporary name, then renamed.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace carom {

/// The process's own stream that /dev/stdout, /dev/stderr or /dev/fd/N names, as a stream of its own that
/// goes on where that one stands; null for every other path, and with errno set where the process has no such
/// stream. Opened by its name, a file that the shell has redirected to would be a second time open: emptied,
/// replaced, or written over by what is printed.
std::FILE* own_stream(const std::string& path);

/// The file that a path stands for, whether it is there or not: all links are followed, and the folder is
/// that without links. The path itself where there is no such folder.
std::string file_of(const std::string& path);

/// Every failure is a std::runtime_error that names the file and the reason.
///
/// If the path is not a regular file (/dev/null, a named pipe), it is written
/// to directly: renaming would replace the device itself. So is the process's
/// own stream (own_stream), whatever the shell has redirected it to.
class OutputFile {
  public:
    explicit OutputFile(std::string path);
    ~OutputFile();  ///< removes the temporary file unless commit() was called
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);

    /// The name that is written to until commit(), for another program that writes the file instead.
    const std::string& written() const { return temporary_.empty() ? target_ : temporary_; }

    /// Whether there is no temporary file.
    bool is_direct() const { return temporary_.empty(); }

    /// Closes and renames; before this call no file has the requested name.
    /// @param durable  the file survives a power cut from here on, which takes milliseconds and more
    void commit(bool durable = false);

  private:
    void open_temporary();
    [[noreturn]] void fail(const char* what);

    std::string path_;       ///< as requested, for messages
    std::string target_;     ///< after following symbolic links
    std::string temporary_;  ///< empty if the target is written to directly
    std::FILE* file_ = nullptr;
    /// of the temporary file, until it has its name: what nobody has locked is left over, and goes
    int lock_ = -1;
};

}  // namespace carom
