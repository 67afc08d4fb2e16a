// A file that is complete or absent: written under a temporary name, then renamed.
#include "base/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "base/as_number.h"

namespace carom {

namespace {

constexpr int kMostLinks = 40;    // as in the Linux kernel
constexpr int kMostNames = 1000;  // temporary files of one process in one folder
constexpr std::string_view kTemporary = ".carom.", kTemporaryEnd = ".tmp";

/// The number of a file descriptor; -1 if the path is none.
int descriptor(std::string_view path) {
    if (path == "/dev/stdout") return STDOUT_FILENO;
    if (path == "/dev/stderr") return STDERR_FILENO;
    constexpr std::string_view kFolder = "/dev/fd/";
    if (!path.starts_with(kFolder)) return -1;
    return as_number<int>(path.substr(kFolder.size())).value_or(-1);
}

/// Removes from a folder what killed programs left: unlocked temporary files. Once per folder, because a run
/// may write many files.
void remove_left(const std::filesystem::path& folder) {
    static std::mutex mutex;
    static std::set<std::filesystem::path> seen;
    {
        const std::lock_guard guard(mutex);
        if (!seen.insert(folder).second) return;
    }
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(kTemporary) || !name.ends_with(kTemporaryEnd)) continue;
        const int fd = ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (fd < 0) continue;
        struct stat opened {};
        if (::fstat(fd, &opened) == 0 && S_ISREG(opened.st_mode) && ::flock(fd, LOCK_EX | LOCK_NB) == 0)
            ::unlink(entry.path().c_str());
        ::close(fd);
    }
}

}  // namespace

std::FILE* own_stream(const std::string& path) {
    errno = 0;
    const int number = descriptor(path);
    if (number < 0) return nullptr;
    if (number == STDOUT_FILENO) std::fflush(stdout);  // keeps the order with earlier output
    const int fd = ::fcntl(number, F_DUPFD_CLOEXEC, 0);
    return fd < 0 ? nullptr : ::fdopen(fd, "wb");
}

std::string file_of(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (const fs::path real = fs::canonical(path, error); !error) return real.string();
    fs::path file = path;
    for (int links = 0; links < kMostLinks && fs::is_symlink(file, error); ++links) {
        const fs::path to = fs::read_symlink(file, error);
        if (error) break;
        file = file.parent_path() / to;
    }
    const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : ".", error);
    return error ? file.string() : (folder / file.filename()).string();
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(path_) {
    namespace fs = std::filesystem;
    file_ = own_stream(path_);
    if (file_ != nullptr) return;
    target_ = file_of(path_);
    std::error_code error;
    if (fs::exists(target_, error) && !fs::is_regular_file(target_, error)) {
        file_ = std::fopen(target_.c_str(), "wb");
        if (file_ == nullptr) fail("cannot open for writing");
        return;
    }
    open_temporary();
}

// Other users may be able to create files in the folder, so the temporary file must be new and not a link. It
// gets the permissions of the file that it replaces.
void OutputFile::open_temporary() {
    struct stat there {};
    const bool replaces = ::stat(target_.c_str(), &there) == 0;
    const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
    remove_left(folder.empty() ? "." : folder);
    for (int k = 0; k < kMostNames; ++k) {
        // Short, because the file's name may already have the maximum length. Contains the process id,
        // because other programs write here too.
        temporary_ = (folder / fmt::format("{}{}.{}{}", kTemporary, ::getpid(), k, kTemporaryEnd)).string();
        const int fd = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd < 0 && errno == EEXIST) continue;
        // Locked while it is written, so that other programs see that it is in use. If one of them saw it
        // earlier and removed it, try again.
        struct stat opened {};
        if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &opened) == 0 &&
            opened.st_nlink == 0) {
            ::close(fd);
            continue;
        }
        if (fd >= 0 && replaces && ::fchmod(fd, there.st_mode & 07777) != 0) errno = 0;  // not ours to change
        lock_ = fd < 0 ? -1 : ::fcntl(fd, F_DUPFD_CLOEXEC, 0);
        file_ = fd < 0 ? nullptr : ::fdopen(fd, "wb");
        break;
    }
    if (file_ != nullptr) return;
    temporary_.clear();
    fail("cannot open for writing");
}

OutputFile::~OutputFile() {
    if (file_ != nullptr) std::fclose(file_);
    if (!temporary_.empty()) std::remove(temporary_.c_str());
    if (lock_ >= 0) ::close(lock_);
}

void OutputFile::fail(const char* what) {
    const int reason = errno;
    if (reason == EPIPE) throw BrokenPipe(path_ + ": the reader has closed the pipe");
    throw std::runtime_error(path_ + ": " + what + ": " + std::strerror(reason));
}

void OutputFile::write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("cannot write");
}

void OutputFile::commit(bool durable) {
    durable = durable && !is_direct();
    // Unsupported by some file systems, which then guarantee nothing.
    if (durable &&
        (std::fflush(file_) != 0 || (::fsync(::fileno(file_)) != 0 && errno != EINVAL && errno != EROFS)))
        fail("cannot write");
    std::FILE* file = file_;
    file_ = nullptr;
    // fclose reports errors that buffering has delayed, such as a full disk.
    if (std::fclose(file) != 0) fail("cannot write");
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename to this name");
    temporary_.clear();
    if (!durable) return;
    const std::string folder = std::filesystem::path(target_).parent_path().string();
    const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    ::fsync(fd);
    ::close(fd);
}

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
