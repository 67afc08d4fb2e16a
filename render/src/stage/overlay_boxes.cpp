#include "stage/overlay_boxes.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "carom/render/table_mesh.h"
#include "font/glyphs.h"

namespace carom::render {

namespace {

constexpr Rgba kPanel{0.0F, 0.0F, 0.0F, 0.60F};      // background of the panels
constexpr Rgba kTextInk{0.97F, 0.97F, 0.95F, 1.0F};  // text

// [pixels] Height of a capital letter: readable in small
// frames, bounded in large ones; both panels fit side by side.
double text_height(const DrawList& list) {
    return std::clamp(std::min(list.camera.size.height / 48.0, list.camera.size.width / 36.0), 5.0, 28.0);
}

// [pixels] From the sides of the image to the panels, which leaves the corner pockets free if the table fills
// the image.
double side_room(const DrawList& list) {
    return 0.11 * list.camera.size.width;
}

// [-] Width of one character divided by the height of a capital letter.
constexpr double kAdvance = 0.92;

}  // namespace

double text_width(double height, std::string_view text) {
    return height * kAdvance * static_cast<double>(text.size());
}

void add_text(DrawList& list, const Vec2& at, double height, std::string_view text, const Rgba& color) {
    // A cell of the atlas is 6 x 9 units; the capital in its centre is 4 x 6 units.
    const double unit = height / 6.0;
    double x = at.x();
    for (char c : text) {
        const int glyph = glyph_index(c);
        if (glyph >= 0) {
            const Vec2 low(x - unit, at.y() - 1.5 * unit);
            list.boxes.push_back({low, low + unit * Vec2(6.0, 9.0), color, glyph});
        }
        x += height * kAdvance;
    }
}

void add_clock(DrawList& list, double t) {
    const double height = text_height(list), room = 0.6 * height;
    const std::string text = fmt::format("{:.3f} s", t);
    const double left = side_room(list);
    list.boxes.push_back(
        {{left, room}, {left + 2.0 * room + text_width(height, text), 3.0 * room + height}, kPanel, -1});
    add_text(list, {left + room, 2.0 * room}, height, text, kTextInk);
}

void add_diamond_numbers(DrawList& list, const Table& table) {
    const double nose = table.cushions.empty() ? 0.0 : table.cushions.front().height;
    for (const auto& [at, number] : diamond_numbers(table, *list.table)) {
        const auto pixel = list.camera.project({at.x(), at.y(), nose});
        if (!pixel) continue;
        const std::string text = fmt::format("{}", number);
        const double height = 0.8 * text_height(list);
        add_text(list, *pixel - 0.5 * Vec2(text_width(height, text), height), height, text, kTextInk);
    }
}

void add_margin_bar(DrawList& list, const FrameBudget& cost) {
    const double height = text_height(list), room = 0.6 * height, width = 16.0 * height;
    const double right = list.camera.size.width - side_room(list), left = right - width - 2.0 * room;
    const std::string text = fmt::format("{:.1f} of {:.1f} ms", cost.cost_ms, cost.budget_ms);
    list.boxes.push_back({{left, room}, {right, 4.0 * room + 1.7 * height}, kPanel, -1});
    add_text(list, {left + room, 2.0 * room}, height, text, kTextInk);
    // The full bar is twice the budget; beyond its middle the frame exceeds its budget.
    const double top = 3.0 * room + height, share = std::clamp(0.5 * cost.cost_ms / cost.budget_ms, 0.0, 1.0);
    const Rgba good{0.25F, 0.80F, 0.35F, 1.0F}, bad{0.92F, 0.25F, 0.20F, 1.0F}, mark{1.0F, 1.0F, 1.0F, 0.9F};
    const double x = left + room, bottom = top + 0.7 * height;
    list.boxes.push_back({{x, top}, {x + share * width, bottom}, share <= 0.5 ? good : bad, -1});
    list.boxes.push_back({{x + 0.5 * width - 1.0, top}, {x + 0.5 * width + 1.0, bottom}, mark, -1});
}

}  // namespace carom::render
