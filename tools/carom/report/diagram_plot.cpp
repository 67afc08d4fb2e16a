#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/render/look.h"
#include "report/diagram_page.h"
#include "report/sweep_plot.h"

namespace carom::tools {
namespace {

// All in points of the page.
constexpr double kWidth = 420.0, kHeight = 300.0, kLeft = 64.0, kTop = 40.0, kRight = 84.0, kBottom = 52.0;
constexpr double kHeading = 13.0, kLabel = 9.0;

class SweepDrawing {
  public:
    SweepDrawing(cairo_t* cr, const SweepPlot& plot) : cr_(cr), plot_(plot) {}

    std::pair<double, double> draw() {
        text(kLeft, kTop - 22.0, plot_.heading, kHeading, 0.0);
        text(kLeft, kTop - 8.0, printable(plot_.measure), kLabel, 0.0);
        plot_.axes.empty() ? histogram() : map();
        cairo_rectangle(cr_, kLeft, kTop, kWidth, kHeight);
        ink(0.0);
        cairo_set_line_width(cr_, 0.8);
        cairo_stroke(cr_);
        return {kLeft + kWidth + kRight, kTop + kHeight + kBottom};
    }

  private:
    void ink(double gray) { cairo_set_source_rgb(cr_, gray, gray, gray); }
    /// From white to the colour of the cloth.
    void shade(double share) {
        const auto& deep = render::look::kCloth;
        const auto part = [&](std::size_t i) { return 1.0 + share * (0.8 * deep[i] - 1.0); };
        cairo_set_source_rgb(cr_, part(0), part(1), part(2));
    }
    /// @param side  0 begins at x, 0.5 is centred, 1 ends there
    void text(double x, double y, const std::string& words, double size, double side) {
        cairo_set_font_size(cr_, size);
        cairo_text_extents_t extents;
        cairo_text_extents(cr_, words.c_str(), &extents);
        ink(0.0);
        cairo_move_to(cr_, x - side * extents.x_advance, y);
        cairo_show_text(cr_, words.c_str());
        cairo_new_path(cr_);
    }
    /// Round numbers between two values, about six of them.
    static std::vector<double> ticks(double low, double high) {
        std::vector<double> values;
        const double rough = (high - low) / 6.0, power = std::pow(10.0, std::floor(std::log10(rough)));
        const double step = power * (rough <= 2.0 * power ? 2.0 : rough <= 5.0 * power ? 5.0 : 10.0);
        const double first = std::ceil(low / step);
        for (int i = 0; i < 8; ++i)
            if (const double value = (first + i) * step; value <= high) values.push_back(value);
        return values;
    }
    void x_axis(double low, double high, const std::string& name) {
        for (const double value : ticks(low, high))
            text(kLeft + (value - low) / (high - low) * kWidth, kTop + kHeight + 14.0,
                 fmt::format("{:.6g}", value), kLabel, 0.5);
        text(kLeft + 0.5 * kWidth, kTop + kHeight + 32.0, name, kLabel, 0.5);
    }
    void y_axis(double low, double high, const std::string& name) {
        for (const double value : ticks(low, high))
            text(kLeft - 6.0, kTop + (1.0 - (value - low) / (high - low)) * kHeight + 3.0,
                 fmt::format("{:.6g}", value), kLabel, 1.0);
        cairo_save(cr_);
        cairo_translate(cr_, 14.0, kTop + 0.5 * kHeight);
        cairo_rotate(cr_, -0.5 * std::numbers::pi);
        text(0.0, 0.0, name, kLabel, 0.5);
        cairo_restore(cr_);
    }

    std::vector<double> column(int axis) const {
        std::vector<double> values;
        for (const PlotShot& shot : plot_.shots)
            if (std::isfinite(shot.value))
                values.push_back(axis < 0 ? shot.value : shot.place[static_cast<std::size_t>(axis)]);
        return values;
    }

    void histogram() {
        const std::vector<double> values = column(-1);
        const Bins bins = bins_of(values, 1);
        std::vector<std::size_t> counts(bins.count);
        for (const double value : values) ++counts[bins.of(value)];
        const double most =
            static_cast<double>(std::max<std::size_t>(1, *std::max_element(counts.begin(), counts.end())));
        const double wide = kWidth / static_cast<double>(bins.count);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const double high = kHeight * static_cast<double>(counts[i]) / most;
            cairo_rectangle(cr_, kLeft + wide * static_cast<double>(i), kTop + kHeight - high, wide, high);
            shade(0.6);
            cairo_fill_preserve(cr_);
            ink(1.0);
            cairo_set_line_width(cr_, 0.5);
            cairo_stroke(cr_);
        }
        x_axis(bins.low, bins.high(), printable(plot_.measure));
        y_axis(0.0, most, fmt::format("shots of {}", values.size()));
    }

    void map() {
        const std::vector<double> values = column(-1), x = column(0), y = column(1);
        const Bins across = bins_of(x, 2), up = bins_of(y, 2);
        std::vector<double> sums(across.count * up.count), counts(sums.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t cell = up.of(y[i]) * across.count + across.of(x[i]);
            sums[cell] += values[i];
            ++counts[cell];
        }
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (counts[i] == 0.0) continue;
            low = std::min(low, sums[i] / counts[i]);
            high = std::max(high, sums[i] / counts[i]);
        }
        if (!(low <= high)) low = high = 0.0;
        const double wide = kWidth / static_cast<double>(across.count),
                     tall = kHeight / static_cast<double>(up.count);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (counts[i] == 0.0) continue;
            const std::size_t up_from_below = i / across.count;
            const auto column = static_cast<double>(i % across.count),
                       row = static_cast<double>(up_from_below);
            shade(high > low ? (sums[i] / counts[i] - low) / (high - low) : 0.5);
            cairo_rectangle(cr_, kLeft + wide * column, kTop + kHeight - tall * (row + 1.0), wide + 0.3,
                            tall + 0.3);
            cairo_fill(cr_);
        }
        x_axis(across.low, across.high(), plot_.axes[0]);
        y_axis(up.low, up.high(), plot_.axes[1]);
        // The scale: the mean of the shots in a cell.
        constexpr int kSteps = 40;
        const double right = kLeft + kWidth + 14.0;
        for (int i = 0; i < kSteps; ++i) {
            shade((i + 0.5) / kSteps);
            cairo_rectangle(cr_, right, kTop + kHeight * (1.0 - (i + 1.0) / kSteps), 12.0,
                            kHeight / kSteps + 0.3);
            cairo_fill(cr_);
        }
        text(right + 17.0, kTop + kHeight, fmt::format("{:.4g}", low), kLabel, 0.0);
        text(right + 17.0, kTop + 8.0, fmt::format("{:.4g}", high), kLabel, 0.0);
    }

    cairo_t* cr_;
    const SweepPlot& plot_;
};

}  // namespace

std::string draw_plot(const SweepPlot& plot, const std::string& format, const std::vector<DiagramShot>& shots,
                      const DiagramStyle& style) {
    return cairo_page(format, [&](cairo_t* cr) {
        const auto [width, height] = shots.empty() ? std::pair(0.0, 0.0) : paint_diagram(cr, shots, style);
        cairo_translate(cr, width, 0.0);
        const auto [more, tall] = SweepDrawing(cr, plot).draw();
        return std::pair(width + more, std::max(height, tall));
    });
}

}  // namespace carom::tools
