// Charts, and the paper for SVG files.
#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "base/console.h"
#include "report/diagram.h"
#include "report/table.h"

namespace carom::tools {
namespace {

// Colours that are also distinct to people who confuse red and green (Okabe and Ito).
constexpr const char* kPalette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000", "#999999"};
constexpr int kColours = 8;
constexpr double kChartLeft = 80, kChartRight = kChartLeft + kPlotWidth;
constexpr double kChartTop = 60, kChartBottom = kChartTop + kPlotHeight;
constexpr double kLineHeight = 18;

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const char* name = c == '&' ? "amp" : c == '<' ? "lt" : c == '>' ? "gt" : c == '"' ? "quot" : nullptr;
        out += name != nullptr ? fmt::format("&{};", name) : std::string(1, c);
    }
    return out;
}

/// Turns values into pixels along one axis.
class AxisScale {
  public:
    AxisScale(const Axis& axis, const std::vector<double>& values, double from, double to)
        : logarithmic_(axis.logarithmic), from_(from), to_(to), given_(axis.marks) {
        double low = INFINITY, high = -INFINITY;
        for (const double value : values) {
            if (!shows(value)) continue;
            low = std::min(low, place(value));
            high = std::max(high, place(value));
        }
        if (axis.low && shows(*axis.low)) low = place(*axis.low);
        if (axis.high && shows(*axis.high)) high = place(*axis.high);
        if (!(low <= high)) low = high = 0.0;
        if (low == high) {
            low -= 0.5;
            high += 0.5;
        }
        const double room = 0.03 * (high - low);
        low_ = axis.low ? low : low - room;
        high_ = axis.high ? high : high + room;
    }

    bool shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0.0); }
    bool inside(double value) const {
        return shows(value) && place(value) >= low_ - 1e-9 && place(value) <= high_ + 1e-9;
    }
    double at(double value) const { return from_ + (to_ - from_) * (place(value) - low_) / (high_ - low_); }

    /// Round values, or those that the axis gives, with their texts.
    std::vector<std::pair<double, std::string>> marks() const {
        if (!given_.empty()) return given_;
        std::vector<std::pair<double, std::string>> list;
        if (logarithmic_) {
            const int first = static_cast<int>(std::ceil(low_ - 1e-9)),
                      last = static_cast<int>(std::floor(high_ + 1e-9));
            if (last - first < 2) {  // too few decades: steps of 1, 2, 5
                for (int p = first - 1; p <= last; ++p)
                    for (const double part : {1.0, 2.0, 5.0}) {
                        const double value = part * std::pow(10.0, p);
                        if (inside(value)) list.emplace_back(value, fmt::format("{:g}", value));
                    }
                return list;
            }
            const int step = std::max(1, (last - first + 8) / 9);
            // All with digits, or all as powers.
            const bool digits = first >= -4 && last <= 5;
            for (int p = first; p <= last; p += step)
                list.emplace_back(std::pow(10.0, p),
                                  digits ? fmt::format("{:g}", std::pow(10.0, p)) : fmt::format("1e{}", p));
            return list;
        }
        const double rough = (high_ - low_) / 7.0, decade = std::pow(10.0, std::floor(std::log10(rough)));
        const double part = rough / decade;
        const double step = decade * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
        for (double k = std::ceil(low_ / step); k * step <= high_; k += 1.0)
            list.emplace_back(k * step, fmt::format("{:g}", k * step + 0.0));  // no -0
        return list;
    }

  private:
    double place(double value) const { return logarithmic_ ? std::log10(value) : value; }

    bool logarithmic_;
    double from_, to_, low_ = 0.0, high_ = 1.0;
    std::vector<std::pair<double, std::string>> given_;
};

class ChartDrawing {
  public:
    ChartDrawing(const Plot& plot, Paper& paper)
        : plot_(plot),
          paper_(paper),
          x_(plot.x, values(true), kChartLeft, kChartRight),
          y_(plot.y, values(false), kChartBottom, kChartTop) {}

