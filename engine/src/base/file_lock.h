// Prevents two programs from writing the same files.
#pragma once

#include <string>

namespace carom {

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
