// Simulates a scene a number of times without profiling: what tools/measure/profile_cost counts the instructions of.
// Usage: profile_probe SCENE RUNS
#include <cstdio>
#include <cstdlib>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/isa.h"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    // The narrowest instruction set: valgrind does not know the widest.
    const carom::Plan plan = carom::make_plan(carom::read_scene(argv[1]), carom::kernel::Isa::kScalar);
    std::size_t events = 0;
    for (int run = 0; run < std::atoi(argv[2]); ++run) events += carom::simulate(plan).events.size();
    std::printf("%zu\n", events);
    return 0;
}
