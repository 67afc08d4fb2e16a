#include "page/ball_styles.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "carom/render/draw_list.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

Json style_json(const render::BallStyle& style) {
    constexpr std::array kPatterns = {"solid", "stripe", "dots", "halves"};
    Json color = Json::array();
    for (const float c : style.color) color.push_back(std::round(1e4 * c) / 1e4);
    return {{"color", color},
            {"pattern", kPatterns.at(static_cast<std::size_t>(style.pattern))},
            {"number", style.number}};
}

}  // namespace

Json ball_styles(const std::vector<std::string>& ids, const std::string& table_preset) {
    Json list = Json::array();
    for (std::size_t i = 0; i < ids.size(); ++i)
        list.push_back(style_json(render::ball_style(ids[i], table_preset, static_cast<int>(i))));
    return list;
}

}  // namespace carom::tools
