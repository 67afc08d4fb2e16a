// Encodes and writes frames, in threads of its own, with a bounded number of images in flight.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "carom/render/kept_image.h"
#include "carom/render/sequence.h"

namespace carom::render {

class FrameWriter {
  public:
    /// threads = 0: submit() does the work itself. Raw frames take one thread, which keeps their order.
    /// @throws RenderError where the system does not give as many
    FrameWriter(const SequenceOptions& options, int threads);

    /// Drops what has not been started and waits for the rest.
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// An image to fill; waits while all are in flight. @throws what a thread failed with
    std::unique_ptr<KeptImage> acquire();

    /// Encodes and writes it as frame timing.frame; fills in the times, which must outlive the writer.
    void submit(std::unique_ptr<KeptImage> image, FrameTiming& timing);

    /// What encoding took for the last frame that is done; 0 before [ms].
    double last_encode_ms();

    /// Waits until everything is written. @throws what a thread failed with
    void finish();

  private:
    struct Task {
        std::unique_ptr<KeptImage> image;
        FrameTiming* timing = nullptr;
    };
    void work();
    void stop();  // drops what has not been started, and ends the threads
    void write(const Image& image, FrameTiming& timing, std::vector<std::uint8_t>& bytes) const;

    const SequenceOptions& options_;
    const std::size_t limit_;          // images that exist at once
    std::vector<std::uint8_t> bytes_;  // of a writer without threads
    std::mutex mutex_;
    std::condition_variable task_ready_, image_ready_;
    std::deque<Task> tasks_;
    std::vector<std::unique_ptr<KeptImage>> idle_;
    std::size_t images_ = 0, in_flight_ = 0;  // made so far; submitted and not yet done
    bool stopping_ = false;
    double last_encode_ms_ = 0.0;
    std::exception_ptr failure_;
    std::vector<std::thread> threads_;
};

/// Milliseconds since the mark, which moves to now.
double ms_since(std::chrono::steady_clock::time_point& mark);

/// Packed RGB rows of an image.
void pack_rgb(const Image& image, std::vector<std::uint8_t>& bytes);

}  // namespace carom::render
