// Tolerances that several files share, and the limits of files:
// name, unit, reason. A constant of one file stands at its top.
#pragma once

#include <cstddef>
#include <limits>

namespace carom {

/// [-] The distance from 1 to the next double.
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// [m] Balls that overlap, or reach into a cushion, by at most this much at the start are taken to touch;
/// deeper is an error. A thousandth of the smallest gap that can be set on a real table, and far above the
/// rounding of typed coordinates.
inline constexpr double kTouchTolerance = 1e-12;

/// [ulp of |v| + R |w|] A ball whose cloth slip is at most
/// this is rolling: the rounding of computing the slip itself.
inline constexpr double kRollingUlp = 8.0;

/// [s] and [-] More events than this within one such span is an error with a dump, never a silent stop.
inline constexpr double kEventCapSpan = 1e-6;
inline constexpr int kEventCap = 10000;

/// [-] More events than the first are an error of a run whose [stop] does not say how many may come, and more
/// than the second of any run. The longest shot of a real table has some thousand; a million take 0.4 GB with
/// their segments, and a record of them is as long as any that can be read (kMaxRecordSize).
inline constexpr int kUsualEvents = 1000000;
inline constexpr int kMostEvents = 10 * kUsualEvents;

/// [m] Depth at which a pocketed ball comes to rest below the cloth; drawing only. pooltool 0.6.0's value.
inline constexpr double kPocketDepth = 0.08;

/// Below which approach a bounce is no bounce: one that would end before the contact itself has, 2 e v / a <
/// t_c(v), with the Hertz contact time t_c = 2.6 (m / k)^0.4 v^-0.2 of two phenolic balls (E = 5.84 GPa, nu =
/// 0.34: k/m = 3.094e9 m^-0.5 s^-2). Such a contact becomes a resting one instead. About 1.5e-3 m/s at a = 2
/// m/s^2.
inline constexpr double kContactTimeFactor = 2.6;
inline constexpr double kContactStiffness = 3.094e9;  ///< [m^-0.5 s^-2] k/m

/// [-] From this many balls, or parts of the table, a tree of boxes is faster than a loop through all of them
/// (lab/notes/2026-11-event_cost.md: measured crossings).
inline constexpr std::size_t kTreeFromBalls = 600;
inline constexpr std::size_t kTreeFromParts = 1000;
/// [-] and [ball radii] From this many balls on, a ball's box covers only this way and is then renewed: what
/// lies beyond is mostly never reached.
inline constexpr std::size_t kShortBoxesFromBalls = 32;
inline constexpr double kBoxTravel = 3.0;

// Limits of scene files. They keep squares and products far from overflow and underflow, and a mistyped file
// from filling the memory; nothing physical is near them.
inline constexpr double kMaxCoordinate = 1e6;  ///< [m]
inline constexpr double kMinLength = 1e-6;     ///< [m], smallest ball radius
inline constexpr double kMaxLength = 1e3;      ///< [m], largest ball radius, jaw or pocket radius, gap
inline constexpr double kMaxJitter = 0.1;      ///< [m] of the places in a rack
inline constexpr double kMinMass = 1e-9;       ///< [kg], of a ball and of a cue
inline constexpr double kMaxMass = 1e6;        ///< [kg]
inline constexpr double kMaxFriction = 1e3;    ///< [-]
inline constexpr double kMaxSpeed = 1e6;       ///< [m/s]
inline constexpr double kMaxSpin = 1e9;        ///< [rad/s]
inline constexpr double kMaxGravity = 1e3;     ///< [m/s^2]
inline constexpr double kMaxAngle = 1e6;       ///< [degrees], of the aim
inline constexpr double kMaxTime = 1e9;        ///< [s]
inline constexpr double kMaxFps = 1e5;         ///< [1/s]
inline constexpr int kMaxSubsteps = 10000000;  ///< of the march; its result stops improving long before
inline constexpr int kMaxImageSize = 16384;    ///< [px] per side, what the OpenGL back ends can hold
inline constexpr int kMaxBalls = 4096;         ///< balls of a scene, written and racked
inline constexpr int kMaxRackRows = 90;        ///< of a triangle: 4095 balls
inline constexpr int kMaxTableParts = 4096;    ///< cushions, jaws and pockets of a table, each
inline constexpr std::size_t kMaxFileSize = 4u << 20;  ///< [bytes] of a scene file
/// [-] Of a dotted key, and of brackets within each other: a scene needs four of either. toml++ goes
/// calls deeper for each; both limits at once take less than 64 KiB of stack.
inline constexpr int kMaxKeyParts = 16;
inline constexpr int kMaxNesting = 16;
/// [bytes] Of a record file: about 700 000 segments. Reading it takes 1.7 times as much memory (93 MB of a
/// profiled break: 157 MB), what was made to take more, up to four times.
inline constexpr std::size_t kMaxRecordSize = std::size_t{256} << 20;
inline constexpr std::size_t kMaxIdLength = 64;  ///< [bytes] of a ball's id
inline constexpr int kVariationTrials = 100;  ///< shots of a variation, one of which has to be a valid scene

}  // namespace carom
