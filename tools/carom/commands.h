// The sub-commands: what each takes from the command line,
// and the function that does it. Each returns an exit status.
//
// A new one needs: a struct and a run_ function here, a file of its own, and an add_ function in options/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace carom::tools {

struct SimulateArgs {
    std::string scene;
    std::string record;  ///< file names; empty: not asked for
    std::string events;
    std::string samples;
    std::optional<double> sample_dt;  ///< [s]
    std::optional<double> until;      ///< [s]
    bool hash = false;
    bool profile = false;
    bool json = false;
    bool verify = false;  ///< check the laws after every event
};
int run_simulate(const SimulateArgs& args);

struct RenderArgs {
    std::string input;  ///< a scene, or a record (.json)
    std::string pattern = "frames/%05d.png";
    std::optional<double> fps;
    std::string size;  ///< "1280x720"; empty: the scene's
    double from = 0.0;
    std::optional<double> to;
    std::optional<long> frame;
    std::optional<double> at;
    std::string camera;  ///< empty: the scene's
    std::string gl = "osmesa";
    int png_level = 1;
    std::string eye, target;  ///< "x,y,z"; empty: a named camera
    std::string ball;         ///< that camera follow follows; empty: the one that moves first
    std::string overlay;      ///< list of names
    bool trails = false;      ///< --overlay trails
    std::string sheet;        ///< "4x3"; empty: frames
    int jobs = 0;
    bool resume = false;
    bool raw = false;
};
int run_render(const RenderArgs& args);

struct MarginArgs {
    std::string scene;
    std::optional<double> fps;
    std::string size;
    int repeat = 1;
    bool no_render = false;
    bool sweep = false;  ///< accuracy x frame rate
    std::string gl = "osmesa";
    std::string csv, plot, trace;  ///< file names; empty: not asked for
    bool json = false;
};
int run_margin(const MarginArgs& args);

struct SweepArgs {
    std::string scene;
    std::vector<std::string> vary;  ///< "KEY=DISTRIBUTION"
    std::uint64_t count = 0;
    std::uint64_t seed = 1;
    int jobs = 0;
    std::string shard;  ///< "2/4"; empty: all
    std::string output;
};
int run_sweep(const SweepArgs& args);

struct CheckArgs {
    std::string scene;
};
int run_check(const CheckArgs& args);

struct BenchRenderArgs {
    std::string scene = "scenes/eight_ball_break.toml";
    int frames = 120;
    std::string gl = "osmesa";
    bool json = false;
};
int run_bench_render(const BenchRenderArgs& args);

struct ImpactArgs {
    std::string method = "mathavan";
    std::optional<int> substeps;
    double tolerance = 1e-6;
    std::string cloth_slip = "consistent";
};
int run_impact(const ImpactArgs& args);

}  // namespace carom::tools
