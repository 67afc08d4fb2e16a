#include "carom/engine/sweep_columns.h"

#include <array>
#include <charconv>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace carom {
namespace {

constexpr int kAfterKeys = 7;  // columns from "outcome" to "pocketed"

/// A column of texts that grows.
class Texts {
  public:
    explicit Texts(ColumnValues& column) : column_(column) {}
    void add(std::string_view text) {
        const auto known = places_.find(std::string(text));
        if (known != places_.end()) return column_.places.push_back(known->second);
        const auto place = static_cast<std::int32_t>(column_.texts.size());
        places_.emplace(text, place);
        column_.texts.emplace_back(text);
        column_.places.push_back(place);
    }

  private:
    ColumnValues& column_;
    std::unordered_map<std::string, std::int32_t> places_;
};

/// A number in TOML notation, which may be 0x1F, 0o17 or 0b101 if it is whole.
template <class T>
T read_number(std::string_view text) {
    const auto read = [&text](auto& value, auto... base) {
        std::from_chars(text.data(), text.data() + text.size(), value, base...);
    };
    std::int64_t whole = 0;
    for (const auto& [prefix, base] : {std::pair("0x", 16), std::pair("0o", 8), std::pair("0b", 2)}) {
        if (!text.starts_with(prefix)) continue;
        text.remove_prefix(2);
        read(whole, base);
        return static_cast<T>(whole);
    }
    T value{};
    read(value);
    return value;
}

void read_draws(ColumnValues& column, ValueKind kind, std::span<const std::string> draws, std::size_t key,
                std::size_t keys) {
    Texts texts(column);
    for (std::size_t i = key; i < draws.size(); i += keys) {
        if (kind == ValueKind::kNumber) column.numbers.push_back(read_number<double>(draws[i]));
        if (kind == ValueKind::kWhole) column.wholes.push_back(read_number<std::int64_t>(draws[i]));
        if (kind == ValueKind::kText) texts.add(draws[i]);
    }
}

/// The balls that fell, in order, separated by semicolons.
std::string fallen(const std::vector<BallStart>& balls, const std::int32_t* fell) {
    std::vector<const std::string*> order(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i)
        if (fell[i] >= 0) order[static_cast<std::size_t>(fell[i])] = &balls[i].id;
    std::string text;
    for (std::size_t k = 0; k < order.size() && order[k] != nullptr; ++k) {
        if (k > 0) text += ';';
        text += *order[k];
    }
    return text;
}

}  // namespace

std::vector<SweepColumn> sweep_columns(const Variation& variation) {
    using enum ValueKind;
    std::vector<SweepColumn> columns = {{"shot", kWhole, "", false}};
    for (std::size_t k = 0; k < variation.keys().size(); ++k)
        columns.push_back({variation.keys()[k], variation.kind(k), variation.unit(k), false});
    columns.push_back({"outcome", kText, "", false});
    columns.push_back({"duration", kNumber, "s", true});
    columns.push_back({"events", kWhole, "", true});
    columns.push_back({"first_contact", kText, "", true});
    columns.push_back({"contacts", kWhole, "", true});
    columns.push_back({"cushions", kWhole, "", true});
    columns.push_back({"pocketed", kText, "", true});
    for (const BallStart& ball : variation.base().ball) {
        columns.push_back({ball.id + ".x", kNumber, "m", true});
        columns.push_back({ball.id + ".y", kNumber, "m", true});
        columns.push_back({ball.id + ".pocket", kText, "", true});
    }
    columns.push_back({"message", kText, "", false});
    return columns;
}

std::vector<ColumnValues> sweep_values(const Variation& variation, std::uint64_t first, std::size_t shots,
                                       std::span<const std::string> draws, const BatchArrays& outcomes,
                                       std::span<const Batch::Message> messages) {
    const std::vector<BallStart>& balls = variation.base().ball;
    const std::vector<Pocket>& pockets = variation.base().table.pockets;
    const std::size_t keys = variation.keys().size(), n = balls.size();
    std::vector<ColumnValues> columns(1 + keys + kAfterKeys + 3 * n + 1);
    for (std::size_t i = 0; i < shots; ++i) columns[0].wholes.push_back(static_cast<std::int64_t>(first + i));
    for (std::size_t k = 0; k < keys; ++k) read_draws(columns[1 + k], variation.kind(k), draws, k, keys);

    ColumnValues* at = columns.data() + 1 + keys;
    const auto each_shot = [&](auto&& put) {
        ColumnValues& column = *at++;
        Texts texts(column);
        for (std::size_t i = 0; i < shots; ++i) put(column, texts, i, has_result(outcomes.status[i]));
    };
    const auto number = [&](const double* values, std::size_t place, std::size_t stride) {
        each_shot([=](ColumnValues& column, Texts&, std::size_t i, bool result) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            column.numbers.push_back(result ? values[place + i * stride] : kNone);
        });
    };
    const auto whole = [&](const auto* values) {
        each_shot([values](ColumnValues& column, Texts&, std::size_t i, bool result) {
            column.wholes.push_back(result ? values[i] : 0);
        });
    };
    const auto text = [&](auto&& text_of) {
        each_shot([&text_of](ColumnValues& column, Texts& texts, std::size_t i, bool result) {
            if (result)
                texts.add(text_of(i));
            else
                column.places.push_back(-1);
        });
    };
    each_shot([&](ColumnValues&, Texts& texts, std::size_t i, bool) { texts.add(name(outcomes.status[i])); });
    number(outcomes.duration, 0, 1);
    whole(outcomes.events);
    text([&](std::size_t i) {
        const std::int32_t hit = outcomes.first_hit[i];
        return hit < 0 ? std::string() : balls[static_cast<std::size_t>(hit)].id;
    });
    whole(outcomes.contacts);
    whole(outcomes.approach_cushions);
    text([&](std::size_t i) { return fallen(balls, outcomes.fell + i * n); });
    for (std::size_t ball = 0; ball < n; ++ball) {
        const std::size_t stride = outcomes.place_stride;
        number(outcomes.x, ball * stride, n * stride);
        number(outcomes.y, ball * stride, n * stride);
        text([&](std::size_t i) {
            const std::int32_t pocket = outcomes.pocket[i * n + ball];
            if (pocket == kOffTable) return std::string("out");
            return pocket < 0 ? std::string() : pockets[static_cast<std::size_t>(pocket)].id;
        });
    }
    std::size_t next = 0;
    each_shot([&](ColumnValues&, Texts& texts, std::size_t i, bool) {
        const bool told = next < messages.size() && messages[next].shot == i;
        texts.add(told ? messages[next++].text : std::string());
    });
    return columns;
}

}  // namespace carom
