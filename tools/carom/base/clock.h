// Time for benchmarks: this thread's processor time, so that other work on the machine affects it as little
// as possible.
#pragma once

#include <time.h>

#include <algorithm>
#include <ctime>
#include <vector>

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

}  // namespace carom::tools
