// Pages: self-contained HTML files. A page has its own script and style, which its Content-Security-Policy
// names by their hashes, and may load nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace carom::tools {

/// A script or another file that the build embedded in the program.
struct PageFile {
    const char* name;
    const char* text;
    const char* sha256;                ///< of the text, in hexadecimal digits
    std::vector<const char*> imports;  ///< names of the scripts that it needs
};
const std::vector<PageFile>& page_files();
/// Adds the page files of another library: the laboratory's.
void add_page_files(const std::vector<PageFile>& more);

/// Data for a page's scripts: JSON in an element with this id.
struct PageData {
    std::string id, json;
};

/// For a few pages only.
struct PageExtras {
    std::vector<std::string> styles;  ///< names of page files, after style.css
    bool wasm = false;                ///< the page may compile WebAssembly, also in a worker
};

/// The whole file. @param script  the name of the page's script, which includes its imports
std::string page_html(const std::string& title, const std::string& script, const std::vector<PageData>& data,
                      const PageExtras& extras = {});

/// The header of every page: title, subtitle, the command that made it, program and machine.
nlohmann::ordered_json page_json(const std::string& title, const std::string& lead,
                                 const std::string& command, const std::string& version);

}  // namespace carom::tools
