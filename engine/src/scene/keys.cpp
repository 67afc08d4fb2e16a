#include "scene/keys.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "base/as_number.h"
#include "carom/engine/printable.h"
#include "carom/engine/table.h"
#include "scene/distribution.h"

namespace carom::detail {
namespace {

/// Removes "name." from the front of a key; false if the key does not begin with it.
bool take(std::string_view& key, std::string_view name) {
    if (key.size() <= name.size() || !key.starts_with(name) || key[name.size()] != '.') return false;
    key.remove_prefix(name.size() + 1);
    return true;
}

/// Removes the id of a ball, and returns its index. Ids may contain dots.
std::size_t take_ball(std::string_view& key, const std::vector<std::string>& ids) {
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (take(key, ids[i])) return i;
    fail("there is no such ball; write ball.ID.position.x with one of these ids: {}",
         ids.empty() ? "none is written" : fmt::format("{}", fmt::join(ids, ", ")));
}

/// Removes the name of a part of the table ("c2" in the list "cushion"), and returns its index.
std::size_t take_part(std::string_view& key, std::string_view list) {
    const char letter = list.front();
    std::size_t number = 0;
    const char* const end = key.data() + key.size();
    const bool lettered = !key.empty() && key[0] == letter;
    const auto [rest, error] = std::from_chars(key.data() + (lettered ? 1 : 0), end, number);
    if (!lettered || error != std::errc() || rest == end || *rest != '.' || number < 1)
        fail("name the part by its number, as in table.{}.{}1.radius", list, letter);
    key.remove_prefix(static_cast<std::size_t>(rest + 1 - key.data()));
    return number - 1;
}

/// The index of "x", "side" or "0". The names are listed in docs/reference/scene_format.md.
std::size_t element_index(std::string_view name) {
    constexpr struct {
        const char* name;
        std::size_t index;
    } kNames[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"side", 0}, {"height", 1}, {"width", 0}};
    for (const auto& known : kNames)
        if (name == known.name) return known.index;
    if (const auto index = as_number<std::size_t>(name)) return *index;
    fail("{} is not an element of an array; use x, y, z, side, height or an index from 0", in_quotes(name));
}

void take_list(std::string_view& key, KeyPath& path) {
    for (const PocketSection& pockets : kPocketSections)
        if (path.list.empty() && take(key, pockets.key)) path.list = pockets.key;
    for (const char* list : {"cushion", "jaw", "arc", "pocket"}) {
        if (!path.list.empty() || !take(key, list)) continue;
        path.list = list;
        path.index = take_part(key, list);
    }
}

std::vector<std::string> steps_of(const KeyPath& path) {
    std::vector<std::string> steps = {path.section};
    if (!path.list.empty()) steps.push_back(path.list);
    if (path.index) steps.push_back(std::to_string(*path.index));
    steps.push_back(path.name);
    if (path.element) steps.push_back(std::to_string(*path.element));
    return steps;
}

}  // namespace

KeyPath parse_key(std::string_view key, const std::vector<std::string>& ids) {
    KeyPath path;
    const std::size_t dot = key.find('.');
    if (dot == key.npos || dot == 0) fail("name a value in its section, such as cue.speed");
    path.section = key.substr(0, dot);
    key.remove_prefix(dot + 1);
    if (path.section == "ball") path.index = take_ball(key, ids);
    if (path.section == "table") take_list(key, path);
    const std::size_t end = key.find('.');
    path.name = key.substr(0, end);
    if (path.name.empty()) fail("the name of the value is missing");
    if (end != key.npos) path.element = element_index(key.substr(end + 1));
    return path;
}

bool KeyPath::overlaps(const KeyPath& other) const {
    const std::vector<std::string> a = steps_of(*this), b = steps_of(other);
    const auto common = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
    return std::equal(a.begin(), a.begin() + common, b.begin());
}

}  // namespace carom::detail
