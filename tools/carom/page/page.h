// Pages: self-contained HTML files. A page has a script and a style of its own, which its Content-Security-Policy names by their
// hashes, and may load nothing.
#pragma once

#include <string>
#include <vector>

namespace carom::tools {

/// A file of tools/carom/page, which the build puts into the program.
struct PageFile {
    const char* name;
    const char* text;
    const char* sha256;  ///< of the text, in hexadecimal digits
};
const std::vector<PageFile>& page_files();

/// What the scripts of a page read: JSON in an element with this id.
struct PageData {
    std::string id, json;
};

/// The whole file. @param scripts  names of files of tools/carom/page, in their order
std::string page_html(const std::string& title, const std::vector<std::string>& scripts,
                      const std::vector<PageData>& data);

/// Checks the argument of -o or --html before any work is done. @throws UsageError
void check_page_path(const std::string& option, const std::string& path);

}  // namespace carom::tools
