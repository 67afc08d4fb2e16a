// Batches of carom-lab bench shot: successive random shots, as in a search or in training.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "reference/random_impacts.h"

namespace carom::tools {

/// One kind of batch. Each shot draws its numbers, is set, checked, planned and played, and its outcome read.
class ManyShots {
  public:
    /// @param name one of many_names() @throws std::invalid_argument for an unknown one
    ManyShots(const std::string& name, kernel::Isa isa);

    /// The next `shots` shots of an endless sequence, the same in every run. @throws std::runtime_error if
    /// one has no result
    void play(std::size_t shots);
    void rewind();

    /// Shots in a round of the benchmark: a few milliseconds.
    std::size_t shots_a_round() const { return shots_a_round_; }
    /// Mean number per shot since rewind().
    double events() const { return static_cast<double>(events_) / static_cast<double>(shots_); }
    double clusters() const { return static_cast<double>(clusters_) / static_cast<double>(shots_); }
    /// Balls pocketed since rewind(), to make sure that outcomes are read.
    long pocketed() const { return pocketed_; }

  private:
    void aim_at_rack();

    struct Number {
        SceneNumber number;
        double low, high;
    };
    std::string name_;
    Simulator simulator_;
    reference::Generator random_;
    std::vector<Number> numbers_;
    std::size_t shots_a_round_;
    double off_;
    std::size_t shots_ = 0;
    std::int64_t events_ = 0, clusters_ = 0;
    long pocketed_ = 0;
};

/// Names of the batches, in the order of the table.
std::vector<std::string> many_names();

}  // namespace carom::tools
