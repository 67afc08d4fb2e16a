// The replay of a record's events on dual numbers.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/engine/tangents.h"
#include "contact/touch.h"
#include "tangent/impacts.h"

namespace carom::tangent {

/// A quantity that must remain positive for the order of events to hold.
struct Room {
    Dual left;
    std::string what;  ///< happens at 0
};

/// Derivatives of one record by up to kLanes inputs.
class Replay {
  public:
    /// @param scene  as in numbers_of()
    Replay(const Plan& plan, const Record& record, Scene& scene, const std::vector<Input>& inputs,
           double until);
    Replay(const Replay&) = delete;

    const Leg& leg_at(int ball, double time) const;
    const std::vector<Dual>& times() const { return times_; }
    const std::vector<Dual2>& places() const { return places_; }
    double error() const { return laws_.error; }
    /// margins.cpp
    std::vector<Room> rooms() const;

  private:
    struct Ball {
        std::vector<Leg> legs;
        std::size_t segment = 0;  ///< index in the record of the last leg's segment
        double fell = 0.0, flew;  ///< as in Balls
        bool on_cloth = false;    ///< the coming ball_cloth event is already part of the last leg
    };
    void replay(const Event& event);
    /// Two colliding balls: the time, the vector from one to the other, and their motion.
    struct Meeting {
        bool space;
        Dual time;
        Dual3 apart;
        State s1, s2;
    };
    Meeting meet(const Event& event);
    Dual ball_ball(const Event& event);
    Dual cluster(const Event& event);
    Dual cushion(const Event& event);
    Dual pocket(const Event& event);
    Dual transition(const Event& event);
    bool in_space(int a, int b) const;
    const Segment& next(int ball, double start);
    void begin(int ball, const Dual& time, const State& state);
    void go_on(int ball, const Dual& time, State state);
    /// Time of an event at which a gap closes: `touch` at the record's time, between bodies of this size.
    Dual when(const Touch<Dual3>& touch, double size) const;
    /// Adds how far a ball is from missing its partner: by `apart` and `velocity`, relative to the partner.
    void add_miss(const Dual2& apart, const Dual2& velocity, const Event& event);
    /// margins.cpp. A ball, and the other ball of a gap, if any.
    struct Pair {
        int ball;
        const Leg* leg;
        int other = -1;
        const Leg* other_leg = nullptr;
    };
    using GapOf = std::function<Dual(const State&, const State&)>;
    void add_near(std::vector<Room>& rooms, const Pair& pair, const GapOf& gap, const Dual& from,
                  const Dual& to, const std::string& what) const;
    std::string who(int ball) const;
    std::string whom(const Event& event) const;

    const Plan& plan_;
    const Record& record_;
    Numbers numbers_;
    Laws laws_;
    std::vector<Ball> balls_;
    std::vector<Dual> times_;
    std::vector<Dual2> places_;
    std::vector<Room> rooms_;  ///< of the events themselves
    double now_ = 0.0, until_;
};

}  // namespace carom::tangent

namespace carom {

struct Tangents::Parts {
    std::vector<std::unique_ptr<tangent::Replay>> replays;
    const tangent::Replay& of(std::size_t input) const { return *replays[input / tangent::kLanes]; }
};

}  // namespace carom
