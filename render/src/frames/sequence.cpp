#include <fmt/core.h>

#include "carom/render/sequence.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/output_file.h"
#include "carom/engine/tolerances.h"
#include "carom/render/draw_list.h"
#include "carom/render/error.h"
#include "carom/render/kept_png.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "frames/writer.h"

namespace carom::render {

namespace {

using Clock = std::chrono::steady_clock;

/// Where the frames lie.
std::filesystem::path folder_of(const std::string& pattern) {
    const std::filesystem::path folder = std::filesystem::path(frame_path(pattern, 0)).parent_path();
    return folder.empty() ? "." : folder;
}

void make_folder(const std::string& pattern) {
    const std::filesystem::path folder = folder_of(pattern);
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (!std::filesystem::is_directory(folder)) {
        throw RenderError(folder.string() + ": cannot make the folder: " +
                          (error ? error.message() : std::string("another file has this name")));
    }
}

/// The number k for which this is the name of frame k, or -1.
long frame_of(const std::string& pattern, const std::string& name) {
    for (std::size_t at = 0; at < name.size(); ++at) {
        long k = 0;
        const auto [end, error] = std::from_chars(name.data() + at, name.data() + name.size(), k);
        if (error == std::errc() && k >= 0 &&
            std::filesystem::path(frame_path(pattern, k)).filename() == name)
            return k;
    }
    return -1;
}

/// Removes the files that this run will write, so that a film whose drawing was interrupted shows one
/// picture.
void remove_old(const std::string& pattern, long count) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_of(pattern), error)) {
        if (entry.is_symlink(error) || !entry.is_regular_file(error)) continue;
        const long k = frame_of(pattern, entry.path().filename().string());
        if (k >= 0 && k < count) std::filesystem::remove(entry.path(), error);
    }
}

std::vector<FrameTiming> frames_to_do(const Record& record, const SequenceOptions& options) {
    const long count = frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (options.frame && (*options.frame < 0 || *options.frame >= count)) {
        throw RenderError("no frame " + std::to_string(*options.frame) + ": there are " +
                          std::to_string(count) + ", counted from 0");
    }
    std::vector<FrameTiming> frames;
    for (long k = options.frame.value_or(0); k < (options.frame ? *options.frame + 1 : count); ++k) {
        FrameTiming timing;
        timing.frame = k;
        timing.time = frame_time(options.from, k, options.fps);
        frames.push_back(timing);
    }
    return frames;
}

int thread_count(const SequenceOptions& options) {
    if (options.jobs < 0) throw RenderError("the number of jobs must be at least 0");
    if (options.raw) return 1;
    if (options.jobs == 1) return 0;
    if (options.jobs > 1) return std::min(options.jobs, 64);
    if (options.pattern.empty()) return 0;
    const unsigned cores = std::thread::hardware_concurrency();
    return static_cast<int>(std::clamp(cores, 1U, 16U));
}

StageOptions stage_options(const SequenceOptions& options) {
    return {options.camera, options.view, options.overlay, options.size, options.table_samples};
}

void check_options(const SequenceOptions& options) {
    if (options.size.width < 1 || options.size.height < 1)
        throw RenderError("an image needs at least one pixel");
}

// Draws the frames in order.
class FrameLoop {
  public:
    FrameLoop(const Record& record, const SequenceOptions& options, std::vector<FrameTiming>& frames)
        : options_(options),
          frames_(frames),
          stage_(record, stage_options(options)),
          renderer_(options.backend),
          threads_(thread_count(options)),
          writer_(options, threads_) {}

    void run() {
        const long total = static_cast<long>(frames_.size());
        if (frames_.empty()) return;
        // Compiles the shaders and draws the table; this time belongs to no frame.
        renderer_.on_table(options_.table_progress);
        renderer_.draw(list_of(0));
        if (options_.overlay.margin && !options_.frame_cost_ms) measure_first();
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            draw(i);
            read(i);
            if (options_.progress) options_.progress(static_cast<long>(i) + 1, total);
        }
        writer_.finish();
    }

  private:
    DrawList list_of(std::size_t i) {
        std::optional<FrameBudget> cost;
        if (options_.overlay.margin) {
            cost = FrameBudget{
                options_.frame_cost_ms ? options_.frame_cost_ms(frames_[i].frame) : last_cost_ms(i),
                1e3 / options_.fps};
        }
        return stage_.at(frames_[i].time, cost);
    }

    // A frame's own time is not known while it is drawn; the times of the latest frames are used instead.
    double last_cost_ms(std::size_t i) {
        const double encode_ms = writer_.last_encode_ms();
        return (options_.simulate_ms ? options_.simulate_ms(frames_[i].frame) : 0.0) +
               (i > 0 ? frames_[i - 1].draw_ms : first_.draw_ms) +
               (i > 0 ? frames_[i - 1].readback_ms : first_.readback_ms) +
               (encode_ms > 0.0 ? encode_ms : first_.encode_ms);
    }

    // The first frames have no earlier ones: the first frame is drawn once more to measure its times.
    void measure_first() {
        KeptImage image;
        Encoder encoder(options_);
        renderer_.read(image);
        encoder.encode(image);
        Clock::time_point mark = Clock::now();
        renderer_.draw(list_of(0));
        first_.draw_ms = ms_since(mark);
        renderer_.read(image);
        first_.readback_ms = ms_since(mark);
        encoder.encode(image);
        first_.encode_ms = ms_since(mark);
    }

    void draw(std::size_t i) {
        Clock::time_point mark = Clock::now();
        renderer_.draw(list_of(i));
        frames_[i].draw_ms = ms_since(mark);
    }

    void read(std::size_t i) {
        std::unique_ptr<KeptImage> image = writer_.acquire();
        Clock::time_point mark = Clock::now();
        renderer_.read(*image);
        frames_[i].readback_ms = ms_since(mark);
        writer_.submit(std::move(image), frames_[i]);
    }

    const SequenceOptions& options_;
    std::vector<FrameTiming>& frames_;
    Stage stage_;
    Renderer renderer_;
    int threads_;
    FrameWriter writer_;
    FrameTiming first_;
};

}  // namespace

