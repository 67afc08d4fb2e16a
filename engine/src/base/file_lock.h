// Keeps two programs from writing the same files.
#pragma once

#include <string>

namespace carom {

/// Files that a program works on, as long as it lives: an empty file beside them,
/// which is removed at the end. One that a killed program left is taken over.
class FileLock {
  public:
    /// @param alone  false: others that are not alone may work on the files too
    /// @throws std::runtime_error that names the file, also where another program has the lock
    FileLock(std::string name, bool alone);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::string name_;
    int fd_ = -1;
};

}  // namespace carom
