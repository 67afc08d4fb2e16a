// The one place for a numeric tolerance or limit of the engine: name, unit, reason.
#pragma once

#include <cstddef>

namespace carom {

/// [m] Balls that overlap, or reach into a cushion, by at most this much at the start are taken to touch;
/// deeper is an error. A thousandth of the smallest gap that can be set on a real table, and far above the
/// rounding of typed coordinates.
inline constexpr double kTouchTolerance = 1e-12;

/// [1] Part of the largest coordinate by which such an overlap may also be explained: far from the origin
/// (1e5 m) the rounding of a typed coordinate, 2^-53 of it, exceeds kTouchTolerance. Two coordinates and a
/// difference make up to four roundings.
inline constexpr double kTouchRounding = 0x1p-51;

/// [ulp of |v| + R |w|] A ball whose cloth slip is at most this is rolling: the rounding of computing the
/// slip itself.
inline constexpr double kRollingUlp = 8.0;

/// [s] and [-] More events than this within one such span is an error with a dump, never a silent stop.
inline constexpr double kEventCapSpan = 1e-6;
inline constexpr int kEventCap = 10000;
/// [-] A contact that has bounced this often within one such span is held. A row of 15 elastic balls taken
/// pair by pair needs 30, the last bounces before a ball is held, about 100.
inline constexpr int kRattle = 200;
/// [-] Rounds of the loop in a row that changed directions of sustained contacts but brought no event: as
/// bad.
inline constexpr int kQuietCap = 1000000;

/// [-] Margin on how far a ball can go when the plan decides what it can reach; far above the rounding of the
/// bound.
inline constexpr double kReachMargin = 1e-9;
/// [-] Steps from which on an impact is long work by itself, about 20 us: the caller is told of progress.
inline constexpr int kLongImpact = 1000;

/// [m] Depth at which a pocketed ball comes to rest below the cloth; drawing only. pooltool 0.6.0's value.
inline constexpr double kPocketDepth = 0.08;

/// Below which approach a bounce is no bounce: one that would end before the contact itself has, 2 e v / a <
/// t_c(v), with the Hertz contact time t_c = 2.6 (m / k)^0.4 v^-0.2 of two phenolic balls (E = 5.84 GPa, nu =
/// 0.34: k/m = 3.094e9 m^-0.5 s^-2). Such a contact is held instead. About 1.5e-3 m/s at a = 2 m/s^2.
inline constexpr double kContactTimeFactor = 2.6;
inline constexpr double kContactStiffness = 3.094e9;  ///< [m^-0.5 s^-2] k/m
inline constexpr double kLeastRestitution =
    0.1;  ///< stands for a smaller e in that rule, where no bounce is left at all

/// [V] and [L/V] Regularisation of the friction in the compliant cluster map, which errs by about 2e-3 V in
/// stick (docs/hard_cases.md), and its longest steps: without friction, where they err by 3e-7 V, and with
/// it, where 2e-5 V (largest of 40 racks 8e-5 V) is far below the former. [L/V] The map goes on while a
/// listed pair would touch within this time.
inline constexpr double kClusterEpsilon = 2e-3;
inline constexpr double kClusterStep = 1.0 / 80.0;
inline constexpr double kClusterFrictionStep = 1.0 / 16.0;
inline constexpr double kClusterLookAhead = 2.0;
/// [V] A contact of a cluster that closes faster than this sets the scale V itself: the step is made for
/// approaches near V.
inline constexpr double kClusterFaster = 2.0;
/// [L/V] A cluster that has not parted after this many contact times is resolved as rigid; the slowest of 16
/// balls takes a few dozen.
inline constexpr double kClusterTimeLimit = 200.0;
/// [-] Largest exponent of the unloading law; restitutions below 0.05 are taken as 0.05 inside a cluster.
inline constexpr int kLargestLawExponent = 1024;
/// [share of R] Gaps up to this are rounding of the positions: the balls touch.
inline constexpr double kTouchUlp = 64.0 * 2.220446049250313e-16;
/// [-] Sweeps of the rigid projection; a rack of 15 takes about 500.
inline constexpr long kRigidSweeps = 100000;

/// [ulp of the coordinates and the length] Foot points nearer than this to a cushion's end are at it: four
/// roundings of position, end and projection.
inline constexpr double kEndUlp = 4.0;

/// [s] Longest and shortest interval over which a sustained contact keeps the directions of its forces where
/// they turn.
inline constexpr double kHoldLongest = 5e-2;
inline constexpr double kHoldShortest = 1e-5;
/// [m] Error that one such interval may make in a ball's place: 1e-6 m in the hundred or so of a long push.
inline constexpr double kHoldError = 2e-8;
/// [rad] and [m] How far a normal may turn within one, and what gap its turning may leave.
inline constexpr double kHoldTurn = 0.03;
inline constexpr double kHoldGap = 1e-8;
/// [m] and [s] An overlap deeper than this is led out within the interval, but in no less time than this:
/// what rounding adds up in a long push would come near to 1e-12 m.
inline constexpr double kHoldDepth = 2e-14;
inline constexpr double kHoldLeadOut = 1e-3;
/// [m/s] The rounding of great forces (a narrow wedge) may move a gap by so much in the long run: its
/// intervals are as much shorter, but not shorter than kHoldLeadOut (beyond 1e5 m/s^2 it may be more). Forces
/// below some 2000 m/s^2 are not affected.
inline constexpr double kHoldDrift = 1e-13;
/// [of the sliding acceleration] A gap that opens by less does not open: the rounding of the forces.
inline constexpr double kHoldOpening = 1e-10;
/// [-] Rounding of the forces, relative.
inline constexpr double kHoldRounding = 1e-9;
/// [-] Part of itself by which each contact of a held group yields, to share the load of contacts that are
/// more than the group needs.
inline constexpr double kContactSoftness = 1e-12;
/// [of what drives a group] Forces beyond this have no answer: what asks for them is left out. A wedge of
/// slope s multiplies the drive by 1/s, and slopes down to 1e-8 are solved; contacts that contradict each
/// other, by 1/kContactSoftness. The second: a wedge that has no room for margins.
inline constexpr double kLargestHold = 1e9;
inline constexpr double kLargestLeadOut = 1e4;
/// [-] A held contact that opens at some rate is closed only if no ball changes by more than this many times
/// the rate.
inline constexpr double kStickyShare = 10.0;
/// [-] Mobility of balls at rest while it is decided which of them stay, against 1 of a ball that slips.
inline constexpr double kRestGives = 1e-4;
/// [-] Times that a ball may change between rest, rolling and sliding in one solution.
inline constexpr int kModeChanges = 8;
/// [-] Changes after which a slow ball is no longer tried at rest.
inline constexpr int kStopTries = 4;
/// [of the coefficient] To which the friction that ends a slip is solved.
inline constexpr double kStickAccuracy = 1e-3;
/// [s] A held ball that its own rolling friction would stop within this time rests, or it would stop again
/// and again; a speed that it would stop within the second counts as none at all.
inline constexpr double kHoldRest = 1e-8;
inline constexpr double kHoldNoise = 1e-12;
/// [s] The same where there is no rolling friction, against that of sliding: a speed that in an hour makes no
/// more than 1e-12 m.
inline constexpr double kHoldNoRoll = 1e-16;
/// [of kHoldShortest] A held ball that its own rolling friction would stop within this time takes the
/// direction of its friction from where its forces lead it; an explicit step would be unstable.
inline constexpr double kHoldSlow = 4.0;
/// [ulp of the time] No interval is shorter: the clock has to go on.
inline constexpr double kHoldTicks = 8.0;
/// [-] A slip or velocity that turns ends where it is nearest to nothing, if it comes as near as this share
/// of itself; else it only turns.
inline constexpr double kHoldEnds = 0.5;
/// [-] Directions that differ by less than this (sine of the angle) do not turn: the closed form of the
/// straight line.
inline constexpr double kHoldStraight = 1e-9;

/// [of the approach speed] Error per step of the cushion model mathavan_2010; a result of its ten or so steps
/// errs by about as much. Far below the ball-ball impact's default.
inline constexpr double kCushionTolerance = 1e-7;
/// [of the approach speed] Slip at the nose that a nose which can stick is taken to have lost; what that
/// leaves out is of second order (docs/physics.md, "Cushion impact").
inline constexpr double kCushionStick = 3e-5;
/// A nose that has let go slips by less than this for a while, and its direction follows the drive at once
/// (stiff): it is taken as driven. What that leaves out is of second order, about the square root of this
/// times its square.
inline constexpr double kCushionCreep = 1e-4;
inline constexpr int kCushionSteps = 5000;  ///< [-] bound on its steps; an impact takes 3 to 300
/// [-] Grid on which the cushion model stronge brackets the end of stick: a thirtieth of the restitution, far
/// finer than the swing of its tangential spring.
inline constexpr int kStrongeGrid = 32;

/// [share] Boxes that leave out far parts of the table are widened by this much: rounding stays inside.
inline constexpr double kBoxShare = 1e-9;

/// [-] From this many balls, or parts of the table, a tree of boxes is faster than a loop through all of them
/// (docs/speed.md: measured crossings).
inline constexpr std::size_t kTreeFromBalls = 600;
inline constexpr std::size_t kTreeFromParts = 1000;
/// [-] and [ball radii] From this many balls on, a ball's box covers only this way and is then renewed: what
/// lies beyond is mostly never reached.
inline constexpr std::size_t kShortBoxesFromBalls = 32;
inline constexpr double kBoxTravel = 3.0;

/// [share of the jaw radius] A cushion end this close to a jaw's circle is rounded off by it and needs no tip
/// of its own. The jaw is a full circle, so nothing can slip between the two.
inline constexpr double kJawJoinShare = 1e-9;
/// [ball radii] Cue offsets beyond this from the centre are refused: with chalk, a tip slips off at about
/// half a radius (static friction of about 0.6 between tip and ball gives sin(atan 0.6) = 0.51), and a miscue
/// is not simulated.
inline constexpr double kMiscueOffset = 0.5;

// Limits of scene files. They keep squares and products far from overflow and underflow, and a mistyped file
// from filling the memory; nothing physical is near them.
inline constexpr double kMaxCoordinate = 1e6;  ///< [m]
inline constexpr double kMinLength = 1e-6;     ///< [m], smallest ball radius
inline constexpr double kMaxLength = 1e3;    ///< [m], largest ball radius, jaw or pocket radius, gap, jitter
inline constexpr double kMinMass = 1e-9;     ///< [kg], of a ball and of a cue
inline constexpr double kMaxMass = 1e6;      ///< [kg]
inline constexpr double kMaxFriction = 1e3;  ///< [-]
inline constexpr double kMaxSpeed = 1e6;     ///< [m/s]
inline constexpr double kMaxSpin = 1e9;      ///< [rad/s]
inline constexpr double kMaxGravity = 1e3;   ///< [m/s^2]
inline constexpr double kMaxAngle = 1e6;     ///< [degrees], of the aim
inline constexpr double kMaxTime = 1e9;      ///< [s]
inline constexpr double kMaxFps = 1e5;       ///< [1/s]
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
