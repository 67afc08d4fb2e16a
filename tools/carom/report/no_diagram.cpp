// Stands in for diagram.cpp in a build without cairo.
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "report/diagram.h"
#include "report/plot.h"
#include "report/sweep_plot.h"

namespace carom::tools {

std::string diagram_format(const std::string&) {
    throw UsageError(
        "this build of carom has no diagrams: the npm and pip packages omit cairo, and others were built "
        "without libcairo2-dev; build carom from its sources with libcairo2-dev");
}

std::string draw_diagram(const std::vector<DiagramShot>&, const DiagramStyle&, const std::string&) {
    throw std::runtime_error("this build cannot draw diagrams");
}

std::string cairo_chart(const Plot&, const std::string&) {
    throw std::runtime_error("this build draws only .svg; choose a name with this ending");
}

std::string draw_plot(const SweepPlot&, const std::string&, const std::vector<DiagramShot>&,
                      const DiagramStyle&) {
    throw std::runtime_error("this build cannot draw plots");
}

}  // namespace carom::tools