bool writes_over(const std::string& pattern, const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (!is_numbered(pattern)) return fs::equivalent(frame_path(pattern, 0), path, error);
    for (const auto& entry : fs::directory_iterator(folder_of(pattern), error))
        if (frame_of(pattern, entry.path().filename().string()) >= 0 &&
            fs::equivalent(entry.path(), path, error))
            return true;
    return false;
}

std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options) {
    check_options(options);
    const bool files = !options.pattern.empty() && !options.raw;
    const long count =
        options.frame ? 1 : frame_count(options.from, options.to.value_or(record.duration), options.fps);
    const bool numbered = files && is_numbered(options.pattern);
    if (files && count > 1 && !numbered)
        throw RenderError("bad frame pattern '" + options.pattern +
                          "'; give exactly one %d or %0Nd, as in frames/%05d.png");
    if (files) make_folder(options.pattern);
    // No other run writes the frames of a film meanwhile; a single one leaves other frames alone.
    std::optional<FileLock> lock;
    try {
        if (numbered) lock.emplace(options.pattern + ".lock", count > 1);
    } catch (const std::runtime_error& error) {
        throw RenderError(error.what());
    }
    std::vector<FrameTiming> frames = frames_to_do(record, options);
    FrameLoop loop(record, options, frames);
    if (numbered && count > 1) remove_old(options.pattern, count);
    loop.run();
    return frames;
}

void render_sheet(const Record& record, const SequenceOptions& options, int columns, int rows,
                  const std::string& path) {
    check_options(options);
    constexpr int kGap = 2;  // pixels between the pictures
    StageOptions cell = stage_options(options);
    const bool possible = columns >= 1 && rows >= 1 && columns <= options.size.width / 16;
    if (possible) {
        cell.size.width = (options.size.width - kGap * (columns - 1)) / columns;
        // A picture keeps the requested shape; another one would be padded with black.
        cell.size.height =
            static_cast<int>(static_cast<long>(cell.size.width) * options.size.height / options.size.width);
    }
    if (!possible || cell.size.width < 14 || cell.size.height < 14 ||
        rows > kMaxImageSize / (cell.size.height + kGap)) {
        throw RenderError(
            "a sheet needs at least one column and one row, 16 pixels for each, and a height of at most " +
            std::to_string(kMaxImageSize));
    }
    cell.overlay.clock = true;
    const Stage stage(record, cell);
    Renderer renderer(options.backend);
    renderer.on_table(options.table_progress);
    Image sheet, picture;
    sheet.resize({options.size.width, rows * cell.size.height + kGap * (rows - 1)});
    const double to = options.to.value_or(record.duration);
    const int last = columns * rows - 1;
    for (int i = 0; i <= last; ++i) {
        renderer.draw(stage.at(last == 0 ? options.from : options.from + (to - options.from) * i / last));
        renderer.read(picture);
        const int left = i % columns * (cell.size.width + kGap),
                  top = i / columns * (cell.size.height + kGap);
        for (int y = 0; y < cell.size.height; ++y) {
            const std::size_t at =
                4 * (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(sheet.size.width) +
                     static_cast<std::size_t>(left));
            std::copy_n(picture.pixel(0, y), std::size_t{4} * static_cast<std::size_t>(cell.size.width),
                        sheet.rgbx.begin() + static_cast<std::ptrdiff_t>(at));
        }
        if (options.progress) options.progress(i + 1, last + 1);
    }
    std::vector<std::uint8_t> bytes;
    options.libpng ? encode_png(sheet, kFrameLevel, bytes) : KeptPng().encode(sheet, bytes);
    write_file(path, bytes);
}

std::string y4m_header(FrameSize size, double fps) {
    // Continued fractions: the first ratio that is close enough has the smallest numbers.
    constexpr double kNear = 1e-9, kMost = std::numeric_limits<std::int32_t>::max();
    double rest = fps, p = 1.0, q = 0.0, p_before = 0.0, q_before = 1.0;
    while (std::isfinite(rest)) {
        const double whole = std::floor(rest);
        const double p_next = whole * p + p_before, q_next = whole * q + q_before;
        if (!(p_next <= kMost && q_next <= kMost)) break;
        p_before = p;
        q_before = q;
        p = p_next;
        q = q_next;
        if (p > 0.0 && std::abs(p / q - fps) <= kNear * fps) {
            return fmt::format(
                "YUV4MPEG2 W{} H{} F{:.0f}:{:.0f} Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n",
                size.width, size.height, p, q);
        }
        rest = 1.0 / (rest - whole);
    }
    throw RenderError(fmt::format(
        "Y4M cannot express {} frames per second as a ratio of two whole numbers; choose another --fps",
        fps));
}

}  // namespace carom::render
