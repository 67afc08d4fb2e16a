#include "page/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/machine.h"

namespace carom::tools {
namespace {

/// The files of this library, and those that other libraries have added.
std::vector<PageFile>& known_files() {
    static std::vector<PageFile> files = page_files();
    return files;
}

const PageFile& page_file(std::string_view name) {
    const std::vector<PageFile>& files = known_files();
    const auto found =
        std::find_if(files.begin(), files.end(), [&name](const PageFile& file) { return file.name == name; });
    if (found == files.end()) throw std::logic_error("no page file is called " + std::string(name));
    return *found;
}

/// Adds a script to the list, after those that it imports.
void add_script(std::string_view name, std::vector<const PageFile*>& scripts) {
    const PageFile& file = page_file(name);
    if (std::find(scripts.begin(), scripts.end(), &file) != scripts.end()) return;
    for (const char* const needed : file.imports) add_script(needed, scripts);
    scripts.push_back(&file);
}

/// Base64 of hexadecimal digits: the form in which a policy writes a hash.
std::string base64(const std::string& hex) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t at = 0; at < hex.size(); at += 6) {
        // Three bytes are six digits and four letters; missing bytes at the end count as 0 and show as "=".
        std::string six = hex.substr(at, 6);
        const std::size_t letters = six.size() / 2 + 1;
        six.resize(6, '0');
        const auto bits = static_cast<std::uint32_t>(std::stoul(six, nullptr, 16));
        for (std::size_t i = 0; i < 4; ++i) out += i < letters ? kDigits[(bits >> (18 - 6 * i)) & 63U] : '=';
    }
    return out;
}

std::string policy_hash(const PageFile& file) {
    return fmt::format(" 'sha256-{}'", base64(file.sha256));
}

std::string replaced(const std::string& text, char what, std::string_view with) {
    std::string out;
    for (const char c : text) {
        if (c == what)
            out += with;
        else
            out += c;
    }
    return out;
}

std::string as_html(const std::string& text) {
    return replaced(replaced(text, '&', "&amp;"), '<', "&lt;");
}

/// JSON whose texts cannot end the element: "<" occurs only in strings, where it may be escaped.
std::string inlined(const std::string& json) {
    return replaced(json, '<', "\\u003c");
}

}  // namespace

void add_page_files(const std::vector<PageFile>& more) {
    known_files().insert(known_files().end(), more.begin(), more.end());
}

std::string page_html(const std::string& title, const std::string& script, const std::vector<PageData>& data,
                      const PageExtras& extras) {
    std::vector<const PageFile*> scripts;
    add_script(script, scripts);
    std::vector<std::string> style_names = {"style.css"};
    style_names.insert(style_names.end(), extras.styles.begin(), extras.styles.end());
    std::string policy = "default-src 'none'; base-uri 'none'; form-action 'none'; style-src", styles;
    for (const std::string& name : style_names) {
        policy += policy_hash(page_file(name));
        styles += std::string("<style>") + page_file(name).text + "</style>\n";
    }
    policy += "; script-src";
    if (extras.wasm) policy += " 'wasm-unsafe-eval'";
    for (const PageFile* const file : scripts) policy += policy_hash(*file);
    // Its worker is a script that the page assembles from its own scripts.
    if (extras.wasm) policy += "; worker-src blob:";
    std::string html =
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
        policy +
        "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
        as_html(title) + "</title>\n" + styles +
        "</head>\n<body>\n<noscript>This page needs JavaScript.</noscript>\n";
    for (const PageData& item : data)
        html +=
            "<script type=\"application/json\" id=\"" + item.id + "\">" + inlined(item.json) + "</script>\n";
    for (const PageFile* const file : scripts) html += std::string("<script>") + file->text + "</script>\n";
    return html + "</body>\n</html>\n";
}

nlohmann::ordered_json page_json(const std::string& title, const std::string& lead,
                                 const std::string& command, const std::string& version) {
    return {{"title", title},
            {"lead", lead},
            {"command", command},
            {"machine", fmt::format("carom {} on {}", version, processor())}};
}

}  // namespace carom::tools
