// Output, progress and interruption; see console.h.
#include "console.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace carom::tools {
namespace {

/// What is done sooner than this shows no progress: a line that flashes by is noise.
constexpr std::chrono::milliseconds kPatience(300);

/// Written by the handler, read by every thread that works.
std::atomic<int> g_interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait");
volatile std::sig_atomic_t g_signal = SIGINT;

void on_interrupt(int signal) {
    g_signal = signal;
    ++g_interrupts;
    // Whoever presses Ctrl-C a third time wants out now, whatever it leaves behind.
    if (g_interrupts >= 3) ::_exit(128 + signal);
}

void catch_interrupt(int signal) {
    // A shell starts background jobs with SIGINT ignored: so it stays.
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) return;
    // No SA_RESTART: a read that waits for input must return.
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    ::sigaction(signal, &action, nullptr);
}

[[noreturn]] void output_failed() {
    const int reason = errno;
    if (reason == EPIPE) throw OutputClosed();
    throw std::runtime_error(std::string("standard output: ") + std::strerror(reason));
}

}  // namespace

void prepare_process() {
    // A closed standard stream must not lend its number to the first file that is opened. Opened the wrong
    // way round, so that using it fails as if it were closed.
    for (int fd = 0; fd <= 2; ++fd) {
        if (::fcntl(fd, F_GETFD) != -1) continue;
        if (::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) < 0) ::_exit(kFailed);
    }
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe shows as a failed write
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow, too: the half that stands is removed
    catch_interrupt(SIGINT);
    catch_interrupt(SIGTERM);
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) output_failed();
}

void flush_output() {
    if (std::fflush(stdout) != 0) output_failed();
}

void message(std::string_view text) {
    const std::string line = fmt::format("carom: {}\n", text);
    std::fwrite(line.data(), 1, line.size(), stderr);
}

bool interrupted() noexcept {
    return g_interrupts != 0;
}

int interrupted_status() noexcept {
    return 128 + g_signal;
}

void throw_if_interrupted() {
    if (interrupted()) throw Interrupted();
}

ProgressLine::ProgressLine(std::string title)
    : title_(std::move(title)),
      terminal_(::isatty(2) == 1),
      next_(std::chrono::steady_clock::now() + kPatience) {}

ProgressLine::~ProgressLine() {
    if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::due() {
    if (!terminal_) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(100);
    return true;
}

void ProgressLine::show_text(std::string_view text) {
    const std::string line = fmt::format("\r\033[K{} {}", title_, text);
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
    drawn_ = true;
}

void ProgressLine::show_bar(long done, long total) {
    if (!due()) return;
    constexpr int kWidth = 40;
    const double part =
        total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 1.0;
    const auto filled = static_cast<std::size_t>(part * kWidth);
    show_text(fmt::format("[{}{}] {} of {}", std::string(filled, '#'), std::string(kWidth - filled, '.'),
                          done, total));
}

}  // namespace carom::tools
