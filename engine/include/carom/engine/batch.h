// Many shots of one scene: outcomes instead of records, in memory that is taken once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"

namespace carom {

/// How a shot of a batch ended: as StopReason says, or without a result.
enum class ShotStatus : std::uint8_t {
    kAtRest,
    kTime,
    kEvents,
    kEndless,
    kInvalid,  ///< its values make no valid scene
    kFailed,   ///< the simulation could not go on
};
inline constexpr int kShotStatuses = 6;
constexpr auto names_of(ShotStatus) {
    std::array<const char*, kShotStatuses> names{"", "", "", "", "invalid", "failed"};
    for (std::size_t i = 0; i < kStopWords.size(); ++i) names[i] = kStopWords[i].word;
    return names;
}
constexpr bool has_result(ShotStatus status) {
    return status < ShotStatus::kInvalid;
}

/// Plays one shot after the other; after the first ones a shot takes no
/// memory, unless it fails or has resting contacts. One thread at a time.
class Simulator {
  public:
    /// @param scene  need not be valid before the first shot changes it
    /// @param isa    must be available
    Simulator(const Scene& scene, kernel::Isa isa);

    /// The scene of the next shot. Its numbers may be changed between shots, nothing else.
    Scene& scene() { return planner_.scene(); }

    /// Checks, plans and plays the scene.
    /// @param change  at least what was changed since the last shot that had a result
    /// @throws only what options.progress throws, and std::bad_alloc
    ShotStatus play(Change change, const SimulateOptions& options = {});
    /// The same for a scene of its own, which is valid (it comes from a reader).
    ShotStatus play(const Scene& scene, const SimulateOptions& options = {});
    /// The same for a shot of a variation whose base() this simulator was made for. All shots have to be of
    /// this one.
    /// @param values  receives what was drawn, as VariedShot
    ShotStatus play(const Variation& variation, std::uint64_t index, std::vector<std::string>& values,
                    const SimulateOptions& options = {});
    /// From now on shots have a record too, in memory that is kept.
    void keep_records() { records_ = true; }
    /// Sets the message of a shot that cannot be played. @return kInvalid
    ShotStatus refuse(std::string why);

    const Outcome& outcome() const { return outcome_; }      ///< of the last shot, if it has a result
    const Record& record() const { return record_; }         ///< the same, if keep_records()
    const std::string& message() const { return message_; }  ///< why it has none

  private:
    ShotStatus run(bool same_table, const SimulateOptions& options);

    Planner planner_;
    RunBuffers buffers_;
    Outcome outcome_;
    Record record_;
    std::string message_;
    bool records_ = false;
    bool checked_ = false;  // what no change of numbers can break
};

/// A number that differs from shot to shot.
struct BatchColumn {
    std::string key;                 ///< as SceneNumber takes it
    std::span<const double> values;  ///< one for each shot
};

struct BatchOptions {
    int threads = 0;             ///< 0: one for each core. The results do not depend on it.
    bool hash = false;           ///< fill Batch::hash
    SimulateOptions simulate{};  ///< `progress` is not called, nothing is profiled
    /// Empty, or for every ball of every shot whether it is left out (not 0). Such a shot is that of the
    /// scene without these balls; they have no numbers (NaN) as x and y, no pocket and no cushion.
    std::span<const std::uint8_t> absent{};
    /// Called by each thread between shots; true ends the batch with an exception of type BatchStopped.
    std::function<bool()> stop{};
    /// Called by each thread for its shots that have a result, when the arrays have it: what
    /// judges shots reads them here, and they need not be played again. Both are lent for the
    /// call; balls that were left out are in neither. What it throws ends the batch.
    std::function<void(std::size_t shot, const Outcome& outcome, const Record& record)> judge{};
    /// Only shots whose number is a multiple of it (not 0) are hashed, the
    /// others have 0: short shots take half as long again with a hash.
    std::uint64_t hash_every = 1;
};

/// Where the outcomes of n shots of b balls go: arrays of n or of n
/// x b, as in Batch, in memory of the caller's. Null: not wanted.
struct BatchArrays {
    ShotStatus* status = nullptr;
    double* duration = nullptr;
    std::int64_t* events = nullptr;
    std::int32_t *first_hit = nullptr, *contacts = nullptr, *approach_cushions = nullptr;
    double *x = nullptr, *y = nullptr;
    /// from a ball's number to the next one's in x and in y: 2 where x and y alternate
    std::size_t place_stride = 1;
    std::int32_t *pocket = nullptr, *fell = nullptr, *cushions = nullptr;
    std::uint64_t* hash = nullptr;
};

class BatchStopped : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Outcomes of n shots of b balls: arrays of n, or of n x b with the balls of a shot one after the other, in
/// the order of Scene::ball. A shot without a result has 0 everywhere and -1 as ball and pocket.
struct Batch {
    Batch() = default;
    /// Arrays for n shots of b balls, to be filled. @param hash  whether `hash` is wanted
    Batch(std::size_t n, std::size_t b, bool hash = false);
    /// Where simulate_many puts their values.
    BatchArrays arrays();

