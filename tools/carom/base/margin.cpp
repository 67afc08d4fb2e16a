// The measurement behind `carom margin` and the chart of `carom view`.
#include "base/margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/clock.h"
#include "base/console.h"
#include "base/setup.h"
#include "base/temporary_folder.h"
#include "carom/render/sequence.h"

namespace carom::tools {
namespace {

using Clock = std::chrono::steady_clock;

double wall_ms() {
    return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count();
}

/// When the process had loaded its libraries.
const double kProcessStart = wall_ms();

render::SequenceOptions draw_options(const Record& record, const FrameSettings& drawn, double fps) {
    const RenderSettings& settings = record.render;
    render::SequenceOptions options;
    options.fps = fps;
    options.jobs = 1;  // with one thread the parts of a frame cannot overlap
    options.size = drawn.size.value_or(settings.size());
    options.camera = settings.camera;
    options.view.eye = settings.eye;
    options.view.target = settings.target;
    options.backend = render::backend_from_name(drawn.gl);
    return options;
}

void draw(MarginRun& run, const FrameSettings& drawn, double fps, const std::string& title) {
    const TemporaryFolder folder;
    render::SequenceOptions options = draw_options(run.record, drawn, fps);
    options.pattern = folder.file("%d.png");
    const double start = wall_ms();
    double first_done = start;
    ProgressLine line(title);
    options.progress = [&](long done, long total) {
        if (done == 1) first_done = wall_ms();
        throw_if_interrupted();
        std::remove(render::frame_path(options.pattern, done - 1).c_str());
        line.show_bar(done, total);
    };
    options.table_progress = [](int, int) { throw_if_interrupted(); };
    const std::vector<render::FrameTiming> timings = render::render_sequence(run.record, options);
    for (const render::FrameTiming& t : timings) {
        run.stage[kDraw].push_back(t.draw_ms);
        run.stage[kReadback].push_back(t.readback_ms);
        run.stage[kEncode].push_back(t.encode_ms);
        run.stage[kWrite].push_back(t.write_ms);
        run.encoded_share.push_back(t.encoded_share);
    }
    run.setup_ms = first_done - start - (run.total(0) - run.stage[kSimulate][0]);
}

/// The cost of a frame that is shown but not written.
double shown_ms(const Margin& margin, std::size_t frame) {
    return margin.total[frame] - margin.stage[kEncode][frame] - margin.stage[kWrite][frame];
}

void widen(Range& range, double value, bool first) {
    range.low = first ? value : std::min(range.low, value);
    range.high = first ? value : std::max(range.high, value);
}

}  // namespace

double Margin::time(std::size_t frame) const {
    return render::frame_time(0.0, static_cast<long>(frame), fps);
}

const char* name(MarginStage stage) {
    constexpr const char* kNames[kMarginStages] = {"simulate", "detect",   "resolve", "kernel", "cluster",
                                                   "draw",     "readback", "encode",  "write"};
    return kNames[stage];
}

bool is_part_of_simulate(std::size_t stage) {
    return stage > kSimulate && stage <= kCluster;
}

double MarginRun::total(std::size_t frame) const {
    double ms = stage[kSimulate][frame];
    for (std::size_t s = kDraw; s < kMarginStages; ++s)
        if (frame < stage[s].size()) ms += stage[s][frame];
    return ms;
}

void add_simulation(MarginRun& run, const FrameCost& frame) {
    run.stage[kSimulate].push_back(frame.simulate_ms());
    run.stage[kDetect].push_back(frame.detect_ms);
    run.stage[kResolve].push_back(frame.resolve_ms);
    run.stage[kKernel].push_back(frame.kernel_ms);
    run.stage[kCluster].push_back(frame.cluster_ms);
}

MarginRun one_run(const Plan& plan, const FrameSettings* drawn, double fps, const std::string& title) {
    MarginRun run;
    SimulateOptions options = interruptible();
    options.profile = true;
    run.record = simulate(plan, options);
    const long frames = checked_frame_count(0.0, run.record.duration, fps);
    run.frames = costs_by_frame(run.record, 0.0, fps, frames);
    for (const FrameCost& frame : run.frames) add_simulation(run, frame);
    if (drawn) draw(run, *drawn, fps, title);
    throw_if_interrupted();
    return run;
}

void account(const MarginRun& run, Accounting& sum) {
    sum.setup_ms += run.setup_ms;
    sum.first_frames_ms += run.total(0);
    for (std::size_t k = 1; k < run.frames.size(); ++k) sum.frames_ms += run.total(k);
}

double process_ms() {
    return wall_ms() - kProcessStart;
}

Spread spread(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {percentile(values, 50.0), percentile(values, 95.0), percentile(values, 99.0), values.back()};
}

Margin combine(const std::vector<MarginRun>& runs, double fps, bool rendered) {
    Margin margin;
    margin.fps = fps;
    margin.budget_ms = 1000.0 / fps;
    margin.rendered = rendered;
    margin.runs = static_cast<int>(runs.size());
    const std::size_t frames = runs.front().frames.size();
    std::vector<double> spreads;
    for (std::size_t k = 0; k < frames; ++k) {
        for (std::size_t s = 0; s < kMarginStages; ++s) {
            std::vector<double> samples;
            for (const MarginRun& run : runs)
                if (k < run.stage[s].size()) samples.push_back(run.stage[s][k]);
            margin.stage[s].push_back(samples.empty() ? 0.0 : median(samples));
        }
        // Every run encodes the same share.
        if (rendered && k < runs.front().encoded_share.size())
            margin.encoded_share.push_back(runs.front().encoded_share[k]);
        double ms = margin.stage[kSimulate][k];
        for (std::size_t s = kDraw; s < kMarginStages; ++s) ms += margin.stage[s][k];
        margin.total.push_back(ms);
        if (ms > margin.budget_ms) ++margin.missed;
        if (shown_ms(margin, k) > margin.budget_ms) ++margin.missed_shown;
        if (ms > margin.total[margin.worst]) margin.worst = k;
        Range range;
        for (std::size_t r = 0; r < runs.size(); ++r) widen(range, runs[r].total(k), r == 0);
        spreads.push_back(ms > 0.0 ? (range.high - range.low) / ms : 0.0);
    }
    margin.frame_spread = median(spreads);
    margin.quiet =
        static_cast<std::size_t>(std::count_if(runs.front().frames.begin(), runs.front().frames.end(),
                                               [](const FrameCost& frame) { return frame.events.empty(); }));
    for (std::size_t r = 0; r < runs.size(); ++r) {
        std::vector<double> totals;
        for (std::size_t k = 0; k < frames; ++k) totals.push_back(runs[r].total(k));
        const auto missed = std::count_if(totals.begin(), totals.end(),
                                          [&margin](double ms) { return ms > margin.budget_ms; });
        const Spread s = spread(totals);
        const auto add = [&](RunTotals& to, bool is_first) {
            widen(to.p50, s.p50, is_first);
            widen(to.p99, s.p99, is_first);
            widen(to.max, s.max, is_first);
            widen(to.missed, static_cast<double>(missed), is_first);
            widen(to.setup_ms, runs[r].setup_ms, is_first);
            widen(to.frame_0_ms, totals[0], is_first);
        };
        add(margin.all, r == 0);
        add(r == 0 ? margin.first : margin.warm, r <= 1);
        account(runs[r], margin.accounting);
    }
    return margin;
}

TimingCost cost_of_timing(const Plan& plan) {
    constexpr int kRounds = 9, kLooks = 1000;
    TimingCost cost;
    const auto samples = interleaved("margin, cost of timing:", 2, kRounds, [&plan](std::size_t i) {
        SimulateOptions options;
        options.profile = i == 1;
        const double start = thread_ns();
        const Record record = simulate(plan, options);
        return (thread_ns() - start) * 1e-6;
    });
    cost.plain_ms = minimum(samples[0]);
    cost.profiled_ms = minimum(samples[1]);
    cost.clock_ns = INFINITY;
    for (int round = 0; round < kRounds; ++round) {
        const Clock::time_point start = Clock::now();
        for (int i = 1; i < kLooks; ++i) static_cast<void>(Clock::now());
        const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
        cost.clock_ns = std::min(cost.clock_ns, ns / kLooks);
    }
    return cost;
}

long frame_of(double t, double from, double fps, long frames) {
    if (frames <= 1 || !(t > from)) return 0;
    const long last = frames - 1;
    const double guess = std::floor((t - from) * fps);
    long k = guess >= static_cast<double>(last) ? last : static_cast<long>(guess);
    // The guess is rounded; the frames' own times decide.
    while (k > 0 && render::frame_time(from, k, fps) > t) --k;
    while (k < last && render::frame_time(from, k + 1, fps) <= t) ++k;
    return k;
}

std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames) {
    std::vector<FrameCost> sums(static_cast<std::size_t>(std::max(frames, 1L)));
    constexpr double kMsPerNs = 1e-6;
    sums[0].detect_ms = record.setup_detect_ns * kMsPerNs;
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        FrameCost& sum = sums[frame_of(record.events[i].time, from, fps, frames)];
        sum.events.push_back(i);
        if (i >= record.costs.size()) continue;
        const EventCost& cost = record.costs[i];
        const bool cluster = record.events[i].type == EventType::kBallCluster;
        sum.detect_ms += cost.detect_ns * kMsPerNs;
        sum.resolve_ms += (cost.resolve_ns - cost.kernel_ns) * kMsPerNs;
        (cluster ? sum.cluster_ms : sum.kernel_ms) += cost.kernel_ns * kMsPerNs;
    }
    return sums;
}

double percentile(const std::vector<double>& sorted, double p) {
    const double rank = std::ceil(p / 100.0 * static_cast<double>(sorted.size()));
    const auto index =
        static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1;
    return sorted[index];
}

}  // namespace carom::tools
