// The reports of carom-lab as pages, in a browser.
#include "lab_cli.h"

#include <string>
#include <vector>
#include "tools/browser.h"

namespace carom::test {
namespace {

TEST(LabPages, ABrowserShowsReports) {
    if (!has("node")) GTEST_SKIP() << "node is not installed";
    if (!has("chromium")) GTEST_SKIP() << "chromium is not installed";
    const TemporaryFolder folder;
    const std::string scene = folder.write("small.toml", kSmallScene);
    Json reports = Json::array();
    // `column`: a column of numbers in the last table.
    const auto make = [&](const std::string& name, int column, std::vector<std::string> command) {
        const std::string file = folder.file(name + ".html");
        command.insert(command.end(), {"--html", file});
        const ProcessResult made = carom_lab(command);
        EXPECT_EQ(made.status, 0) << made.err;
        reports.push_back({{"name", name},
                           {"file", file},
                           {"column", column},
                           {"command", "carom-lab " + command.front()}});
    };
    make("margin", 3, {"margin", scene, "--no-render"});
    make("margin_sweep", 5, {"margin", scene, "--no-render", "--sweep"});
    make("accuracy", 2, {"accuracy", scene, "--repeat", "1", "--march", "10,30", "--tolerance", "1e-3,1e-6"});
    make("accuracy_kernel", 3,
         {"accuracy", "kernel", "--count", "20", "--repeat", "1", "--most-substeps", "100"});
    expect_no_fault(folder, {{"chromium", "chromium"},
                             {"profile", folder.file("profile")},
                             {"pages", Json::array()},
                             {"reports", reports}});
}

}  // namespace
}  // namespace carom::test
