// The contact phase of a cluster by another method than the kernel's, for tests and `carom accuracy`:
// Dormand-Prince's order 5 in short steps, which end at the events, located by bisection; the phases of
// contacts do not change within a step. It shares no code with the kernel, computes one contact at a time,
// and is slow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/kernel/contact_phase.h"

namespace carom::reference {

using kernel::ContactPhase;
using kernel::HertzContact;
using kernel::HertzLaw;

struct Cluster {
    std::vector<double> motion;  ///< six numbers per ball
    std::vector<HertzContact> contacts;
    std::vector<double> inverse_mass;  ///< empty: all 1
    bool held = true;
    const kernel::ContactSurfaces* surfaces = nullptr;
    std::vector<double> lies{};  ///< as ContactPhase::lies; empty: no cloth

    std::size_t balls() const { return motion.size() / 6; }
};

class ContactReference {
  public:
    ContactReference(Cluster cluster, const HertzLaw& law);

    /// Integrates for a time [L/V] in steps of at most kStep.
    void run(double time);
    /// Integrates until all contacts are open and none would close within look_ahead. @return the time, or -1
    /// if it exceeds the limit
    double run_to_end(double look_ahead, double time_limit);

    /// As ContactPhase::motion and moved.
    std::vector<double> motion() const { return part(3, 6); }
    std::vector<double> moved() const { return part(0, 3); }

  private:
    enum class Phase : std::uint8_t { kOpen, kLoading, kUnloading };
    struct Contact {
        Phase phase = Phase::kOpen;
        double most = 0.0;
    };
    struct Now {
        std::array<double, 3> n;
        double d, rate;
    };

    std::vector<double> part(std::size_t first, std::size_t count) const;
    Now look(const std::vector<double>& y, std::size_t number) const;
    static Phase next_phase(const Now& now, const Contact& contact);
    bool happens(const std::vector<double>& y) const;
    void change(std::size_t number);
    bool ended(double look_ahead) const;
    double light(std::size_t ball) const { return c_.inverse_mass.empty() ? 1.0 : c_.inverse_mass[ball]; }
    bool touched(std::size_t ball) const;
    bool aloft(std::size_t ball) const;
    std::array<double, 9> state(std::size_t ball) const;
    double hit_surfaces();
    bool is_out() const;
    std::vector<double> slope(const std::vector<double>& y) const;
    std::vector<double> advance(double h) const;
    std::vector<double> dormand_prince(const std::vector<double>& y, double h) const;
    void glide(std::vector<double>& y, std::size_t ball, double h) const;

    const Cluster c_;
    const HertzLaw law_;
    std::vector<double> y_;  // per ball place, velocity and R w
    double time_ = 0.0;      // [L/V]
    std::vector<Contact> contacts_;
};

/// A ContactPhaseFunction that calls it; the tolerance is ignored, and it writes no history.
std::int64_t contact_phase(const ContactPhase& phase, const HertzLaw& law, double tolerance,
                           double look_ahead, double time_limit) noexcept;

}  // namespace carom::reference
