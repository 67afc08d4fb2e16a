// The one place for a numeric tolerance of the engine: name, unit, reason.
#pragma once

namespace carom {

/// [m] Balls that overlap, or reach into a cushion, by at most this much at the start are taken to touch; deeper is an error.
/// A thousandth of the smallest gap that can be set on a real table, and far above the rounding of typed coordinates.
inline constexpr double kTouchTolerance = 1e-12;

/// [ulp of |v| + R |w|] A ball whose cloth slip is at most this is rolling: the rounding of computing the slip itself.
inline constexpr double kRollingUlp = 8.0;

/// [s] and [-] More events than this within one such span is an error with a dump, never a silent stop.
inline constexpr double kEventCapSpan = 1e-6;
inline constexpr int kEventCap = 10000;

/// [m] Depth at which a pocketed ball comes to rest below the cloth; drawing only. pooltool 0.6.0's value.
inline constexpr double kPocketDepth = 0.08;

/// [share of the jaw radius] A cushion end this close to a jaw's circle is rounded off by it and needs no tip of its own. The
/// jaw is a full circle, so nothing can slip between the two.
inline constexpr double kJawJoinShare = 1e-9;

}  // namespace carom
