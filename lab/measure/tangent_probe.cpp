// Plays a scene, optionally with its derivatives, for lab/measure/tangent_cost.py:
// tangent_probe SCENE shot|plan|tangents|margins ROUNDS KEY...
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"

int main(int argc, char** argv) {
    using namespace carom;
    if (argc < 5) return 2;
    const std::string what = argv[2];
    const std::vector<std::string> keys(argv + 4, argv + argc);
    const auto [isa, problem] = kernel::isa_from_environment();
    if (*problem != '\0') return 2;
    const Scene scene = read_scene(argv[1]);
    const Plan plan = make_plan(scene, isa);
    const Record record = simulate(plan);
    double sum = 0.0;
    for (long round = std::strtol(argv[3], nullptr, 10); round > 0; --round) {
        if (what == "plan") {
            sum += make_plan(scene, isa).gravity;
        } else if (what == "shot") {
            sum += simulate(plan).duration;
        } else {
            const Tangents tangents(plan, record, keys);
            if (what == "margins") sum += tangents.margins()[0].up;
            sum += tangents.at_end(0, 0).position.x();
        }
    }
    std::printf("%g\n", sum);
    return 0;
}
