// The files of the interactive page, which the build puts into the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "page/page.h"

namespace carom::tools {

/// Scripts and styles in this folder, core.js of the npm package, the schema of scene files, the scenes that
/// come with carom, and carom.wasm if tools/web has built it.
const std::vector<PageFile>& play_files();

/// The text of one of them, or "" if there is none.
inline std::string play_file(std::string_view name) {
    for (const PageFile& file : play_files())
        if (file.name == name) return file.text;
    return "";
}

}  // namespace carom::tools
