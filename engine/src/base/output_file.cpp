// A file that is complete or absent: written under a temporary name, then renamed.
#include "base/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace carom {

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(path_) {
    std::error_code error;
    if (std::filesystem::exists(path_, error)) {
        const std::filesystem::path real = std::filesystem::canonical(path_, error);
        if (!error) target_ = real.string();
    }
    const bool direct =
        std::filesystem::exists(target_, error) && !std::filesystem::is_regular_file(target_, error);
    // The process id distinguishes two programs that write the same file.
    if (!direct) temporary_ = target_ + "." + std::to_string(::getpid()) + ".tmp";
    file_ = std::fopen(direct ? target_.c_str() : temporary_.c_str(), "wb");
    if (file_ == nullptr) {
        temporary_.clear();
        fail("cannot open for writing");
    }
}

OutputFile::~OutputFile() {
    if (file_ != nullptr) std::fclose(file_);
    if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void OutputFile::fail(const char* what) {
    const int reason = errno;
    throw std::runtime_error(path_ + ": " + what + ": " + std::strerror(reason));
}

void OutputFile::write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("cannot write");
}

void OutputFile::commit() {
    std::FILE* file = file_;
    file_ = nullptr;
    // fclose reports errors that buffering has hidden until now, for example a full disk.
    if (std::fclose(file) != 0) fail("cannot write");
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename to this name");
    temporary_.clear();
}

}  // namespace carom
