#include "base/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace carom {
namespace {

[[noreturn]] void fail(const std::string& name, const char* what) {
    const int reason = errno;
    throw std::runtime_error(name + ": " + what + ": " + std::strerror(reason));
}

/// Whether the file still has this name: another program may have renamed or removed it between opening and
/// locking.
bool is_named(int fd, const std::string& name) {
    struct stat opened {};
    struct stat named {};
    return ::fstat(fd, &opened) == 0 && ::lstat(name.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}

void lock(int fd, const std::string& name, int how) {
    if (::flock(fd, how | LOCK_NB) == 0) return;
    if (errno == EWOULDBLOCK)
        throw std::runtime_error(name + ": another program is writing the files that this lock protects");
    fail(name, "cannot lock");
}

}  // namespace

FileLock::FileLock(std::string name, bool alone) : name_(std::move(name)) {
    constexpr int kTries = 100;
    for (int k = 0; k < kTries; ++k) {
        fd_ = ::open(name_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd_ < 0) fail(name_, "cannot open for writing");
        try {
            lock(fd_, name_, alone ? LOCK_EX : LOCK_SH);
        } catch (...) {
            ::close(fd_);
            throw;
        }
        if (is_named(fd_, name_)) return;
        ::close(fd_);
    }
    throw std::runtime_error(name_ + ": other programs are writing the files that this lock protects");
}

FileLock::~FileLock() {
    // The last holder of a shared lock removes the file; nobody waits for a lock.
    if (::flock(fd_, LOCK_EX | LOCK_NB) == 0) ::unlink(name_.c_str());
    ::close(fd_);
}

}  // namespace carom
