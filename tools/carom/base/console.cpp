// Output, progress and interruption; see console.h.
#include "base/console.h"

#include "base/output_file.h"
#include "carom/engine/printable.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace carom::tools {
namespace {

/// Shorter work shows no progress line.
constexpr std::chrono::milliseconds kPatience(300);

/// Written by the handler, read by every thread that works.
std::atomic<int> g_interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not block");
volatile std::sig_atomic_t g_signal = SIGINT;

void on_interrupt(int signal) {
    g_signal = signal;
    ++g_interrupts;
    // A third Ctrl-C ends the program at once, even if incomplete files are left.
    if (g_interrupts >= 3) ::_exit(128 + signal);
}

void catch_interrupt(int signal) {
    // A shell starts background jobs with SIGINT ignored; keep it ignored.
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) return;
    // SA_RESTART is not set: a read that waits for input must return.
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    ::sigaction(signal, &action, nullptr);
}

/// Whether the terminal shows a progress line. There is at most one, whichever object wrote it.
std::atomic<bool> g_line_stands = false;

void wipe_line() {
    if (g_line_stands.exchange(false)) std::fputs("\r\033[K", stderr);
}

/// Columns available to a progress line now; the window may have been resized. A terminal that does not
/// report its width counts as 80 columns wide. Three columns stay free: a wrapped line could not be removed,
/// and Ctrl-C is echoed as "^C".
std::size_t columns() {
    struct winsize size {};
    constexpr std::size_t kUsual = 80, kFree = 3;
    const std::size_t all = ::ioctl(2, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
    return all - std::min(all, kFree);
}

/// The command line and the version from prepare_process().
std::string& kept_command_line() {
    static std::string line;
    return line;
}
std::string& kept_program() {
    static std::string name = "carom";
    return name;
}

std::string& kept_version() {
    static std::string version;
    return version;
}

[[noreturn]] void output_failed() {
    const int reason = errno;
    if (reason == EPIPE) throw BrokenPipe("standard output: the reader has closed the pipe");
    throw std::runtime_error(std::string("standard output: ") + std::strerror(reason));
}

}  // namespace

std::string shell_word(const std::string& argument) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::strchr("-_./=,:+%@", c) != nullptr;
    };
    if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) return argument;
    std::string out = "'";
    for (const char c : argument) {
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    out += '\'';
    return out;
}

const std::string& command_line() {
    return kept_command_line();
}

const std::string& program_version() {
    return kept_version();
}

void prepare_process(int argc, char** argv, const char* version, const char* program) {
    kept_version() = version;
    kept_program() = program;
    kept_command_line() = program;
    for (int i = 1; i < argc; ++i) kept_command_line() += " " + shell_word(argv[i]);
    // If a standard stream is closed, the next file opened would take its number. Open /dev/null in its
    // place, in the wrong direction, so that using the stream fails as if it were still closed.
    for (int fd = 0; fd <= 2; ++fd) {
        if (::fcntl(fd, F_GETFD) != -1) continue;
        if (::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) < 0) ::_exit(kFailed);
    }
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is seen as a failed write
    std::signal(SIGXFSZ, SIG_IGN);  // so is the file size limit; the incomplete file is removed
    catch_interrupt(SIGINT);
    catch_interrupt(SIGTERM);
}

std::string counted(std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

bool& quiet() {
    static bool value = false;
    return value;
}

void print(std::string_view text) {
    if (!quiet()) print_bytes(harmless(text));
}

void print_bytes(std::string_view bytes) {
    // If output goes to a file or a pipe, keep the line: it may show the progress of this output.
    static const bool on_terminal = ::isatty(1) == 1;
    if (on_terminal) wipe_line();
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size()) output_failed();
}

void flush_output() {
    wipe_line();
    if (std::fflush(stdout) != 0) output_failed();
}

void message(std::string_view text) {
    if (quiet() && (text.starts_with("warning: ") || text.starts_with("note: "))) return;
    const std::string line = fmt::format("{}: {}\n", kept_program(), harmless(text));
    wipe_line();
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
    wipe_line();
}

bool ProgressLine::due() {
    if (!terminal_) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(100);
    return true;
}

void ProgressLine::show_text(std::string_view text) {
    std::string line = fmt::format("{} {}", title_, text);
    line.resize(std::min(line.size(), columns()));
    line.insert(0, "\r\033[K");
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
    g_line_stands = true;
}

void ProgressLine::show_bar(std::int64_t done, std::int64_t total) {
    if (!due()) return;
    constexpr std::size_t kWidest = 40, kNarrowest = 5;
    const double part =
        total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 1.0;
    const std::string numbers = fmt::format("{} of {}", done, total);
    // The line is the title, a space, the bar in brackets, a space, and the numbers.
    const std::size_t other = title_.size() + numbers.size() + 4, all = columns();
    const std::size_t width = std::min(kWidest, all - std::min(all, other));
    if (width < kNarrowest) {
        show_text(numbers);
        return;
    }
    const auto filled = static_cast<std::size_t>(part * static_cast<double>(width));
    show_text(fmt::format("[{}{}] {}", std::string(filled, '#'), std::string(width - filled, '.'), numbers));
}

}  // namespace carom::tools
