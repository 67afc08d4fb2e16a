// carom-lab compare: the paths of two shots in one picture.
#include <string>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "compare/picture.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

struct PictureArgs {
    std::string a, b, plot;
};

int run(const PictureArgs& args) {
    check_plot_path(args.plot);
    write_plot(ways_plot(read_shot(args.a, {}), harmless(args.a), read_shot(args.b, {}), harmless(args.b)),
               args.plot);
    return kOk;
}

}  // namespace

void add_lab_compare(Options& program) {
    auto [command, args] =
        program.command<PictureArgs>("compare", "The paths of two shots in one picture", run);
    command.argument("A", args.a, "Scene file (TOML) or record (.json)").required = true;
    command.argument("B", args.b, "Scene file or record to compare with; its paths are dashed").required =
        true;
    add_plot(command, args.plot);
    command.rows.back().required = true;
}

}  // namespace carom::tools
