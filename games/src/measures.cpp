// Expressions over measures: read once, evaluated for many shots.
#include "carom/games/measures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "measure_tree.h"

namespace carom::games {

using detail::Arguments;
using detail::kNone;
using detail::measure_rows;
using detail::MeasureRow;
using detail::PlayedShot;
using detail::Texts;

namespace {

using Node = Measure::Node;

bool truth(const MeasureValue& value) {
    if (const double* number = std::get_if<double>(&value)) return *number != 0.0 && !std::isnan(*number);
    const Texts& texts = std::get<Texts>(value);
    return !texts.empty() && !(texts.size() == 1 && texts[0].empty());
}

MeasureValue value_of(const Node& node, const PlayedShot& played) {
    const auto part = [&](std::size_t i) { return value_of(node.parts[i], played); };
    switch (node.kind) {
        case Node::Kind::kValue:
            return node.value;
        case Node::Kind::kMeasure:
            return node.row->value(played, node.arguments);
        case Node::Kind::kOr:
            return double(truth(part(0)) || truth(part(1)));
        case Node::Kind::kAnd:
            return double(truth(part(0)) && truth(part(1)));
        case Node::Kind::kNot:
            return double(!truth(part(0)));
        case Node::Kind::kIn: {
            const MeasureValue left = part(0), right = part(1);
            const Texts* texts = std::get_if<Texts>(&right);
            return double(texts != nullptr &&
                          std::find(texts->begin(), texts->end(), text_of(left)) != texts->end());
        }
        case Node::Kind::kSum: {
            const double a = std::get<double>(part(0)), b = std::get<double>(part(1));
            return node.word == "+" ? a + b : node.word == "-" ? a - b : node.word == "*" ? a * b : a / b;
        }
        case Node::Kind::kCompare:
            break;
    }
    const MeasureValue left = part(0), right = part(1);
    if (node.word == "==" || node.word == "!=")
        return double((text_of(left) == text_of(right)) == (node.word == "=="));
    const double a = std::get<double>(left), b = std::get<double>(right);
    return double(node.word == "<" ? a < b : node.word == ">" ? a > b : node.word == "<=" ? a <= b : a >= b);
}

}  // namespace

std::span<const MeasureInfo> measures() {
    static const std::vector<MeasureInfo> list = [] {
        std::vector<MeasureInfo> all;
        for (const MeasureRow& row : measure_rows()) all.push_back(row.info);
        return all;
    }();
    return list;
}

std::string text_of(const MeasureValue& value) {
    if (const double* number = std::get_if<double>(&value)) {
        if (std::isnan(*number)) return "";
        char digits[32];
        return std::string(digits, std::to_chars(digits, digits + sizeof digits, *number).ptr);
    }
    std::string text;
    for (const std::string& one : std::get<Texts>(value)) {
        if (!text.empty()) text += ';';
        text += one;
    }
    return text;
}

Measure::Measure(const std::string& text, const Scene& scene, std::optional<Game> game)
    : text_(text), root_(std::make_unique<Node>(detail::read_tree(text_, scene, game))) {}
Measure::~Measure() = default;
Measure::Measure(Measure&&) noexcept = default;
Measure& Measure::operator=(Measure&&) noexcept = default;

bool Measure::is_truth() const {
    using Kind = Node::Kind;
    if (root_->kind == Kind::kMeasure) return std::string_view(root_->row->info.unit) == "truth";
    return root_->kind != Kind::kValue && root_->kind != Kind::kSum;
}

bool Measure::is_number() const {
    return detail::is_number(*root_);
}

MeasureValue Measure::of(const Record& record) const {
    return value_of(*root_, PlayedShot(record));
}

MeasureValue Measure::in_table(const Record& record) const {
    try {
        return of(record);
    } catch (const std::invalid_argument&) {
        if (record.stopped == StopReason::kAtRest) throw;
        if (is_number()) return kNone;
        return Texts();
    }
}

bool Measure::holds(const Record& record) const {
    return truth(of(record));
}

std::vector<Place> Measure::places() const {
    std::vector<Place> places;
    std::vector<const Node*> open{root_.get()};
    while (!open.empty()) {
        const Node& node = *open.back();
        open.pop_back();
        if (node.kind == Node::Kind::kAnd) open.insert(open.end(), {&node.parts[1], &node.parts[0]});
        const Node* near = node.kind == Node::Kind::kCompare && node.word == "<=" ? &node.parts[0] : nullptr;
        if (near == nullptr || near->kind != Node::Kind::kMeasure ||
            std::string_view(near->row->info.name) != "distance")
            continue;
        const Arguments& at = near->arguments;
        places.push_back({at.ball, {at.numbers[0], at.numbers[1]}});
    }
    return places;
}

}  // namespace carom::games
