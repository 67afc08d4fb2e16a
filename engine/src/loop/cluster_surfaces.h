// Cushions and jaws near a cluster, which act by the scene's own law, and the cloth under its balls in space.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "carom/engine/plan.h"
#include "contact/touch.h"
#include "physics/cluster.h"

namespace carom {

struct ClusterSurfacesMemory {
    struct Part {
        std::size_t member;
        Contact contact;
    };
    std::vector<Part> parts_;
    std::vector<Hit> hits_;  // times since the start of the cluster
    std::vector<int> ball_;  // per member
};

class NearSurfaces : public ClusterSurfaces {
  public:
    NearSurfaces(const Plan& plan, ClusterSurfacesMemory& memory) : plan_(plan), m_(memory) {}

    /// Forgets the last cluster. @param longest  [s] a ball that would need more to come out stays inside
    void begin(const std::vector<ClusterBall>& members, bool in_space, double longest);
    void add(std::size_t member, const Contact& part) { m_.parts_.push_back({member, part}); }
    bool any() const { return in_space_ || !m_.parts_.empty(); }
    const std::vector<Hit>& hits() const { return m_.hits_; }
    void sort();
    void forget() { begin({}, false, 0.0); }

    /// Whether a ball is on the cloth: it does not rise or fall by more than the cloth yields.
    bool lies(int ball, const Placed& at) const;
    /// The place of a ball outside of all parts, and not below the cloth; nothing if there is none near, or
    /// the ball has passed through a part since it was at `from`.
    std::optional<Vec3> outside(std::size_t member, const Vec3& from, const Placed& at) const;

    double next(std::size_t member, const Placed& at, const Vec3& spin) const override;
    void hit(std::size_t member, double time, const Vec3& r, Velocities& ball) override;
    double out(std::size_t member, const Placed& at) const override;

  private:
    struct Reached {
        const Contact* part = nullptr;  // null: the cloth
        double time;                    // [s] 0: now
        Touch touch{};                  // of a part
    };
    Reached find(std::size_t member, const Placed& at, const Vec3& spin) const;
    template <class F>
    void each_beside(std::size_t member, const Placed& at, F&& f) const;
    double R(std::size_t member) const { return plan_.sizes[static_cast<std::size_t>(m_.ball_[member])].R; }
    const MotionParams& motion(std::size_t member) const {
        return plan_.motion[static_cast<std::size_t>(m_.ball_[member])];
    }

    const Plan& plan_;
    ClusterSurfacesMemory& m_;
    bool in_space_ = false;
    double longest_ = 0.0;
};

}  // namespace carom
