// Runs one kernel variant on the paper's five states, for tools that observe a whole process:
// one_variant NAME ISA CALLS [N]. Prints the number of steps and the shortest time of one impact [ns].
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/clock.h"
#include "bench/five_states.h"
#include "ladder/ladder.h"

int main(int argc, char** argv) {
    using namespace carom;
    kernel::Isa isa{};
    if (argc < 4 || !kernel::parse_isa(argv[2], isa) || !kernel::available(isa)) {
        std::fprintf(stderr, "usage: one_variant NAME scalar|v3|v4 CALLS [N]\n");
        return 2;
    }
    const int n = argc > 4 ? std::atoi(argv[4]) : 1000;
    for (const kernel::Variant& variant : kernel::ladder()) {
        if (std::strcmp(variant.name, argv[1]) != 0 || variant.isa != isa || variant.march == nullptr)
            continue;
        long steps = 0;
        double least = 1e30;
        for (long i = 0; i < std::atol(argv[3]); ++i) {
            const double start = tools::thread_ns();
            for (const tools::BenchImpact& s : tools::kFiveStates) {
                kernel::ImpactResult out;
                variant.march(s.ball1, s.ball2, s.params, n, out);
                steps += out.steps;
            }
            least = std::min(least, (tools::thread_ns() - start) / 5.0);
        }
        std::printf("%ld %.1f\n", steps, least);
        return 0;
    }
    std::fprintf(stderr, "one_variant: no variant \"%s\" for one impact on %s\n", argv[1], argv[2]);
    return 2;
}
