// A scene malformed in each of ten ways prints its exact message and exits 2.
#include <gtest/gtest.h>

#include <string>

#include "cli.h"

namespace carom::test {
namespace {

struct Malformed {
    const char* text;
    const char* message;  ///< behind "carom: FILE"; a "*" at the end stands for a list
};

const Malformed kScenes[] = {
    {"[[ball]]\nid = \"cue\"\ncolor = \"white\"\n",
     ":3:1: unknown key \"color\" in [ball]; the keys there are *"},
    {"[[ball]]\nposition = [0.5, \"x\"]\n",
     ":2:18: ball.position[1] must be a number, or a number with a unit in quotes (m, cm, mm, in, ft), not "
     "\"x\""},
    {"[balls]\nmass = -0.17\n[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n",
     ":2:8: balls.mass = -0.17 is out of range; it must be at least 1e-09 and at most 1000000 kg"},
    {"[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n[[ball]]\nid = \"1\"\nposition = [0.5, 0.55]\n",
     ":4:1: balls \"cue\" and \"1\" overlap by 0.00715 m; move one of them"},
    {"[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\n[[ball]]\nid = \"a\"\nposition = [0.5, 1.5]\n",
     ":4:1: ball id \"a\" is already used in line 1; give each ball an id of its own"},
    {"[[ball]]\nid = \"one\"\nposition = [0.5, 0.5]\n[cue]\nball = \"cue\"\nspeed = 1\n",
     ":5:8: cue.ball: there is no ball \"cue\"; add a [[ball]] with this id or name another"},
    {"[physics]\ncushion = \"rubber\"\n[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n",
     ":2:11: unknown physics.cushion \"rubber\"; use *"},
    {"[table]\npreset = \"nine_foot\"\n", ": there is no ball; add a [[ball]] or a [rack]"},
    {"[render]\nfps = 0\n[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n",
     ":2:7: render.fps = 0 is out of range; it must be more than 0 and at most 100000 frames per second"},
    {"[table]\npreset = \"nine_foot\"\npreset = \"carom\"\n",
     ":3:10: this key or section appears twice; keep one of the two (Error while parsing key-value pair: "
     "cannot "
     "redefine existing string 'preset')"},
};

TEST(CliScene, CheckShowsFrictionBySlipAndBallsOfTheirOwn) {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("s.toml",
                     "[balls]\nmu_b_fit = [0.01, 0.1, 1.5]\n[physics]\nball_ball = \"inelastic\"\n"
                     "clusters = \"sequential\"\n[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\n"
                     "[[ball]]\nid = \"b\"\nposition = [0.9, 0.5]\nmass = 0.2\n");
    const ProcessResult result = carom({"check", scene});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("mu_b at slip u: 0.01 + 0.1 exp(-1.5 u)\n"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("ball b differs: R 0.028575 m, mass 0.2 kg\n"), std::string::npos);
    EXPECT_NE(result.out.find("closed form"), std::string::npos);
}

TEST(CliScene, TenMalformedScenesPrintTenExactMessages) {
    ASSERT_EQ(std::size(kScenes), 10u);
    const TemporaryFolder folder;
    for (const Malformed& scene : kScenes) {
        const std::string path = folder.write("bad.toml", scene.text);
        for (const char* command : {"simulate", "render", "margin", "check"}) {
            const ProcessResult result = carom({command, path});
            EXPECT_EQ(result.status, 2) << scene.text;
            EXPECT_EQ(result.out, "") << scene.text;
            std::string want = "carom: " + path + scene.message, got = result.err;
            if (want.back() == '*') {
                want.pop_back();
                EXPECT_GT(got.size(), want.size() + 1) << scene.text;
                got = got.substr(0, want.size()) + got.substr(got.find('\n'));
            }
            EXPECT_EQ(got, want + "\n") << scene.text;
        }
    }
}

}  // namespace
}  // namespace carom::test
