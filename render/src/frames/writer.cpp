#include "frames/writer.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "carom/render/png.h"

namespace carom::render {

double ms_since(std::chrono::steady_clock::time_point& mark) {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - mark).count();
    mark = now;
    return ms;
}

const std::vector<std::uint8_t>& Encoder::encode(const KeptImage& image) {
    if (options_.raw && options_.raw_format == RawFormat::kY4m) {
        const std::vector<std::uint8_t>& bytes = yuv_.pack(image);
        share_ = yuv_.share();
        return bytes;
    }
    if (options_.raw) {
        const std::vector<std::uint8_t>& bytes = rgb_.pack(image);
        share_ = rgb_.share();
        return bytes;
    }
    if (options_.libpng) {
        encode_png(image.image(), kFrameLevel, bytes_);
        share_ = 1.0;
    } else {
        png_.encode(image, bytes_);
        share_ = png_.share();
    }
    return bytes_;
}

namespace {

// [bytes] Limit for all images in flight together; it bounds the memory of a run with many threads.
constexpr double kMemory = 64e6;

// One image in work and one waiting per thread, and one being filled; fewer if the images are large.
std::size_t image_limit(FrameSize size, int threads) {
    const double fit = kMemory / (4.0 * size.width * size.height);
    return static_cast<std::size_t>(std::max(2.0, std::min(2.0 * threads + 1.0, fit)));
}

}  // namespace

FrameWriter::FrameWriter(const SequenceOptions& options, int threads)
    : options_(options), limit_(image_limit(options.size, threads)), encoder_(options) {
    // More threads than images would only wait.
    threads = std::min(threads, static_cast<int>(limit_));
    try {
        for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
    } catch (const std::exception& error) {  // the system refuses to start more threads
        const std::size_t started = threads_.size();
        stop();
        throw RenderError("only " + std::to_string(started) + " of " + std::to_string(threads) +
                          " threads could be started (" + error.what() + "); use fewer with --jobs");
    }
}

FrameWriter::~FrameWriter() {
    stop();
}

void FrameWriter::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        tasks_.clear();
    }
    task_ready_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void FrameWriter::write(const KeptImage& image, FrameTiming& timing, Encoder& encoder) const {
    auto mark = std::chrono::steady_clock::now();
    const std::vector<std::uint8_t>& bytes = encoder.encode(image);
    timing.encode_ms = ms_since(mark);
    timing.encoded_share = encoder.share();
    if (options_.raw)
        options_.raw(bytes.data(), bytes.size());
    else if (!options_.pattern.empty())
        write_file(frame_path(options_.pattern, timing.frame), bytes);
    timing.write_ms = ms_since(mark);
}

void FrameWriter::work() {
    Encoder encoder(options_);
    std::unique_lock lock(mutex_);
    while (true) {
        task_ready_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
        if (stopping_) return;
        Task task = std::move(tasks_.front());
        tasks_.pop_front();
        lock.unlock();
        std::exception_ptr failure;
        try {
            write(*task.image, *task.timing, encoder);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        last_encode_ms_ = task.timing->encode_ms;
        idle_.push_back(std::move(task.image));
        --in_flight_;
        if (failure && !failure_) failure_ = failure;
        image_ready_.notify_all();
    }
}

std::unique_ptr<KeptImage> FrameWriter::acquire() {
    std::unique_lock lock(mutex_);
    image_ready_.wait(lock, [&] { return failure_ || !idle_.empty() || images_ < limit_; });
    if (failure_) std::rethrow_exception(failure_);
    if (idle_.empty()) {
        ++images_;
        return std::make_unique<KeptImage>();
    }
    std::unique_ptr<KeptImage> image = std::move(idle_.back());
    idle_.pop_back();
    return image;
}

void FrameWriter::submit(std::unique_ptr<KeptImage> image, FrameTiming& timing) {
    if (threads_.empty()) {
        write(*image, timing, encoder_);
        last_encode_ms_ = timing.encode_ms;
        idle_.push_back(std::move(image));
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back({std::move(image), &timing});
        ++in_flight_;
    }
    task_ready_.notify_one();
}

double FrameWriter::last_encode_ms() {
    const std::lock_guard lock(mutex_);
    return last_encode_ms_;
}

void FrameWriter::finish() {
    std::unique_lock lock(mutex_);
    image_ready_.wait(lock, [this] { return failure_ || in_flight_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace carom::render
