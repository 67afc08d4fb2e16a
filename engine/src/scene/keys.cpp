#include "scene/keys.h"

#include <charconv>

#include "carom/engine/printable.h"
#include "scene/distribution.h"

namespace carom::detail {

bool take(std::string_view& key, std::string_view name) {
    if (key.size() <= name.size() || key.substr(0, name.size()) != name || key[name.size()] != '.')
        return false;
    key.remove_prefix(name.size() + 1);
    return true;
}

std::size_t take_part(std::string_view& key, const std::string& list) {
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

// The names are those of docs/reference/scene_format.md.
std::size_t element_index(std::string_view name) {
    constexpr struct {
        const char* name;
        std::size_t index;
    } kNames[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"side", 0}, {"height", 1}, {"width", 0}};
    for (const auto& known : kNames)
        if (name == known.name) return known.index;
    std::size_t index = 0;
    const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error != std::errc() || rest != name.data() + name.size())
        fail("{} is not an element of an array; use x, y, z, side, height or an index from 0",
             in_quotes(name));
    return index;
}

}  // namespace carom::detail
