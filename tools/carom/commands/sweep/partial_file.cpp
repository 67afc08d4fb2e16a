#include "commands/sweep/partial_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "base/file_lock.h"
#include "base/output_file.h"

namespace carom::tools {

namespace fs = std::filesystem;

namespace {

/// Writing to the disk takes milliseconds and more.
constexpr std::chrono::seconds kSyncEvery(5);

}  // namespace

PartialFile::PartialFile(const std::string& path, std::uint64_t id, const Seen& seen)
    : path_(path), target_(path) {
    file_ = own_stream(path);
    if (file_ != nullptr) {
        name_ = target_;
        return;
    }
    std::error_code error;
    target_ = file_of(path);
    if (fs::is_directory(target_, error)) {
        errno = EISDIR;
        fail("cannot write");
    }
    const bool direct = fs::exists(target_, error) && !fs::is_regular_file(target_, error);
    name_ = direct ? target_ : fmt::format("{}.{:016x}.part", target_, id);
    open(direct);
    if (direct) return;
    lock_file(::fileno(file_), name_);
    take_up(seen);
}

// Others may be able to make files in the folder, and they can
// tell the name: it has to be a file, and no link to another one.
void PartialFile::open(bool direct) {
    const int flags = direct ? O_WRONLY | O_CREAT | O_TRUNC : O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW;
    const int fd = ::open(name_.c_str(), flags | O_CLOEXEC, 0666);
    struct stat opened {};
    if (fd >= 0 && !direct && ::fstat(fd, &opened) == 0 && !S_ISREG(opened.st_mode)) {
        ::close(fd);
        throw std::runtime_error(name_ + ": this is no file; remove it");
    }
    file_ = fd < 0 ? nullptr : ::fdopen(fd, direct ? "wb" : "a+b");
    if (file_ == nullptr && errno == ELOOP)
        throw std::runtime_error(name_ + ": this is a link, and following it is not safe; remove it");
    if (file_ == nullptr) fail("cannot open for writing");
}

void PartialFile::take_up(const Seen& seen) {
    std::rewind(file_);
    std::vector<char> block(1 << 16);
    long end = 0, at = 0;  // behind the last complete line; of the byte read
    std::string line;
    for (std::size_t got; (got = std::fread(block.data(), 1, block.size(), file_)) > 0;) {
        for (std::size_t i = 0; i < got; ++i) {
            ++at;
            if (block[i] != '\n') {
                line += block[i];
                continue;
            }
            if (seen) seen(lines_, line);
            ++lines_;
            end = at;
            last_.swap(line);
            line.clear();
        }
    }
    if (std::ferror(file_) != 0) fail("cannot read");
    if (std::fseek(file_, 0, SEEK_END) != 0 || ::ftruncate(::fileno(file_), end) != 0) fail("cannot shorten");
}

PartialFile::~PartialFile() {
    if (file_ != nullptr) std::fclose(file_);
}

void PartialFile::fail(const std::string& what) const {
    const int reason = errno;
    throw std::runtime_error(fmt::format("{}: {}: {}", path_, what, std::strerror(reason)));
}

void PartialFile::append(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("cannot write");
}

void PartialFile::flush() {
    if (std::fflush(file_) != 0) fail("cannot write");
    const auto now = std::chrono::steady_clock::now();
    if (!can_be_taken_up() || now - synced_ < kSyncEvery) return;
    sync();
    synced_ = now;
}

void PartialFile::sync() {
    // Some file systems cannot; they promise nothing.
    if (::fsync(::fileno(file_)) != 0 && errno != EINVAL && errno != EROFS) fail("cannot write");
}

void PartialFile::commit() {
    if (std::fflush(file_) != 0) fail("cannot write");
    if (can_be_taken_up()) sync();
    // The file is renamed before it is closed, because closing releases the lock.
    if (can_be_taken_up() && std::rename(name_.c_str(), target_.c_str()) != 0)
        fail("cannot rename to this name");
    if (can_be_taken_up()) {  // so that the new name survives, too
        const std::string folder = fs::path(target_).parent_path().string();
        const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (fd >= 0) {
            ::fsync(fd);
            ::close(fd);
        }
    }
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail("cannot write");
}

}  // namespace carom::tools
