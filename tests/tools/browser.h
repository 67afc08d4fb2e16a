// Pages in a real browser.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli.h"

namespace carom::test {

using Json = nlohmann::json;

inline constexpr char kView[] = CAROM_SOURCE_DIR "/tests/tools/view/";

inline bool has(const char* program) {
    return run_process({program, "--version"}).status == 0;
}

/// Lets the browser open all pages of a manifest. To look at them, set CAROM_VIEW_PICTURES to a folder for
/// its screenshots.
inline void expect_no_fault(const TemporaryFolder& folder, const Json& manifest) {
    const char* const pictures = std::getenv("CAROM_VIEW_PICTURES");
    const ProcessResult seen =
        run_process({"node", kView + std::string("browser.mjs"),
                     folder.write("manifest.json", manifest.dump()), pictures != nullptr ? pictures : ""});
    EXPECT_EQ(seen.status, 0) << seen.out << seen.err;
    const std::size_t pages = manifest.at("pages").size() + manifest.at("reports").size();
    EXPECT_TRUE(contains(seen.out, fmt::format("{} pages, 0 faults", pages))) << seen.out;
    std::fputs(seen.out.c_str(), stdout);
}

}  // namespace carom::test
