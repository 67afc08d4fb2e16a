// Runs a program on its own terminal, as seen by a person: the contents of the screen, and Ctrl-C.
#pragma once

#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom::test {

/// The screen of a terminal of this width after all of `text`: lines without trailing spaces. Understands the
/// program's output: line ends, carriage returns, and "erase to the end of the line".
inline std::vector<std::string> screen_of(const std::string& text, std::size_t columns) {
    std::vector<std::string> lines(1);
    std::size_t column = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (text.compare(i, 3, "\033[K") == 0) {
            lines.back().resize(std::min(lines.back().size(), column));
            i += 2;
        } else if (c == '\r') {
            column = 0;
        } else if (c == '\n') {
            lines.emplace_back();
            column = 0;
        } else {
            if (column == columns) {
                lines.emplace_back();
                column = 0;
            }
            std::string& line = lines.back();
            line.resize(std::max(line.size(), column + 1), ' ');
            line[column++] = c;
        }
    }
    for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

class Terminal {
  public:
    explicit Terminal(std::vector<std::string> arguments, unsigned short columns = 100) : columns_(columns) {
        struct winsize size {};
        size.ws_row = 24;
        size.ws_col = columns;
        pid_ = ::forkpty(&fd_, nullptr, nullptr, &size);
        if (pid_ < 0) throw std::runtime_error("forkpty failed");
        if (pid_ > 0) return;
        ::setenv("CAROM_ISA", "scalar", 1);
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        ::execvp(argv[0], argv.data());
        ::_exit(127);
    }
    ~Terminal() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(fd_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// Reads until this text appears; false if the program ended, or after two minutes.
    bool see(const std::string& what) {
        const auto enough = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (seen_.find(what) == std::string::npos)
            if (std::chrono::steady_clock::now() > enough || !read_some()) return false;
        return true;
    }

    void press_ctrl_c() const {
        if (::write(fd_, "\003", 1) != 1) throw std::runtime_error("cannot write to the terminal");
    }

    /// Reads the rest. Exit status; 128 + signal if a signal ended it, SIGKILL after two minutes.
    int finish() {
        const auto enough = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (std::chrono::steady_clock::now() < enough && read_some()) {
        }
        if (!ended_) ::kill(pid_, SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

    const std::string& seen() const { return seen_; }  ///< every byte
    std::vector<std::string> screen() const { return screen_of(seen_, columns_); }

  private:
    bool read_some() {
        char buffer[4096];
        pollfd ready{fd_, POLLIN, 0};
        if (::poll(&ready, 1, 120000) <= 0) return false;
        const ssize_t count = ::read(fd_, buffer, sizeof buffer);
        ended_ = count <= 0;  // the other end of a terminal ends with an error
        if (!ended_) seen_.append(buffer, static_cast<std::size_t>(count));
        return !ended_;
    }

    unsigned short columns_;
    int fd_ = -1;
    pid_t pid_ = -1;
    bool ended_ = false;
    std::string seen_;
};

}  // namespace carom::test
