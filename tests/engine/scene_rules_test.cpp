// All rules of the scene format: bad scenes and their exact messages, defaults, limits.
#include <gtest/gtest.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/temporary_folder.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "support/files.h"
#include "support/scene_errors.h"

namespace {

using carom::parse_scene;
using carom::Scene;
using carom::SceneError;
using carom::Vec2;
using carom::Vec3;
using carom::test::error_of;
using carom::test::matches;
using carom::test::read_file;
using carom::test::toml_files;

const std::string kOneBall = "[[ball]]\nposition = [0.6, 0.5]\n";

// A scene is refused with the message of its row, at a place in its text.
TEST(BadScenes, OfTheTableCauseTheirExactMessage) {
    const toml::table table = toml::parse_file(CAROM_TEST_DATA "/scene_messages.toml");
    std::size_t rows = 0;
    for (const toml::node& scene : *table["scene"].as_array()) {
        const std::string text = scene.at_path("text").value<std::string>().value(),
                          says = scene.at_path("says").value<std::string>().value(), got = error_of(text);
        EXPECT_TRUE(matches(says, got)) << text << "want " << says << "\ngot  " << got;
        EXPECT_NE(got.rfind("s.toml: ", 0), 0u) << "without a place: " << got;
        ++rows;
    }
    EXPECT_GE(rows, 80u);
    EXPECT_EQ(error_of(kOneBall + "[cue]\nspeed = 1000000\n"), "");
}

// The first line of each file is a comment with the whole message. `*` replaces text that depends on the
// version of toml++ (syntax errors) and lists of keys or choices, which scene_docs_test compares with the
// schema. unknown_section.toml lists all sections.
TEST(BadScenes, CauseTheirExactMessage) {
    const auto files = toml_files(std::filesystem::path(CAROM_TEST_DATA) / "bad_scenes");
    ASSERT_GE(files.size(), 25u);
    for (const auto& path : files) {
        const std::string text = read_file(path);
        const std::string file = path.filename().string();
        const std::string want = text.substr(2, text.find('\n') - 2);
        ASSERT_EQ(want.rfind(file, 0), 0u) << file << " does not begin with its message";
        try {
            parse_scene(text, file);
            ADD_FAILURE() << file << " was accepted";
        } catch (const SceneError& error) {
            EXPECT_TRUE(matches(want, error.what())) << "want " << want << "\ngot  " << error.what();
            const carom::SourceLocation at = error.where();
            const std::string place =
                at.line > 0 ? ":" + std::to_string(at.line) + ":" + std::to_string(at.column) : "";
            EXPECT_EQ(error.what(), error.file() + place + ": " + error.message());
            EXPECT_EQ(error.file(), file);
        }
    }
}

TEST(Scenes, EveryFileOfTheRepositoryParses) {
    const auto files = toml_files(std::filesystem::path(CAROM_SOURCE_DIR) / "scenes");
    ASSERT_GE(files.size(), 8u);
    for (const auto& path : files) {
        const Scene scene = carom::read_scene(path.string());
        EXPECT_FALSE(scene.ball.empty()) << path;
        const std::string text = read_file(path);
        EXPECT_EQ(text.rfind("# ", 0), 0u) << path << ": say in a comment what to look for";
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 30) << path;
    }
}

