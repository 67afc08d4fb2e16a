// All numeric constants of resting contacts: unit, source of the value, and the tests that fail if it is a
// hundred times smaller or larger (a count: half or double).
#pragma once

#include <cstddef>

namespace carom::resting {

// When a contact begins to rest, and when it is open (loop/resting_contacts.cpp, contact/resting.cpp)

// [s] A contact that bounces repeatedly within this time chatters: a twentieth of the duration of a contact
// of two balls.
inline constexpr double kChatterSpan = 1e-5;
// [-] Treat a contact as resting after the number of bounces that would leave this fraction of the speed,
// within limits: a row of 15 elastic balls, resolved pair by pair, needs 30.
// A hundredth: Jams.BallsWithoutFrictionAreSolvedWithoutIt. At least 50 bounces:
// Jams.ImpactsBetweenRailsSoonEnd.
inline constexpr double kSpeedLeft = 1e-3;
inline constexpr int kFewestBounces = 20, kMostBounces = 200;
// [of the closing speed at the first of them] Elastic bounces leave more, however quickly they follow each
// other: a grain between walls, or pressed against one by a ball of a hundred million times its mass.
inline constexpr double kNotFallen = 0.5;
// [bounces] Capacity for the latest closing speeds, of all contacts.
inline constexpr std::size_t kBouncesKept = 1024;
// [bounces] A resting contact that began and ended within that time counts as this many bounces, and so does
// a cluster that begins with this contact, because it resolves all bounces of its balls at once. Chains of
// impacts contain none, and even a second cluster is rare.
// Less than half: Jams.BallsWithoutFrictionAreSolvedWithoutIt.
inline constexpr int kManyAtOnce = 20;
// [balls] Initial capacity for the balls of one impact; a larger cluster allocates more.
inline constexpr std::size_t kMostStruck = 32;
// [-] Smallest restitution in the rule of holds(): with 0 a bounce would have no duration at any speed.
inline constexpr double kLeastRestitution = 0.1;
// [s] A speed that rolling friction would stop within this time, or a slip that sliding friction would end,
// counts as zero.
// Without it: RestingContacts.TopspinPushesALine.
inline constexpr double kStopNoise = 1e-12;
// [s] The same for speeds if there is only sliding friction: such a speed moves a ball by at most 1e-12 m an
// hour.
inline constexpr double kSlideNoise = 1e-16;
// [of a closing speed] Impulses that leave a smaller fraction count as progress.
// Without it: Jams.ClosingSpeedsVanishDownToRounding.
inline constexpr double kNearer = 0.5;
// [m] Largest gap of a contact that continues: an invisible fifth of the wavelength of light.
inline constexpr double kGapLeft = 1e-7;
// [m] While its normal turns, a contact keeps a gap of at most this: half of kGapLeft, so that the gap may
// grow or shrink without ending the contact.
inline constexpr double kGapKept = 0.5 * kGapLeft;
// [-] A contact may close its gap without an impulse if that needs at least this many of the group's last
// intervals.
inline constexpr double kSlackTime = 4.0;
// [of the speeds] Without dissipation, a contact rests only if it closes more slowly: --verify does not
// notice the energy of its bounce.
inline constexpr double kLosslessShare = 5e-7;

// How long an interval is (contact/resting_interval.cpp)

// [s] Shortest interval: a motion that reverses within it is treated as in its end state.
inline constexpr double kShortestInterval = 1e-5;
// [ulp of the time] The same, so that the clock advances.
inline constexpr double kClockTicks = 8.0;
// [s] Longest interval, and the length of the first attempt if nothing moves.
inline constexpr double kLongestInterval = 1e6;
// [m] Position error of a ball in one interval: 1e-6 m after the hundred or so intervals of a long push.
// A hundred times larger: RestingContacts.ObliqueSpinIntoACushion.
inline constexpr double kPlaceError = 2e-8;
// [m] The same from the friction between balls, which is weaker: using its mean over the interval leaves a
// tenth.
inline constexpr double kFrictionError = 2e-7;
// [s] Latest time at which a ball stopped by friction rests while others of its group move: the position
// tolerance alone would let it creep for days.
inline constexpr double kStopsWithin = 0.01;
// [-] A stop at most this fraction before the end of an interval does not shorten it; one at most this
// fraction after the end lengthens it.
// Without it: Jams.GapsHaveRoomForARate.
inline constexpr double kSoon = 1e-2;
// [rad] For a direction that turns by at most this angle, use the one at the middle of the interval.
// Without such directions: RestingContacts.ObliqueSpinIntoACushion.
inline constexpr double kTurnOfMiddle = 0.5;
// [-] Interval lengths and directions (sine of the angle) that differ by less are equal.
inline constexpr double kSame = 1e-9;
// [-] Most attempts at an interval, and most extensions to the end of a slip or velocity.
// Without extensions: RestingContacts.SpinIntoACushion.
inline constexpr int kAttempts = 60, kLonger = 6;
// [-] First attempt, as a multiple of the group's last interval: usually the same limit applies again.
inline constexpr double kGrowth = 4.0;
// [-] An interval with too large an error is reduced by this factor until the error is acceptable.
inline constexpr double kReduced = 0.9;
// [-] The same for a gap that would leave its allowed range.
inline constexpr double kShorter = 0.7;
// [ulp] A smaller change of a speed is rounding: such a group moves uniformly.
// Without it: Effects.SkippedAndZeroGiveTheSameRecordOver1000Scenes.
inline constexpr double kChangeUlp = 8.0;

// The solution over an interval (contact/resting_newton.cpp, resting_response.cpp)

// [-] Most Newton steps of one solution. A few are usual; a step is exact once every ball's mode of motion is
// right.
inline constexpr int kNewtonSteps = 40;
// [-] From this step on, friction between balls can only decrease, so that its impulses converge even if
// balls lock; from the second one on there is none, which leaves a convex problem.
inline constexpr int kFallsFrom = 8, kNoneFrom = 14;
// [-] From this step on, a solution is accepted if its wrong rates change no gap noticeably.
// From the first step on: Jams.AccumulatedRoundingIsNoOverlap.
inline constexpr int kHarmlessFrom = 5;
// [m] Tolerance of a position for the friction between balls.
inline constexpr double kFrictionPlace = 1e-11;
// [-] Most trials of a line search, and the fraction of its first slope that may remain.
// No test fails without the search: it guarantees that Newton's method ends on a convex function.
inline constexpr int kSearches = 8;
inline constexpr double kSlopeLeft = 0.25;
// [-] Mobility of a resting ball, in the derivatives only, so that resting balls share a load; a sliding ball
// has 1. A smaller value would turn a nearly right rate into impulses that set the balls moving.
inline constexpr double kRestCompliance = 1e-4;
// [m] Smaller changes of a gap are ignored, and so is an overlap that the turning of a normal may cause: a
// few ulp of a coordinate of 5 m.
inline constexpr double kNoGap = 4e-15;
// [m] A deeper overlap is removed: otherwise the rounding errors of a long push would add up to nearly
// 1e-12 m.
inline constexpr double kOverlapDepth = 2e-14;
// [m] Overlap that may arise within an interval: a tenth of the limit of U3 of --verify.
inline constexpr double kOverlapGrowth = 1e-13;
// [-] A gap whose normal turns further than this is not examined in detail, because the interval will be
// shortened anyway.
inline constexpr double kLongestTurn = 0.1;
// [ulp of the speeds and impulses] Smaller rates of a gap are zero.
inline constexpr double kRateUlp = 32.0;

// The linear problem of one Newton step (contact/complementarity.cpp)

// [-] Compliance of each contact of a group, relative to its mobility (the diagonal of A). It makes the
// solution unique: redundant contacts share the load.
inline constexpr double kContactSoftness = 1e-12;
// [-] Exchanges before giving up: a solvable matrix usually needs three.
inline constexpr std::size_t kFewExchanges = 16;
// [-] Block exchanges without fewer infeasible rows before single exchanges (Murty's rule) begin, which
// terminate.
// No test fails without it: it guarantees termination.
inline constexpr int kBlockTries = 8;
// [-] Further refinements after the first two. Each multiplies the residual by the compliance divided by the
// smallest eigenvalue, so they help only if the matrix is singular to rounding.
// Without it: Complementarity.NarrowWedgeIsSolvedToRounding.
inline constexpr int kMoreRefinements = 20;
// [-] Regularisation, relative to the mobility, at the start and end of the proximal iteration, and most
// rounds.
inline constexpr double kApproachSoftness = 1e-4, kLeastSoftness = 1e-8;
inline constexpr int kMostRounds = 40;
// [ulp of a row's terms] A smaller residual is the rounding of their sum.
inline constexpr double kSumUlp = 4.0;
// [of a row's terms] A larger violation is infeasible.
inline constexpr double kInfeasible = 1e-12;

}  // namespace carom::resting
