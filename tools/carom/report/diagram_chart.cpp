// Charts on paper of cairo.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/scene.h"
#include "report/diagram_page.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

class CairoPaper : public Paper {
  public:
    explicit CairoPaper(cairo_t* cr) : cr_(cr) {}

    void text(double x, double y, const std::string& words, const char* anchor, const Font& font) override {
        cairo_select_font_face(cr_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                               font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cr_, font.size);
        cairo_text_extents_t extents;
        cairo_text_extents(cr_, words.c_str(), &extents);
        const std::string_view side = anchor;
        cairo_save(cr_);
        cairo_translate(cr_, x, y);
        if (font.upwards) cairo_rotate(cr_, -0.5 * std::numbers::pi);
        cairo_move_to(cr_, -extents.x_advance * (side == "middle" ? 0.5 : side == "end" ? 1.0 : 0.0), 0.0);
        cairo_text_path(cr_, words.c_str());
        if (font.halo) {
            use({"#fff", 4.0});
            cairo_stroke_preserve(cr_);
        }
        use({font.colour});
        cairo_fill(cr_);
        cairo_restore(cr_);
    }
    void line(double x1, double y1, double x2, double y2, const Pen& pen) override {
        path({{x1, y1}, {x2, y2}}, pen);
    }
    void path(const std::vector<std::pair<double, double>>& points, const Pen& pen) override {
        for (const auto& [x, y] : points) cairo_line_to(cr_, x, y);
        use(pen);
        cairo_stroke(cr_);
    }
    void dot(double x, double y, double radius, const char* colour) override {
        cairo_arc(cr_, x, y, radius, 0.0, 2.0 * std::numbers::pi);
        use({colour});
        cairo_fill(cr_);
    }
    void frame(double x, double y, double width, double height, const Pen& pen) override {
        cairo_rectangle(cr_, x, y, width, height);
        use(pen);
        cairo_stroke(cr_);
    }

  private:
    void use(const Pen& pen) {
        std::string hex = pen.colour;
        if (hex.size() == 4) hex = {'#', hex[1], hex[1], hex[2], hex[2], hex[3], hex[3]};
        const std::array<double, 3> c = color_of(hex).value_or(std::array<double, 3>{});
        cairo_set_source_rgb(cr_, c[0], c[1], c[2]);
        cairo_set_line_width(cr_, pen.width);
        char* end = nullptr;
        const double on = std::strtod(pen.dash, &end), dashes[] = {on, std::strtod(end, nullptr)};
        cairo_set_dash(cr_, dashes, on > 0.0 ? 2 : 0, 0.0);
    }

    cairo_t* cr_;
};

}  // namespace

std::string cairo_chart(const Plot& plot, const std::string& format) {
    return cairo_page(format, [&](cairo_t* cr) {
        CairoPaper paper(cr);
        draw_chart(plot, paper);
        return std::pair(kChartWidth, kChartHeight);
    });
}

}  // namespace carom::tools