std::string message(const std::string& path) {
    try {
        carom::read_scene(path);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(Scenes, UnreadableFilesAreRefused) {
    EXPECT_EQ(message("no/such.toml"), "no/such.toml: cannot be read: there is no such file; check the path");
    const std::string folder = CAROM_TEST_DATA;
    EXPECT_EQ(message(folder), folder + ": cannot be read: it is a directory; name a scene file in it");
    // A file that exists but is out of reach is not reported as missing. (Removing a folder's permissions
    // would not stop root.)
    const auto loop =
        std::filesystem::temp_directory_path() / ("carom_loop_" + std::to_string(::getpid()) + ".toml");
    std::filesystem::create_symlink(loop, loop);
    EXPECT_EQ(message(loop.string()),
              loop.string() +
                  ": cannot be read: Too many levels of symbolic links; check the path and its permissions");
    std::filesystem::remove(loop);
}

TEST(Scenes, ATooLargeFileIsRefused) {
    const std::string large = "#" + std::string(carom::kMaxFileSize, 'x');
    EXPECT_EQ(error_of(large), "s.toml: is larger than 4 MiB; check that it is a scene file");
    EXPECT_EQ(error_of(kOneBall + "#" + std::string(carom::kMaxFileSize - kOneBall.size() - 1, 'x')), "");
}

// A file is read in pieces, and only until it is known to be too large.
TEST(Scenes, FilesAreReadAsAWhole) {
    const carom::TemporaryFolder folder;
    const std::string path = folder.file("s.toml");
    for (const std::size_t size : {std::size_t{0}, std::size_t{1} << 14U, (std::size_t{1} << 15U) + 7,
                                   carom::kMaxFileSize, carom::kMaxFileSize + 1}) {
        std::string text(size, 'x');
        for (std::size_t i = 0; i < size; i += 1000) text[i] = static_cast<char>('a' + i / 1000 % 26);
        std::ofstream(path) << text;
        EXPECT_TRUE(carom::read_scene_text(path) == text) << size;
    }
    std::ofstream(path) << "#" + std::string(2 * carom::kMaxFileSize, 'x');
    EXPECT_EQ(message(path), path + ": is larger than 4 MiB; check that it is a scene file");
}

TEST(Scenes, TooManyPartsOfATableAreRefused) {
    const auto with_pockets = [](int count) {
        std::string text = kOneBall;
        for (int i = 0; i < count; ++i) text += "[[table.pocket]]\ncenter = [9, 9]\nradius = 0.06\n";
        return text;
    };
    EXPECT_EQ(error_of(with_pockets(carom::kMaxTableParts)), "");
    EXPECT_EQ(error_of(with_pockets(carom::kMaxTableParts + 1)),
              "s.toml:3:1: table.pocket has 4097 entries; at most 4096 are allowed");
}

// The defaults of every section equal the file written by scene_text.
TEST(Scenes, DefaultsAreWrittenOut) {
    const Scene s = parse_scene("[[ball]]\n[cue]\n", "s.toml");
    EXPECT_EQ(scene_text(s), read_file(CAROM_TEST_DATA "/default_scene.toml"));
    EXPECT_EQ(s.file, "s.toml");
    EXPECT_FALSE(parse_scene("[[ball]]\n", "s.toml").cue);
}

TEST(Scenes, BallsAndCueHaveSourceLocations) {
    const Scene s = parse_scene("[[ball]]\nid = \"1\"\n  [[ball]]\nposition = [0.3, 0.4]\n[cue]\n", "s.toml");
    EXPECT_EQ(s.ball[1].where.line, 3);
    EXPECT_EQ(s.ball[1].where.column, 3);
    EXPECT_EQ(s.cue->where.line, 5);
}

// The rounding of 0.5 + 0.05715 is far below the tolerance; 1e-9 m is far above it.
TEST(Scenes, TouchingIsNotOverlapping) {
    const auto two = [](const char* x) {
        return error_of(
            std::string("[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\n[[ball]]\nid = \"b\"\nposition = [") +
            x + ", 0.5]\n");
    };
    EXPECT_EQ(two("0.55715"), "");
    EXPECT_EQ(two("0.5571499999991"), "");
    EXPECT_EQ(two("0.557149999"), "s.toml:4:1: balls \"a\" and \"b\" overlap by 1e-09 m; move one of them");
    const auto at_rail = [](const char* x) {
        return error_of(std::string("[[ball]]\nposition = [") + x + ", 0.6]\n");
    };
    EXPECT_EQ(at_rail("0.028575"), "");
    EXPECT_EQ(at_rail("0.0285749999991"), "");
    EXPECT_EQ(at_rail("0.028574999"),
              "s.toml:1:1: ball \"cue\" reaches 1e-09 m into cushion c3; move it away");
}

// At 1e5 m the spacing of doubles, 1.5e-11 m, is wider than the touch tolerance.
TEST(Scenes, TouchingFarFromTheOrigin) {
    const std::string far =
        "[table]\ncushion = []\n[[ball]]\nid = \"a\"\nposition = [1e5, 1e5]\n[[ball]]\nid = \"b\"\nposition "
        "= ";
    EXPECT_EQ(error_of(far + "[100000.05715, 1e5]\n"), "");
    EXPECT_NE(error_of(far + "[100000.0571499, 1e5]\n"), "");
}

TEST(Scenes, BallsMayLieInAPocketMouthOrOffTheTable) {
    EXPECT_EQ(error_of("[[ball]]\nposition = [0.01, 0.01]\n"), "");
    EXPECT_EQ(error_of("[[ball]]\nposition = [-3, 1e5]\n"), "");
}

TEST(Scenes, CushionsActOnBothSides) {
    const std::string wall = "[[table.cushion]]\nfrom = [0, 0]\nto = [1, 0]\n[[ball]]\nposition = ";
    EXPECT_NE(error_of(wall + "[0.5, 0.028]\n"), "");
    EXPECT_NE(error_of(wall + "[0.5, -0.028]\n"), "");
    EXPECT_NE(error_of(wall + "[-0.02, -0.02]\n"), "") << "the round end";
    EXPECT_EQ(error_of(wall + "[-0.021, -0.021]\n"), "");
    EXPECT_EQ(error_of(wall + "[0.5, -0.029]\n"), "");
}

TEST(Scenes, CustomOutline) {
    const Scene s = parse_scene(R"([[table.cushion]]
from = [-1, 2]
to = [1, 2]
[[table.cushion]]
from = [1, 2]
to = [1, 6]
height = 0.03
[[table.jaw]]
center = [0, 9]
radius = 0.02
[[table.pocket]]
center = [5, 5]
radius = 0.06
[[ball]]
)",
                                "s.toml");
    const carom::Table& t = s.table;
    EXPECT_EQ(t.preset, "");
    ASSERT_EQ(t.cushions.size(), 2u);
    EXPECT_EQ(t.cushions[0].id, "c1");
    EXPECT_EQ(t.cushions[0].height, 1.28 * 0.028575);
    EXPECT_EQ(t.cushions[1].from, Vec2(1, 2));
    EXPECT_EQ(t.cushions[1].to, Vec2(1, 6));
    EXPECT_EQ(t.cushions[1].height, 0.03);
    ASSERT_EQ(t.jaws.size(), 1u);
    EXPECT_EQ(t.jaws[0].id, "j1");
    EXPECT_EQ(t.jaws[0].radius, 0.02);
    ASSERT_EQ(t.pockets.size(), 1u);
    EXPECT_EQ(t.pockets[0].id, "p1");
    EXPECT_EQ(t.pockets[0].center, Vec2(5, 5));
    EXPECT_EQ(t.corner, Vec2(-1, 2));
    EXPECT_EQ(t.width, 2.0);
    EXPECT_EQ(t.length, 4.0);
    EXPECT_EQ(foot_spot(t), Vec2(0, 5));
}

TEST(Scenes, EndlessCloth) {
    const Scene s = parse_scene("table.cushion = []\n[[ball]]\n", "s.toml");
    EXPECT_TRUE(s.table.cushions.empty() && s.table.jaws.empty() && s.table.pockets.empty());
    EXPECT_EQ(s.table.width, 0.0);
    EXPECT_EQ(s.table.length, 0.0);
}

TEST(Scenes, MiscueLimitIsInclusive) {
    EXPECT_EQ(error_of(kOneBall + "[cue]\noffset = [0.3, 0.4]\n"), "");
    EXPECT_EQ(error_of(kOneBall + "[cue]\noffset = [0, -0.5]\n"), "");
    EXPECT_NE(error_of(kOneBall + "[cue]\noffset = [0, 0.5001]\n"), "");
    EXPECT_EQ(error_of(kOneBall + "[cue]\nelevation_deg = 89.9\n"), "");
}

TEST(Scenes, ManyBallsUpToTheLimit) {
    const std::string line = "table.cushion = []\n[rack]\ngame = \"line\"\ngap = 0\ncount = ";
    EXPECT_EQ(parse_scene(line + "4096\n", "s.toml").ball.size(), 4096u);
    EXPECT_NE(error_of(line + "4097\n"), "");
}

TEST(Rest, AMotionlessSceneNeedsNoStop) {
    EXPECT_EQ(error_of("[balls]\nmu_s = 0\nmu_r = 0\nmu_sp = 0\n[physics]\ngravity = 0\n" + kOneBall), "");
    EXPECT_EQ(error_of("[balls]\nmu_r = 0\n" + kOneBall + "[cue]\nspeed = 0\n"), "");
}

TEST(Rest, AnyStopSuffices) {
    const std::string endless = "[balls]\nmu_s = 0\n[[ball]]\nvelocity = [0, 1]\n";
    EXPECT_NE(error_of(endless), "");
    EXPECT_EQ(error_of(endless + "[stop]\ntime = 1\n"), "");
    EXPECT_EQ(error_of(endless + "[stop]\nevents = 10\n"), "");
    EXPECT_NE(error_of(endless + "[stop]\n"), "");
}

TEST(Rest, OnlyPossibleMotionsNeedAStop) {
    const std::string cloth = "[table]\ncushion = []\n";
    // A rolling ball with nothing to hit never slides; with a second ball it may.
    const std::string rolling =
        cloth + "[balls]\nmu_s = 0\n[[ball]]\nvelocity = [0, 1]\nspin = [-34.99562554680665, 0, 0]\n";
    EXPECT_EQ(error_of(rolling), "");
    EXPECT_NE(error_of(rolling + "[[ball]]\nid = \"other\"\nposition = [2, 2]\n"), "");
    // Vertical spin needs a side offset, ball-ball friction or cushion friction.
    const std::string straight = "[balls]\nmu_sp = 0\nmu_b = 0\n[[ball]]\n[cue]\n";
    EXPECT_EQ(error_of(cloth + straight), "");
    EXPECT_NE(error_of(straight), "");
    EXPECT_EQ(error_of(straight + "[physics]\ncushion = \"smooth\"\n"), "");
    EXPECT_NE(error_of(cloth + straight + "offset = [0.1, 0]\n"), "");
    EXPECT_NE(error_of(cloth + "[balls]\nmu_sp = 0\n[[ball]]\nspin = [0, 0, 5]\n"), "");
    // A ball that only spins in place does not roll.
    EXPECT_EQ(error_of("[balls]\nmu_r = 0\n[[ball]]\nspin = [0, 0, 5]\n"), "");
}

// Any file is read, or refused with a location; reading never crashes or throws anything else.
TEST(Scenes, BrokenTextIsRefusedInTheSameForm) {
    const std::string good =
        read_file(std::filesystem::path(CAROM_SOURCE_DIR) / "scenes" / "eight_ball_break.toml");
    ASSERT_EQ(error_of(good), "");
    std::uint64_t state = 11;
    const auto random = [&state](std::size_t n) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<std::size_t>((state >> 33) % n);
    };
    const std::string alphabet = "[]{}=.,\"'#\n\t\\ -+0159eaxntf\xff\xc3\x01";
    int refused = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string text = good;
        for (std::size_t k = 0, n = 1 + random(4); k < n; ++k) {
            const std::size_t at = random(text.size());
            switch (random(3)) {
                case 0:
                    text[at] = alphabet[random(alphabet.size())];
                    break;
                case 1:
                    text.insert(at, 1, alphabet[random(alphabet.size())]);
                    break;
                default:
                    text.erase(at, 1 + random(8));
            }
        }
        const std::string message = error_of(text);
        if (message.empty()) continue;
        ++refused;
        EXPECT_EQ(message.rfind("s.toml:", 0), 0u) << message;
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
