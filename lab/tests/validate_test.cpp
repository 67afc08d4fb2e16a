// Validation cases: their files, quantities read from a record, and every number's claim, including misses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "carom/engine/simulate.h"
#include "support/pages.h"
#include "validate/case.h"
#include "validate/measure.h"
#include "validate/report.h"
#include "validate/run.h"

namespace carom::tools {
namespace {

std::vector<std::string> all_files() {
    std::vector<std::string> names;
    for (const CaseFile& file : case_files()) names.emplace_back(file.name);
    return names;
}

CaseFile file_of(const std::string& name) {
    for (const CaseFile& file : case_files())
        if (file.name == name) return file;
    throw std::runtime_error(name);
}

/// All data of a row, to update its case if a claim no longer holds.
std::string told(const ValidationRow& row) {
    return fmt::format("{}: {}, {} under {}: computed {:.4g}, measured {:.4g} +- {:.2g}, claimed {}",
                       row.of->file, row.shot->name, info(row.measured->quantity).name, row.variant->name,
                       row.computed, row.measured->value, row.uncertainty,
                       row.claim ? fmt::format("{:.4g}", *row.claim) : "within");
}

class Validation : public testing::TestWithParam<std::string> {};

// If a model improves or worsens, its case must state it: a claim is neither a wish nor out of date.
TEST_P(Validation, MatchesItsClaims) {
    const ValidationCase of = read_case(file_of(GetParam()));
    long runs = 0;
    const std::vector<ValidationRow> rows =
        run_case(of, kernel::Isa::kScalar, [&](long done) { runs = done; });
    EXPECT_EQ(runs, runs_of(of));
    std::size_t numbers = 0;
    for (const ValidationShot& shot : of.shots) numbers += shot.measured.size();
    EXPECT_EQ(rows.size(), numbers * of.variants.size());
    for (const ValidationRow& row : rows) EXPECT_TRUE(row.as_claimed()) << told(row);
}

INSTANTIATE_TEST_SUITE_P(Cases, Validation, testing::ValuesIn(all_files()),
                         [](const auto& param) { return param.param.substr(0, param.param.find('.')); });

TEST(ValidationCases, MatchTheFolderInOrder) {
    std::vector<std::string> ids;
    for (const CaseFile& file : case_files()) {
        EXPECT_EQ(file.text, test::read_source("lab/data/validation/" + std::string(file.name)));
        ids.push_back(read_case(file).id);
    }
    std::vector<std::string> expected;
    for (int i = 1; i <= 20; ++i) expected.push_back(fmt::format("V{}", i));
    expected.emplace_back("B1");
    EXPECT_EQ(ids, expected);
}

// Every case has both the game's preset and the coefficients from before the measured ones.
TEST(ValidationCases, HaveTheGamesPresetAndTheClassicOne) {
    for (const ValidationCase& of : chosen_cases("")) {
        std::set<std::string> plain;
        for (const Variant& variant : of.variants)
            if (variant.own_keys().empty()) plain.insert(variant.preset);
        ASSERT_EQ(plain.size(), 2u) << of.file;
        EXPECT_EQ(*plain.rbegin(), *plain.begin() + "_classic") << of.file;
    }
}

// A number told in words is not measured; a number of a case is measured only if the case is.
TEST(ValidationCases, SayHowEachNumberCameAbout) {
    int words = 0;
    for (const ValidationCase& of : chosen_cases(""))
        for (const ValidationShot& shot : of.shots)
            for (const Measured& m : shot.measured) {
                words += m.kind == "words" ? 1 : 0;
                if (m.kind == "measured") EXPECT_EQ(of.trust, "measured") << of.file;
            }
    EXPECT_EQ(words, 5);
}

TEST(ValidationCases, SayWhatDiffersFromTheShippedPreset) {
    const auto differs = [](const char* id) {
        const std::vector<ValidationCase> cases = chosen_cases(id);
        return run_case(cases[0], kernel::Isa::kScalar, [](long) {}).at(0).differs;
    };
    EXPECT_EQ(differs("V1"), "mass = 0.1406, mu_s = 0.21, mu_r = 1e-06");
    EXPECT_EQ(differs("V20"), "");
}

TEST(ValidationCases, AnUnknownOneIsRefusedWithTheKnownNames) {
    EXPECT_EQ(chosen_cases("V17").at(0).id, "V17");
    try {
        chosen_cases("V99");
        ADD_FAILURE();
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("there is no case V99; the cases are V1, V2, V3, "),
                  std::string::npos)
            << error.what();
    }
}

/// A case with one text replaced by another.
std::string edited(const std::string& from, const std::string& to) {
    std::string text = R"(id = "X"
title = "t"
source = "s"
trust = "measured"
about = "cloth"
scene = "[[ball]]"
[[shot]]
name = "a"
measured = [{ quantity = "speed", when = "start", value = 1.0, uncertainty = 0.1 }]
[[variant]]
preset = "pool"
free_of_fit = true
claims = ["within"]
)";
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(ValidationCases, AWrongFileIsAnErrorAtItsPlace) {
    const struct {
        const char *from, *to, *message;
    } kCases[] = {
        {"id = \"X\"", "id = 1", "x.toml:1:6: id has a value of another kind"},
        {"id = \"X\"", "", "title"},
        {"title", "titel", "x.toml:2:9: unknown key titel; the keys here are id, title, "},
        {"measured\"\n", "heard\"\n", "heard is none of measured, published, second hand, forum"},
        {"\"speed\"", "\"heat\"", "heat is none of speed, speed_ratio, "},
        {"\"start\"", "\"noon\"", "noon is none of start, hit, "},
        {"0.1 }", "0.1, kind = \"heard\" }", "heard is none of measured, published, words"},
        {"0.1 }", "0 }", "uncertainty has to be greater than 0"},
        {"value = 1.0, ", "", "value is missing"},
        {"value = 1.0", "value = 9007199254740993", "value = 9007199254740993 has more digits than a number"},
        {"[\"within\"]", "[\"good\"]", "x.toml:13:11: a claim is \"within\" or the value that is computed"},
        {"[\"within\"]", "[1.0, 2.0]", "2 claims for 1 numbers"},
        {"[\"within\"]", "[]", "claims has to be a list that is not empty"},
        {"quantity = \"speed\", when = \"start\"", "quantity = \"share\"", "of is missing"},
        {"quantity = \"speed\", when = \"start\"", "quantity = \"mean\", of = \"scratch\"",
         "a share or a mean needs [sweep]"},
        {"quantity = \"speed\"", "quantity = \"place\", place = [1.0]", "place is [x, y]"},
        {"title = ", "title ", "x.toml:2:"},
    };
    EXPECT_EQ(read_case({"x.toml", edited("title = \"t\"", "title = \"u\"")}).title, "u");
    for (const auto& c : kCases) {
        const std::string text = edited(c.from, c.to);
        try {
            read_case({"x.toml", text});
            // Only the id is missing.
            ADD_FAILURE() << c.message;
        } catch (const SceneError& error) {
            if (std::string(c.message) == "title")
                EXPECT_NE(std::string(error.what()).find("id is missing"), std::string::npos) << error.what();
            else
                EXPECT_NE(std::string(error.what()).find(c.message), std::string::npos) << error.what();
        }
    }
}

TEST(ValidationCases, ATemplateNeedsAValueForEveryName) {
    const ValidationCase of = read_case({"x.toml", edited("[[ball]]", "{preset} {v}")});
    ValidationShot shot = of.shots.front();
    EXPECT_THROW(filled_in(of, shot, of.variants.front(), of.scene), SceneError);
    shot.values.emplace_back("v", "2.5");
    EXPECT_EQ(filled_in(of, shot, of.variants.front(), of.scene), "pool 2.5");
}

// Every quantity at every instant, on a shot with known numbers: a ball slides, rolls, hits a smooth cushion,
// slides and rolls.
TEST(ValidationMeasure, ReadsEveryQuantity) {
    const Record record = simulate(make_plan(
        parse_scene(
            "[table]\n[[table.cushion]]\nfrom = [0, -9]\nto = [0, 9]\n[balls]\nmu_s = 0.2\nmu_r = 0.01\n"
            "e_c = 0.5\n[physics]\ncushion = \"smooth\"\ngravity = 10\n"
            "[[ball]]\nposition = [2.028575, 0]\nvelocity = [-1.4, 0]\n",
            "m.toml"),
        kernel::Isa::kScalar));
    const auto at = [&record](Quantity quantity, Instant when, double after = 0.0) {
        Measured m;
        m.quantity = quantity;
        m.when = when;
        m.after = after;
        m.place = {2.028575, 1.0};
        return measure(record, m);
    };
    // Slides for 2 v/(7 mu_s g) = 0.2 s over 12 v^2/(49 mu_s g) = 0.24 m, rolls at 1 m/s and loses 2 mu_r g x
    // before the cushion; after it, half of the speed and the earlier spin.
    const double in = std::sqrt(1.0 - 0.2 * 1.76), out = 0.5 * in, rolls = out - 2.0 / 7.0 * (out + in);
    EXPECT_NEAR(at(Quantity::kSpeed, Instant::kStart), 1.4, 1e-12);
    EXPECT_NEAR(at(Quantity::kVelocityX, Instant::kStart, 0.1), -1.2, 1e-12);
    EXPECT_NEAR(at(Quantity::kDeceleration, Instant::kStart), 2.0, 1e-12);
    EXPECT_NEAR(at(Quantity::kDeceleration, Instant::kStart, 0.3), 0.1, 1e-12);
    EXPECT_NEAR(at(Quantity::kWay, Instant::kStart, 0.2), 0.24, 1e-12);
    EXPECT_NEAR(at(Quantity::kPlace, Instant::kStart), 1.0, 1e-12);
    EXPECT_NEAR(at(Quantity::kDirection, Instant::kStart), 180.0, 1e-12);
    EXPECT_NEAR(at(Quantity::kSpeed, Instant::kCushion), out, 1e-12);
    EXPECT_NEAR(at(Quantity::kSpeedRatio, Instant::kCushion), 0.5, 1e-12);
    EXPECT_NEAR(at(Quantity::kDirection, Instant::kCushion), 0.0, 1e-9);
    EXPECT_NEAR(at(Quantity::kTime, Instant::kCushion), 0.2 + (1.0 - in) / 0.1, 1e-9);
    EXPECT_NEAR(at(Quantity::kVelocityX, Instant::kRolled), rolls, 1e-9);
    EXPECT_NEAR(at(Quantity::kVelocityY, Instant::kRolled), 0.0, 1e-12);
    EXPECT_EQ(at(Quantity::kSpeed, Instant::kRest), 0.0);
    EXPECT_EQ(at(Quantity::kTime, Instant::kRest), record.duration);
    EXPECT_THROW(at(Quantity::kSpeed, Instant::kHit), std::runtime_error);  // there is no other ball
}

// The ball starts at 1 to 20 m/s, so that everything has a closed form.
TEST(ValidationMeasure, SharesAndMeansCoverTheCountedShots) {
    const std::string text = R"toml(id = "X"
title = "t"
source = "s"
trust = "measured"
about = "cue"
scene = """
[table]
cushion = []
[[ball]]
[cue]
ball_speed = 1.0
"""
[sweep]
count = 20
seed = 1
vary = ["cue.ball_speed=grid(1,20,20)"]
[[shot]]
name = "a"
[[shot.measured]]
quantity = "share"
of = "max_speed(cue) > 15.5"
value = 0.2
uncertainty = 0.1
[[shot.measured]]
quantity = "mean"
of = "max_speed(cue)"
value = 10.0
uncertainty = 1.0
[[shot.measured]]
quantity = "mean"
name = "fast ones"
of = "max_speed(cue)"
among = "max_speed(cue) > 10.5"
value = 15.0
uncertainty = 1.0
[[variant]]
preset = "pool"
free_of_fit = true
claims = [0.25, 10.5, 15.5]
)toml";
    const ValidationCase of = read_case({"x.toml", text});
    const std::vector<ValidationRow> rows = run_case(of, kernel::Isa::kScalar, [](long) {});
    const double computed[] = {0.25, 10.5, 15.5},
                 sampled[] = {std::sqrt(0.25 * 0.75 / 20.0), std::sqrt(399.0 / 12.0 / 20.0),
                              std::sqrt(99.0 / 12.0 / 10.0)};
    ASSERT_EQ(rows.size(), 3u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_NEAR(rows[i].computed, computed[i], 1e-12);
        EXPECT_NEAR(rows[i].sampled, sampled[i], 1e-12);
        EXPECT_NEAR(rows[i].uncertainty, std::hypot(rows[i].measured->uncertainty, 1.96 * sampled[i]), 1e-12);
        EXPECT_TRUE(rows[i].as_claimed());
    }
    EXPECT_NE(validation_text(rows).find("  fast ones "), std::string::npos) << validation_text(rows);
}

