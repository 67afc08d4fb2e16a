// Suggestions for mistyped names.
#include "base/nearest.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/scene.h"

namespace {

using carom::did_you_mean;

const std::vector<std::string_view> kCueKeys = {"ball",          "speed",  "aim_deg",
                                                "elevation_deg", "offset", "mass"};

TEST(DidYouMean, SuggestsNearNames) {
    const struct {
        const char *word, *says;
    } kCases[] = {
        {"sped", "; did you mean speed?"},       // a letter is missing
        {"speeed", "; did you mean speed?"},     // one too many
        {"spead", "; did you mean speed?"},      // a different one
        {"psede", "; did you mean speed?"},      // two swapped pairs
        {"blal", "; did you mean ball?"},        // with four letters only one may be wrong: a swap is one
        {"Speed", "; did you mean speed?"},      // keys are lower case
        {"aim", "; did you mean aim_deg?"},      // the unit is missing
        {"speed_mps", "; did you mean speed?"},  // or one too many
        {"elev", "; did you mean elevation_deg?"},
    };
    for (const auto& c : kCases) EXPECT_EQ(did_you_mean(c.word, kCueKeys), c.says) << c.word;
}

TEST(DidYouMean, SpellsNumbersOut) {
    const std::vector<std::string_view> games = {"eight_ball", "nine_ball", "ten_ball", "three_cushion"};
    EXPECT_EQ(did_you_mean("8ball", games), "; did you mean eight_ball?");
    EXPECT_EQ(did_you_mean("9-Ball", games), "; did you mean nine_ball?");
    EXPECT_EQ(did_you_mean("10 ball", games), "; did you mean ten_ball?");
    EXPECT_EQ(did_you_mean("3cushion", games), "; did you mean three_cushion?");
}

TEST(DidYouMean, SuggestsNothingForDistantWords) {
    // "bats" shares two of four letters with ball, "a" begins no key, and "mass" exists: the word is wrong
    // for another reason.
    for (const char* word : {"", "a", "wind", "bats", "colour", "mass", "sxxxd"})
        EXPECT_EQ(did_you_mean(word, kCueKeys), "") << word;
    EXPECT_EQ(did_you_mean(std::string(1 << 20, 's'), kCueKeys), "");
    EXPECT_EQ(did_you_mean("speed", {}), "");
}

TEST(DidYouMean, SuggestsAllEquallyNearNames) {
    EXPECT_EQ(did_you_mean("mu_x", {"mu_s", "mu_r", "mass", "mu_b"}), "; did you mean mu_s, mu_r or mu_b?");
    EXPECT_EQ(did_you_mean("mu_bb", {"mu_s", "mu_b"}), "; did you mean mu_b?");
}

TEST(DidYouMean, WorksOnPresets) {
    const auto says = [](auto&& ask) -> std::string {
        try {
            ask();
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(says([] { carom::make_table("nine_fot"); }),
              "unknown table preset \"nine_fot\"; did you mean nine_foot?");
    EXPECT_EQ(says([] { carom::make_ball_params("snoker"); }),
              "unknown ball preset \"snoker\"; did you mean snooker?");
    EXPECT_EQ(says([] { carom::make_table("xyz"); }), "unknown table preset \"xyz\"");
}

}  // namespace
