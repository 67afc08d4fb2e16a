#include "commands/export/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/console.h"

namespace carom::tools {
namespace {

/// [m] Positions that differ by less are the same: the engine's rounding, far below that of floats.
constexpr double kSamePlace = 1e-9;
/// [rad] Largest turn between two rotation keys, and largest error of a constant rate between them; [-] most
/// keys of one piece of motion.
constexpr double kLargestTurn = 0.4, kLargestError = 0.005, kMostKeys = 1e5;

/// One segment, between the instants at which it applies.
struct Piece {
    double from, to;
    BallState first, last;  ///< its states at those instants
};

/// The pieces that last long enough for a float to resolve.
std::vector<Piece> pieces_of(const Record& record, int ball) {
    const std::vector<Segment>& segments = record.tracks[ball].segments;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Segment& s = segments[i];
        const double next = i + 1 < segments.size() ? segments[i + 1].start : record.duration;
        // On the floor, not a rounding error above it.
        const double floor = until_floor(s, record.size(ball).R, record.gravity);
        double end = s.start + std::min(s.duration, floor);
        if (end - s.start < floor) end = std::nextafter(end, std::numeric_limits<double>::infinity());
        const double to = std::min(next, record.duration), own_end = std::min(to, end);
        // If a segment ends by itself before the next one begins, the ball stays where it is.
        for (const auto& [a, b] : {std::pair(s.start, own_end), std::pair(own_end, to)}) {
            if (!(static_cast<float>(b) > static_cast<float>(a))) continue;
            // The end state is the one just before the end: at the end itself, the next segment or the floor
            // applies.
            double before = std::nextafter(b, a);
            while (a == s.start && before > a && before - s.start >= floor)
                before = std::nextafter(before, a);
            pieces.push_back({a, b, record.state_at(ball, a), record.state_at(ball, before)});
        }
    }
    return pieces;
}

bool moves(const Piece& piece) {
    return piece.first.velocity != Vec3::Zero() || piece.last.velocity != Vec3::Zero();
}

/// Appends a key. It replaces one of the same time, or comes one float later if the position jumps.
void append(std::vector<PositionKey>& keys, double time, const BallState& state, bool begins) {
    PositionKey key{static_cast<float>(time), {}, gltf_axes(state.position), {}};
    (begins ? key.after : key.before) = gltf_axes(state.velocity);
    if (!keys.empty() && keys.back().time >= key.time) {
        double apart = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            apart = std::max<double>(apart, std::abs(keys.back().place[k] - key.place[k]));
        if (apart <= std::max(kSamePlace, 4.0 * std::numeric_limits<float>::epsilon())) {
            keys.back().after = key.after;
            return;
        }
        key.time = std::nextafter(keys.back().time, std::numeric_limits<float>::infinity());
    }
    keys.push_back(key);
}

}  // namespace

std::vector<PositionKey> position_keys(const Record& record, int ball) {
    std::vector<PositionKey> keys;
    append(keys, 0.0, record.state_at(ball, 0.0), false);
    for (const Piece& piece : pieces_of(record, ball)) {
        append(keys, piece.from, piece.first, true);
        if (moves(piece)) append(keys, piece.to, piece.last, false);
    }
    append(keys, record.duration, record.state_at(ball, record.duration), false);
    const bool rests = std::all_of(keys.begin(), keys.end(), [&keys](const PositionKey& key) {
        return key.place == keys.front().place;
    });
    if (rests) keys.resize(1);
    return keys;
}

std::vector<PositionKey> sampled_position_keys(const Record& record, int ball, double fps) {
    std::vector<PositionKey> keys;
    append(keys, 0.0, record.state_at(ball, 0.0), false);
    for (const Piece& piece : pieces_of(record, ball)) {
        append(keys, piece.from, piece.first, true);
        if (!moves(piece)) continue;
        const double first = std::floor(piece.from * fps) + 1.0;
        for (double k = first; k / fps < piece.to; ++k) {
            throw_if_interrupted();
            if (static_cast<float>(k / fps) > keys.back().time)
                append(keys, k / fps, record.state_at(ball, k / fps), true);
        }
        append(keys, piece.to, piece.last, false);
    }
    append(keys, record.duration, record.state_at(ball, record.duration), false);
    return keys;
}

std::vector<RotationKey> rotation_keys(const Record& record, int ball) {
    std::vector<RotationKey> keys;
    const auto add = [&](double time) {
        RotationKey key{static_cast<float>(time), gltf_axes(record.orientation_at(ball, time).normalized())};
        if (!keys.empty()) {
            if (!(key.time > keys.back().time)) return;
            // q and -q are the same rotation; the nearer one gives the shorter turn.
            float same = 0.0F;
            for (std::size_t k = 0; k < 4; ++k) same += key.q[k] * keys.back().q[k];
            if (same < 0.0F)
                for (float& x : key.q) x = -x;
        }
        keys.push_back(key);
    };
    add(0.0);
    for (const Piece& piece : pieces_of(record, ball)) {
        const double fastest = std::max(piece.first.spin.norm(), piece.last.spin.norm());
        if (fastest == 0.0) continue;
        const double lasts = piece.to - piece.from;
        // If the rate changes by a per second, a constant rate between two keys h apart is off by at most a
        // h^2 / 8.
        const double change = (piece.last.spin - piece.first.spin).norm();
        const double count = std::ceil(std::max(
            {fastest * lasts / kLargestTurn, std::sqrt(change * lasts / (8.0 * kLargestError)), 1.0}));
        if (!(count <= kMostKeys))
            throw UsageError(fmt::format(
                "ball {} turns {:.3g} rad between {:.3f} and {:.4g} s, more than an animation can hold; end "
                "the shot earlier with [stop] time",
                record.tracks[ball].id, fastest * lasts, piece.from, piece.to));
        add(piece.from);
        for (double k = 1.0; k <= count; ++k) {
            throw_if_interrupted();
            add(piece.from + lasts * k / count);
        }
    }
    return keys;
}

}  // namespace carom::tools
