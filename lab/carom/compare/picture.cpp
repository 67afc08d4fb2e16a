#include "compare/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/engine/vec.h"
#include "commands/compare/difference.h"

namespace carom::tools {
namespace {

constexpr int kGrey = 7, kBallColours = 7;  // of the palette of plots
constexpr std::size_t kMostNames = 22;      // in the legend; the frame fits no more

/// Maps the cloth to the paper, and collects the extent of the drawing.
class PaperPlane {
  public:
    explicit PaperPlane(bool turned) : turned_(turned) {}

    /// Turned by a right angle, not mirrored.
    std::pair<double, double> point(double x, double y) {
        const std::pair<double, double> p = turned_ ? std::pair(y, -x) : std::pair(x, y);
        low_ = low_.cwiseMin(Vec2(p.first, p.second));
        high_ = high_.cwiseMax(Vec2(p.first, p.second));
        return p;
    }

    /// Both axes to the same scale.
    void set_axes(Plot& plot) const {
        const Vec2 middle = 0.5 * (low_ + high_), span = 1.04 * (high_ - low_);
        const double metre =
            std::min(kPlotWidth / std::max(span.x(), 1e-3), kPlotHeight / std::max(span.y(), 1e-3));
        const Vec2 half = 0.5 * Vec2(kPlotWidth, kPlotHeight) / metre;
        plot.x = {turned_ ? "y (m)" : "x (m)", false, middle.x() - half.x(), middle.x() + half.x()};
        plot.y = {turned_ ? "x (m)" : "y (m)", false, middle.y() - half.y(), middle.y() + half.y()};
        if (!turned_) return;
        const double step = half.y() < 2.0 ? 0.5 : std::ceil(half.y() / 3.0);
        for (double k = std::ceil(*plot.y.low / step); k * step <= *plot.y.high; k += 1.0)
            plot.y.marks.emplace_back(k * step, fmt::format("{:g}", 0.0 - k * step));
    }

  private:
    static constexpr double kFar = std::numeric_limits<double>::infinity();
    bool turned_;
    Vec2 low_ = Vec2(kFar, kFar), high_ = Vec2(-kFar, -kFar);
};

/// Times along the path: at the ends of its segments, and in between as close as a line needs.
std::vector<double> times_on(const BallWay& way) {
    const double step = std::max(0.02, way.last() / 2000.0);  // [s]
    std::vector<double> times;
    for (double k = 0.0; k * step < way.last(); k += 1.0) times.push_back(k * step);
    for (const Segment& s : way.segments())
        if (s.start <= way.last()) times.push_back(s.start);
    times.push_back(way.last());
    std::sort(times.begin(), times.end());
    return times;
}

void draw_ways(const Record& record, const std::vector<int>& colours, bool dashed, PaperPlane& paper,
               Plot& plot) {
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallWay way(record, static_cast<int>(i));
        Series line;
        for (const double t : times_on(way)) {
            const Vec3 place = way.at(t);
            const auto point = paper.point(place.x(), place.y());
            if (line.points.empty() || line.points.back() != point) line.points.push_back(point);
        }
        line.dots = false;
        line.dashed = dashed;
        line.colour = colours[i];
        if (!dashed && i < kMostNames) line.name = record.tracks[i].id;
        Series end = line;
        end.name.clear();
        end.points = {line.points.back()};
        end.line = false;
        end.dots = true;
        plot.series.push_back(std::move(line));
        plot.series.push_back(std::move(end));
    }
}

void draw_noses(const carom::Table& table, PaperPlane& paper, Plot& plot) {
    const carom::Table drawn = without_arcs(table);
    for (const Cushion& cushion : drawn.cushions) {
        Series nose;
        nose.points = {paper.point(cushion.from.x(), cushion.from.y()),
                       paper.point(cushion.to.x(), cushion.to.y())};
        nose.dots = false;
        nose.colour = kGrey;
        plot.series.push_back(std::move(nose));
    }
}

}  // namespace

Plot ways_plot(const Record& a, const std::string& name_a, const Record& b, const std::string& name_b) {
    PaperPlane paper(a.table.length >= a.table.width);
    Plot plot;
    plot.title = fmt::format("{} and {}", name_a, name_b);
    plot.notes = {"solid: A, dashed: B; a dot is the last place"};
    draw_noses(a.table, paper, plot);
    std::vector<int> colours_a, colours_b;
    for (std::size_t i = 0; i < a.tracks.size(); ++i) colours_a.push_back(static_cast<int>(i) % kBallColours);
    for (const BallTrack& track : b.tracks) {
        const auto same = std::find_if(a.tracks.begin(), a.tracks.end(),
                                       [&track](const BallTrack& other) { return other.id == track.id; });
        colours_b.push_back(
            same == a.tracks.end() ? kGrey : static_cast<int>(same - a.tracks.begin()) % kBallColours);
    }
    draw_ways(a, colours_a, false, paper, plot);
    draw_ways(b, colours_b, true, paper, plot);
    paper.set_axes(plot);
    return plot;
}

}  // namespace carom::tools
