// From text to a validated scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "carom/engine/tolerances.h"
#include "scene/reader.h"
#include "scene/sections.h"

namespace carom {
namespace {

void check_size(std::string_view text, const std::string& name) {
    if (text.size() <= kMaxFileSize) return;
    throw SceneError(name, {},
                     fmt::format("is larger than {} MiB; check that it is a scene file", kMaxFileSize >> 20));
}

[[noreturn]] void cannot_read(const std::string& path, const std::string& why) {
    throw SceneError(path, {}, fmt::format("cannot be read: {}", why));
}

}  // namespace

std::string read_scene_text(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        cannot_read(path, "there is no such file; check the path");
    if (error) cannot_read(path, error.message() + "; check the path and its permissions");
    if (std::filesystem::is_directory(status))
        cannot_read(path, "it is a directory; name a scene file in it");
    std::ifstream in(path, std::ios::binary);
    if (!in) cannot_read(path, "it cannot be opened; check its permissions");
    // In pieces: clearing a buffer for the largest file would take longer than a shot.
    std::string text;
    std::array<char, 1U << 14U> piece;
    while (in && text.size() <= kMaxFileSize) {
        in.read(piece.data(), piece.size());
        text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) cannot_read(path, "reading it failed");
    return text;
}

namespace detail {

toml::table toml_from(std::string_view text, const std::string& name) {
    check_size(text, name);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != text.npos && text[first] == '{')
        throw SceneError(name, {1, 1},
                         "this is JSON, but a scene is TOML; if it is a record, pass it to carom render, "
                         "view, export or compare");
    if (const auto deep = too_deep(text)) throw SceneError(name, deep->where, deep->what);
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        const SourceLocation where{static_cast<int>(at.line), static_cast<int>(at.column)};
        const std::string_view what = error.description();
        if (what.find("redefine") != std::string_view::npos) {
            throw SceneError(
                name, where,
                fmt::format("this key or section appears twice; keep one of the two ({})", what));
        }
        throw SceneError(name, where, fmt::format("not valid TOML; correct it here ({})", what));
    }
}

toml::table read_toml(const std::string& path) {
    return toml_from(read_scene_text(path), path);
}

Section top_of(const toml::table& file, const std::string& name) {
    return {
        file, name, "", {"table", "balls", "rack", "ball", "cue", "physics", "stop", "render", "effects"}};
}

Scene scene_from(const toml::table& file, const std::string& name) {
    const Section top = top_of(file, name);
    Scene scene;
    scene.file = name;
    read_balls(top, scene);
    read_physics(top, scene);
    read_table(top, scene);
    read_ball_list(top, scene);
    read_rack(top, scene);
    read_cue(top, scene);
    read_effects(top, scene);
    read_stop(top, scene);
    read_render(top, scene);
    check_scene(top, scene);
    return scene;
}

}  // namespace detail

SceneError::SceneError(const std::string& file, SourceLocation where, const std::string& message)
    : std::runtime_error(where.line > 0 ? fmt::format("{}:{}:{}: {}", file, where.line, where.column, message)
                                        : fmt::format("{}: {}", file, message)),
      file_(file),
      message_(message),
      where_(where) {}

Scene parse_scene(std::string_view text, const std::string& name) {
    return detail::scene_from(detail::toml_from(text, name), name);
}

Cue parse_cue(std::string_view text, const Scene& scene) {
    const toml::table file = detail::toml_from(text, scene.file);
    Scene struck = scene;
    detail::read_cue(detail::top_of(file, scene.file), struck);
    return struck.cue.value_or(Cue());
}

Scene read_scene(const std::string& path) {
    return parse_scene(read_scene_text(path), path);
}

namespace detail {
namespace {

// End of the string that begins at `at`. A string must be closed on its line unless it has three quotes.
std::size_t string_end(std::string_view toml, std::size_t at) {
    const char quote = toml[at];
    const auto marks = [&] { return std::min(toml.find_first_not_of(quote, at), toml.size()) - at; };
    const bool many_lines = marks() >= 3;
    for (at += many_lines ? 3 : 1; at < toml.size(); ++at) {
        if (toml[at] == '\n' && !many_lines) return at;
        // Up to two quotation marks may precede the closing three.
        if (toml[at] == quote && (!many_lines || marks() >= 3))
            return at + (many_lines ? std::min<std::size_t>(marks(), 5) : 1);
        if (toml[at] == '\\' && quote == '"') ++at;
    }
    return toml.size();
}

SourceLocation location(std::string_view before) {
    const std::string_view line = before.substr(before.rfind('\n') + 1);  // from 0 if there is none
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
            1 + static_cast<int>(characters)};
}

}  // namespace

std::optional<TooDeep> too_deep(std::string_view toml) {
    int parts = 1, depth = 0;
    bool in_value = false;
    for (std::size_t at = 0; at < toml.size(); ++at) {
        const char c = toml[at];
        if (c == '"' || c == '\'')
            at = string_end(toml, at) - 1;
        else if (c == '#')
            at = std::min(toml.find('\n', at), toml.size()) - 1;
        else if (c == '.' && ++parts > kMaxKeyParts)
            return TooDeep{location(toml.substr(0, at)),
                           fmt::format("this key has more than {} parts; remove some dots", kMaxKeyParts)};
        if (std::string_view("=,[]{}\n").find(c) == std::string_view::npos) continue;
        parts = 1;
        if (c == '=') in_value = true;
        if (c == ']' || c == '}') depth = std::max(0, depth - 1);
        if ((c == '[' || c == '{') && ++depth > kMaxNesting)
            return TooDeep{
                location(toml.substr(0, at)),
                fmt::format("brackets are nested more than {} deep here; close some above, or nest fewer",
                            kMaxNesting)};
        if (c == '\n') {
            // Only a value may continue on the next line. toml++ describes an unclosed bracket of a section
            // better.
            if (!in_value) depth = 0;
            in_value = depth > 0;
        }
    }
    return std::nullopt;
}

}  // namespace detail

}  // namespace carom
