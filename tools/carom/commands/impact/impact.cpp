// carom impact: reads one impact from each line of standard input and writes
// its result to a line of standard output. Every result is flushed, so that
// another program can send an impact through a pipe and wait for the result.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/kernel/tolerance.h"
#include "commands/impact/impact_line.h"

namespace carom::tools {
namespace {

struct ImpactArgs {
    std::string method = "mathavan";
    std::optional<int> substeps;
    double tolerance = 1e-6;
    std::string cloth_slip = "consistent";
};

/// Reads lines of bounded length from standard input. std::getline
/// cannot be used: it neither returns on SIGINT nor limits the length.
class LineReader {
  public:
    enum class Got : unsigned char { kLine, kTooLong, kEnd };

    Got next(std::string& line) {
        line.clear();
        bool too_long = false;
        for (;;) {
            if (position_ == filled_ && !fill()) {
                if (too_long) return Got::kTooLong;
                return line.empty() ? Got::kEnd : Got::kLine;
            }
            const char* const start = buffer_ + position_;
            const auto* const end = static_cast<const char*>(std::memchr(start, '\n', filled_ - position_));
            const std::size_t count =
                end != nullptr ? static_cast<std::size_t>(end - start) : filled_ - position_;
            if (line.size() + count > kLongestImpactLine) too_long = true;
            if (!too_long) line.append(start, count);
            position_ += count;
            if (end != nullptr) {
                ++position_;
                return too_long ? Got::kTooLong : Got::kLine;
            }
        }
    }

  private:
    bool fill() {
        for (;;) {
            throw_if_interrupted();
            const ssize_t count = ::read(STDIN_FILENO, buffer_, sizeof buffer_);
            throw_if_interrupted();  // the end of the input may arrive together with the signal
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) throw std::runtime_error(std::string("standard input: ") + std::strerror(errno));
            position_ = 0;
            filled_ = static_cast<std::size_t>(count);
            return count > 0;
        }
    }

    char buffer_[1 << 16];
    std::size_t position_ = 0, filled_ = 0;
};

ImpactSettings settings_of(const ImpactArgs& args) {
    ImpactSettings settings;
    using Method = ImpactSettings::Method;
    settings.method = args.method == "inelastic" ? Method::kInelastic
                      : args.method == "elastic" ? Method::kElastic
                                                 : Method::kMathavan;
    settings.substeps = args.substeps;
    settings.cloth_slip =
        args.cloth_slip == "as_published" ? kernel::ClothSlip::kAsPublished : kernel::ClothSlip::kConsistent;
    settings.tolerance = args.tolerance;
    settings.march = kernel::march_function(chosen_isa());
    settings.by_tolerance = kernel::tolerance_function(chosen_isa());
    return settings;
}

bool is_blank(const std::string& line) {
    return line.find_first_not_of(" \t\r") == std::string::npos;
}

int run(const ImpactArgs& args) {
    const ImpactSettings settings = settings_of(args);
    LineReader reader;
    std::string line;
    bool all_computed = true;
    for (;;) {
        const LineReader::Got got = reader.next(line);
        if (got == LineReader::Got::kEnd) break;
        // A blank line, such as the last one of a file, has no result.
        if (got == LineReader::Got::kLine && is_blank(line)) continue;
        const ImpactAnswer answer =
            got == LineReader::Got::kTooLong
                ? impact_error(fmt::format("the line is longer than {} bytes", kLongestImpactLine))
                : answer_impact(line, settings);
        all_computed = all_computed && answer.ok;
        print(answer.json + "\n");
        flush_output();
    }
    return all_computed ? kOk : kFailed;
}

}  // namespace

void add_impact(Options& program) {
    auto [command, args] = program.command<ImpactArgs>(
        "impact", "Compute impacts: one per line of standard input, one result per line (JSON)", run);
    command.option("--method", &args.method, "NAME", "Ball-ball model")
        .one_of({"mathavan", "inelastic", "elastic"});
    command
        .option("--substeps", &args.substeps, "N",
                "Use the published march with this N (mathavan; default: off)")
        .in(1, 100000000);
    Option& tolerance = command.option("--tolerance", &args.tolerance, "E",
                                       "Allowed error, relative to the approach speed (mathavan)");
    tolerance.in(kernel::kTightestTolerance, kernel::kLoosestTolerance);
    tolerance.excludes = "--substeps";
    add_cloth_slip(command, args.cloth_slip, "Sign of the cloth slip inside the impact (mathavan)");
    command.footer = impact_keys();
}

}  // namespace carom::tools
