// A batch: threads that take blocks of shots, each with a simulator of its own.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "carom/engine/batch.h"

namespace carom {

namespace {

// [-] Shots that a thread takes at once: a few microseconds each at least, so that taking them costs nothing, and few
// enough for all threads to end at the same time.
constexpr std::size_t kBlock = 16;

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
                throw std::invalid_argument(column.key + ": the key is there twice; keep one of the two");
        numbers.emplace_back(scene, column.key);
    }
    return numbers;
}

void set_up(Batch& batch, const Scene& scene, std::size_t shots, bool hash) {
    batch.shots = shots;
    batch.balls = scene.ball.size();
    batch.status.assign(shots, ShotStatus::kInvalid);
    batch.duration.assign(shots, 0.0);
    batch.events.assign(shots, 0);
    batch.first_hit.assign(shots, -1);
    const std::size_t places = shots * batch.balls;
    batch.x.assign(places, 0.0);
    batch.y.assign(places, 0.0);
    batch.pocket.assign(places, -1);
    batch.fell.assign(places, -1);
    batch.cushions.assign(places, 0);
    if (hash) batch.hash.assign(shots, 0);
}

void keep(Batch& batch, std::size_t shot, const Outcome& outcome) {
    batch.duration[shot] = outcome.duration;
    batch.events[shot] = outcome.events;
    batch.first_hit[shot] = outcome.first_hit;
    if (!batch.hash.empty()) batch.hash[shot] = outcome.hash;
    std::size_t at = shot * batch.balls;
    for (const BallOutcome& ball : outcome.balls) {
        batch.x[at] = ball.position.x();
        batch.y[at] = ball.position.y();
        batch.pocket[at] = ball.pocket;
        batch.fell[at] = ball.fell;
        batch.cushions[at] = ball.cushions;
        ++at;
    }
}

/// What the threads share.
struct Work {
    Work(const Scene& base, std::span<const BatchColumn> list, const std::vector<SceneNumber>& keys,
         kernel::Isa set, const BatchOptions& how, Batch& out)
        : scene(base),
          columns(list),
          numbers(keys),
          isa(set),
          options(how),
          simulate(how.simulate),
          batch(out) {
        simulate.hash = how.hash;
        simulate.profile = false;
        simulate.progress = nullptr;
    }

    const Scene& scene;
    std::span<const BatchColumn> columns;
    const std::vector<SceneNumber>& numbers;
    kernel::Isa isa;
    const BatchOptions& options;
    SimulateOptions simulate;
    Batch& batch;
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stopped{false};
    std::mutex mutex;
    std::exception_ptr error;  // the first one

    void stop(std::exception_ptr why) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::move(why);
        stopped = true;
    }
    void tell(std::size_t shot, const std::string& text) {
        const std::lock_guard lock(mutex);
        batch.messages.push_back({shot, text});
    }

    ShotStatus play(Simulator& simulator, std::size_t shot) const {
        Change change = Change::kNumbers;
        try {
            for (std::size_t k = 0; k < numbers.size(); ++k)
                change = std::max(change, numbers[k].put(simulator.scene(), columns[k].values[shot]));
        } catch (const SceneError& refused) {
            return simulator.refuse(refused.message());
        }
        return simulator.play(change, simulate);
    }

    void play_all() noexcept {
        try {
            Simulator simulator(scene, isa);
            while (!stopped) {
                const std::size_t first = next.fetch_add(kBlock);
                if (first >= batch.shots) return;
                for (std::size_t shot = first; shot < std::min(first + kBlock, batch.shots); ++shot) {
                    if (options.stop && options.stop()) throw BatchStopped("the batch was stopped");
                    const ShotStatus status = play(simulator, shot);
                    batch.status[shot] = status;
                    if (has_result(status))
                        keep(batch, shot, simulator.outcome());
                    else
                        tell(shot, simulator.message());
                }
            }
        } catch (...) {
            stop(std::current_exception());
        }
    }
};

}  // namespace

Batch simulate_many(const Scene& scene, std::size_t shots, std::span<const BatchColumn> columns,
                    kernel::Isa isa, const BatchOptions& options) {
    const std::vector<SceneNumber> numbers = numbers_of(scene, shots, columns);
    Batch batch;
    set_up(batch, scene, shots, options.hash);
    Work work(scene, columns, numbers, isa, options, batch);
    const std::size_t wanted = options.threads > 0 ? static_cast<std::size_t>(options.threads)
                                                   : std::max(1u, std::thread::hardware_concurrency());
    const std::size_t most = std::min(wanted, (shots + kBlock - 1) / kBlock);
    std::vector<std::thread> threads;
    try {
        for (std::size_t i = 1; i < most; ++i) threads.emplace_back([&work] { work.play_all(); });
    } catch (...) {
        work.stop(std::current_exception());
    }
    work.play_all();
    for (std::thread& thread : threads) thread.join();
    if (work.error) std::rethrow_exception(work.error);
    std::sort(batch.messages.begin(), batch.messages.end(),
              [](const Batch::Message& p, const Batch::Message& q) { return p.shot < q.shot; });
    return batch;
}

}  // namespace carom
