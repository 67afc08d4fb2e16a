#include "carom/render/sequence.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "base/fnv.h"
#include "base/output_file.h"
#include "carom/engine/tolerances.h"
#include "carom/render/draw_list.h"
#include "carom/render/kept_png.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "frames/writer.h"

namespace carom::render {

namespace {

using Clock = std::chrono::steady_clock;

void make_folder(const std::string& pattern) {
    const std::filesystem::path folder = std::filesystem::path(frame_path(pattern, 0)).parent_path();
    if (folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (!std::filesystem::is_directory(folder)) {
        throw RenderError(folder.string() + ": cannot make the folder: " +
                          (error ? error.message() : std::string("something else has this name")));
    }
}

/// Says of which shot and picture frames are; not how many there are, nor how they are encoded.
std::string shot_and_picture(const Record& record, const SequenceOptions& options) {
    Fnv all;
    all.add(record.hash());
    for (const double x : {record.balls.R, record.table.width, record.table.length, options.fps, options.from,
                           options.view.fov_deg, double(options.size.width), double(options.size.height),
                           double(options.table_samples)})
        all.add(x);
    for (const std::optional<Vec3>& point : {options.view.eye, options.view.target})
        for (int k = 0; point && k < 3; ++k) all.add((*point)[k]);
    const Overlay& o = options.overlay;
    for (const bool drawn : {o.trails, o.ball_trails, o.events, o.spin, o.ghost, o.clock, o.margin})
        all.add(std::uint64_t{drawn});
    for (const BallTrack& track : record.tracks) all.add(track.id);
    all.add(options.camera);
    all.add(options.view.ball);
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(all.value()));
    return digits.data();
}

/// Beside the frames, "frames/.%05d.png.shot" says which shot and picture they are of. The frames themselves do not: their bytes
/// depend on their pixels alone.
std::string mark_path(const std::string& pattern) {
    const std::filesystem::path path(pattern);
    return (path.parent_path() / ("." + path.filename().string() + ".shot")).string();
}

void mark_frames(const Record& record, const SequenceOptions& options) {
    OutputFile file(mark_path(options.pattern));
    file.write(shot_and_picture(record, options) + "\n");
    file.commit();
}

/// @throws RenderError unless the frames that are there are of this shot and picture
void check_mark(const Record& record, const SequenceOptions& options) {
    std::array<char, 17> digits{};
    if (std::FILE* file = std::fopen(mark_path(options.pattern).c_str(), "rb")) {
        if (std::fread(digits.data(), 1, digits.size() - 1, file) != digits.size() - 1) digits[0] = '\0';
        std::fclose(file);
    }
    if (shot_and_picture(record, options) == digits.data()) return;
    throw RenderError(options.pattern + ": " +
                      (digits[0] == '\0' ? "nothing says which shot the frames there are of"
                                         : "the frames there are of another shot, camera, overlay or size") +
                      "; render without --resume");
}

// Whether the file is a whole PNG of this size.
bool is_frame_of_size(const std::string& path, FrameSize size) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) return false;
    std::array<unsigned char, 24> head{};
    // The last chunk is empty: only a power cut leaves a file without it, because a frame gets its name when it is complete.
    constexpr std::array<unsigned char, 12> kEnd{0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
    std::array<unsigned char, 12> tail{};
    const bool whole = std::fread(head.data(), 1, head.size(), file) == head.size() &&
                       std::fseek(file, -static_cast<long>(tail.size()), SEEK_END) == 0 &&
                       std::fread(tail.data(), 1, tail.size(), file) == tail.size() && tail == kEnd;
    std::fclose(file);
    const auto number = [&](std::size_t i) {
        return (unsigned{head[i]} << 24U) | (unsigned{head[i + 1]} << 16U) | (unsigned{head[i + 2]} << 8U) |
               head[i + 3];
    };
    // The signature is followed by the header chunk, which contains width and height.
    constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    return whole && std::equal(kSignature.begin(), kSignature.end(), head.begin()) &&
           number(16) == static_cast<unsigned>(size.width) &&
           number(20) == static_cast<unsigned>(size.height);
}

std::vector<FrameTiming> frames_to_do(const Record& record, const SequenceOptions& options) {
    const long count = frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (options.frame && (*options.frame < 0 || *options.frame >= count)) {
        throw RenderError("no frame " + std::to_string(*options.frame) + ": there are " +
                          std::to_string(count) + ", counted from 0");
    }
    std::vector<FrameTiming> frames;
    for (long k = options.frame.value_or(0); k < (options.frame ? *options.frame + 1 : count); ++k) {
        if (options.resume && is_frame_of_size(frame_path(options.pattern, k), options.size)) continue;
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
    if (options.libpng_level && (*options.libpng_level < 0 || *options.libpng_level > 9))
        throw RenderError("the PNG level must be 0 to 9");
    if (options.size.width < 1 || options.size.height < 1)
        throw RenderError("an image needs at least one pixel");
    if (options.resume && (options.pattern.empty() || options.raw || !is_numbered(options.pattern)))
        throw RenderError("only numbered frames in files can be resumed");
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

    void run(long skipped) {
        const long total = skipped + static_cast<long>(frames_.size());
        if (frames_.empty()) return;
        // Compiles the shaders and draws the table; this time belongs to no frame.
        renderer_.on_table(options_.table_progress);
        renderer_.draw(list_of(0));
        if (options_.overlay.margin && !options_.frame_cost_ms) measure_first();
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            draw(i);
            read(i);
            if (options_.progress) options_.progress(skipped + static_cast<long>(i) + 1, total);
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

    // The time of the frame itself is not known while it is drawn; the times of the latest frames are used instead.
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

std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options) {
    check_options(options);
    const bool files = !options.pattern.empty() && !options.raw;
    if (files) frame_path(options.pattern, 0);
    if (options.resume) check_mark(record, options);
    std::vector<FrameTiming> frames = frames_to_do(record, options);
    const long count =
        options.frame ? 1 : frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (files && count > 1 && !is_numbered(options.pattern))
        throw RenderError("bad frame pattern '" + options.pattern +
                          "'; give exactly one %d or %0Nd, like frames/%05d.png");
    if (files) make_folder(options.pattern);
    if (files && !options.resume && count > 1) mark_frames(record, options);
    FrameLoop(record, options, frames).run(count - static_cast<long>(frames.size()));
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
        // A picture keeps the shape that was asked for; another one would be filled up with black.
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
    options.libpng_level ? encode_png(sheet, *options.libpng_level, bytes) : KeptPng().encode(sheet, bytes);
    write_file(path, bytes);
}

}  // namespace carom::render
