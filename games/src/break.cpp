#include "carom/games/break.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/engine/variation.h"

namespace carom::games {
namespace {

/// What a good break of a game does, and more keys of [rack].
struct BreakGame {
    const char* rack;
    const char* want;
    std::optional<Game> game;
};
// In the order of kBreakGames.
constexpr BreakGame kGames[] = {
    {"spot_ball = 9\n", "any_pocketed and legal_break", Game::kNineBall},
    {"", "any_pocketed and not scratch", std::nullopt},
    {"", "any_pocketed and legal_break", Game::kEightBall},
};
static_assert(std::size(kGames) == kBreakGames.size());

const BreakGame& game_of(const std::string& name) {
    const auto found = std::find(kBreakGames.begin(), kBreakGames.end(), name);
    if (found == kBreakGames.end())
        throw std::invalid_argument(
            fmt::format("no break of {}; use {}", in_quotes(name), fmt::join(kBreakGames, ", ")));
    return kGames[found - kBreakGames.begin()];
}

/// The keys of [rack] for options.rack.
std::string method_of(const std::string& rack) {
    if (rack == "template" || rack == "triangle") return fmt::format("method = \"{}\"\n", rack);
    double gap = -1.0;
    const char* const end = rack.data() + rack.size();
    if (rack.starts_with("gap=") && std::from_chars(rack.data() + 4, end, gap).ptr == end && gap >= 0.0 &&
        gap <= kLargestGap)
        return fmt::format("gap = {}\njitter = {}\n", gap, 0.5 * gap);
    throw std::invalid_argument(
        fmt::format("the rack {} is not known; use template, triangle or gap=METRES with 0 to {}",
                    in_quotes(rack), kLargestGap));
}

}  // namespace

std::vector<Scene> racks_of(const std::string& text, const std::string& name, int count, std::uint64_t seed) {
    std::vector<Scene> racks;
    try {
        const Variation each = Variation::from_text(text, name, {"rack.seed=integer(1,1000000000)"}, seed);
        for (int i = 0; count > 1 && i < count; ++i)
            if (auto shot = each.shot(static_cast<std::uint64_t>(i)); shot.scene)
                racks.push_back(std::move(*shot.scene));
    } catch (const VariationError&) {
        // There is no rack: the balls lie where they are.
    }
    return racks;
}

BreakSearch break_search(const BreakOptions& options) {
    const BreakGame& game = game_of(options.game);
    if (!(options.speed_max >= 1.0 && options.speed_max <= 20.0))
        throw std::invalid_argument("the largest speed of a break must be 1 to 20 m/s");
    const std::string text = fmt::format(
        "[table]\npreset = \"{}\"\n[balls]\nradius_sd = {}\n[rack]\ngame = \"{}\"\n{}{}"
        "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n[cue]\npreset = \"break\"\nball_speed = {}\noffset = "
        "[0, "
        "0]\n",
        options.table, options.radius_sd, options.game, game.rack, method_of(options.rack),
        options.speed_max);
    const std::string name = "break of " + options.game;
    BreakSearch search;
    search.scene = parse_scene(text, name);
    search.want = game.want;
    search.game = game.game;
    search.layouts = racks_of(text, name, options.layouts, options.seed);
    const Table& table = search.scene.table;
    const double side = options.box ? 0.25 * table.width : search.scene.balls.R;
    // The cue that gives the ball its largest speed.
    const double fastest = search.scene.cue->speed;
    search.ball_speed = options.speed_max / fastest;
    search.scene.cue->speed = 5.0;
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
