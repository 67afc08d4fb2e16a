// Encodes and writes frames in its own threads, with a bounded number of images in flight.
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
#include "carom/render/kept_png.h"
#include "carom/render/sequence.h"
#include "frames/packed.h"

namespace carom::render {

/// Makes the bytes of a frame. It keeps those of the last one, so every thread has its own.
class Encoder {
  public:
    explicit Encoder(const SequenceOptions& options) : options_(options) {}

    /// @returns the bytes, valid until the next call
    const std::vector<std::uint8_t>& encode(const KeptImage& image);

    /// The share of the last picture that was encoded anew, 0..1.
    double share() const { return share_; }

  private:
    const SequenceOptions& options_;
    KeptPng png_;
    PackedRgb rgb_;
    PackedYuv yuv_;
    std::vector<std::uint8_t> bytes_;
    double share_ = 0.0;
};

class FrameWriter {
  public:
    /// @param threads 0: submit() does the work itself. Raw frames need exactly one thread, which preserves
    /// their order.
    /// @throws RenderError if the system cannot start that many threads
    FrameWriter(const SequenceOptions& options, int threads);

    /// Drops the frames that have not been started and waits for the others.
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Returns an image to fill; waits while all images are
    /// in flight. Rethrows the exception of a failed thread.
    std::unique_ptr<KeptImage> acquire();

    /// Encodes and writes the image as frame timing.frame and
    /// sets the times. `timing` must outlive the writer.
    void submit(std::unique_ptr<KeptImage> image, FrameTiming& timing);

    /// Encoding time of the last finished frame [ms]; 0 before the first one.
    double last_encode_ms();

    /// Waits until everything is written. Rethrows the exception of a failed thread.
    void finish();

  private:
    struct Task {
        std::unique_ptr<KeptImage> image;
        FrameTiming* timing = nullptr;
    };
    void work();
    void stop();  // drops the frames that have not been started, and ends the threads
    void write(const KeptImage& image, FrameTiming& timing, Encoder& encoder) const;

    const SequenceOptions& options_;
    const std::size_t limit_;  // largest number of images
    Encoder encoder_;          // of a writer without threads
    std::mutex mutex_;
    std::condition_variable task_ready_, image_ready_;
    std::deque<Task> tasks_;
    std::vector<std::unique_ptr<KeptImage>> idle_;
    std::size_t images_ = 0, in_flight_ = 0;  // images created; images submitted and not yet finished
    bool stopping_ = false;
    double last_encode_ms_ = 0.0;
    std::exception_ptr failure_;
    std::vector<std::thread> threads_;
};

/// Milliseconds since the mark, which is then set to the current time.
double ms_since(std::chrono::steady_clock::time_point& mark);

}  // namespace carom::render
