// Any text as a scene file: read it, plan it, run its first events. It may be refused; a crash, a hang, a NaN
// or an exception of another kind is a finding.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"

namespace {

// Enough for every kind of event, few enough for hundreds of runs per second.
constexpr std::int64_t kEvents = 60;
constexpr std::size_t kBalls = 12;
constexpr int kSubsteps = 1000;
// Slow rounds, after which a run ends: without friction a ball runs along a round wall for a million rounds.
constexpr int kSlowRounds = 20000;

void check_finite(const carom::Record& record) {
    for (const carom::BallTrack& track : record.tracks) {
        for (const carom::Segment& s : track.segments) {
            if (!s.r.allFinite() || !s.v.allFinite() || !s.w.allFinite() || !s.a.allFinite() ||
                !s.dw.allFinite() || !std::isfinite(s.start))
                std::abort();
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        carom::Scene scene =
            carom::parse_scene(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.toml");
        const bool small = scene.ball.size() <= kBalls && scene.physics.substeps.value_or(1) <= kSubsteps;
        if (!scene.stop.events || *scene.stop.events > kEvents) scene.stop.events = kEvents;
        const carom::Plan plan = carom::make_plan(scene, carom::kernel::Isa::kScalar);
        carom::SimulateOptions options;
        options.progress = [slow = 0](std::size_t, double) mutable {
            if (++slow > kSlowRounds) throw carom::SimulationError("long enough");
        };
        if (small) check_finite(carom::simulate(plan, options));
    } catch (const carom::SceneError&) {
    } catch (const carom::SimulationError&) {
        // A run that cannot continue may say so.
    }
    return 0;
}
