// A file that is complete or absent: written under a temporary name, then renamed.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace carom {

/// A new stream for the process's own stream that /dev/stdout, /dev/stderr or /dev/fd/N names, continuing at
/// its position. Null for every other path, and with errno set if the process has no such stream. Opening it
/// by name would open a file that the shell has redirected to a second time: it would be emptied, replaced,
/// or overwritten by what is printed.
std::FILE* own_stream(const std::string& path);

/// The file that a path refers to, whether it exists or not: all links are followed, and the folder has no
/// links. Returns the path itself if there is no such folder.
std::string file_of(const std::string& path);

/// All errors are std::runtime_error and name the file and the reason.
///
/// A path that is not a regular file (/dev/null, a named pipe) is written to directly: renaming would replace
/// the device itself. So is the process's own stream (own_stream), wherever the shell has redirected it.
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
    /// of the temporary file, until it is renamed: a temporary file that nobody has locked may be removed
    int lock_ = -1;
};

}  // namespace carom
