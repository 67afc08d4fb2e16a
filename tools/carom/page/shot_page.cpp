#include "page/shot_page.h"

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/shown_units.h"
#include "carom/render/draw_list.h"
#include "page/ball_styles.h"
#include "page/event_sentence.h"
#include "page/page.h"
#include "page/table_shape.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Data for a page besides the record: the shape of the table, and each ball's look as the renderer paints
/// it.
Json shot_json(const Record& record) {
    const render::Stage stage(record, {});
    return {{"shape", table_shape(record.table, *stage.table())},
            {"styles", ball_styles(ids_of(record.tracks), record.table.preset)}};
}

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::string shot_lead(const Record& record) {
    return fmt::format("{}, {}, {:.3f} s", counted(record.tracks.size(), "ball"),
                       counted(record.events.size(), "event"), record.duration);
}

std::string shot_page(const Record& record, const Record* second, const nlohmann::ordered_json& margin,
                      const ShotPageTexts& texts) {
    Json page = page_json(texts.title, shot_lead(record), texts.command, texts.version);
    page.update(shot_json(record));
    page["margin"] = margin;
    for (std::size_t i = 0; i < record.events.size(); ++i)
        page["story"].push_back(event_sentence(record, i, Units::kMetric));
    std::vector<PageData> data = {{"shot", record_json(record)}};
    if (second != nullptr) {
        page["second"] = shot_json(*second);
        data.push_back({"second", record_json(*second)});
    }
    data.push_back({"page", page.dump(-1, ' ', false, Json::error_handler_t::replace)});
    return page_html(texts.title, "shot.js", data);
}

}  // namespace carom::tools
