#include "scene/distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/draws.h"
#include "base/nearest.h"
#include "base/toml_number.h"
#include "scene/reader.h"

namespace carom::detail {

toml::array arguments(std::string_view name, std::string_view text) {
    const std::string line = fmt::format("v = [{}\n]", text);
    if (const auto deep = too_deep(line)) fail("values of {}: {}", name, deep->what);
    try {
        const toml::table table = toml::parse(line);
        // Text that closes the bracket early could add further keys.
        if (const toml::array* array = table["v"].as_array(); array && table.size() == 1) return *array;
    } catch (const toml::parse_error&) {
    }
    fail("cannot read the values of {}({}); write numbers, or strings in double quotes, separated by commas",
         name, text);
}

namespace {

/// Value `i` of the list, read by a function of toml_number.h.
template <class Read>
auto value(std::string_view name, const toml::array& list, std::size_t i, const Read& read) {
    try {
        return read(list[i]);
    } catch (const std::invalid_argument& error) {
        fail("value {} of {} {}", i + 1, name, error.what());
    }
}

double number(std::string_view name, const toml::array& list, std::size_t i) {
    return value(name, list, i, [](const toml::node& node) { return number_in(node); });
}

std::int64_t whole(std::string_view name, const toml::array& list, std::size_t i) {
    return value(name, list, i, [](const toml::node& node) { return integer_in(node); });
}

/// The values of a list, at fixed addresses.
struct List {
    explicit List(toml::array list) : nodes(std::move(list)) {
        for (const toml::node& node : nodes) items.emplace_back(node);
    }
    /// kWhole only if all values are integers.
    ValueKind kind() const {
        const auto all = [this](auto&& is) { return std::all_of(nodes.begin(), nodes.end(), is); };
        if (all([](const toml::node& value) { return value.is_integer(); })) return ValueKind::kWhole;
        return all([](const toml::node& value) { return value.is_number(); }) ? ValueKind::kNumber
                                                                              : ValueKind::kText;
    }
    toml::array nodes;
    std::vector<ListItem> items;
};

Distribution grid_of_list(std::string_view text) {
    const auto list = std::make_shared<const List>(arguments("list", text));
    if (list->items.empty()) fail("list has 0 values; write list(v,...)");
    return {{}, list->kind(), list->items.size(), [list](std::uint64_t step) { return &list->items[step]; }};
}

Distribution grid_of_numbers(std::string_view text) {
    const toml::array values = arguments("grid", text);
    if (values.size() != 3) fail("grid has {} values; write grid(a,b,n) or grid(list(v,...))", values.size());
    const double low = number("grid", values, 0), high = number("grid", values, 1);
    const std::int64_t steps = whole("grid", values, 2);
    if (!std::isfinite(high - low)) fail("grid(a,b,n): b - a is too large for a number");
    if (steps < 1 || steps > 1000000000) fail("grid(a,b,n) needs 1 <= n <= 1000000000");
    if (steps == 1 && low != high) fail("grid(a,b,n) needs n >= 2 to reach from a to b");
    const auto last = static_cast<std::uint64_t>(steps - 1);
    // Integers suit keys that accept nothing else.
    constexpr double kExact = 0x1p53;
    const double each = last > 0 ? (high - low) / static_cast<double>(last) : 0.0;
    const bool whole_numbers = low == std::floor(low) && each == std::floor(each) &&
                               std::fmax(std::abs(low), std::abs(high)) < kExact;
    return {{},
            whole_numbers ? ValueKind::kWhole : ValueKind::kNumber,
            last + 1,
            [=](std::uint64_t step) -> DrawnValue {
                const double value =
                    step == last
                        ? high
                        : low + (high - low) * (static_cast<double>(step) / static_cast<double>(last));
                if (whole_numbers) return static_cast<std::int64_t>(value);
                return value;
            }};
}

}  // namespace

ListItem::ListItem(const toml::node& value) : node(&value) {
    if (const auto* words = value.as_string()) {
        text = words->get();
    } else if (const auto* x = value.as_floating_point()) {
        text = fmt::format("{}", x->get());
        number = x->get();
    } else {
        std::ostringstream out;
        value.visit([&out](const auto& v) { out << v; });
        text = out.str();
    }
    if (const auto* whole = value.as_integer()) {
        integer = whole->get();
        number = static_cast<double>(integer);
    }
    try {
        if (value.is_number()) exact = number_in(value);
    } catch (const std::invalid_argument&) {  // infinite, or more digits than a number can store
    }
}

Distribution parse_distribution(std::string_view text, const toml::node* own) {
    const std::size_t open = text.find('(');
    if (open == text.npos || text.back() != ')')
        fail(
            "expected uniform(a,b), normal(sd), normal(mean,sd), integer(a,b), list(v,...), grid(a,b,n) or "
            "grid(list(v,...))");
    const std::string_view name = text.substr(0, open);
    if (name == "grid") {
        const std::string_view inner = text.substr(open + 1, text.size() - open - 2);
        if (inner.starts_with("list(") && inner.ends_with(')'))
            return grid_of_list(inner.substr(5, inner.size() - 6));
        return grid_of_numbers(inner);
    }
    const toml::array list = arguments(name, text.substr(open + 1, text.size() - open - 2));
    const auto need = [&](std::size_t low, std::size_t high, const char* shape) {
        if (list.size() < low || list.size() > high)
            fail("{} has {} values; write {}", name, list.size(), shape);
    };
    if (name == "uniform") {
        need(2, 2, "uniform(a,b)");
        const double low = number(name, list, 0), high = number(name, list, 1);
        if (!(low <= high)) fail("uniform(a,b) needs a <= b");
        if (!std::isfinite(high - low)) fail("uniform(a,b): b - a is too large for a number");
        return {[=](SplitMix64& random) { return low + (high - low) * random.uniform(); }};
    }
    if (name == "normal") {
        need(1, 2, "normal(sd) or normal(mean,sd)");
        if (list.size() == 1 && (own == nullptr || !own->is_number()))
            fail("normal(sd) needs a number in the scene as its centre; add it, or use normal(mean,sd)");
        const double mean = list.size() == 1 ? number_in(*own) : number(name, list, 0);
        const double deviation = number(name, list, list.size() - 1);
        if (!(deviation >= 0.0)) fail("the standard deviation of normal must be at least 0");
        return {[=](SplitMix64& random) { return mean + deviation * standard_normal(random); }};
    }
    if (name == "integer") {
        need(2, 2, "integer(a,b)");
        const std::int64_t low = whole(name, list, 0), high = whole(name, list, 1);
        // The draw has 32 bits: up to 2^31 - 1 values.
        constexpr std::int64_t kMost = 1000000000;
        if (low < -kMost || high > kMost || high < low)
            fail("integer(a,b) needs {} <= a <= b <= {}", -kMost, kMost);
        return {[=](SplitMix64& random) { return low + random.below(static_cast<int>(high - low + 1)); },
                ValueKind::kWhole};
    }
    if (name == "list") {
        need(1, std::numeric_limits<std::int32_t>::max(), "list(v,...)");
        const auto values = std::make_shared<const List>(list);
        const int count = static_cast<int>(list.size());
        return {
            [=](SplitMix64& random) { return &values->items[static_cast<std::size_t>(random.below(count))]; },
            values->kind()};
    }
    fail("unknown distribution {}; use uniform, normal, integer, list or grid{}", in_quotes(name),
         did_you_mean(name, {"uniform", "normal", "integer", "list", "grid"}));
}

}  // namespace carom::detail
