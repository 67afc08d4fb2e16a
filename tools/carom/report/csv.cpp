// Events and samples of a record as CSV.
#include "report/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/output_file.h"
#include "carom/engine/event_details.h"

namespace carom::tools {
namespace {

/// 1e9 rows are more than 100 GB, probably a typing error.
constexpr double kMostRows = 1e9;

}  // namespace

void write_events_csv(const Record& record, const std::string& path) {
    OutputFile file(path);
    const bool profiled = !record.costs.empty();
    std::string header =
        profiled ? "time,type,a,b,detect_ns,resolve_ns,kernel_ns,steps,method" : "time,type,a,b";
    for (const EventColumn& column : event_columns()) header += fmt::format(",{}", column.name);
    file.write(header + ",met,cluster\n");
    std::vector<double> numbers(event_columns().size());
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        throw_if_interrupted();
        const Event& event = record.events[i];
        const std::string& ball = record.tracks.at(event.a).id;
        std::string row =
            fmt::format("{},{},{},{}", event.time, name(event.type), ball, record.partner_id(event));
        if (profiled) {
            const EventCost& cost = record.costs.at(i);
            row += fmt::format(",{},{},{},{},{}", cost.detect_ns, cost.resolve_ns, cost.kernel_ns, cost.steps,
                               cost.method);
        }
        event_row(record, i, numbers);
        for (const double number : numbers) row += std::isnan(number) ? "," : fmt::format(",{}", number);
        // Names of cushions contain commas.
        row += fmt::format(",\"{}\",", met_name(record, event));
        if (event.type == EventType::kBallCluster) {
            const char* between = "";
            for (const int member : record.clusters.at(static_cast<std::size_t>(event.detail)).balls)
                row += std::exchange(between, ";") + record.tracks.at(member).id;
        }
        file.write(row + '\n');
    }
    file.commit();
}

void write_samples_csv(const Record& record, double dt, const std::string& path) {
    OutputFile file(path);
    const double rows = (record.duration / dt + 1.0) * static_cast<double>(record.tracks.size());
    if (!(rows <= kMostRows)) {
        throw UsageError(
            fmt::format("--sample-dt {}: that is more than {:.0f} rows; use a larger step", dt, kMostRows));
    }
    file.write("time,ball,state,x,y,z,vx,vy,vz,wx,wy,wz\n");
    for (long k = 0; static_cast<double>(k) * dt <= record.duration; ++k) {
        throw_if_interrupted();
        const double time = static_cast<double>(k) * dt;
        fmt::memory_buffer block;
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const BallState s = record.state_at(static_cast<int>(i), time);
            fmt::format_to(std::back_inserter(block), "{},{},{},{},{},{},{},{},{},{},{},{}\n", time,
                           record.tracks[i].id, name(s.state), s.position.x(), s.position.y(), s.position.z(),
                           s.velocity.x(), s.velocity.y(), s.velocity.z(), s.spin.x(), s.spin.y(),
                           s.spin.z());
        }
        file.write({block.data(), block.size()});
    }
    file.commit();
}

}  // namespace carom::tools