/// One row with a number of 10 +- 2.
class ValidationClaims : public testing::Test {
  protected:
    ValidationClaims() {
        measured_.value = 10.0;
        measured_.uncertainty = 2.0;
    }
    bool holds(Claim claim, double computed) {
        const ValidationRow row{&case_, nullptr, nullptr, &measured_, "", "", claim, computed, sampled_, 2.0};
        return row.as_claimed();
    }

    ValidationCase case_;
    Measured measured_;
    double sampled_ = 0.0;
};

TEST_F(ValidationClaims, WithinMeansWithinTheUncertainty) {
    EXPECT_TRUE(holds({}, 8.1));
    EXPECT_TRUE(holds({}, 11.9));
    EXPECT_FALSE(holds({}, 12.1));
}

TEST_F(ValidationClaims, AClaimedMissMustMissByItsClaim) {
    EXPECT_TRUE(holds(13.0, 13.4));
    EXPECT_FALSE(holds(13.0, 13.6));  // worse than claimed
    EXPECT_FALSE(holds(13.0, 12.4));  // better
    EXPECT_FALSE(holds(12.1, 11.9));  // near the claim, but not a miss
}

TEST_F(ValidationClaims, ManyShotsHaveTheirSpread) {
    case_.sweep = CaseSweep{100, 1, {}};
    sampled_ = 0.05;
    EXPECT_TRUE(holds(0.5, 0.64));
    EXPECT_FALSE(holds(0.5, 0.68));
    sampled_ = 0.0;
    EXPECT_TRUE(holds(1.0, 0.995));
    EXPECT_FALSE(holds(1.0, 0.97));
}

TEST_F(ValidationClaims, TheReportListsFailedClaims) {
    std::vector<ValidationCase> cases = chosen_cases("V20");
    std::vector<ValidationRow> rows = run_case(cases[0], kernel::Isa::kScalar, [](long) {});
    EXPECT_NE(validation_text(rows).find("all as claimed\n"), std::string::npos);
    rows[0].claim = 3.75;
    const std::string text = validation_text(rows);
    EXPECT_NE(text.find("NOT AS CLAIMED (1.2 deg high)\n"), std::string::npos) << text;
    EXPECT_NE(text.find("; 1 not as claimed\n"), std::string::npos) << text;
    EXPECT_NE(text.find("presets as they ship: fitted 3 of 3 within, rms 0."), std::string::npos) << text;
    EXPECT_EQ(text.find("free"), std::string::npos) << text;
}

}  // namespace
}  // namespace carom::tools
