#include "sweep/partial_file.h"

#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace carom::tools {

namespace fs = std::filesystem;

PartialFile::PartialFile(const std::string& path, std::uint64_t id) : path_(path), target_(path) {
    std::error_code error;
    if (const fs::path real = fs::canonical(path, error); !error) target_ = real.string();
    if (fs::is_directory(target_, error)) {
        errno = EISDIR;
        fail("cannot write");
    }
    const bool direct = fs::exists(target_, error) && !fs::is_regular_file(target_, error);
    name_ = direct ? target_ : fmt::format("{}.{:016x}.part", target_, id);
    file_ = std::fopen(name_.c_str(), direct ? "wb" : "a+b");
    if (file_ == nullptr) fail("cannot open for writing");
    if (direct) return;
    if (::flock(::fileno(file_), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK)
            throw std::runtime_error(fmt::format("{}: another program is writing this very file", name_));
        fail("cannot lock");
    }
    // Between opening and locking, the other program may have finished and renamed it.
    struct stat opened {};
    struct stat named {};
    if (::fstat(::fileno(file_), &opened) != 0 || ::stat(name_.c_str(), &named) != 0 ||
        opened.st_ino != named.st_ino)
        throw std::runtime_error(fmt::format("{}: another program has just finished this very file", name_));
    take_up();
}

void PartialFile::take_up() {
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
}

void PartialFile::commit() {
    flush();
    // The file is renamed before it is closed, because closing releases the lock.
    if (can_be_taken_up() && std::rename(name_.c_str(), target_.c_str()) != 0)
        fail("cannot rename to this name");
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail("cannot write");
}

}  // namespace carom::tools
