// The columns and values of a sweep's table.
#include "carom/games/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "support/scenes.h"

namespace carom::games {
namespace {

TEST(Sweep, ColumnsHaveTheirKindsAndValues) {
    const std::vector<std::string> measures = {"travel(cue)", "pocketed"};
    const Sweep sweep(Variation::from_text(test::kSmallScene, "s.toml",
                                           {"cue.speed=list(0x2,2.5)", "stop.events=list(0b11,0o17)",
                                            "physics.cushion=list(\"none\",\"smooth\")",
                                            "cue.aim_deg=uniform(80,90)", "cue.elevation_deg=integer(0,1)"},
                                           1),
                      measures, {});
    using enum ValueKind;
    const std::vector<ValueKind> kinds = {kNumber, kWhole, kText, kNumber, kWhole};
    std::string names;
    for (const SweepColumn& column : sweep.columns()) names += column.name + " " + column.unit + ",";
    EXPECT_EQ(
        names,
        "shot ,cue.speed m/s,stop.events ,physics.cushion ,cue.aim_deg degrees,cue.elevation_deg degrees,"
        "status ,duration s,events ,first_hit ,contacts ,approach_cushions ,cue.x m,cue.y m,"
        "cue.pocket ,cue.fell ,cue.cushions ,ball.2.x m,ball.2.y m,ball.2.pocket ,ball.2.fell ,"
        "ball.2.cushions ,message ,travel(cue) ,pocketed ,");
    for (std::size_t k = 0; k < kinds.size(); ++k) EXPECT_EQ(sweep.columns()[1 + k].kind, kinds[k]) << k;
    constexpr std::size_t kShots = 3;
    ShotStatus status[kShots] = {ShotStatus::kAtRest, ShotStatus::kFailed, ShotStatus::kEvents};
    double duration[kShots] = {1.5, 0, 2}, xy[4 * kShots] = {1, -1, 2, -2, 0, 0, 0, 0, 3, -3, 4, -4};
    std::int64_t events[kShots] = {7, 0, 8};
    std::int32_t hit[kShots] = {1, -1, -1}, none[kShots] = {0, 0, 0};
    std::int32_t pocket[2 * kShots] = {0, -1, -1, -1, kOffTable, 0}, fell[2 * kShots] = {0, -1, -1, -1, 1, 0};
    const ListedValue two{"0x2", 2.0, 2}, more{"2.5", 2.5, 0}, three{"0b11", 3.0, 3}, smooth{"smooth"};
    SweptShots shots;
    shots.first = 40;
    shots.count = kShots;
    std::int32_t cushions[2 * kShots] = {5, 6, 0, 0, 7, 8};
    shots.outcomes = {status, duration, events, hit, none, none, xy, pocket, fell, cushions, nullptr};
    for (const ListedValue* speed : {&two, &more, &more})
        shots.draws.insert(shots.draws.end(), {speed, &three, &smooth, 80.5, std::int64_t{1}});
    using Texts = std::vector<std::string>;
    shots.measured = {1.25, Texts{}, 0.0, Texts{}, std::nan(""), Texts{"cue", "ball.2"}};
    shots.messages = {"", "it fell over", ""};
    const auto row = [&](std::size_t shot) {
        std::string text;
        for (const SweepColumn& column : sweep.columns()) {
            const SweepValue value = sweep.value(column, shots, shot);
            if (const auto* number = std::get_if<double>(&value)) text += text_of(DrawnValue(*number));
            if (const auto* whole = std::get_if<std::int64_t>(&value)) text += std::to_string(*whole);
            if (const auto* words = std::get_if<std::string>(&value)) text += *words;
            text += value.index() == 0 ? "-|" : "|";
        }
        return text;
    };
    EXPECT_EQ(row(0),
              "40|2|3|smooth|80.5|1|at_rest|1.5|7|ball.2|0|0|1|-1|p1|0|5|2|-2||-1|6|"
              "|1.25||");
    EXPECT_EQ(row(1), "41|2.5|3|smooth|80.5|1|failed|-|-|-|-|-|-|-|-|-|-|-|-|-|-|-|it fell over|-|-|");
    EXPECT_EQ(row(2), "42|2.5|3|smooth|80.5|1|events|2|8||0|0|3|-3|out|1|7|4|-4|p1|0|8||nan|cue;ball.2|");
}

TEST(Sweep, AMeasureThatDoesNotApplyIsNamed) {
    const std::vector<std::string> measures = {"foul"};
    const Sweep sweep(Variation::from_text(test::kSmallScene, "s.toml", {"cue.speed=uniform(1,2)"}, 1),
                      measures, &games::kEightBall);
    Batch batch(2, 2);
    try {
        sweep.play(0, 2, kernel::best_isa(), {}, batch);
        ADD_FAILURE() << "eight-ball with two balls";
    } catch (const MeasureError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("foul: ", 0), 0u) << error.what();
    }
}

}  // namespace
}  // namespace carom::games
