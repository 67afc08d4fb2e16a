#include "player/description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/games/spots.h"
#include "facts.h"

namespace carom::games::detail {
namespace {

/// [s] Just before or after a contact.
constexpr double kAtOnce = 1e-6;

/// Whether a ball that moves at a time goes straight to a place, or nearly so.
bool is_direct(const Record& record, int ball, double from, const Vec2& to) {
    // [-] Cosine of 8 degrees: a ball along a rail may touch it.
    constexpr double kStraight = 0.99;
    const BallState start = record.state_at(ball, from);
    const Vec2 way = to - planar(start.position), went = planar(start.velocity);
    return dot(way, went) > kStraight * length(way) * length(went);
}

}  // namespace

ShotKind kind_of(const Record& record, const Shot& shot, const Shot::Fallen& fallen) {
    for (const BallContact& touch : shot.touches)
        if (touch.cushion() && touch.ball == shot.struck && touch.time < shot.first_time &&
            !is_direct(record, shot.struck, 0.0,
                       planar(record.state_at(shot.struck, shot.first_time).position)))
            return ShotKind::kKick;
    if (shot.first_hits.empty() || shot.first_hits[0] != fallen.ball) return ShotKind::kCombination;
    const bool direct = is_direct(record, fallen.ball, shot.first_time + kAtOnce,
                                  record.table.pockets[static_cast<std::size_t>(fallen.pocket)].center);
    return !direct && is_bank(record, shot, fallen) ? ShotKind::kBank : ShotKind::kPot;
}

std::string spin_words(const Record& record, const Shot& shot) {
    // [-] Of the spin of a rolling ball.
    constexpr double kRolls = 0.5, kDraws = -0.1;
    if (shot.first_hits.empty()) return "";
    const BallState at = record.state_at(shot.struck, std::max(0.0, shot.first_time - kAtOnce));
    const Vec2 way = planar(at.velocity);
    const double share =
        cross(planar(at.spin), way) * -record.size(shot.struck).R / std::max(dot(way, way), 1e-12);
    return share > kRolls ? "follow" : share < kDraws ? "draw" : "stun";
}

std::vector<Hit> chain_of(const Record& record, int ball, double until) {
    // [-] Of the table's width: the rail beside a jaw is a part of the pocket.
    constexpr double kMouth = 0.15;
    const auto in_mouth = [&](const Hit& hit) {
        const Vec2 place = planar(record.state_at(hit.a, hit.time).position);
        const auto& pockets = record.table.pockets;
        return std::any_of(pockets.begin(), pockets.end(), [&](const Pocket& pocket) {
            return length(place - pocket.center) < kMouth * record.table.width;
        });
    };
    std::vector<Hit> hits, chain;
    for (const Event& event : record.events)
        each_hit(event, record.hits(event), [&](const Hit& hit) {
            if (hit.time < until) hits.push_back(hit);
        });
    for (auto hit = hits.rbegin(); hit != hits.rend(); ++hit) {
        if (hit->partner == Partner::kBall && (hit->a == ball || hit->b == ball)) {
            Hit drives = *hit;
            const bool rested =
                planar(record.state_at(ball, std::max(0.0, hit->time - kAtOnce)).velocity) == Vec2::Zero();
            if ((hit->b == ball) != rested) std::swap(drives.a, drives.b);
            chain.push_back(drives);
            if (rested) ball = drives.a;
        } else if (hit->partner == Partner::kCushion && hit->a == ball && !in_mouth(*hit)) {
            chain.push_back(*hit);
        }
    }
    std::reverse(chain.begin(), chain.end());
    return chain;
}

std::string chain_words(const Record& record, const Shot& shot, int ball) {
    if (ball < 0 &&
        is_direct(record, shot.struck, 0.0, planar(record.state_at(shot.struck, shot.first_time).position)))
        return "";
    std::vector<std::string> words;
    for (const Hit& hit :
         ball < 0 ? chain_of(record, shot.struck, shot.first_time) : chain_of(record, ball)) {
        if (hit.partner == Partner::kBall) {
            if (hit.b != ball) words.push_back(record.tracks[static_cast<std::size_t>(hit.b)].id);
            continue;
        }
        const Cushion& cushion = record.table.cushions[static_cast<std::size_t>(hit.b)];
        const std::string name = cushion.name.empty() ? cushion.id : cushion.name;
        const Vec2 place = planar(record.state_at(hit.a, hit.time).position);
        words.push_back(fmt::format("{} at diamond {:.1f}", name.substr(0, name.find(',')),
                                    cushion_point(record.table, hit.partner, hit.b, place).diamond));
    }
    return words.empty() ? "" : fmt::format("off the {}", fmt::join(words, ", the "));
}

std::string place_words(const Table& table, const Vec2& place) {
    // [-] Of the table's width.
    constexpr double kNear = 0.2;
    std::vector<std::pair<double, std::string>> marks;
    const auto add = [&](const Vec2& at, const std::string& name) {
        marks.emplace_back(length(place - at), name);
    };
    for (const Pocket& pocket : table.pockets) add(pocket.center, pocket.id);
    add(head_spot(table), "the head spot");
    add(center_spot(table), "the centre spot");
    add(foot_spot(table), "the foot spot");
    std::partial_sort(marks.begin(), marks.begin() + 2, marks.end());
    if (marks[0].first < kNear * table.width) return "near " + marks[0].second;
    return "between " + marks[0].second + " and " + marks[1].second;
}

}  // namespace carom::games::detail
