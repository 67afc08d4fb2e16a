// Keeps two programs from writing the same files.
#pragma once

#include <string>

namespace carom {

/// Locks files that a program works on, for its own lifetime, by an empty file next to them. The lock file is
/// removed at the end; one that a killed program left behind is reused.
class FileLock {
  public:
    /// @param alone  false: other users with `alone` false may work on the files too
    /// @throws std::runtime_error that names the file, including when another program has the lock
    FileLock(std::string name, bool alone);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::string name_;
    int fd_ = -1;
};

}  // namespace carom
