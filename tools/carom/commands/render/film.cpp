#include "commands/render/film.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "base/console.h"

namespace carom::tools {
namespace {

// Y4M frames have the colours of ITU-R BT.709, which the stream cannot declare. WebP and GIF receive RGB:
// WebP weights colours differently, GIF has a palette. The palette is computed from the first ten frames,
// because ffmpeg keeps all of these in memory; ordered dithering stays the same from frame to frame.
#define CAROM_BT709 "-vf setparams=colorspace=bt709:color_primaries=bt709:color_trc=bt709 -pix_fmt yuv420p"
constexpr FilmKind kKinds[] = {
    {".mp4", "mp4", render::RawFormat::kY4m,
     "-c:v libx264 -preset veryfast -crf 18 -movflags +faststart " CAROM_BT709, true, 0.0},
    {".webm", "webm", render::RawFormat::kY4m,
     "-c:v libvpx-vp9 -crf 30 -b:v 0 -deadline realtime -cpu-used 6 -row-mt 1 " CAROM_BT709, false, 0.0},
    {".gif", "gif", render::RawFormat::kRgb,
     "-filter_complex "
     "split[a][b];[a]trim=end_frame=10,palettegen[p];[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode="
     "rectangle "
     "-loop 0",
     false, 50.0},
    {".webp", "webp", render::RawFormat::kRgb, "-c:v libwebp_anim -quality 85 -loop 0 -pix_fmt yuv420p",
     false, 0.0},
};
#undef CAROM_BT709

std::vector<std::string> command_words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

// The last line of a file that is not empty.
std::string last_line(std::FILE* file) {
    std::rewind(file);
    std::string last;
    std::array<char, 1000> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr) {
        std::string text(line.data());
        text.erase(text.find_last_not_of(" \r\n") + 1);
        if (!text.empty()) last = text;
    }
    return last;
}

}  // namespace

const FilmKind* film_kind(const std::string& path) {
    for (const FilmKind& kind : kKinds)
        if (path.ends_with(kind.ending)) return &kind;
    return nullptr;
}

void require_ffmpeg(const std::string& path) {
    const char* const folders = std::getenv("PATH");
    std::istringstream stream(folders == nullptr ? "" : folders);
    for (std::string folder; std::getline(stream, folder, ':');)
        if (::access((folder + "/ffmpeg").c_str(), X_OK) == 0) return;
    throw std::runtime_error(
        fmt::format("{}: films need ffmpeg, which is not installed; install the package ffmpeg, or write "
                    "frames with -o frames/%05d.png",
                    path));
}

Film::Film(const std::string& path, const FilmKind& kind, FrameSize size, double fps)
    : path_(path), file_(path), messages_(std::tmpfile()) {
    if (messages_ == nullptr) throw std::runtime_error(path + ": cannot make a temporary file");
    try {
        start(kind, size, fps);
        if (kind.input == render::RawFormat::kY4m) {
            const std::string header = render::y4m_header(size, fps);
            write(reinterpret_cast<const std::uint8_t*>(header.data()), header.size());
        }
    } catch (...) {
        end();
        throw;
    }
}

Film::~Film() {
    end();
}

void Film::start(const FilmKind& kind, FrameSize size, double fps) {
    std::string command = "ffmpeg -hide_banner -nostdin -loglevel error -y ";
    command += kind.input == render::RawFormat::kY4m
                   ? "-f yuv4mpegpipe -i pipe:0 "
                   : fmt::format("-f rawvideo -pix_fmt rgb24 -s {}x{} -framerate {} -i pipe:0 ", size.width,
                                 size.height, fps);
    command += fmt::format("{} -f {}", kind.options, kind.muxer);
    std::vector<std::string> words = command_words(command);
    words.push_back("file:" + file_.written());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::runtime_error(path_ + ": cannot make a pipe: " + std::strerror(errno));
    pipe_ = ends[1];
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[0], 0);
    posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ::fileno(messages_), 2);
    // In its own process group: Ctrl-C in the terminal then reaches only carom, which decides what to do.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = ::posix_spawnp(&child_, "ffmpeg", &files, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    ::close(ends[0]);
    if (error != 0) {
        child_ = -1;
        throw std::runtime_error(path_ + ": cannot start ffmpeg: " + std::strerror(error));
    }
    // A write that would block returns instead, so that an interrupt is noticed.
    ::fcntl(pipe_, F_SETFL, ::fcntl(pipe_, F_GETFL) | O_NONBLOCK);
}

void Film::end() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    if (child_ > 0) {
        ::kill(-child_, SIGKILL);  // its group
        while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
        }
        child_ = -1;
    }
    if (messages_ != nullptr) std::fclose(std::exchange(messages_, nullptr));
}

int Film::wait_for_end() {
    ::close(std::exchange(pipe_, -1));  // the end of its input
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0) {
        if (errno != EINTR) throw std::runtime_error(path_ + ": lost ffmpeg: " + std::strerror(errno));
        throw_if_interrupted();
    }
    child_ = -1;
    return status;
}

void Film::fail(int status) {
    const std::string line = last_line(messages_);
    throw std::runtime_error(fmt::format("{}: ffmpeg failed ({}){}{}", path_,
                                         WIFSIGNALED(status)
                                             ? fmt::format("signal {}", WTERMSIG(status))
                                             : fmt::format("exit status {}", WEXITSTATUS(status)),
                                         line.empty() ? "" : ": ", line));
}

void Film::write(const std::uint8_t* bytes, std::size_t count) {
    constexpr int kPatience = 100;  // ms between checks for an interrupt
    // Frames still in flight when ffmpeg failed also reach this line.
    if (pipe_ < 0) throw std::runtime_error(path_ + ": ffmpeg has already ended");
    while (count > 0) {
        throw_if_interrupted();
        const ssize_t written = ::write(pipe_, bytes, count);
        if (written > 0) {
            bytes += written;
            count -= static_cast<std::size_t>(written);
        } else if (errno == EAGAIN) {
            pollfd wait{pipe_, POLLOUT, 0};
            ::poll(&wait, 1, kPatience);
        } else if (errno != EINTR) {
            fail(wait_for_end());
        }
    }
}

void Film::commit() {
    if (const int status = wait_for_end(); status != 0) fail(status);
    file_.commit();
}

}  // namespace carom::tools
