#include "commands/sweep/tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/statistics.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

// [lines] Number of texts of a measure in a summary, the most frequent first.
constexpr std::size_t kTexts = 8;
// Beyond this number of different texts the rest is counted together, to limit memory.
constexpr std::size_t kMostTexts = 100000;

std::vector<std::pair<std::string, std::size_t>> by_frequency(
    const std::map<std::string, std::size_t>& texts) {
    std::vector<std::pair<std::string, std::size_t>> list(texts.begin(), texts.end());
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return list;
}

}  // namespace

void Tally::add(const games::MeasureValue& value) {
    ++shots_;
    if (!number_) {
        const std::string text = games::text_of(value);
        const bool known = texts_.size() < kMostTexts || texts_.contains(text);
        ++texts_[known ? text : "(others)"];
        return;
    }
    const double number = std::get<double>(value);
    if (std::isnan(number)) return;
    least_ = counted_ == 0 ? number : std::min(least_, number);
    most_ = counted_ == 0 ? number : std::max(most_, number);
    // Welford's mean and sum of squares.
    const double away = number - mean_;
    mean_ += away / static_cast<double>(++counted_);
    squares_ += away * (number - mean_);
}

std::string Tally::text() const {
    if (!number_) {
        std::string text = name_ + "\n";
        std::size_t told = 0;
        for (const auto& [value, count] : by_frequency(texts_)) {
            if (told++ == kTexts) return text + fmt::format("  ... and {} others\n", texts_.size() - kTexts);
            text += fmt::format("  {:<24}{}\n", value.empty() ? "(none)" : value,
                                share_text(share_of(count, shots_)));
        }
        return text;
    }
    if (truth_)
        return fmt::format(
            "{}\n  {:<24}{}\n", name_, "true",
            share_text(share_of(static_cast<std::size_t>(std::llround(mean_ * static_cast<double>(counted_))),
                                counted_)));
    if (counted_ == 0) return name_ + "\n  no values\n";
    const double spread = counted_ > 1 ? std::sqrt(squares_ / static_cast<double>(counted_ - 1)) : 0.0;
    return fmt::format("{}\n  mean {:.6g}, standard deviation {:.3g}, {:.6g} to {:.6g}, {} of {} shots\n",
                       name_, mean_, spread, least_, most_, counted_, shots_);
}

Json Tally::json() const {
    Json json = {{"measure", name_}, {"shots", shots_}};
    if (number_) {
        json["values"] = counted_;
        if (counted_ == 0) return json;
        json["mean"] = mean_;
        json["sd"] = counted_ > 1 ? std::sqrt(squares_ / static_cast<double>(counted_ - 1)) : 0.0;
        json["least"] = least_;
        json["most"] = most_;
        if (!truth_) return json;
        const Share share =
            share_of(static_cast<std::size_t>(std::llround(mean_ * static_cast<double>(counted_))), counted_);
        json["interval"] = {share.low, share.high};
        return json;
    }
    json["texts"] = Json::object();
    for (const auto& [value, count] : by_frequency(texts_)) {
        const Share share = share_of(count, shots_);
        json["texts"][value] = {
            {"shots", count}, {"share", share.value}, {"interval", {share.low, share.high}}};
    }
    return json;
}

}  // namespace carom::tools