    void draw() {
        paper_.text(kChartLeft, 22, plot_.title, "start", {.size = 15, .bold = true});
        for (std::size_t i = 0; i < plot_.notes.size(); ++i)
            paper_.text(kChartLeft, 40 + 14 * static_cast<double>(i), plot_.notes[i], "start",
                        {.size = 11, .colour = "#555"});
        axes();
        int next = 0;
        for (const Series& series : plot_.series) draw(series, series.colour >= 0 ? series.colour : next++);
        for (std::size_t i = 0; i < plot_.ticks.size(); ++i) draw(plot_.ticks[i], static_cast<int>(i), next);
        for (const Level& level : plot_.levels) draw(level);
    }

  private:
    std::vector<double> values(bool x) const {
        std::vector<double> all;
        for (const Series& series : plot_.series) {
            for (const auto& [px, py] : series.points) all.push_back(x ? px : py);
            for (std::size_t i = 0; i < series.errors.size() && !x; ++i)
                for (const double side : {-1.0, 1.0})
                    all.push_back(series.points[i].second + side * series.errors[i]);
        }
        if (x)
            for (const Ticks& ticks : plot_.ticks) all.insert(all.end(), ticks.at.begin(), ticks.at.end());
        else
            for (const Level& level : plot_.levels) all.push_back(level.y);
        return all;
    }

    void axes() {
        for (const auto& [value, label] : x_.marks()) {
            paper_.line(x_.at(value), kChartTop, x_.at(value), kChartBottom, kGridPen);
            paper_.text(x_.at(value), kChartBottom + 24, label, "middle", {});
        }
        for (const auto& [value, label] : y_.marks()) {
            paper_.line(kChartLeft, y_.at(value), kChartRight, y_.at(value), kGridPen);
            paper_.text(kChartLeft - 8, y_.at(value) + 4, label, "end", {});
        }
        paper_.frame(kChartLeft, kChartTop, kChartRight - kChartLeft, kChartBottom - kChartTop, {"#444"});
        paper_.text(0.5 * (kChartLeft + kChartRight), kChartBottom + 46, plot_.x.title, "middle", {});
        paper_.text(18, 0.5 * (kChartTop + kChartBottom), plot_.y.title, "middle", {.upwards = true});
    }

    double legend_line(const std::string& name) {
        const double y = kChartTop + 10 + kLineHeight * legend_++;
        paper_.text(kChartRight + 42, y + 4, name, "start", {.size = 12});
        return y;
    }

    void draw(const Level& level) {
        if (!y_.inside(level.y)) return;
        const double y = y_.at(level.y);
        paper_.line(kChartLeft, y, kChartRight, y, {"#444", 1.0, "6 4"});
        paper_.text(kChartRight - 4, y - 4, level.name, "end", {.size = 11, .colour = "#444", .halo = true});
    }

    void draw(const Series& series, int number) {
        const char* colour = kPalette[number % kColours];
        const Pen pen{colour, 1.6, series.dashed ? "5 4" : ""};
        std::vector<std::pair<double, double>> path;
        for (std::size_t i = 0; i < series.errors.size(); ++i) {
            const auto& [x, y] = series.points[i];
            const double low = y - series.errors[i], high = y + series.errors[i];
            if (x_.inside(x) && y_.inside(low) && y_.inside(high))
                paper_.line(x_.at(x), y_.at(low), x_.at(x), y_.at(high), {colour, 1.6});
        }
        for (const auto& [x, y] : series.points) {
            if (!x_.inside(x) || !y_.inside(y)) continue;
            path.emplace_back(x_.at(x), y_.at(y));
            if (series.dots) paper_.dot(x_.at(x), y_.at(y), dot_of(series), colour);
        }
        if (series.line && !path.empty()) paper_.path(path, pen);
        if (series.name.empty()) return;
        const double y = legend_line(series.name);
        if (series.line) paper_.line(kChartRight + 12, y, kChartRight + 36, y, pen);
        if (series.dots) paper_.dot(kChartRight + 24, y, std::max(dot_of(series), 3.2), colour);
    }

