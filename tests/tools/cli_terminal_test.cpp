// Long work at a terminal: a moving progress line, no trace of it under the final output, and Ctrl-C.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "on_a_terminal.h"

namespace carom::test {
namespace {

class OnATerminal : public LongWork {
  protected:
    OnATerminal() : LongWork(CAROM_PROGRAM) {}
};

TEST_F(OnATerminal, RenderShowsProgress) {
    const std::string frames = folder_.file("f/%05d.png");
    moves_and_stops({"render", scene_, "--fps", "90000", "--size", "320x180", "-o", frames}, "rendering: [");
}

// The only visible part of one large picture is its table.
TEST_F(OnATerminal, OneLargePictureShowsProgress) {
    moves_and_stops({"render", scene_, "--at", "0", "--size", "3200x1800", "-o", folder_.file("%d.png")},
                    "rendering: the table, ");
}

TEST_F(OnATerminal, ASheetShowsProgress) {
    moves_and_stops(
        {"render", kBreak, "--sheet", "100x50", "--size", "12800x7200", "-o", folder_.file("s.png")},
        "rendering: [");
}

TEST_F(OnATerminal, MarginShowsProgress) {
    moves_and_stops({"margin", kBreak, "--repeat", "1000", "--size", "640x360"}, "run ");
}

TEST_F(OnATerminal, AccuracyShowsProgress) {
    moves_and_stops({"accuracy", kBreak, "--repeat", "1000"}, "accuracy, times: [");
}

TEST_F(OnATerminal, SweepShowsProgress) {
    moves_and_stops({"sweep", kBreak, "--vary", "rack.seed=integer(1,9)", "--count", "10000000", "--jobs",
                     "1", "-o", "/dev/null"},
                    "sweep [");
}

TEST_F(OnATerminal, SimulateShowsProgress) {
    std::string endless(kSmallScene);
    endless +=
        "[balls]\nmu_s = 0\nmu_r = 0\nmu_sp = 0\nmu_b = 0\ne_b = 1\ne_c = 1\nf_c = 0\n[physics]\nball_ball = "
        "\"elastic\"\ncushion = \"smooth\"\n[stop]\ntime = 1e8\n";
    const std::string bare = endless.substr(endless.find("[[ball]]"));
    const std::string box =
        "[[table.cushion]]\nfrom = [0, 0]\nto = [0, 2.54]\n[[table.cushion]]\nfrom = [0, 2.54]\nto = [1.27, "
        "2.54]\n"
        "[[table.cushion]]\nfrom = [1.27, 2.54]\nto = [1.27, 0]\n[[table.cushion]]\nfrom = [1.27, 0]\nto = "
        "[0, 0]\n";
    const std::string scene = folder_.write("endless.toml", box + bare);
    moves_and_stops({"simulate", scene}, "simulating: ");
    moves_and_stops({"compare", scene_, scene}, "simulating: ");
}

// The summary has its own line, as does every line after it.
TEST_F(OnATerminal, ProgressLeavesNoTraceUnderTheSummary) {
    Terminal terminal(
        {CAROM_PROGRAM, "render", scene_, "--size", "1280x720", "--to", "1", "-o", folder_.file("%d.png")});
    ASSERT_EQ(terminal.finish(), 0) << terminal.seen();
    EXPECT_TRUE(contains(terminal.seen(), "\r\033[Krendering: ")) << "too fast to be seen";
    const std::vector<std::string> screen = terminal.screen();
    ASSERT_GE(screen.size(), 2u);
    EXPECT_EQ(screen[0], "61 frames, 1280x720 at 60 fps: " + folder_.file("%d.png")) << terminal.seen();
    EXPECT_EQ(screen[1].substr(0, 19), "to make a film of t") << terminal.seen();
}

TEST_F(OnATerminal, ANarrowTerminalAlsoHasOneLine) {
    for (const unsigned short columns : {50, 20, 10}) {
        Terminal terminal({CAROM_PROGRAM, "sweep", kBreak, "--vary", "rack.seed=integer(1,9)", "--count",
                           "10000000", "--jobs", "1", "-o", "/dev/null"},
                          columns);
        EXPECT_TRUE(terminal.see("\r\033[Kswee"));
        EXPECT_TRUE(columns < 20 || terminal.see("of 10")) << terminal.seen();
        terminal.press_ctrl_c();
        EXPECT_EQ(terminal.finish(), 130);
        for (const std::string& line : terminal.screen())
            EXPECT_FALSE(contains(line, "swee")) << columns << ": " << all_of(terminal.screen());
    }
}

}  // namespace
}  // namespace carom::test
