// What every sub-command shares at the edge to the person or program that called it: output, progress, interruption.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>

namespace carom::tools {

/// Exit statuses of the program.
inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;
inline constexpr int kBadUsage = 2;
// Interrupted by a signal: 128 + its number, interrupted_status().

/// A bad option, or bad input other than a scene: exit status 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// SIGINT or SIGTERM came: exit status 130 or 143.
class Interrupted : public std::exception {};

/// The reader of standard output has gone (`carom ... | head -1`): exit status 1, without a word.
class OutputClosed : public std::exception {};

/// Sets up signals and the three standard streams; call once, first.
void prepare_process();

/// "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);

/// Results. A progress line that stands on the terminal is wiped first. Failures to write are errors, not
/// lost output. @throws OutputClosed, std::runtime_error
void print(std::string_view text);
void flush_output();

/// One line on standard error, with the program's name in front.
void message(std::string_view text);

/// SIGINT and SIGTERM only set a flag, so that nothing half-written stays; long work asks here now and then.
bool interrupted() noexcept;
void throw_if_interrupted();
int interrupted_status() noexcept;

/// A line on standard error that renews itself while work goes on; silent when that is no terminal. It is as
/// long as the terminal is wide, at most, and gone when anything else is written.
class ProgressLine {
  public:
    explicit ProgressLine(std::string title);
    ~ProgressLine();  ///< wipes the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Whether it is time to renew the line; if so, not again for a while. Cheap, so that callers build their
    /// text only then.
    bool due();
    void show_text(std::string_view text);

    void show_bar(long done, long total);  ///< asks due() itself

  private:
    std::string title_;
    bool terminal_;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace carom::tools
