#include "commands/sweep/status.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "report/table.h"

namespace carom::tools {

namespace {
constexpr std::chrono::seconds kEvery(1);
}

SweepStatus::SweepStatus(std::string path, std::string output, std::uint64_t first, std::uint64_t last,
                         std::uint64_t from)
    : path_(std::move(path)),
      output_(std::move(output)),
      first_(first),
      last_(last),
      from_(from),
      done_(from),
      start_(Clock::now()),
      written_(start_) {
    write("running");
}

void SweepStatus::show(std::uint64_t done, const Outcomes& outcomes) {
    done_ = done;
    outcomes_ = outcomes;
    if (Clock::now() - written_ >= kEvery) write("running");
}

void SweepStatus::end(const char* state) {
    write(state);
}

void SweepStatus::write(const char* state) {
    if (path_.empty()) return;
    written_ = Clock::now();
    const double seconds = std::chrono::duration<double>(written_ - start_).count();
    const std::uint64_t played = done_ - from_;
    nlohmann::ordered_json json;
    json["state"] = state;
    json["output"] = output_;
    json["first"] = first_;
    json["last"] = last_;
    json["rows"] = done_ - first_;
    json["played"] = played;
    json["seconds"] = seconds;
    json["shots_per_second"] = seconds > 0.0 ? static_cast<double>(played) / seconds : 0.0;
    for (int i = 0; i < kShotStatuses; ++i)
        json["outcomes"][name(static_cast<ShotStatus>(i))] = outcomes_[static_cast<std::size_t>(i)];
    write_report(path_, json.dump(1) + '\n');
}

}  // namespace carom::tools
