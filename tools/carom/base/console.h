// What every command uses to talk to the person or program that called it: output, progress, interruption.
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
// A run that a signal interrupted returns 128 + the number of the signal: interrupted_status().

/// An option is wrong, or input other than a scene is. The exit status is 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// SIGINT or SIGTERM was received. The exit status is 130 or 143.
class Interrupted : public std::exception {};

/// The reader of standard output has ended (`carom ... | head
/// -1`). The exit status is 1, and no message is printed.
class OutputClosed : public std::exception {};

/// Sets up signals and the three standard streams, and keeps the command line.
/// Must be called once, before anything else. `program`: how messages begin.
void prepare_process(int argc, char** argv, const char* version, const char* program = "carom");

/// How the program was called, as it can be typed again;
/// empty in a test that has not called prepare_process().
const std::string& command_line();
const std::string& program_version();

/// An argument as a shell takes it: in quotes where it has to be.
std::string shell_word(const std::string& argument);

/// "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);

/// Writes results to standard output, as harmless(): names of files may hold anything. A progress line on the
/// terminal is removed first. A failure to write is an error.
/// @throws OutputClosed, std::runtime_error
void print(std::string_view text);
/// The same with what is no text.
void print_bytes(std::string_view bytes);
void flush_output();

/// Writes one line to standard error, which begins with the name of the program.
void message(std::string_view text);

/// SIGINT and SIGTERM only set a flag, so that no incomplete
/// file is left. Long work must ask for it regularly.
bool interrupted() noexcept;
void throw_if_interrupted();
int interrupted_status() noexcept;

/// A line on standard error that is renewed while work goes on. Nothing is
/// written if standard error is not a terminal. The line is not longer than
/// the terminal is wide, and it is removed before anything else is written.
class ProgressLine {
  public:
    explicit ProgressLine(std::string title);
    ~ProgressLine();  ///< removes the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Whether it is time to renew the line; if so, the next true answer comes 0.1 s later. The call is
    /// cheap, so that callers can make their text only when it is needed.
    bool due();
    void show_text(std::string_view text);

    void show_bar(long done, long total);  ///< calls due() itself

  private:
    std::string title_;
    bool terminal_;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace carom::tools
