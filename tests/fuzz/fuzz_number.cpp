// Any text as a number, wherever a scene or a rule accepts one: it is refused, or read as the number in the
// text.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "carom/engine/variation.h"

namespace {

const std::string kScene =
    "[table]\npreset = \"nine_foot\"\n[rack]\ngame = \"eight_ball\"\njitter = 0.001\nseed = "
    "0\n[[ball]]\nposition = [0.6, "
    "0.5]\n"
    "[cue]\nspeed = 1\n";

void expect(bool holds) {
    if (!holds) std::abort();
}

/// As a number: the double nearest to the digits; an integer must be exact.
void check_number(double got, const std::string& text) {
    expect(got == std::strtod(text.c_str(), nullptr));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    // strtod reads digits, signs, a point and an exponent the same way.
    if (size > 400 || text.find_first_not_of("+-.0123456789eE") != text.npos) return 0;
    for (const char* const key : {"gravity", "tolerance"}) {
        try {
            const carom::Scene scene =
                carom::parse_scene(kScene + "[physics]\n" + key + " = " + text, "n.toml");
            check_number(key[0] == 'g' ? scene.physics.gravity : scene.physics.tolerance, text);
        } catch (const carom::SceneError& error) {
            // Messages quote an integer's digits; toml++ quotes those that it cannot represent.
            const bool whole = size < 100 && text.find_first_of("123456789") == 0 &&
                               text.find_first_not_of("0123456789") == text.npos;
            expect(!whole || error.message().find(text) != text.npos);
        }
    }
    try {
        const carom::Scene scene = carom::parse_scene(kScene + "[stop]\nevents = " + text, "n.toml");
        expect(*scene.stop.events == std::strtoll(text.c_str(), nullptr, 10));
    } catch (const carom::SceneError&) {
    }
    for (const std::string& rule :
         {"cue.speed=list(" + text + ")", "cue.speed=uniform(" + text + "," + text + ")",
          "cue.speed=normal(" + text + ",0)", "rack.seed=list(" + text + ")",
          "rack.seed=integer(" + text + "," + text + ")"}) {
        try {
            const carom::Variation rules = carom::Variation::from_text(kScene, "n.toml", {rule}, 1);
            const carom::VariedShot shot = rules.shot(0);
            if (rule[0] == 'c') check_number(shot.scene->cue->speed, text);
            // A batch that sets a number without the file equals the file with it.
            carom::Scene quick = rules.base();
            if (!rules.put(shot.values, quick)) continue;
            expect(quick.cue->speed == shot.scene->cue->speed);
            for (std::size_t i = 0; i < quick.ball.size(); ++i)
                expect(quick.ball[i].position == shot.scene->ball[i].position);
        } catch (const carom::SceneError&) {
        } catch (const carom::VariationError&) {
        }
    }
    return 0;
}
