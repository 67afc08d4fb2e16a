// The layers of the design, tools -> render -> engine -> kernel, as a check of what every file includes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace carom::test {

/// One sentence for every include (and every target in a CMakeLists.txt) of kernel/, engine/, render/ or
/// tools/ under `root` that points upwards, that cannot be resolved, or that brings in a library which the
/// layer may not use.
std::vector<std::string> layer_violations(const std::filesystem::path& root);

}  // namespace carom::test
