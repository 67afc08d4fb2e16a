// Candidate shots of a search, played with the errors of a hand and in the layouts of its options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "carom/games/solve.h"

namespace carom::games::detail {

struct Candidate {
    std::vector<double> values;
    std::size_t shots = 0, successes = 0, invalid = 0;
    double score() const {
        return shots == 0 ? 0.0 : static_cast<double>(successes) / static_cast<double>(shots);
    }
};

class Trials {
  public:
    /// @throws std::invalid_argument as solve()
    Trials(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options);

    /// Plays the next shots of all candidates until each has `shots`.
    void play(std::vector<Candidate>& candidates, std::size_t shots,
              const std::function<void(std::size_t, const Record&)>& look = {});
    /// The scene of a shot without errors.
    Scene meant_scene(const std::vector<double>& values) const;
    std::size_t played() const { return played_; }

    bool fresh = false;   ///< draws errors that no earlier shot used
    bool exact = false;   ///< plays exact tables
    double turned = 0.0;  ///< [degrees] added to all aims

  private:
    /// The errors of a stroke.
    struct Draw {
        double aim, speed, side, height, elevation;
    };
    int ball_of(const std::string& id) const;
    double speed_of(std::vector<double> row, double ball_speed) const;
    Draw draw(std::uint64_t index) const;
    std::vector<double> meant(const std::vector<double>& values) const;
    void add_table_keys();
    const std::vector<double>& table(std::size_t trial);
    void play_rows(std::span<Candidate> candidates, std::size_t shots, std::size_t rows,
                   const std::function<void(std::size_t, const Record&)>& look);

    const Scene& scene_;
    const Measure& want_;
    kernel::Isa isa_;
    const SolveOptions& options_;
    std::size_t struck_ = 0;
    int hit_ = -1;
    std::vector<std::string> keys_;
    // The column of every key of a table, its values in the scene, and its values per trial: seen by the
    // search, fresh, and the same two on exact tables.
    std::vector<std::size_t> columns_;
    std::vector<double> usual_;
    std::vector<std::vector<double>> tables_[4];
    std::vector<bool> resized_;  // balls whose sizes differ from table to table
    std::size_t chosen_ = 0, played_ = 0;
};

}  // namespace carom::games::detail
