// The options of every command. Only this folder, main.cpp and describe.cpp include CLI11, which takes seconds to compile.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace carom::tools {

/// What the command that was named will do.
using Action = std::function<int()>;

// Commands on a scene or record: shots.cpp.
void add_simulate(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);
void add_margin(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_impact(CLI::App& app, Action& action);
// Commands that measure accuracy and time: measurements.cpp.
void add_accuracy(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);

// Options that several commands have.
void add_gl(CLI::App& sub, std::string& gl);
void add_reports(CLI::App& sub, std::string& csv, std::string& plot, bool& json);

}  // namespace carom::tools
