#include "options/options.h"

#include <string>

namespace carom::tools {

void add_gl(CLI::App& sub, std::string& gl) {
    sub.add_option("--gl", gl, "OpenGL without a display: osmesa, or egl (surfaceless)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"osmesa", "egl"}))
        ->capture_default_str();
}

void add_reports(CLI::App& sub, std::string& csv, std::string& plot, bool& json) {
    sub.add_option("--csv", csv, "Write the table (default: not written)")->type_name("FILE.csv");
    sub.add_option("--plot", plot, "Draw it (default: not drawn)")->type_name("FILE.svg");
    sub.add_flag("--json", json, "Print JSON (default: off)");
}

}  // namespace carom::tools
