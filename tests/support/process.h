// Runs a program as a shell would, and captures all its output. For tests of the command line.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/temporary_folder.h"
#include "support/files.h"

namespace carom::test {

/// A temporary folder for one test, removed with its contents.
class TemporaryFolder : public carom::TemporaryFolder {
  public:
    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path() / name, std::ios::binary) << text;
        return file(name);
    }

    /// Names of all entries, including folders, except the mark that identifies the frames' shot.
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path())) {
            const std::string name = entry.path().filename().string();
            if (entry.is_regular_file() && !name.ends_with(".png.shot")) found.push_back(name);
        }
        return found;
    }
};

struct ProcessOptions {
    std::string input;                                             ///< for its standard input
    std::vector<std::pair<std::string, std::string>> environment;  ///< set additionally
    std::string folder;                                            ///< to run in; empty: the test's
    std::string output_to;                                         ///< file or device for its standard output
    long file_limit = -1;       ///< bytes that a file may have; -1: any number
    long stack_limit = -1;      ///< bytes of stack of its threads (RLIMIT_STACK); -1: the test's
    bool close_output = false;  ///< read nothing: its standard output is a broken pipe
};

struct ProcessResult {
    int status = -1;  ///< exit status; 128 + signal if a signal ended it
    std::string out, err;
};

/// A child process with its three standard streams piped.
class Process {
  public:
    Process(const std::vector<std::string>& arguments, const ProcessOptions& options) {
        // A child that does not read its input must not end the test.
        std::signal(SIGPIPE, SIG_IGN);
        int in[2], out[2], err[2];
        if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) {
            throw std::runtime_error("pipe2 failed");
        }
        // Close it before the child runs, which might otherwise finish first.
        if (options.close_output) close_one(out[0]);
        pid_ = ::fork();
        if (pid_ < 0) throw std::runtime_error("fork failed");
        if (pid_ == 0) become(arguments, options, in[0], out[1], err[1]);
        ::close(in[0]);
        ::close(out[1]);
        ::close(err[1]);
        to_ = in[1];
        from_[0] = out[0];
        from_[1] = err[0];
    }
    ~Process() {
        close_one(to_);
        for (int& fd : from_) close_one(fd);
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void interrupt() const { send(SIGINT); }
    void send(int signal) const { ::kill(pid_, signal); }

    /// Current number of its threads.
    int threads() const {
        const std::string tasks = "/proc/" + std::to_string(pid_) + "/task";
        return static_cast<int>(std::distance(std::filesystem::directory_iterator(tasks), {}));
    }

    /// Sends text, and reads standard output to the next line end; "" at its end or after `milliseconds`.
    std::string ask(const std::string& text, int milliseconds) {
        if (::write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return "";
        std::string line;
        for (char c = 0; c != '\n'; line += c) {
            pollfd ready{from_[0], POLLIN, 0};
            if (::poll(&ready, 1, milliseconds) <= 0 || ::read(from_[0], &c, 1) != 1) return "";
        }
        return line;
    }

    /// Sends the input, reads all, waits.
    ProcessResult finish(const std::string& input) {
        ProcessResult result;
        std::string* const texts[2] = {&result.out, &result.err};
        std::size_t sent = 0;
        if (input.empty()) close_one(to_);
        while (from_[0] >= 0 || from_[1] >= 0) {
            pollfd ready[3] = {{from_[0], POLLIN, 0}, {from_[1], POLLIN, 0}, {to_, POLLOUT, 0}};
            if (::poll(ready, 3, 240000) <= 0) break;  // four minutes of silence: the destructor ends it
            for (int i = 0; i < 2; ++i) {
                if (ready[i].revents != 0) read_some(from_[i], *texts[i]);
            }
            if (to_ >= 0 && ready[2].revents != 0) {
                // Small enough for a ready pipe to accept at once.
                const std::size_t count = std::min<std::size_t>(input.size() - sent, 4096);
                const ssize_t done = ::write(to_, input.data() + sent, count);
                if (done > 0) sent += static_cast<std::size_t>(done);
                if (done <= 0 || sent == input.size()) close_one(to_);
            }
        }
        if (from_[0] >= 0 || from_[1] >= 0) ::kill(pid_, SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return result;
    }

  private:
    [[noreturn]] static void become(const std::vector<std::string>& arguments, const ProcessOptions& options,
                                    int in, int out, int err) {
        std::signal(SIGPIPE, SIG_DFL);
        std::signal(SIGINT, SIG_DFL);
        if (!options.output_to.empty()) {
            out = ::open(options.output_to.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        }
        ::dup2(in, 0);
        ::dup2(out, 1);
        ::dup2(err, 2);
        if (options.file_limit >= 0) {
            const rlimit limit{static_cast<rlim_t>(options.file_limit),
                               static_cast<rlim_t>(options.file_limit)};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            // tools/coverage: it could only write the beginning of its counts.
            ::setenv("LLVM_PROFILE_FILE", "/dev/null", 1);
        }
        if (options.stack_limit >= 0) {
            rlimit limit{};
            ::getrlimit(RLIMIT_STACK, &limit);
            limit.rlim_cur = static_cast<rlim_t>(options.stack_limit);
            if (::setrlimit(RLIMIT_STACK, &limit) != 0) ::_exit(125);
        }
        for (const auto& [key, value] : options.environment) ::setenv(key.c_str(), value.c_str(), 1);
        if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
        std::vector<char*> argv;
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        ::execvp(argv[0], argv.data());
        ::_exit(127);
    }

    static void close_one(int& fd) {
        if (fd >= 0) ::close(fd);
        fd = -1;
    }

    static void read_some(int& fd, std::string& text) {
        char buffer[4096];
        const ssize_t count = ::read(fd, buffer, sizeof buffer);
        if (count > 0)
            text.append(buffer, static_cast<std::size_t>(count));
        else
            close_one(fd);
    }

    pid_t pid_ = -1;
    int to_ = -1;
    int from_[2] = {-1, -1};
};

inline ProcessResult run_process(const std::vector<std::string>& arguments,
                                 const ProcessOptions& options = {}) {
    return Process(arguments, options).finish(options.input);
}

}  // namespace carom::test
