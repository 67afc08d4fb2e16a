#include "carom/games/break.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/as_number.h"
#include "base/draws.h"
#include "carom/engine/printable.h"
#include "carom/engine/strike.h"
#include "carom/engine/variation.h"

namespace carom::games {
namespace {

/// The rack of a game, and its rules.
struct BreakGame {
    RackGame rack;
    std::optional<int> spot_ball;
    Game game;
};
// In the order of kBreakGames.
constexpr BreakGame kGames[] = {{RackGame::kNineBall, 9, &kNineBall},
                                {RackGame::kTenBall, {}, &kTenBall},
                                {RackGame::kEightBall, {}, &kEightBall}};
static_assert(std::size(kGames) == kBreakGames.size());

const BreakGame& game_of(const std::string& name) {
    const auto found = std::find(kBreakGames.begin(), kBreakGames.end(), name);
    if (found == kBreakGames.end())
        throw std::invalid_argument(
            fmt::format("no break for {}; use {}", in_quotes(name), fmt::join(kBreakGames, ", ")));
    return kGames[found - kBreakGames.begin()];
}

/// Largest seed of a rack: integer(a,b) can draw as many.
constexpr int kSeeds = 1000000000;

Rack rack_of(const BreakGame& game, const BreakOptions& options) {
    Rack rack;
    rack.game = game.rack;
    rack.spot_ball = game.spot_ball;
    rack.radius_sd = options.radius_sd;
    const std::string& how = options.rack;
    if (how == "template" || how == "triangle") {
        rack.method = how == "template" ? RackMethod::kTemplate : RackMethod::kTriangle;
        return rack;
    }
    rack.gap = how.starts_with("gap=") ? as_number<double>(how.substr(4)).value_or(-1.0) : -1.0;
    rack.jitter = 0.5 * rack.gap;
    if (rack.gap >= 0.0 && rack.gap <= kLargestGap) return rack;
    throw std::invalid_argument(fmt::format(
        "unknown rack {}; use template, triangle or gap=METRES with 0 to {}", in_quotes(how), kLargestGap));
}

/// The table with the cue ball and a break cue.
Scene without_rack(const BreakOptions& options) {
    Scene scene;
    scene.file = "break of " + options.game;
    scene.table = make_table(options.table);
    use_balls(scene, balls_for(options.table));
    BallStart& ball = scene.ball.emplace_back();
    ball.own = scene.cue_ball;
    ball.position = {0.3, 0.3, scene.size_of(ball).R};
    Cue& cue = scene.cue.emplace();
    use_cue(cue, "break");
    cue.side = cue.height = 0.0;
    cue.speed = 5.0;
    return scene;
}

}  // namespace

Racks racks_of(const std::string& text, const std::string& name, int count, std::uint64_t seed) {
    if (count == 1) return {};
    try {
        const Variation each =
            Variation::from_text(text, name, {fmt::format("rack.seed=integer(1,{})", kSeeds)}, seed);
        return [each, count](std::uint64_t i) {
            auto shot = each.shot(count > 0 ? i % static_cast<std::uint64_t>(count) : i);
            if (!shot.scene) throw std::invalid_argument(shot.error);
            return std::move(*shot.scene);
        };
    } catch (const VariationError&) {
        // There is no rack: the balls lie where they are.
        return {};
    }
}

BreakSearch break_search(const BreakOptions& options) {
    const BreakGame& game = game_of(options.game);
    if (!(options.speed_max >= 1.0 && options.speed_max <= 20.0))
        throw std::invalid_argument("the maximum speed of a break must be 1 to 20 m/s");
    Rack rack = rack_of(game, options);
    const Scene bare = without_rack(options);
    BreakSearch search;
    search.scene = bare;
    search.want = "any_pocketed and legal_break";
    search.game = game.game;
    add_rack(search.scene, rack);
    validate(search.scene);
    search.racks = [bare, rack, seed = options.seed](std::uint64_t i) {
        Rack drawn = rack;
        drawn.seed = 1 + static_cast<std::uint64_t>(draws_of(seed, i, "rack.seed").below(kSeeds));
        Scene scene = bare;
        add_rack(scene, drawn);
        return scene;
    };
    const Table& table = bare.table;
    const double side = options.box ? 0.25 * table.width : bare.balls.R;
    search.ball_speed = ball_speed_gain(*bare.cue, bare.size_of(bare.ball[0]));
    const double fastest = options.speed_max / search.ball_speed;
    search.choices = {
        {"ball.cue.position.x", table.corner.x() + side + 1e-4, table.corner.x() + table.width - side - 1e-4},
        {"ball.cue.position.y", table.corner.y() + 0.1 * table.length,
         table.corner.y() + 0.25 * table.length - 1e-4},
        {std::string("hit.") + kBreakApex, -0.9, 0.9},
        {"cue.speed", 0.3 * fastest, fastest},
        {"cue.offset.height", -0.35, 0.35}};
    return search;
}

}  // namespace carom::games
