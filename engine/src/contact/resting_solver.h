// One solution of one held group (resting.h): capture, forces, intervals. Split over resting.cpp (the order of
// steps), resting_capture.cpp, resting_forces.cpp, resting_modes.cpp and resting_intervals.cpp.
#pragma once

#include <vector>

#include "contact/resting.h"
#include "physics/motion.h"

namespace carom {

/// [-] Times that a ball may change between rest, rolling and sliding in one solution.
inline constexpr int kModeChanges = 8;
/// [-] Rounding of the forces, relative.
inline constexpr double kHoldRounding = 1e-9;
/// [s] Shortest interval over which a resting contact keeps the directions of its forces where they turn.
inline constexpr double kHoldShortest = 1e-5;
/// [m] and [s] An overlap deeper than this is led out within the interval, but in no less time than this:
/// what rounding adds up in a long push would come near to 1e-12 m.
inline constexpr double kHoldDepth = 2e-14;
inline constexpr double kHoldLeadOut = 1e-3;
/// [s] A held ball that its own rolling friction would stop within this time rests, or it would stop again and again.
inline constexpr double kHoldRest = 1e-8;

class HeldSolver {
  public:
    HeldSolver(HeldGroup& group, const HeldSurroundings& around, const MotionParams& motion, double now);
    void run();

  private:
    enum class Mode : unsigned char { kSliding, kRolling, kResting };

    // A member with what the equations need. All forces are per mass.
    struct Body {
        Mode mode = Mode::kResting;
        Vec2 direction =
            Vec2::Zero();     // sliding: of the slip; rolling: of the velocity, or of the push that starts it
        bool starts = false;  // direction is that of the forces: there is no slip, or no velocity, yet, or
                              // so little that friction would turn it over within the shortest interval
        Vec2 due = Vec2::Zero();     // rolling and slow: velocity / kHoldShortest
        bool lifted = false;         // its contacts carry its whole weight: no friction from the cloth
        int changes = 0;             // of mode, in one solution
        Vec2 push = Vec2::Zero();    // sum of contact forces
        Vec2 couple = Vec2::Zero();  // (T x z) / R of the contact torques
        double lift = 0.0;           // vertical contact force
        Vec2 a = Vec2::Zero();       // acceleration
        double mobility() const {
            return mode == Mode::kSliding ? 1.0 : (mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
        }
    };

    // A contact as the solver sees it; i, j index the bodies.
    struct Link {
        int i, j;
        Vec2 n;
        double friction_z = 0.0;            // f_z / N, on ball i
        double slip_z = 0.0, slip_x = 0.0;  // m/s, between two balls: upward, and along the cloth
        double friction = 0.0;              // coefficient at that slip
        bool stuck = false;                 // friction_z is what ends slip_z within the interval
        double curving = 0.0;               // what turning normals add to the acceleration of the gap
        double depth = 0.0;                 // m, by which the bodies overlap
        double margin = 0.0;                // what the gap needs besides to end the interval at 0 or above
        double returning = 0.0;  // opening rate / h of a contact that would be closed again within h
        double diagonal = 0.0;
        double N = 0.0;
        bool walled = false;   // there is no room for a margin
        bool open = false;     // the gap is opening by more than rounding
        bool pressed = false;  // by the forces at the start of the interval
    };

    // resting.cpp
    void make_bodies();
    Mode mode_of(const HeldBall& ball) const;
    bool settle();
    void make_links();
    double overlap(const HeldContact& contact, const Link& link) const;
    bool any_deep() const;
    void mark_released();
    Vec2 velocity(int body) const;
    double gap_rate(const Link& link) const;
    Body& body(int index) { return bodies_[index]; }
    const Body& body(int index) const { return bodies_[index]; }

    // resting_capture.cpp
    void capture();
    bool project(const std::vector<char>& sticky);
    std::vector<char> sticky_contacts() const;
    void kick(int body, const Vec2& dv);
    void stop_slow();

    // resting_forces.cpp
    void make_directions();
    void solve_forces(double interval);
    void solve_forces_once(double interval);
    bool stick(double interval);
    bool any_stuck() const;
    double slip_rate(const Link& link) const;
    static double margin_for(const Link& link, const Vec2& across, double distance, double interval);
    bool margin_falls_short(double interval) const;
    void curve(double interval);
    bool hold_returning();
    bool solve_contacts();
    /// What one solution for the normal forces takes into account.
    struct Share {
        bool friction, margins;
    };
    bool solve_contacts_once(Share share);
    bool drop_margins(const std::vector<std::size_t>& active);
    Vec2 response(const Link& link, int body, bool friction) const;
    void accelerate();
    void sum_forces();
    double load(const Body& body) const;
    double gap_acceleration(const Link& link) const;

    // resting_modes.cpp
    bool modes_hold();
    bool resting_holds(Body& body);
    bool rolling_holds(Body& body);
    bool sliding_holds(Body& body);
    bool change_mode(Body& body, Mode mode);
    bool turn_to(Body& body, const Vec2& drive, double size);

    // resting_intervals.cpp
    double across(std::size_t link, Vec2& velocity_across) const;
    double turning_interval() const;
    bool take_middle_directions();
    Vec2 slip_or_velocity(std::size_t body, Vec2& rate) const;
    double time_of(std::size_t body, bool& gone) const;
    double friction_flip(const Link& link) const;
    double opening_interval(const Link& link) const;
    double rounding_interval(const Link& link) const;
    double closing_interval(const Link& link) const;
    double bare_interval(std::size_t link, double interval) const;
    Vec2 spin_rate(std::size_t body) const;
    enum class Opening : unsigned char { kIgnored, kEnds };
    double write_segments(double longest, Opening opening);

    HeldGroup& group_;
    const HeldSurroundings& around_;
    const MotionParams& motion_;
    double now_;
    std::vector<Body> bodies_;
    std::vector<Link> links_;
    double give_ = 0.0;      // mobility of balls at rest
    double noise_ = 0.0;     // m/s: what rounding makes of the group's speeds in a few sums of eight
    bool margins_ = false;   // whether the last solution has them
    bool solved_ = true;     // whether the contacts have an answer
    bool may_stop_ = false;  // slow balls that friction stops within the shortest interval stop now
};

}  // namespace carom
