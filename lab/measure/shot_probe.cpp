// Runs one shot, for lab/measure/callgrind_shot.py: shot_probe NAME SEED [RUNS], or shot_probe gas N EVENTS
// (collisions pair by pair; "gas compliant" uses the default model of clusters), or shot_probe 'many
// two_ball' SHOTS. Prints the kind of event of every iteration of the loop in the last run, one per line.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/many_shots.h"
#include "bench/shot_cases.h"
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"

int main(int argc, char** argv) {
    using namespace carom;
    if (argc < 3) {
        std::fprintf(stderr,
                     "usage: shot_probe NAME SEED [RUNS] | shot_probe gas N EVENTS | shot_probe 'gas "
                     "compliant' N EVENTS; NAME is one of");
        for (const std::string& name : tools::shot_names()) std::fprintf(stderr, " '%s'", name.c_str());
        std::fprintf(stderr, "\n");
        return 2;
    }
    const std::string name = argv[1];
    const long number = std::strtol(argv[2], nullptr, 10),
               third = argc > 3 ? std::strtol(argv[3], nullptr, 10) : 1;
    const auto [isa, problem] = kernel::isa_from_environment();
    if (*problem != '\0') return 2;
    if (name.rfind("many ", 0) == 0) {  // a batch with this number of shots; prints the balls pocketed
        tools::ManyShots many(name, isa);
        many.play(static_cast<std::size_t>(number));
        std::printf("%ld\n", many.pocketed());
        return 0;
    }
    const bool gas = name == "gas" || name == "gas compliant";
    Scene scene = gas ? tools::gas_scene(static_cast<int>(number), third, 1)
                      : tools::shot_scene(name, static_cast<std::uint64_t>(number));
    if (name == "gas compliant") scene.physics.clusters = ClusterModel::kCompliant;
    const Plan plan = make_plan(scene, isa);
    std::vector<std::size_t> ends;  // number of events at the end of every iteration
    ends.reserve(100000);
    Record record;
    for (long run = gas ? 1 : third; run > 0; --run) {
        SimulateOptions options;
        options.progress_rounds = 1;
        options.progress = [&ends](std::size_t events, double) { ends.push_back(events); };
        ends.clear();
        record = simulate(plan, options);
    }
    std::size_t begin = scene.cue ? 1 : 0;
    for (const std::size_t end : ends) {
        std::printf("%s\n", end > begin ? carom::name(record.events[begin].type) : "no event");
        begin = end;
    }
    return 0;
}
