// Shared by the tests of long work at a terminal.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/terminal.h"
#include "tools/cli.h"

namespace carom::test {

inline std::string all_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

/// A break with more frames and shots than anyone would wait for.
inline const std::string kBreak = std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml";

class LongWork : public ::testing::Test {
  protected:
    /// The work would last far too long: once its line appears, Ctrl-C ends it and removes the line.
    void moves_and_stops(const std::vector<std::string>& arguments, const std::string& line) {
        std::vector<std::string> command{program_};
        command.insert(command.end(), arguments.begin(), arguments.end());
        Terminal terminal(command);
        EXPECT_TRUE(terminal.see("\r\033[K" + line)) << terminal.seen();
        terminal.press_ctrl_c();
        EXPECT_EQ(terminal.finish(), 130) << terminal.seen();
        EXPECT_FALSE(contains(all_of(terminal.screen()), line)) << all_of(terminal.screen());
    }

    explicit LongWork(const char* program) : program_(program) {}

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);

  private:
    const char* program_;
};

}  // namespace carom::test
