// carom-lab bench render: the cost of a frame, stage by stage.
#include "bench/render.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/temporary_folder.h"
#include "carom/render/kept_png.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "carom/render/sequence.h"
#include "report/table.h"

namespace carom::tools {
using namespace render;

namespace {

using Clock = std::chrono::steady_clock;

double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double wall_ms_since(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

/// Shows the progress over the frames of all measurements. SIGINT ends them.
struct Steps {
    long total, done = 0;
    ProgressLine line{"bench render"};
    void look() {
        throw_if_interrupted();
        line.show_bar(done, total);
    }
    void next() {
        ++done;
        look();
    }
};

/// The picture of one row.
struct Picture {
    const char *name, *camera;
    FrameSize size;
};
constexpr std::array<Picture, 4> kPictures = {{{"720p", "top", {1280, 720}},
                                               {"1080p", "top", {1920, 1080}},
                                               {"1080p follow", "follow", {1920, 1080}},
                                               {"2160p", "top", {3840, 2160}}}};

StageOptions stage_options(const Picture& picture) {
    StageOptions options;
    options.size = picture.size;
    options.camera = picture.camera;
    return options;
}

// Runs in the child of set_up_ms() and writes its CPU time into the pipe.
[[noreturn]] void draw_once_and_exit(const Record& record, const Picture& picture, Backend backend,
                                     int pipe_end) {
    int status = 1;
    try {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
        const double start = cpu_ms();
        const Stage stage(record, stage_options(picture));
        Renderer renderer(backend);
        renderer.draw(stage.at(0.0));
        Image image;
        renderer.read(image);
        const double spent = cpu_ms() - start;
        if (write(pipe_end, &spent, sizeof spent) == sizeof spent) status = 0;
    } catch (const RenderError&) {
        // The parent meets the same error, and reports it.
    }
    _exit(status);
}

// CPU time of one picture in a separate process; in this one, every row after the first would find the driver
// ready. Call it before drawing anything, because a child has none of its parent's threads.
double set_up_ms(const Record& record, const Picture& picture, Backend backend) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw RenderError("no pipe for measuring the set-up");
    const pid_t child = fork();
    if (child == 0) draw_once_and_exit(record, picture, backend, ends[1]);
    close(ends[1]);
    double spent = 0.0;
    const bool got = child > 0 && read(ends[0], &spent, sizeof spent) == sizeof spent;
    close(ends[0]);
    int status = 0;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    return got ? spent : 0.0;
}

// Measures frame by frame, with nothing else running in the process.
void measure_stages(const Record& record, const Picture& picture, int frames, Backend backend,
                    const std::string& file, Steps& steps, RenderBenchRow& row) {
    const Stage stage(record, stage_options(picture));
    Renderer renderer(backend);
    renderer.on_table([&steps](int, int) { steps.look(); });
    KeptImage image;
    KeptPng png;
    std::vector<std::uint8_t> bytes;
    std::vector<double> draw, read, both, encode, share, write;
    for (int i = 0; i <= frames; ++i) {
        steps.next();
        const double t0 = cpu_ms();
        renderer.draw(stage.at(record.duration * i / frames));
        const double t1 = cpu_ms();
        renderer.read(image);
        const double t2 = cpu_ms();
        png.encode(image, bytes);
        const double t3 = cpu_ms();
        const Clock::time_point before = Clock::now();
        write_file(file, bytes);
        if (i == 0) continue;
        draw.push_back(t1 - t0);
        read.push_back(t2 - t1);
        both.push_back(t2 - t0);
        encode.push_back(t3 - t2);
        share.push_back(png.share());
        write.push_back(wall_ms_since(before));
    }
    row.draw_ms = median(draw);
    row.readback_ms = median(read);
    row.encode_ms = median(encode);
    row.encoded_share = median(share);
    row.write_ms = median(write);
    std::sort(both.begin(), both.end());
    row.slow_ms = both[both.size() * 19 / 20];
}

// Sets the rates of whole files from the first frame to the last.
void measure_sequence(const Record& record, const Picture& picture, int frames, Backend backend,
                      const std::string& pattern, Steps& steps, RenderBenchRow& row) {
    SequenceOptions options;
    options.pattern = pattern;
    options.size = picture.size;
    options.camera = picture.camera;
    options.backend = backend;
    options.fps = frames / std::max(record.duration, 1e-3);
    Clock::time_point first;
    double first_cpu = 0.0;
    long done = 0;
    options.progress = [&](long count, long) {
        if (count == 1) {
            first = Clock::now();
            first_cpu = cpu_ms();
        }
        done = count;
        steps.next();
    };
    options.table_progress = [&steps](int, int) { steps.look(); };
    render_sequence(record, options);
    row.fps = 1e3 * static_cast<double>(done - 1) / wall_ms_since(first);
    row.cpu_ms = (cpu_ms() - first_cpu) / static_cast<double>(done - 1);
}

}  // namespace

std::vector<RenderBenchRow> bench_render(const Record& record, int frames, Backend backend) {
    if (frames < 3) throw RenderError("measuring takes at least 3 frames");
    const TemporaryFolder folder;
    // Every row is measured with one thread, and with one thread per core.
    Steps steps{static_cast<long>(kPictures.size()) * (2L * frames + 3L)};
    std::vector<RenderBenchRow> rows;
    for (const Picture& picture : kPictures) {
        RenderBenchRow row;
        row.name = picture.name;
        row.setup_ms = set_up_ms(record, picture, backend);
        steps.next();
        rows.push_back(row);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Picture& picture = kPictures[i];
        RenderBenchRow& row = rows[i];
        measure_stages(record, picture, frames, backend, folder.file("one.png"), steps, row);
        measure_sequence(record, picture, frames, backend, folder.file("%05d.png"), steps, row);
    }
    return rows;
}

namespace {

struct BenchRenderArgs {
    std::string scene = "scenes/eight_ball_break.toml";
    int frames = 120;
    std::string gl = "auto";
    bool json = false;
};

int run(const BenchRenderArgs& args) {
    const Record record = simulate_plan(plan_scene(args.scene), {});
    Table table(Column("name", "picture", "<12"), Column("draw_ms", "draw", ">9.2f"),
                Column("readback_ms", "readback", ">10.2f"),
                Column("draw_readback_p95_ms", "both p95", ">10.2f"), Column("encode_ms", "encode", ">9.2f"),
                Column("encoded_share", "share", ">8.3f"), Column("write_ms", "write", ">9.2f"),
                Column("setup_ms", "set-up", ">10.0f"), Column("cpu_ms", "all CPU", ">10.2f"),
                Column("fps", "frames/s", ">12.1f"));
    for (const RenderBenchRow& r : bench_render(record, args.frames, backend_from_name(args.gl)))
        table.add({r.name, r.draw_ms, r.readback_ms, r.slow_ms, r.encode_ms, r.encoded_share, r.write_ms,
                   r.setup_ms, r.cpu_ms, r.fps});
    if (args.json) {
        const nlohmann::ordered_json all = {
            {"gl", args.gl}, {"frames", args.frames}, {"rows", table_json(table)}};
        print(all.dump(2) + "\n");
        return kOk;
    }
    print(
        fmt::format("{}: {} frames of each picture, spread over the shot; CPU ms a frame, medians after the "
                    "first; share of the picture that is "
                    "encoded anew; write is wall time; set-up is CPU time of a process "
                    "of its own for its first picture, without shaders that Mesa kept; all CPU is the "
                    "CPU time of a frame of files written with a thread per core\n\n{}",
                    args.scene, args.frames, table_text(table)));
    return kOk;
}

}  // namespace

void add_bench_render(Options& bench) {
    auto [command, args] = bench.command<BenchRenderArgs>(
        "render", "What drawing, reading back and encoding a frame costs", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)");
    command.option("--frames", &args.frames, "N", "Frames of each picture, spread over the shot")
        .in(3, 100000);
    add_gl(command, args.gl);
    command.flag("--json", args.json, "Print JSON (default: off)");
}

}  // namespace carom::tools
