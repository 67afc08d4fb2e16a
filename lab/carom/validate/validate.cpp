// carom-lab validate: shots measured on real tables, compared with carom's results.
#include <string>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "report/plot.h"
#include "report/table.h"
#include "validate/case.h"
#include "validate/report.h"
#include "validate/run.h"

namespace carom::tools {
namespace {

struct ValidateArgs {
    std::string id, csv, plot;
    bool json = false;
};

int run(const ValidateArgs& args) {
    check_plot_path(args.plot);
    const kernel::Isa isa = chosen_isa();
    const std::vector<ValidationCase> cases = chosen_cases(args.id);
    long all = 0, done = 0;
    for (const ValidationCase& c : cases) all += runs_of(c);
    std::vector<ValidationRow> rows;
    {
        ProgressLine line("validate");
        for (const ValidationCase& c : cases) {
            const std::vector<ValidationRow> more =
                run_case(c, isa, [&](long runs) { line.show_bar(done + runs, all); });
            rows.insert(rows.end(), more.begin(), more.end());
            done += runs_of(c);
        }
    }
    write_report(args.csv, table_csv(validation_table(rows)));
    if (!args.plot.empty()) write_plot(validation_plot(rows), args.plot);
    print(args.json ? validation_json(rows) : validation_text(rows));
    return kOk;
}

}  // namespace

void add_validate(Options& program) {
    auto [command, args] = program.command<ValidateArgs>(
        "validate", "Shots that were measured on real tables, beside what carom computes", run);
    command.argument("CASE", args.id, "One case, such as V3 (default: all)");
    add_reports(command, args.csv, args.json);
    add_plot(command, args.plot);
    command.footer =
        "It reports and does not judge: the exit status is 0 also where a number is missed. The cases, their "
        "sources and "
        "what they show: docs/reference/validation.md.";
}

}  // namespace carom::tools
