// Plots as SVG files.
#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/console.h"
#include "report/table.h"

namespace carom::tools {
namespace {

// Colours that are also distinct to people who confuse red and green (Okabe and Ito).
constexpr const char* kPalette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000", "#999999"};
constexpr int kColours = 8;
constexpr double kWidth = 960, kLeft = 80, kRight = kLeft + kPlotWidth;
constexpr double kTop = 60, kBottom = kTop + kPlotHeight, kHeight = 530;
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
class Scale {
  public:
    Scale(const Axis& axis, const std::vector<double>& values, double from, double to)
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
            for (int p = first; p <= last; p += step)
                list.emplace_back(std::pow(10.0, p), p >= 0 && p <= 3 ? fmt::format("{:.0f}", std::pow(10, p))
                                                                      : fmt::format("1e{}", p));
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

class Drawing {
  public:
    explicit Drawing(const Plot& plot)
        : plot_(plot), x_(plot.x, values(true), kLeft, kRight), y_(plot.y, values(false), kBottom, kTop) {}

    std::string svg() {
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
            "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
            "fill=\"white\"/>\n",
            kWidth, kHeight);
        text(kLeft, 22, plot_.title, "start", "font-weight=\"bold\" font-size=\"15\"");
        for (std::size_t i = 0; i < plot_.notes.size(); ++i)
            text(kLeft, 40 + 14 * static_cast<double>(i), plot_.notes[i], "start",
                 "font-size=\"11\" fill=\"#555\"");
        axes();
        int next = 0;
        for (const Series& series : plot_.series) draw(series, series.colour >= 0 ? series.colour : next++);
        for (std::size_t i = 0; i < plot_.ticks.size(); ++i) draw(plot_.ticks[i], static_cast<int>(i), next);
        for (const Level& level : plot_.levels) draw(level);
        add("</svg>\n");
        return fmt::to_string(out_);
    }

  private:
    template <typename... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
    }

    void text(double x, double y, const std::string& words, const char* anchor, const char* more = "") {
        add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, more,
            escaped(words));
    }

    void stroke(double x1, double y1, double x2, double y2, const char* colour, const char* more = "") {
        add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" {}/>\n", x1, y1, x2,
            y2, colour, more);
    }

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
            stroke(x_.at(value), kTop, x_.at(value), kBottom, "#e4e4e4");
            text(x_.at(value), kBottom + 24, label, "middle");
        }
        for (const auto& [value, label] : y_.marks()) {
            stroke(kLeft, y_.at(value), kRight, y_.at(value), "#e4e4e4");
            text(kLeft - 8, y_.at(value) + 4, label, "end");
        }
        add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n", kLeft,
            kTop, kRight - kLeft, kBottom - kTop);
        text(0.5 * (kLeft + kRight), kBottom + 46, plot_.x.title, "middle");
        const double middle = 0.5 * (kTop + kBottom);
        text(18, middle, plot_.y.title, "middle",
             fmt::format("transform=\"rotate(-90 18 {})\"", middle).c_str());
    }

    double legend_line(const std::string& name) {
        const double y = kTop + 10 + kLineHeight * legend_++;
        text(kRight + 42, y + 4, name, "start", "font-size=\"12\"");
        return y;
    }

    void draw(const Level& level) {
        if (!y_.inside(level.y)) return;
        const double y = y_.at(level.y);
        stroke(kLeft, y, kRight, y, "#444", "stroke-dasharray=\"6 4\"");
        text(kRight - 4, y - 4, level.name, "end",
             "font-size=\"11\" fill=\"#444\" stroke=\"white\" stroke-width=\"4\" paint-order=\"stroke\"");
    }

    void draw(const Series& series, int number) {
        const char* colour = kPalette[number % kColours];
        const char* dash =
            series.dashed ? "stroke-dasharray=\"5 4\" stroke-width=\"1.6\"" : "stroke-width=\"1.6\"";
        std::string path;
        for (std::size_t i = 0; i < series.errors.size(); ++i) {
            const auto& [x, y] = series.points[i];
            const double low = y - series.errors[i], high = y + series.errors[i];
            if (x_.inside(x) && y_.inside(low) && y_.inside(high))
                stroke(x_.at(x), y_.at(low), x_.at(x), y_.at(high), colour, "stroke-width=\"1.6\"");
        }
        for (const auto& [x, y] : series.points) {
            if (!x_.inside(x) || !y_.inside(y)) continue;
            path += fmt::format("{:.1f},{:.1f} ", x_.at(x), y_.at(y));
            if (series.dots)
                add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x_.at(x), y_.at(y),
                    series.line ? 3.2 : 2.2, colour);
        }
        if (series.line && !path.empty())
            add("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" {}/>\n", path, colour, dash);
        if (series.name.empty()) return;
        const double y = legend_line(series.name);
        if (series.line) stroke(kRight + 12, y, kRight + 36, y, colour, dash);
        if (series.dots) add("<circle cx=\"{}\" cy=\"{}\" r=\"3.2\" fill=\"{}\"/>\n", kRight + 24, y, colour);
    }

    void draw(const Ticks& ticks, int row, int next) {
        const char* colour = kPalette[(next + row) % kColours];
        const double low = kBottom - 10.0 * row;
        for (const double x : ticks.at)
            if (x_.inside(x)) stroke(x_.at(x), low, x_.at(x), low - 9, colour, "stroke-width=\"1.5\"");
        if (ticks.name.empty()) return;
        const double y = legend_line(ticks.name);
        stroke(kRight + 24, y + 5, kRight + 24, y - 5, colour, "stroke-width=\"2\"");
    }

    const Plot& plot_;
    fmt::memory_buffer out_;
    Scale x_, y_;
    int legend_ = 0;
};

}  // namespace

std::string plot_svg(const Plot& plot) {
    return Drawing(plot).svg();
}

void write_plot(const Plot& plot, const std::string& path) {
    write_report(path, plot_svg(plot));
}

void add_plot(Options& command, std::string& plot) {
    command.option("--plot", &plot, "FILE.svg", "Draw it (default: not drawn)");
}

void check_plot_path(const std::string& path) {
    if (!path.empty() && (path.size() <= 4 || !path.ends_with(".svg")))
        throw UsageError(fmt::format("--plot {}: plots are SVG; give a name that ends in .svg", path));
}

}  // namespace carom::tools
