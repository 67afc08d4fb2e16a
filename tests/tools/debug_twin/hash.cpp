// Prints what `carom simulate SCENE --hash` prints.
#include <cstdio>
#include <exception>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/isa.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const auto [isa, problem] = carom::kernel::isa_from_environment();
    if (*problem != '\0') return 2;
    try {
        std::puts(carom::simulate(carom::make_plan(carom::read_scene(argv[1]), isa)).hash().c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
