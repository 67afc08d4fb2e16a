// Tolerances that several files share, and the limits of files, each with unit and reason. A constant used in
// one file only is at the top of that file.
#pragma once

#include <cstddef>
#include <limits>

namespace carom {

/// [-] Distance from 1 to the next double.
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// [m] Balls that overlap each other or a cushion by at most this at the start count as touching; a deeper
/// overlap is an error. A thousandth of the smallest gap that can be set on a real table, and far above the
/// rounding of typed coordinates.
inline constexpr double kTouchTolerance = 1e-12;

/// [ulp of |v| + R |w|] A ball rolls if its cloth slip is at most this: the rounding error of the slip.
inline constexpr double kRollingUlp = 8.0;

/// [ulp of the speeds of centres and surfaces] Lower closing speeds are rounding errors of the projection,
/// not an approach.
inline constexpr double kClosingUlp = 8.0;

/// [s] and [-] More events than this within one such span are an error with a dump, never a silent stop.
inline constexpr double kEventCapSpan = 1e-6;
inline constexpr int kEventCap = 10000;

/// [-] Limits on the number of events: the first unless [stop] sets one, the second always. The longest shots
/// on a real table have a few thousand. A million events need 0.4 GB with their segments, and their record
/// has the largest readable size (kMaxRecordSize).
inline constexpr int kUsualEvents = 1000000;
inline constexpr int kMostEvents = 10 * kUsualEvents;

/// [m] Depth below the cloth at which a pocketed ball comes to rest; for drawing only. The value of pooltool
/// 0.6.0.
inline constexpr double kPocketDepth = 0.08;

/// physics.tolerance unless the scene has one.
inline constexpr double kDefaultTolerance = 1e-6;

/// A contact becomes a resting one at approach speeds whose bounce would be shorter than the contact itself:
/// 2 e v / a < t_c(v), with the Hertz contact time t_c = 2.6 (m / k)^0.4 v^-0.2 of two pool balls: about
/// 1.4e-3 m/s at a = 2 m/s^2. k is from 2270 N at a compression of 0.1995 mm, in a contact of 284 us at
/// 2.06 m/s (Alciatore, TP B.29): E = 8.94 GPa with nu = 0.34.
inline constexpr double kContactTimeFactor = 2.6;
inline constexpr double kContactStiffness = 4.736e9;  ///< [m^-0.5 s^-2] k/m

/// [-] From this many balls or parts of the table, a tree of boxes is faster than a loop over all of them
/// (measured: lab/notes/2026-11-event_cost.md).
inline constexpr std::size_t kTreeFromBalls = 600;
inline constexpr std::size_t kTreeFromParts = 1000;
/// [-] and [ball radii] From this many balls, a ball's box covers only this distance before it is renewed,
/// because most balls never get farther.
inline constexpr std::size_t kShortBoxesFromBalls = 32;
inline constexpr double kBoxTravel = 3.0;

// Limits of scene files. They keep squares and products far from overflow and underflow, and prevent a typing
// error from filling the memory. All are far outside the physical range.
inline constexpr double kMaxCoordinate = 1e6;  ///< [m]
inline constexpr double kMinLength = 1e-6;     ///< [m], smallest ball radius
inline constexpr double kMaxLength = 1e3;      ///< [m], largest ball radius, jaw or pocket radius, gap
inline constexpr double kMaxJitter = 0.1;      ///< [m] of the positions in a rack
inline constexpr double kMaxRadiusSd = 1e-4;   ///< [m] of racked balls
inline constexpr double kMinMass = 1e-9;       ///< [kg], of a ball and of a cue
inline constexpr double kMaxMass = 1e6;        ///< [kg]
inline constexpr double kMaxFriction = 1e3;    ///< [-]
inline constexpr double kMaxSpeed = 1e6;       ///< [m/s]
inline constexpr double kMaxSpin = 1e9;        ///< [rad/s]
inline constexpr double kMaxGravity = 1e3;     ///< [m/s^2]
inline constexpr double kMaxAngle = 1e6;       ///< [degrees], of the aim
inline constexpr double kMaxTime = 1e9;        ///< [s]
inline constexpr double kMaxFps = 1e5;         ///< [1/s]
inline constexpr int kMaxSubsteps = 10000000;  ///< the result stops improving long before
inline constexpr int kMaxImageSize = 16384;    ///< [px] per side, the limit of the OpenGL back ends
inline constexpr int kMaxBalls = 4096;         ///< balls of a scene, written and racked
inline constexpr int kMaxRackRows = 90;        ///< of a triangle: 4095 balls
inline constexpr int kMaxPressedBalls = 55;    ///< of unlike size in a rack: ten rows
inline constexpr int kMaxTableParts = 4096;    ///< cushions, jaws and pockets of a table, each
inline constexpr std::size_t kMaxFileSize = 4u << 20;  ///< [bytes] of a scene file
/// [-] Parts of a dotted key, and depth of nested brackets: a scene needs four of each. toml++ recurses for
/// each; both limits together need less than 64 KiB of stack.
inline constexpr int kMaxKeyParts = 16;
inline constexpr int kMaxNesting = 16;
/// [bytes] Size of a record file: about 700 000 segments. Reading needs 1.7 times the memory (157 MB for the
/// 93 MB of a profiled break), and up to four times for a hostile file.
inline constexpr std::size_t kMaxRecordSize = std::size_t{256} << 20;
inline constexpr std::size_t kMaxIdLength = 64;  ///< [bytes] of a ball's id
/// At least one of the first shots of a variation, this many, must be a valid scene.
inline constexpr int kVariationTrials = 100;

}  // namespace carom
