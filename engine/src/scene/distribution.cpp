#include "scene/distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/draws.h"
#include "base/nearest.h"
#include "base/toml_number.h"
#include "scene/reader.h"
#include "scene/toml_depth.h"

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
    fail(
        "cannot read the values of {}({}); write numbers, or strings in double quotes, with commas "
        "between them",
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

}  // namespace

namespace {

/// The values of grid(a,b,n) or grid(list(v,...)).
struct Grid {
    toml::array list;
    double low = 0.0, high = 0.0;
    std::int64_t steps = 0;

    explicit Grid(std::string_view text) {
        if (text.starts_with("list(") && text.ends_with(')')) {
            list = arguments("list", text.substr(5, text.size() - 6));
            steps = static_cast<std::int64_t>(list.size());
            if (steps == 0) fail("list has 0 values; write list(v,...)");
            return;
        }
        const toml::array values = arguments("grid", text);
        if (values.size() != 3)
            fail("grid has {} values; write grid(a,b,n) or grid(list(v,...))", values.size());
        low = number("grid", values, 0);
        high = number("grid", values, 1);
        steps = whole("grid", values, 2);
        if (!std::isfinite(high - low)) fail("grid(a,b,n): b - a is too large for a number");
        if (steps < 1 || steps > 1000000000) fail("grid(a,b,n) needs 1 <= n <= 1000000000");
        if (steps == 1 && low != high) fail("grid(a,b,n) needs n >= 2 to reach from a to b");
    }

    double at(std::int64_t step) const {
        if (step == steps - 1) return high;
        return low + (high - low) * (static_cast<double>(step) / static_cast<double>(steps - 1));
    }
    /// Whether all numbers are whole, so that they suit keys that take whole numbers only.
    bool is_whole() const {
        constexpr double kExact = 0x1p53;
        const double each = steps > 1 ? (high - low) / static_cast<double>(steps - 1) : 0.0;
        return low == std::floor(low) && each == std::floor(each) &&
               std::fmax(std::abs(low), std::abs(high)) < kExact;
    }
};

}  // namespace

Distribution parse_distribution(std::string_view text, const toml::node* own) {
    const std::size_t open = text.find('(');
    if (open == text.npos || text.back() != ')')
        fail(
            "expected uniform(a,b), normal(sd), normal(mean,sd), integer(a,b), list(v,...), grid(a,b,n) or "
            "grid(list(v,...))");
    const std::string_view name = text.substr(0, open);
    if (name == "grid") {
        const auto grid = std::make_shared<const Grid>(text.substr(open + 1, text.size() - open - 2));
        const bool whole_numbers = grid->list.empty() && grid->is_whole();
        return {
            {}, static_cast<std::uint64_t>(grid->steps), [grid, whole_numbers](std::uint64_t step) -> Drawn {
                if (!grid->list.empty()) return grid->list.get(step);
                const double value = grid->at(static_cast<std::int64_t>(step));
                if (whole_numbers) return static_cast<std::int64_t>(value);
                return value;
            }};
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
            fail(
                "normal(sd) is around the number in the scene, and there is none; write the number there, or "
                "use normal(mean,sd)");
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
        return {[=](SplitMix64& random) { return low + random.below(static_cast<int>(high - low + 1)); }};
    }
    if (name == "list") {
        need(1, std::numeric_limits<std::int32_t>::max(), "list(v,...)");
        return {[values = std::make_shared<const toml::array>(list)](SplitMix64& random) {
            return values->get(static_cast<std::size_t>(random.below(static_cast<int>(values->size()))));
        }};
    }
    fail("unknown distribution {}; use uniform, normal, integer, list or grid{}", in_quotes(name),
         did_you_mean(name, {"uniform", "normal", "integer", "list", "grid"}));
}

ValueKind kind_of(std::string_view text) {
    const std::size_t open = text.find('(');
    const std::string_view name = text.substr(0, open);
    if (name == "grid") {
        const std::string_view inner = text.substr(open + 1, text.size() - open - 2);
        const Grid grid(inner);
        if (grid.list.empty()) return grid.is_whole() ? ValueKind::kWhole : ValueKind::kNumber;
        return kind_of(inner);
    }
    if (name != "list") return name == "integer" ? ValueKind::kWhole : ValueKind::kNumber;
    const toml::array list = arguments(name, text.substr(open + 1, text.size() - open - 2));
    const auto all = [&list](auto&& is) { return std::all_of(list.begin(), list.end(), is); };
    if (all([](const toml::node& value) { return value.is_integer(); })) return ValueKind::kWhole;
    return all([](const toml::node& value) { return value.is_number(); }) ? ValueKind::kNumber
                                                                          : ValueKind::kText;
}

}  // namespace carom::detail
