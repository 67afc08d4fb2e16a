// Many shots of one scene: outcomes instead of records, in memory that is allocated once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"

namespace carom {

/// How a shot of a batch ended: a StopReason, or no result.
enum class ShotStatus : std::uint8_t {
    kAtRest,
    kTime,
    kEvents,
    kEndless,
    kInvalid,  ///< its values make no valid scene
    kFailed,   ///< the simulation failed
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

/// Plays shots one after another. Once its buffers have grown, a shot allocates no memory unless it fails or
/// has resting contacts. Not thread-safe.
class Simulator {
  public:
    /// @param scene  may be invalid until the first shot has changed it
    /// @param isa    must be available
    Simulator(const Scene& scene, kernel::Isa isa);

    /// The scene of the next shot. Change only its numbers between shots.
    Scene& scene() { return planner_.scene(); }

    /// Checks, plans and plays the scene.
    /// @param change  covers at least the changes since the last shot with a result
    /// @throws only std::bad_alloc and exceptions of options.progress
    ShotStatus play(Change change, const SimulateOptions& options = {});
    /// The same for another scene, which must be valid (as from a reader).
    ShotStatus play(const Scene& scene, const SimulateOptions& options = {});
    /// The same for a shot of a variation. The simulator must have been made for its base(), and all its
    /// shots must come from this variation.
    /// @param values  receives the draws, one per key
    ShotStatus play(const Variation& variation, std::uint64_t index, std::span<DrawnValue> values,
                    const SimulateOptions& options = {});
    /// From now on, also record every shot, in reused memory.
    void keep_records() { records_ = true; }
    /// Sets the message of a shot that cannot be played. @return kInvalid
    ShotStatus refuse(std::string why);

    const Outcome& outcome() const { return outcome_; }      ///< of the last shot, if it has a result
    const Record& record() const { return record_; }         ///< the same, if keep_records()
    const std::string& message() const { return message_; }  ///< why it has no result

  private:
    ShotStatus run(bool same_table, const SimulateOptions& options);

    Planner planner_;
    RunBuffers buffers_;
    Outcome outcome_;
    Record record_;
    std::string message_;
    bool records_ = false;
    bool checked_ = false;  // the checks that no change of numbers can affect
};

/// A number that differs from shot to shot.
struct BatchColumn {
    std::string key;                 ///< as for SceneNumber
    std::span<const double> values;  ///< one per shot
};

struct BatchOptions {
    int threads = 0;             ///< 0: one per core. The results do not depend on it.
    bool hash = false;           ///< fill Batch::hash
    SimulateOptions simulate{};  ///< `progress` is not called, and nothing is profiled
    /// Empty, or one flag per ball of every shot; nonzero removes the ball. The shot is that of the scene
    /// without these balls; their x and y are NaN, and they have no pocket and no cushions.
    std::span<const std::uint8_t> absent{};
    /// Called by each thread between shots; true ends the batch with BatchStopped.
    std::function<bool()> stop{};
    /// Called by each thread after a shot with a result has been stored, to judge it without playing it
    /// again. Both arguments are valid only during the call and omit removed balls. An exception ends the
    /// batch.
    std::function<void(std::size_t shot, const Outcome& outcome, const Record& record)> judge{};
    /// Called by each thread after every shot has been stored and judged. @param message  why the shot has no
    /// result, or ""
    std::function<void(std::size_t shot, const std::string& message)> done{};
};

/// Destination of the outcomes of n shots of b balls: the caller's arrays, as kOutcomeColumns describes them.
/// Null arrays are not filled.
struct BatchArrays {
    ShotStatus* status = nullptr;
    double* duration = nullptr;
    std::int64_t* events = nullptr;
    std::int32_t *first_hit = nullptr, *contacts = nullptr, *approach_cushions = nullptr;
    double* xy = nullptr;
    std::int32_t *pocket = nullptr, *fell = nullptr, *cushions = nullptr;
    std::uint64_t* hash = nullptr;
};

enum class NumberType : std::uint8_t { kUint8, kInt32, kInt64, kUint64, kFloat64 };
constexpr auto names_of(NumberType) {
    return std::array{"uint8", "int32", "int64", "uint64", "float64"};
}

/// An outcome of shots as a column of numbers, under this name in C, Python, JavaScript and sweeps.
struct OutcomeColumn {
    const char* name;
    const char* unit;  ///< "s", "m", "", or whose index the number is: "status", "ball", "pocket"
    const char* meaning;
    bool on_request = false;  ///< only with BatchOptions::hash
    NumberType type{};
    std::size_t size = 0;      ///< of a number [bytes]
    std::size_t per_ball = 0;  ///< numbers of each ball; 0: one number of the shot
    void* (*array)(const BatchArrays& of) = nullptr;
    void (*set_array)(BatchArrays& of, void* array) = nullptr;
    double (*number)(const BatchArrays& of, std::size_t at) = nullptr;
    void (*put)(const BatchArrays& to, std::size_t shot, const Outcome& outcome) = nullptr;

