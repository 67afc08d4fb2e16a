// Any text as a line of `carom impact`: the response is one prompt line of JSON without NaN.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "commands/impact/impact_line.h"

namespace {

using carom::tools::ImpactSettings;

// By tolerance and by the published march; the cushions exercise the closed forms.
void answer(std::string_view line, ImpactSettings settings) {
    const carom::tools::ImpactAnswer got = carom::tools::answer_impact(line, settings);
    if (got.json.find('\n') != std::string::npos) std::abort();
    const nlohmann::json json = nlohmann::json::parse(got.json, nullptr, false);
    if (!json.is_object() || json.contains("error") == got.ok) std::abort();
    // The writer turns a NaN into null.
    if (got.ok && got.json.find("null") != std::string::npos && line.find("null") == std::string_view::npos)
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view line(reinterpret_cast<const char*>(data), size);
    ImpactSettings settings;
    settings.march = carom::kernel::march_function(carom::kernel::Isa::kScalar);
    settings.by_tolerance = carom::kernel::tolerance_function(carom::kernel::Isa::kScalar);
    answer(line, settings);
    settings.substeps = 100;
    answer(line, settings);
    return 0;
}
