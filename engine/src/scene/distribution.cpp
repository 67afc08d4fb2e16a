#include "scene/distribution.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "carom/engine/math.h"
#include "scene/reader.h"
#include "scene/toml_depth.h"

namespace carom::detail {
namespace {

[[noreturn]] void fail(const std::string& message) {
    throw std::invalid_argument(message);
}

/// What stands between the brackets, as TOML values.
toml::array arguments(std::string_view name, std::string_view text) {
    const std::string line = fmt::format("v = [{}\n]", text);
    if (const auto deep = too_deep(line)) fail(fmt::format("values of {}: {}", name, deep->what));
    try {
        const toml::table table = toml::parse(line);
        // Whatever closes the bracket early could bring keys of its own.
        if (const toml::array* array = table["v"].as_array(); array && table.size() == 1) return *array;
    } catch (const toml::parse_error&) {
    }
    fail(fmt::format(
        "cannot read the values of {}({}); write numbers, or strings in double quotes, with commas "
        "between them",
        name, text));
}

double number(std::string_view name, const toml::array& list, std::size_t i) {
    const toml::node& node = list[i];
    const double x = node.is_number() ? *node.value<double>() : NAN;
    if (!std::isfinite(x)) fail(fmt::format("value {} of {} must be a finite number", i + 1, name));
    return x;
}

std::int64_t whole(std::string_view name, const toml::array& list, std::size_t i) {
    if (!list[i].is_integer()) fail(fmt::format("value {} of {} must be an integer", i + 1, name));
    return *list[i].value<std::int64_t>();
}

}  // namespace

Distribution Distribution::parse(std::string_view text, const toml::node* own) {
    const std::size_t open = text.find('(');
    if (open == text.npos || text.back() != ')')
        fail("expected uniform(a,b), normal(sd), normal(mean,sd), integer(a,b) or list(v,...)");
    const std::string_view name = text.substr(0, open);
    const toml::array list = arguments(name, text.substr(open + 1, text.size() - open - 2));
    const auto need = [&](std::size_t low, std::size_t high, const char* shape) {
        if (list.size() < low || list.size() > high)
            fail(fmt::format("{} has {} values; write {}", name, list.size(), shape));
    };
    Distribution d;
    if (name == "uniform") {
        need(2, 2, "uniform(a,b)");
        d.kind_ = Kind::kUniform;
        d.first_ = number(name, list, 0);
        d.second_ = number(name, list, 1);
        if (!(d.first_ <= d.second_)) fail("uniform(a,b) needs a <= b");
        if (!std::isfinite(d.second_ - d.first_)) fail("uniform(a,b): b - a is too large for a number");
    } else if (name == "normal") {
        need(1, 2, "normal(sd) or normal(mean,sd)");
        d.kind_ = Kind::kNormal;
        if (list.size() == 1 && (own == nullptr || !own->is_number()))
            fail(
                "normal(sd) is around the number in the scene, and there is none; write it there, or use "
                "normal(mean,sd)");
        d.first_ = list.size() == 1 ? *own->value<double>() : number(name, list, 0);
        d.second_ = number(name, list, list.size() - 1);
        if (!(d.second_ >= 0.0)) fail("the standard deviation of normal must be at least 0");
    } else if (name == "integer") {
        need(2, 2, "integer(a,b)");
        d.kind_ = Kind::kInteger;
        d.low_ = whole(name, list, 0);
        d.high_ = whole(name, list, 1);
        // The draw takes 32 bits: up to 2^31 - 1 values.
        constexpr std::int64_t kMost = 1000000000;
        if (d.low_ < -kMost || d.high_ > kMost || d.high_ < d.low_)
            fail(fmt::format("integer(a,b) needs {} <= a <= b <= {}", -kMost, kMost));
    } else if (name == "list") {
        need(1, std::numeric_limits<std::int32_t>::max(), "list(v,...)");
        d.kind_ = Kind::kList;
        d.list_ = std::make_shared<const toml::array>(list);
    } else {
        fail(fmt::format("unknown distribution {}; use uniform, normal, integer or list", in_quotes(name)));
    }
    return d;
}

Drawn Distribution::draw(SplitMix64& random) const {
    switch (kind_) {
        case Kind::kUniform:
            return first_ + (second_ - first_) * random.uniform();
        case Kind::kNormal:
            return first_ + second_ * standard_normal(random);
        case Kind::kInteger:
            return low_ + random.below(static_cast<int>(high_ - low_ + 1));
        case Kind::kList:
            break;
    }
    return list_->get(static_cast<std::size_t>(random.below(static_cast<int>(list_->size()))));
}

double standard_normal(SplitMix64& random) {
    const double width = 2.0 * std::sqrt(2.0 * exponential(-1.0));  // sqrt(8 / e)
    for (;;) {
        const double u = 1.0 - random.uniform();  // in (0, 1]
        const double x = width * (random.uniform() - 0.5) / u;
        if (u <= exponential(-0.25 * x * x)) return x;
    }
}

}  // namespace carom::detail
