// A batch: threads that take blocks of shots, each with a simulator of its own.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
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

template <class T>
void fill(T* array, std::size_t count, T value, std::size_t stride = 1) {
    for (std::size_t i = 0; array != nullptr && i < count; ++i) array[i * stride] = value;
}

/// What a shot without a result has.
void clear(const BatchArrays& out, std::size_t shot, std::size_t balls) {
    const std::size_t at = shot * balls;
    const auto from = [](auto* array, std::size_t first) { return array ? array + first : nullptr; };
    fill(from(out.duration, shot), 1, 0.0);
    fill(from(out.events, shot), 1, std::int64_t{0});
    fill(from(out.first_hit, shot), 1, -1);
    fill(from(out.hash, shot), 1, std::uint64_t{0});
    fill(from(out.x, at * out.place_stride), balls, 0.0, out.place_stride);
    fill(from(out.y, at * out.place_stride), balls, 0.0, out.place_stride);
    fill(from(out.pocket, at), balls, -1);
    fill(from(out.fell, at), balls, -1);
    fill(from(out.cushions, at), balls, 0);
}

void keep(const BatchArrays& out, std::size_t shot, const Outcome& outcome) {
    const auto put = [](auto* array, std::size_t at, const auto& value) {
        if (array != nullptr) array[at] = value;
    };
    put(out.duration, shot, outcome.duration);
    put(out.events, shot, outcome.events);
    put(out.first_hit, shot, outcome.first_hit);
    put(out.hash, shot, outcome.hash);
    std::size_t at = shot * outcome.balls.size();
    for (const BallOutcome& ball : outcome.balls) {
        put(out.x, at * out.place_stride, ball.position.x());
        put(out.y, at * out.place_stride, ball.position.y());
        put(out.pocket, at, ball.pocket);
        put(out.fell, at, ball.fell);
        put(out.cushions, at, ball.cushions);
        ++at;
    }
}

/// What the threads share.
struct Work {
    Work(const Scene& base, std::size_t count, std::span<const BatchColumn> list,
         const std::vector<SceneNumber>& keys, kernel::Isa set, const BatchOptions& how,
         const BatchArrays& arrays)
        : scene(base),
          shots(count),
          columns(list),
          numbers(keys),
          isa(set),
          options(how),
          simulate(how.simulate),
          out(arrays) {
        simulate.hash = out.hash != nullptr;
        simulate.profile = false;
        simulate.progress = nullptr;
    }

    const Scene& scene;
    std::size_t shots;
    std::span<const BatchColumn> columns;
    const std::vector<SceneNumber>& numbers;
    kernel::Isa isa;
    const BatchOptions& options;
    SimulateOptions simulate;
    const BatchArrays& out;
    std::vector<Batch::Message> messages;
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
        messages.push_back({shot, text});
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
                if (first >= shots) return;
                for (std::size_t shot = first; shot < std::min(first + kBlock, shots); ++shot) {
                    if (options.stop && options.stop()) throw BatchStopped("the batch was stopped");
                    const ShotStatus status = play(simulator, shot);
                    if (out.status != nullptr) out.status[shot] = status;
                    if (has_result(status)) {
                        keep(out, shot, simulator.outcome());
                    } else {
                        clear(out, shot, scene.ball.size());
                        tell(shot, simulator.message());
                    }
                }
            }
        } catch (...) {
            stop(std::current_exception());
        }
    }
};

}  // namespace

std::vector<Batch::Message> simulate_many(const Scene& scene, std::size_t shots,
                                          std::span<const BatchColumn> columns, kernel::Isa isa,
                                          const BatchOptions& options, const BatchArrays& out) {
    const std::vector<SceneNumber> numbers = numbers_of(scene, shots, columns);
    Work work(scene, shots, columns, numbers, isa, options, out);
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
    std::sort(work.messages.begin(), work.messages.end(),
              [](const Batch::Message& p, const Batch::Message& q) { return p.shot < q.shot; });
    return std::move(work.messages);
}

Batch simulate_many(const Scene& scene, std::size_t shots, std::span<const BatchColumn> columns,
                    kernel::Isa isa, const BatchOptions& options) {
    Batch batch;
    batch.shots = shots;
    batch.balls = scene.ball.size();
    const std::size_t places = shots * batch.balls;
    batch.status.resize(shots);
    batch.duration.resize(shots);
    batch.events.resize(shots);
    batch.first_hit.resize(shots);
    batch.x.resize(places);
    batch.y.resize(places);
    batch.pocket.resize(places);
    batch.fell.resize(places);
    batch.cushions.resize(places);
    if (options.hash) batch.hash.resize(shots);
    BatchArrays out;
    out.status = batch.status.data();
    out.duration = batch.duration.data();
    out.events = batch.events.data();
    out.first_hit = batch.first_hit.data();
    out.x = batch.x.data();
    out.y = batch.y.data();
    out.pocket = batch.pocket.data();
    out.fell = batch.fell.data();
    out.cushions = batch.cushions.data();
    if (options.hash) out.hash = batch.hash.data();
    batch.messages = simulate_many(scene, shots, columns, isa, options, out);
    return batch;
}

}  // namespace carom
