#include "report/diagram_page.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

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

}  // namespace carom::tools
