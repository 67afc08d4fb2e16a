// Ball-ball impacts with a third ball within reach: finds the members of such a cluster and their motion
// after it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "carom/engine/plan.h"
#include "contact/touch.h"
#include "loop/balls.h"
#include "loop/detector.h"
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

struct ClustersMemory {
    ClusterMap map_;
    std::vector<ClusterBall> members_;
    std::vector<ClusterContact> contacts_;
    std::vector<Vec3> paths_;  // per ball
    ClusterSurfacesMemory surfaces_;
    std::vector<int> joined_;  // balls that a member would hit during the cluster
    std::vector<Hit> hits_;
    std::vector<ClusterPush> pushes_;  // per contact, of all that resolve() has computed for it
};

class Clusters : private Borrowed<ClustersMemory> {
  public:
    Clusters(const Plan& plan, const Balls& balls, const Detector& detector, ClustersMemory& memory);

    /// Finds the cluster of two balls that collide at v_n [m/s]. @return the fastest approach in it [m/s]
    /// @param pair  also if there is no third ball
    double collect(int a, int b, double v_n, bool pair = false);
    /// The result of the last collect(). Without a third ball: two balls and, unless `pair`, no contacts.
    const std::vector<ClusterBall>& balls() const { return members_; }
    const std::vector<ClusterContact>& contacts() const { return contacts_; }

    /// Whether a ball found by the last collect() flies, or may leave the cloth in this impact model.
    bool in_space() const { return in_space_; }

    /// Replaces the velocities and spins of balls() by those after the impact.
    /// @param v_n   [m/s] the fastest approach
    /// @param friction  whether there is friction between the balls
    /// @param may_last  whether the balls may move during the cluster
    /// @return number of integration steps
    std::int64_t resolve(double v_n, bool friction, bool may_last);

    /// Who touched whom in the last resolved cluster, ordered by time.
    const std::vector<Hit>& hits();

    /// [s] Duration of the last resolved cluster; 0: instantaneous, and the balls stay in place.
    double duration() const { return duration_; }
    /// [m] The displacement of the k-th ball during that time.
    const Vec3& path(std::size_t k) const { return paths_[k]; }

    /// Number of balls that collect() examined besides the first two; for tests.
    std::int64_t looks() const { return looks_; }

  private:
    void collect_at(int a, int b, double v_n);
    std::int64_t rigid(const ClusterSettings& settings);
    ClusterSettings of_members(ClusterSettings settings) const;
    std::int64_t compliant(const ClusterSettings& settings, double v_n);
    void add_pushes();
    std::int64_t integrate(const ClusterSettings& settings, double v_n);
    bool find_paths();
    double overlap_ends() const;
    int find_obstacle() const;
    bool is_member(int ball) const;
    bool has_room(const ClusterBall& ball, const Vec3& path, int other) const;
    bool closes_still(double v_n) const;
    Box near_box(const ClusterBall& ball, double gap) const;
    ClusterBall member(int ball) const;
    bool passes(int a, int b) const;

    const Plan& plan_;
    const bool flights_;  // balls may leave the cloth
    const Balls& balls_;
    const Detector& detector_;
    std::int64_t looks_ = 0;
    int first_ = -1, second_ = -1;  // the pair that met
    double contact_time_ = 0.0;     // [s] of their contact
    double duration_ = 0.0;
    // A ball that a member hits on its path; kColliding: one that cannot join.
    static constexpr int kNone = -1, kColliding = -2;
    int obstacle_ = kNone;
    NearSurfaces near_{plan_, surfaces_};
    bool in_space_ = false;
    bool pair_ = false;    // of the last collect()
    bool unlike_ = false;  // the last collect() found balls of different size
};

}  // namespace carom
