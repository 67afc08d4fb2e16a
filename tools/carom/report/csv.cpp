// Events and samples of a record as CSV.
#include "report/csv.h"

#include <fmt/format.h>

#include <iterator>

#include "base/console.h"
#include "base/output_file.h"

namespace carom::tools {
namespace {

/// 1e9 rows are more than 100 GB: taken for a typing error.
constexpr double kMostRows = 1e9;

}  // namespace

void write_events_csv(const Record& record, const std::string& path) {
    OutputFile file(path);
    const bool profiled = !record.costs.empty();
    file.write(profiled ? "time,type,a,b,detect_ns,resolve_ns,kernel_ns,steps,method\n" : "time,type,a,b\n");
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        const Event& event = record.events[i];
        const std::string& ball = record.tracks.at(event.a).id;
        std::string row =
            fmt::format("{},{},{},{}", event.time, name(event.type), ball, record.partner_id(event));
        if (profiled) {
            const EventCost& cost = record.costs.at(i);
            row += fmt::format(",{},{},{},{},{}", cost.detect_ns, cost.resolve_ns, cost.kernel_ns, cost.steps,
                               cost.method);
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
