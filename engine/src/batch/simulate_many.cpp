// A batch: threads process blocks of shots, each with its own simulator.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"

namespace carom {

namespace {

// [-] Largest block of shots. Each shot needs at least a few microseconds, so fetching blocks costs nothing.
// Towards the end blocks shrink to 1 / kShareLeft of the remaining shots per thread, so that all threads end
// at about the same time.
constexpr std::size_t kBlock = 16, kShareLeft = 4;

std::vector<SceneNumber> numbers_of(const Scene& scene, std::size_t shots,
                                    std::span<const BatchColumn> columns) {
    std::vector<SceneNumber> numbers;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const BatchColumn& column = columns[k];
        if (column.values.size() != shots)
            throw std::invalid_argument(column.key + ": there are " + std::to_string(column.values.size()) +
                                        " values for " + std::to_string(shots) + " shots; give one for each");
        for (std::size_t other = 0; other < k; ++other)
            if (columns[other].key == column.key)
                throw std::invalid_argument(column.key + ": this key appears twice; keep one of the two");
        numbers.emplace_back(scene, column.key);
    }
    return numbers;
}

/// The outcome of a shot that removed balls: those present are at these places in the scene.
Outcome with_removed(Outcome outcome, const std::vector<int>& present, std::size_t balls) {
    std::vector<BallOutcome> all(balls);
    for (std::size_t i = 0; i < present.size(); ++i) all[present[i]] = outcome.balls[i];
    outcome.balls = std::move(all);
    if (outcome.first_hit >= 0) outcome.first_hit = present[outcome.first_hit];
    return outcome;
}

void keep(const BatchArrays& out, std::size_t shot, const Outcome& outcome) {
    for (const OutcomeColumn& column : kOutcomeColumns) column.put(out, shot, outcome);
}

/// A thread of a batch: its simulators, and the balls of its last shot if some were removed.
struct Worker {
    Worker(const Scene& scene, kernel::Isa isa, bool keeps_records)
        : whole(scene, isa), records(keeps_records) {
        if (records) whole.keep_records();
    }
    /// The simulator for shots with removed balls.
    Simulator& partial(const Scene& scene, kernel::Isa isa) {
        if (!part) {
            part.emplace(scene, isa);
            if (records) part->keep_records();
        }
        return *part;
    }

    Simulator whole;
    bool records;
    std::optional<Simulator> part;  // for shots with removed balls
    Simulator* last = &whole;
    std::vector<int> present;
};
using PlayShot = std::function<ShotStatus(Worker&, std::size_t shot, const SimulateOptions&)>;

struct ColumnShots {
    const Scene& scene;
    std::span<const BatchColumn> columns;
    std::vector<SceneNumber> numbers;
    std::span<const std::uint8_t> absent;
    kernel::Isa isa;

    Change put(Scene& into, std::size_t shot) const {
        Change change = Change::kNumbers;
        for (std::size_t k = 0; k < numbers.size(); ++k)
            change = std::max(change, numbers[k].put(into, columns[k].values[shot]));
        return change;
    }

    ShotStatus operator()(Worker& worker, std::size_t shot, const SimulateOptions& options) const {
        const std::size_t balls = scene.ball.size();
        const auto gone = absent.subspan(absent.empty() ? 0 : shot * balls, absent.empty() ? 0 : balls);
        const bool some = std::any_of(gone.begin(), gone.end(), [](std::uint8_t ball) { return ball != 0; });
        worker.last = some ? &worker.partial(scene, isa) : &worker.whole;
        try {
            if (!some) return worker.whole.play(put(worker.whole.scene(), shot), options);
            Scene without = scene;
            put(without, shot);
            worker.present.clear();
            std::vector<BallStart> left;
            for (std::size_t i = 0; i < balls; ++i) {
                if (gone[i] != 0) continue;
                worker.present.push_back(static_cast<int>(i));
                left.push_back(std::move(without.ball[i]));
            }
            without.ball = std::move(left);
            validate(without);
            return worker.last->play(without, options);
        } catch (const SceneError& refused) {
            return worker.last->refuse(refused.message());
        }
    }
};

struct Work {
    Work(const Scene& base, std::size_t count, PlayShot how_to_play, kernel::Isa set, const BatchOptions& how,
         const BatchArrays& arrays)
        : scene(base),
          shots(count),
          play(std::move(how_to_play)),
          isa(set),
          options(how),
          simulate(how.simulate),
          out(arrays) {
        simulate.hash = out.hash != nullptr;
        simulate.profile = false;
        // A crowded shot may last for seconds.
        simulate.progress = nullptr;
        if (options.stop) simulate.progress = [this](std::size_t, double) { check_stop(); };
    }

    const Scene& scene;
    std::size_t shots;
    PlayShot play;
    kernel::Isa isa;
    const BatchOptions& options;
    SimulateOptions simulate;
    const BatchArrays& out;
    std::vector<Batch::Message> messages;
    std::size_t threads = 1;
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stopped{false};
    std::mutex mutex;
    std::exception_ptr error;  // the first one

    void stop(std::exception_ptr why) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::move(why);
        stopped = true;
    }
    void check_stop() const {
        if (options.stop && options.stop()) throw BatchStopped("the batch was stopped");
    }
    void add_message(std::size_t shot, const std::string& text) {
        const std::lock_guard lock(mutex);
        messages.push_back({shot, text});
    }

