// carom impact: one impact per line of standard input, its result per line of standard output. Every answer
// is flushed, so that another program can ask over a pipe and wait for it.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "console.h"
#include "impact_line.h"
#include "setup.h"

namespace carom::tools {
namespace {

/// Lines of standard input, of bounded length. Not std::getline:
/// that neither returns on SIGINT nor stops at a length.
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
            throw_if_interrupted();  // the end of the input may come together with the signal
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

}  // namespace

int run_impact(const ImpactArgs& args) {
    const ImpactSettings settings = settings_of(args);
    LineReader reader;
    std::string line;
    bool all_computed = true;
    for (;;) {
        const LineReader::Got got = reader.next(line);
        if (got == LineReader::Got::kEnd) break;
        // A blank line, such as one at the end of a file, asks for nothing.
        if (got == LineReader::Got::kLine && is_blank(line)) continue;
        const ImpactAnswer answer =
            got == LineReader::Got::kTooLong
                ? impact_error("the line is longer than " + std::to_string(kLongestImpactLine) + " bytes")
                : answer_impact(line, settings);
        all_computed = all_computed && answer.ok;
        print(answer.json + "\n");
        flush_output();
    }
    return all_computed ? kOk : kFailed;
}

}  // namespace carom::tools