    void draw(const Ticks& ticks, int row, int next) {
        const char* colour = kPalette[(next + row) % kColours];
        const double low = kChartBottom - 10.0 * row;
        for (const double x : ticks.at)
            if (x_.inside(x)) paper_.line(x_.at(x), low, x_.at(x), low - 9, {colour, 1.5});
        if (ticks.name.empty()) return;
        const double y = legend_line(ticks.name);
        paper_.line(kChartRight + 24, y + 5, kChartRight + 24, y - 5, {colour, 2.0});
    }

    static double dot_of(const Series& series) {
        return series.points.size() == 1 && !series.line ? 6.0 : series.line ? 3.2 : 2.2;
    }

    static constexpr Pen kGridPen{"#e4e4e4"};
    const Plot& plot_;
    Paper& paper_;
    AxisScale x_, y_;
    int legend_ = 0;
};

class SvgPaper : public Paper {
  public:
    SvgPaper() {
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
            "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
            "fill=\"white\"/>\n",
            kChartWidth, kChartHeight);
    }
    std::string file() const { return fmt::to_string(out_) + "</svg>\n"; }

    void text(double x, double y, const std::string& words, const char* anchor, const Font& font) override {
        std::string more;
        const auto say = [&more](const std::string& attribute) {
            more += (more.empty() ? "" : " ") + attribute;
        };
        if (font.bold) say("font-weight=\"bold\"");
        if (font.size != Font().size) say(fmt::format("font-size=\"{}\"", font.size));
        if (font.colour != std::string_view(Font().colour)) say(fmt::format("fill=\"{}\"", font.colour));
        if (font.halo) say("stroke=\"white\" stroke-width=\"4\" paint-order=\"stroke\"");
        if (font.upwards) say(fmt::format("transform=\"rotate(-90 {} {})\"", x, y));
        add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, more,
            escaped(words));
    }
    void line(double x1, double y1, double x2, double y2, const Pen& pen) override {
        add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" {}/>\n", x1, y1, x2,
            y2, pen.colour, more_of(pen));
    }
    void path(const std::vector<std::pair<double, double>>& points, const Pen& pen) override {
        std::string list;
        for (const auto& [x, y] : points) list += fmt::format("{:.1f},{:.1f} ", x, y);
        add("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" {}/>\n", list, pen.colour, more_of(pen));
    }
    void dot(double x, double y, double radius, const char* colour) override {
        add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, radius, colour);
    }
    void frame(double x, double y, double width, double height, const Pen& pen) override {
        add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", x, y, width,
            height, pen.colour);
    }

  private:
    template <typename... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
    }
    static std::string more_of(const Pen& pen) {
        std::string more = *pen.dash ? fmt::format("stroke-dasharray=\"{}\"", pen.dash) : "";
        if (pen.width != 1.0)
            more += fmt::format("{}stroke-width=\"{}\"", more.empty() ? "" : " ", pen.width);
        return more;
    }

    fmt::memory_buffer out_;
};

}  // namespace

void draw_chart(const Plot& plot, Paper& paper) {
    ChartDrawing(plot, paper).draw();
}

std::string plot_svg(const Plot& plot) {
    SvgPaper paper;
    draw_chart(plot, paper);
    return paper.file();
}

void write_plot(const Plot& plot, const std::string& path) {
    write_report(path, path.ends_with(".svg") ? plot_svg(plot) : cairo_chart(plot, diagram_format(path)));
}

void add_plot(Options& command, std::string& plot) {
    command.option("--plot", &plot, "FILE", "Draw a chart: .svg, .pdf or .png (default: not drawn)");
}

void check_plot_path(const std::string& path) {
    if (path == ".svg") throw UsageError("--plot .svg: give a name before the ending");
    if (!path.empty() && !path.ends_with(".svg")) diagram_format(path);
}

}  // namespace carom::tools
