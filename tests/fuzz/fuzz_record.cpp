// Any text as a record file: read it, then query it as rendering does. It may be refused; a crash, a hang or
// a NaN is a finding.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "carom/engine/record.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const carom::Record record =
            carom::parse_record(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.json");
        if (record.hash().size() != 16) std::abort();
        for (std::size_t ball = 0; ball < record.tracks.size(); ++ball) {
            for (const double part : {0.0, 0.37, 1.0}) {
                const carom::BallState state =
                    record.state_at(static_cast<int>(ball), part * record.duration);
                if (!state.position.allFinite() || !state.velocity.allFinite() || !state.spin.allFinite())
                    std::abort();
                const Eigen::Quaterniond q =
                    record.orientation_at(static_cast<int>(ball), part * record.duration);
                if (!q.coeffs().allFinite()) std::abort();
            }
        }
        for (const carom::Event& event : record.events) record.partner_id(event);
    } catch (const carom::SceneError&) {
    }
    return 0;
}