    void play_one(Worker& worker, std::size_t shot) {
        const std::size_t balls = scene.ball.size();
        const ShotStatus status = play(worker, shot, simulate);
        const Outcome& outcome = worker.last->outcome();
        if (!has_result(status))
            keep(out, shot, {.balls = std::vector<BallOutcome>(balls)});
        else if (worker.last != &worker.whole)
            keep(out, shot, with_removed(outcome, worker.present, balls));
        else
            keep(out, shot, outcome);
        if (out.status != nullptr) out.status[shot] = status;
        if (has_result(status)) {
            if (options.judge) options.judge(shot, outcome, worker.last->record());
        } else {
            add_message(shot, worker.last->message());
        }
        if (options.done) options.done(shot, has_result(status) ? std::string() : worker.last->message());
    }

    void play_all() noexcept {
        try {
            Worker worker(scene, isa, options.judge != nullptr);
            while (!stopped) {
                std::size_t first = next, last = 0;
                do {
                    if (first >= shots) return;
                    last =
                        first + std::clamp((shots - first) / (kShareLeft * threads), std::size_t{1}, kBlock);
                } while (!next.compare_exchange_weak(first, last));
                for (std::size_t shot = first; shot < last; ++shot) {
                    check_stop();
                    play_one(worker, shot);
                }
            }
        } catch (...) {
            stop(std::current_exception());
        }
    }

    std::vector<Batch::Message> run() {
        threads = options.threads > 0 ? static_cast<std::size_t>(options.threads)
                                      : std::max(1u, std::thread::hardware_concurrency());
        threads = std::max<std::size_t>(1, std::min(threads, shots));
        std::vector<std::thread> others;
        try {
            for (std::size_t i = 1; i < threads; ++i) others.emplace_back([this] { play_all(); });
        } catch (...) {
            stop(std::current_exception());
        }
        play_all();
        for (std::thread& thread : others) thread.join();
        if (error) std::rethrow_exception(error);
        std::sort(messages.begin(), messages.end(),
                  [](const Batch::Message& p, const Batch::Message& q) { return p.shot < q.shot; });
        return std::move(messages);
    }
};

}  // namespace

Batch::Batch(std::size_t n, std::size_t b, bool hash_wanted) : shots(n), balls(b) {
    for (const OutcomeColumn& column : kOutcomeColumns) {
        if (column.on_request && !hash_wanted) continue;
        memory.push_back(std::make_unique<std::byte[]>(n * column.each(b) * column.size));
        column.set_array(*this, memory.back().get());
    }
}

ValueKind kind_of(const OutcomeColumn& column) {
    if (std::string_view(column.unit).size() > 1) return ValueKind::kText;
    return column.type == NumberType::kFloat64 ? ValueKind::kNumber : ValueKind::kWhole;
}

OutcomeValue value_of(const OutcomeColumn& column, const BatchArrays& of, std::size_t at,
                      const Scene& scene) {
    const double number = column.number(of, at);
    const ValueKind kind = kind_of(column);
    if (kind == ValueKind::kNumber) return number;
    if (kind == ValueKind::kWhole) return static_cast<std::int64_t>(number);
    if (column.unit == std::string_view("status")) return name(static_cast<ShotStatus>(number));
    if (number == kOffTable) return "out";
    if (number < 0) return "";
    const auto index = static_cast<std::size_t>(number);
    return column.unit == std::string_view("ball") ? scene.ball[index].id : scene.table.pockets[index].id;
}

void check_shots(std::size_t shots) {
    if (shots > kMostBatchShots)
        throw std::invalid_argument("shots = " + std::to_string(shots) +
                                    " is out of range; it must be at most " +
                                    std::to_string(kMostBatchShots));
}

std::vector<Batch::Message> simulate_many(const Scene& scene, std::size_t shots,
                                          std::span<const BatchColumn> columns, kernel::Isa isa,
                                          const BatchOptions& options, const BatchArrays& out) {
    check_shots(shots);
    if (!options.absent.empty() && options.absent.size() != shots * scene.ball.size())
        throw std::invalid_argument("absent: expected a value for every ball of every shot");
    const ColumnShots play{scene, columns, numbers_of(scene, shots, columns), options.absent, isa};
    return Work(scene, shots, std::cref(play), isa, options, out).run();
}

std::vector<Batch::Message> simulate_many(const Variation& variation, std::uint64_t first, std::size_t shots,
                                          kernel::Isa isa, const BatchOptions& options,
                                          const BatchArrays& out, std::vector<DrawnValue>& values) {
    check_shots(shots);
    const std::size_t keys = variation.keys().size();
    values.assign(shots * keys, {});
    const auto play = [&](Worker& worker, std::size_t shot, const SimulateOptions& how) {
        const std::span drawn = std::span(values).subspan(shot * keys, keys);
        return worker.whole.play(variation, first + shot, drawn, how);
    };
    return Work(variation.base(), shots, play, isa, options, out).run();
}

Batch simulate_many(const Scene& scene, std::size_t shots, std::span<const BatchColumn> columns,
                    kernel::Isa isa, const BatchOptions& options) {
    check_shots(shots);
    Batch batch(shots, scene.ball.size(), options.hash);
    batch.messages = simulate_many(scene, shots, columns, isa, options, batch);
    return batch;
}

}  // namespace carom
