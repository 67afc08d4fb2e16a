#include "view/shot_data.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/temporary_folder.h"
#include "carom/render/draw_list.h"
#include "view/table_shape.h"

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

std::string record_text(const Record& record) {
    // The writer of records writes files.
    const TemporaryFolder folder;
    const std::string path = folder.file("record.json");
    write_record(record, path);
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) throw std::runtime_error(path + ": cannot be read back");
    return text;
}

Json shot_json(const Record& record) {
    const render::Stage stage(record, {});
    Json styles = Json::array();
    for (std::size_t i = 0; i < record.tracks.size(); ++i)
        styles.push_back(
            style_json(render::ball_style(record.tracks[i].id, record.table.preset, static_cast<int>(i))));
    return {{"shape", table_shape(*stage.table())}, {"styles", styles}};
}

}  // namespace carom::tools
