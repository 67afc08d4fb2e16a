// Interleaved rounds: alternatives are measured alternately, in a new order each round, so that a drift of
// the machine's speed favours none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "carom/kernel/splitmix64.h"

namespace carom::tools {

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
