#include "carom/render/sequence.h"

#include <chrono>
#include <filesystem>
#include <system_error>

#include "carom/render/draw_list.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"

namespace carom::render {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point& mark) {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - mark).count();
    mark = now;
    return ms;
}

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

struct FrameRange {
    long first = 0, count = 0;
};

FrameRange frames_of(const Record& record, const SequenceOptions& options) {
    const long count = frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (!options.frame) return {0, count};
    if (*options.frame < 0 || *options.frame >= count) {
        throw RenderError("no frame " + std::to_string(*options.frame) + ": there are " +
                          std::to_string(count) + ", counted from 0");
    }
    return {*options.frame, 1};
}

}  // namespace

std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options) {
    if (options.png_level < 0 || options.png_level > 9) throw RenderError("the PNG level must be 0 to 9");
    const FrameRange range = frames_of(record, options);
    if (!options.pattern.empty()) make_folder(options.pattern);
    const Stage stage(record, options.camera, options.size);
    Renderer renderer(options.backend);
    Image image;
    std::vector<std::uint8_t> bytes;
    std::vector<FrameTiming> timings;
    for (long i = 0; i < range.count; ++i) {
        FrameTiming timing;
        timing.frame = range.first + i;
        timing.time = frame_time(options.from, timing.frame, options.fps);
        Clock::time_point mark = Clock::now();
        DrawList list = stage.at(timing.time);
        list.table_samples = options.table_samples;
        renderer.draw(list);
        timing.draw_ms = ms_since(mark);
        renderer.read(image);
        timing.readback_ms = ms_since(mark);
        encode_png(image, options.png_level, bytes);
        timing.encode_ms = ms_since(mark);
        if (!options.pattern.empty()) write_file(frame_path(options.pattern, timing.frame), bytes);
        timing.write_ms = ms_since(mark);
        timings.push_back(timing);
        if (options.progress) options.progress(i + 1, range.count);
    }
    return timings;
}

}  // namespace carom::render
