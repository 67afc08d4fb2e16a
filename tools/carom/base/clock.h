// Time for benchmarks: this thread's processor time, so that other work on the machine affects it as little
// as possible.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "carom/kernel/splitmix64.h"

namespace carom::tools {

/// Processor time of this thread [ns].
inline double thread_ns() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

/// Length of a cycle [ns]: each addition in a dependent chain takes one cycle. The chain adds a register,
/// because some processors fold additions of constants when they rename registers.
inline double cycle_ns() {
    constexpr int kAdds = 100000;
    double best = 1e30;
    for (int repeat = 0; repeat < 20; ++repeat) {
        long x = repeat, step = repeat | 1;
        const double start = thread_ns();
        for (int i = 0; i < kAdds / 10; ++i)
            asm volatile(
                "add %1, %0\n\tadd %1, %0\n\tadd %1, %0\n\tadd %1, %0\n\tadd %1, %0\n\t"
                "add %1, %0\n\tadd %1, %0\n\tadd %1, %0\n\tadd %1, %0\n\tadd %1, %0"
                : "+r"(x)
                : "r"(step));
        best = std::min(best, (thread_ns() - start) / kAdds);
    }
    return best;
}

/// The smallest value; 0 if there are none.
inline double minimum(const std::vector<double>& x) {
    return x.empty() ? 0.0 : *std::min_element(x.begin(), x.end());
}

/// The middle value, or the mean of the two middle ones; 0 if there are none.
inline double median(std::vector<double> x) {
    if (x.empty()) return 0.0;
    std::sort(x.begin(), x.end());
    const std::size_t half = x.size() / 2;
    return x.size() % 2 ? x[half] : 0.5 * (x[half - 1] + x[half]);
}

// Interleaved rounds: alternatives are measured alternately, in a new order each round, so that a drift of
// the machine's speed favours none.

/// Calls measure(i) for every i in 0..count-1, `rounds` times, in a new seeded order each round, with a
/// progress bar. SIGINT ends it. @returns for each i what measure(i) returned in each round
inline std::vector<std::vector<double>> interleaved(const std::string& title, std::size_t count, int rounds,
                                                    const std::function<double(std::size_t)>& measure) {
    std::vector<std::vector<double>> samples(count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    SplitMix64 rng(99);
    ProgressLine progress(title);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[rng.next() % i]);
        for (std::size_t k = 0; k < count; ++k) {
            throw_if_interrupted();
            samples[order[k]].push_back(measure(order[k]));
            progress.show_bar(round * static_cast<std::int64_t>(count) + static_cast<std::int64_t>(k) + 1,
                              rounds * static_cast<std::int64_t>(count));
        }
    }
    return samples;
}

}  // namespace carom::tools