    /// Numbers of each shot: the balls are in the order of Scene::ball.
    constexpr std::size_t each(std::size_t balls) const { return per_ball == 0 ? 1 : per_ball * balls; }
};

/// The column of a member of Outcome, or of each BallOutcome; of a place, x and y.
template <auto kArray, auto kMember>
constexpr OutcomeColumn outcome_column(const char* name, const char* unit, const char* meaning,
                                       bool on_request = false) {
    using Number = std::remove_pointer_t<std::remove_cvref_t<decltype(BatchArrays().*kArray)>>;
    constexpr bool kOfBall = std::is_invocable_v<decltype(kMember), BallOutcome>;
    constexpr bool kIsPlace = std::is_same_v<decltype(kMember), Vec3 BallOutcome::*>;
    OutcomeColumn column{name, unit, meaning, on_request};
    column.type = std::is_floating_point_v<Number> ? NumberType::kFloat64
                  : sizeof(Number) == 1            ? NumberType::kUint8
                  : sizeof(Number) == 4            ? NumberType::kInt32
                  : std::is_signed_v<Number>       ? NumberType::kInt64
                                                   : NumberType::kUint64;
    column.size = sizeof(Number);
    column.per_ball = std::size_t{kOfBall} + kIsPlace;
    column.array = [](const BatchArrays& of) -> void* { return of.*kArray; };
    column.set_array = [](BatchArrays& of, void* array) { of.*kArray = static_cast<Number*>(array); };
    column.number = [](const BatchArrays& of, std::size_t at) {
        return static_cast<double>((of.*kArray)[at]);
    };
    column.put = [](const BatchArrays& to, std::size_t shot, const Outcome& outcome) {
        Number* at = to.*kArray;
        if (at == nullptr) return;
        if constexpr (kOfBall) at += shot * outcome.balls.size() * (1 + kIsPlace);
        if constexpr (kIsPlace)
            for (const BallOutcome& ball : outcome.balls) at = std::copy_n((ball.*kMember).data(), 2, at);
        else if constexpr (kOfBall)
            for (const BallOutcome& ball : outcome.balls) *at++ = ball.*kMember;
        else
            at[shot] = static_cast<Number>(outcome.*kMember);
    };
    return column;
}

/// A shot without a result has the numbers of Outcome() and BallOutcome().
inline constexpr OutcomeColumn kOutcomeColumns[] = {
    outcome_column<&BatchArrays::status, &Outcome::stopped>("status", "status", "at the end"),
    outcome_column<&BatchArrays::duration, &Outcome::duration>("duration", "s", "until its end"),
    outcome_column<&BatchArrays::events, &Outcome::events>("events", "", "in its record"),
    outcome_column<&BatchArrays::first_hit, &Outcome::first_hit>("first_hit", "ball",
                                                                 "that the struck ball hits first, or -1"),
    outcome_column<&BatchArrays::contacts, &Outcome::contacts>("contacts", "", "balls that it hits"),
    outcome_column<&BatchArrays::approach_cushions, &Outcome::approach_cushions>(
        "approach_cushions", "",
        "cushions that it hits before its second ball, or in all; one that it touches at the start counts "
        "after it has left it"),
    outcome_column<&BatchArrays::xy, &BallOutcome::position>(
        "xy", "m", "at the end; of a pocketed ball, its pocket; NaN if it was left out"),
    outcome_column<&BatchArrays::pocket, &BallOutcome::pocket>(
        "pocket", "pocket", "that holds it; -1: none; -2: it has left the table"),
    outcome_column<&BatchArrays::fell, &BallOutcome::fell>(
        "fell", "", "0 for the first ball that falls, 1 for the next, ..., or -1"),
    outcome_column<&BatchArrays::cushions, &BallOutcome::cushions>("cushions", "",
                                                                   "how often it hits a cushion or a jaw"),
    outcome_column<&BatchArrays::hash, &Outcome::hash>("hash", "", "of the record", true),
};

using OutcomeValue = std::variant<double, std::int64_t, std::string>;
/// kText: the values are names, of a status, a ball or a pocket.
ValueKind kind_of(const OutcomeColumn& column);
/// A number of a column, or its name: "out" is the pocket of a ball off the table, "" no ball or no pocket.
OutcomeValue value_of(const OutcomeColumn& column, const BatchArrays& of, std::size_t at, const Scene& scene);

class BatchStopped : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Outcomes of n shots of b balls, in arrays of its own.
struct Batch : BatchArrays {
    Batch() = default;
    /// Arrays for n shots of b balls, to be filled. @param hash  whether to allocate `hash`
    Batch(std::size_t n, std::size_t b, bool hash = false);

    std::size_t shots = 0, balls = 0;
    struct Message {
        std::size_t shot;
        std::string text;  ///< why the shot has no result
    };
    std::vector<Message> messages;                     ///< in the order of the shots
    std::vector<std::unique_ptr<std::byte[]>> memory;  ///< of the arrays
};

/// [-] The most shots in one batch: beyond it, array sizes would overflow.
inline constexpr std::size_t kMostBatchShots = std::size_t{1} << 31;
/// @throws std::invalid_argument for more shots than that
void check_shots(std::size_t shots);

/// Plays `shots` shots that differ in the numbers of some columns. Shot i has exactly the result of
/// simulate() for its scene, for any number of threads. A shot that is invalid or fails gets that status, and
/// the others are played.
/// @throws std::invalid_argument for a key that names no number, a repeated key, or a column of another
/// length
/// @throws std::bad_alloc, and std::system_error if the system cannot start the threads
Batch simulate_many(const Scene& scene, std::size_t shots, std::span<const BatchColumn> columns,
                    kernel::Isa isa, const BatchOptions& options = {});

/// The same into existing arrays: allocates memory only for the threads and the messages. Ignores
/// BatchOptions::hash. @return the messages, in the order of the shots
std::vector<Batch::Message> simulate_many(const Scene& scene, std::size_t shots,
                                          std::span<const BatchColumn> columns, kernel::Isa isa,
                                          const BatchOptions& options, const BatchArrays& out);

/// Plays shots first, first + 1, ... of a variation; otherwise the same. Ignores `options.absent`.
/// @param values  receives the draws: one per shot and key, as in VariedShot
std::vector<Batch::Message> simulate_many(const Variation& variation, std::uint64_t first, std::size_t shots,
                                          kernel::Isa isa, const BatchOptions& options,
                                          const BatchArrays& out, std::vector<DrawnValue>& values);

}  // namespace carom