    std::size_t shots = 0, balls = 0;
    std::vector<ShotStatus> status;       ///< n
    std::vector<double> duration;         ///< n [s]
    std::vector<std::int64_t> events;     ///< n
    std::vector<std::int32_t> first_hit;  ///< n: the first ball that the struck ball meets, or -1
    std::vector<std::int32_t> contacts;   ///< n: how many balls it meets
    /// n: how many cushions it meets before the second of them, or at all
    std::vector<std::int32_t> approach_cushions;
    std::vector<double> x, y;            ///< n x b [m], at the end
    std::vector<std::int32_t> pocket;    ///< n x b: index of the pocket that holds the ball, kOffTable, or -1
    std::vector<std::int32_t> fell;      ///< n x b: 0 for the ball that fell first, 1, ..., or -1
    std::vector<std::int32_t> cushions;  ///< n x b: how often the ball met a cushion or a jaw
    std::vector<std::uint64_t> hash;     ///< n, if asked for: Outcome::hash
    struct Message {
        std::size_t shot;
        std::string text;  ///< why the shot has no result
    };
    std::vector<Message> messages;  ///< in the order of the shots
};

/// [-] Most shots of one batch: beyond it sizes of arrays would overflow.
inline constexpr std::size_t kMostBatchShots = std::size_t{1} << 31;
/// @throws std::invalid_argument for more shots than that
void check_shots(std::size_t shots);

/// Plays `shots` shots that differ in the numbers of some columns. Shot i has the results of simulate() for
/// the scene with these numbers, bit for bit, whatever the number of threads. A shot that is invalid or fails
/// has its status, and the others are played.
/// @throws std::invalid_argument for a key that names no number, a key that is there twice, or a column of
/// another length
/// @throws std::bad_alloc, and std::system_error where the system gives no threads
Batch simulate_many(const Scene& scene, std::size_t shots, std::span<const BatchColumn> columns,
                    kernel::Isa isa, const BatchOptions& options = {});

/// The same into arrays that are there already: memory is taken for the threads and the messages only.
/// BatchOptions::hash is not read. @return the messages, in the order of the shots
std::vector<Batch::Message> simulate_many(const Scene& scene, std::size_t shots,
                                          std::span<const BatchColumn> columns, kernel::Isa isa,
                                          const BatchOptions& options, const BatchArrays& out);

/// Plays shots first, first + 1, ... of a variation, which differ in what its rules say; otherwise the same.
/// `options.absent` is not read.
/// @param values  receives what was drawn: for every shot a text for every key, as VariedShot has them
std::vector<Batch::Message> simulate_many(const Variation& variation, std::uint64_t first, std::size_t shots,
                                          kernel::Isa isa, const BatchOptions& options,
                                          const BatchArrays& out, std::vector<std::string>& values);

}  // namespace carom
