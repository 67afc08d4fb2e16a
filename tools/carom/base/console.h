// Output, progress and interruption of every command.
#pragma once

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace carom::tools {

/// Exit statuses of the program.
inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;
inline constexpr int kBadUsage = 2;
// A run that a signal interrupted returns 128 + the number of the signal: interrupted_status().

/// An option is wrong, or an input other than a scene. The exit status is 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// SIGINT or SIGTERM was received. The exit status is 130 or 143.
class Interrupted : public std::exception {};

/// Sets up signals and the three standard streams, and keeps the command line. Call it once, before anything
/// else. Every message begins with `program`.
void prepare_process(int argc, char** argv, const char* version, const char* program = "carom");

/// The command line in a form that can be typed again; empty in a test that has not called prepare_process().
const std::string& command_line();
const std::string& program_version();

/// Quotes an argument for a shell if it needs quotes.
std::string shell_word(const std::string& argument);

/// "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);

/// Whether print() prints nothing, and message() no warnings and notes: --quiet, or a file on standard
/// output.
bool& quiet();

/// Writes results to standard output, as harmless() makes them: names of files may contain anything. Removes
/// a progress line from the terminal first.
/// @throws BrokenPipe, std::runtime_error if writing fails
void print(std::string_view text);
/// As above for bytes that are not text.
void print_bytes(std::string_view bytes);
void flush_output();

/// Writes one line to standard error, prefixed with the program's name.
void message(std::string_view text);

/// SIGINT and SIGTERM only set a flag, so that no incomplete file is left behind. Long work must check it
/// regularly.
bool interrupted() noexcept;
void throw_if_interrupted();
int interrupted_status() noexcept;

/// A line on standard error that is updated during the work. It is never wider than the terminal, and it
/// is removed before anything else is written. If standard error is not a terminal, nothing is written.
class ProgressLine {
  public:
    explicit ProgressLine(std::string title);
    ~ProgressLine();  ///< removes the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Whether to update the line; then not again for 0.1 s. Cheap, so that callers can check before they
    /// build the text.
    bool due();
    void show_text(std::string_view text);

    void show_bar(std::int64_t done, std::int64_t total);  ///< calls due() itself

  private:
    std::string title_;
    bool terminal_;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace carom::tools
