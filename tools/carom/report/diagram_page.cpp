#include "report/diagram_page.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/scene.h"
#include "report/plot.h"

namespace carom::tools {
namespace {

// [pixels per point] In a PNG.
constexpr double kPngScale = 2.5;

cairo_status_t append(void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

/// A cairo context that releases itself.
struct Context {
    explicit Context(cairo_surface_t* made) : surface(made), cr(cairo_create(made)) {
        cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    }
    ~Context() {
        cairo_destroy(cr);
        cairo_surface_destroy(surface);
    }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    cairo_surface_t* surface;
    cairo_t* cr;
};

}  // namespace

std::string cairo_page(const std::string& format, const PaintPage& paint) {
    // The size is known once everything has been drawn, so the first pass draws into nothing.
    std::pair<double, double> size;
    {
        const Context nowhere(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
        size = paint(nowhere.cr);
    }
    std::string bytes;
    cairo_status_t status = CAIRO_STATUS_SUCCESS;
    {
        const bool png = format == ".png";
        const auto pixels = [](double points) { return static_cast<int>(std::ceil(kPngScale * points)); };
        const Context page(
            png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(size.first), pixels(size.second))
            : format == ".pdf"
                ? cairo_pdf_surface_create_for_stream(append, &bytes, size.first, size.second)
                : cairo_svg_surface_create_for_stream(append, &bytes, size.first, size.second));
        if (png) cairo_scale(page.cr, kPngScale, kPngScale);
        cairo_set_source_rgb(page.cr, 1.0, 1.0, 1.0);
        cairo_paint(page.cr);
        paint(page.cr);
        status = cairo_status(page.cr);
        if (png && status == CAIRO_STATUS_SUCCESS)
            status = cairo_surface_write_to_png_stream(page.surface, append, &bytes);
        cairo_surface_finish(page.surface);
    }
    if (status != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error(
            fmt::format("the picture cannot be drawn: {}", cairo_status_to_string(status)));
    return bytes;
}

// Charts on paper of cairo.

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
