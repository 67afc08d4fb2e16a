// The design's layers, lab -> tools -> render -> games -> engine -> kernel, as a check of every file's
// includes.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace carom::test {

/// One sentence for every include and every target in a CMakeLists.txt under `root` that points upwards, into
/// another room or into the laboratory, that cannot be resolved, or that brings in a library forbidden to its
/// layer; and for every product target that reads tests/.
std::vector<std::string> layer_violations(const std::filesystem::path& root);

/// "games -> engine" for every folder of the product that includes a file of another one.
std::set<std::string> layer_arrows(const std::filesystem::path& root);

/// The same from the lines "games -> engine, kernel" below the heading "## Layers" of
/// docs/design/architecture.md.
std::set<std::string> described_arrows(std::string_view page);

}  // namespace carom::test
