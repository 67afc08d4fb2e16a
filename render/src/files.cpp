#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "carom/render/error.h"
#include "carom/render/png.h"

namespace carom::render {

namespace {

// Writes all bytes and closes; an error number, or 0.
int write_all(int file, const std::vector<std::uint8_t>& bytes) {
    int error = 0;
    for (std::size_t done = 0; done < bytes.size() && error == 0;) {
        const ssize_t wrote = ::write(file, bytes.data() + done, bytes.size() - done);
        if (wrote > 0) done += static_cast<std::size_t>(wrote);
        else if (wrote == 0) error = EIO;
        else if (errno != EINTR) error = errno;
    }
    // Some file systems report a full disk only here.
    if (::close(file) != 0 && error == 0) error = errno;
    return error;
}

}  // namespace

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    const std::string temporary = path + "." + std::to_string(::getpid()) + ".tmp";
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) throw RenderError(path + ": cannot write: " + std::strerror(errno));
    int error = write_all(file, bytes);
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        throw RenderError(path + ": cannot write: " + std::strerror(error));
    }
}

}  // namespace carom::render
