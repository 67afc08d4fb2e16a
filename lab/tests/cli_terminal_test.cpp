// Long measurements at a terminal: a moving progress line, and Ctrl-C.
#include "tools/on_a_terminal.h"

namespace carom::test {
namespace {

class LabOnATerminal : public LongWork {
  protected:
    LabOnATerminal() : LongWork(CAROM_LAB_PROGRAM) {}
};

TEST_F(LabOnATerminal, EveryMeasurementShowsProgress) {
    moves_and_stops({"margin", kBreak, "--sweep", "--no-render", "--repeat", "1000"}, "margin --sweep: [");
    moves_and_stops({"accuracy", "kernel", "--count", "1000000"}, "accuracy kernel, converged solutions: [");
    moves_and_stops({"bench", "kernel", "--random", "1", "--repeat", "1000", "--no-growth"},
                    "bench kernel [");
    moves_and_stops({"bench", "shot", "--seeds", "1", "--repeat", "1000", "--no-growth"}, "bench shot [");
    moves_and_stops({"bench", "render", scene_, "--frames", "100000"}, "bench render [");
}

}  // namespace
}  // namespace carom::test
