#include "carom/render/table_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "carom/engine/event_details.h"
#include "stage/mesh_builder.h"

namespace carom::render {

namespace {

// [m] Dimensions that the engine does not define because they do not affect the balls.
constexpr double kCushionWidth = 0.05;    // of a cushion without facings, which would show its depth
constexpr double kRailWidth = 0.1;        // of the wooden rail outside the cushion
constexpr double kWallHalfWidth = 0.005;  // of a cushion with balls on both sides
constexpr double kShadeWidth = 0.055;     // of the dark shading along a cushion
constexpr double kUndercut = 0.018;       // of a cushion: its foot is this far behind its nose
constexpr double kFloorLevel = -0.75, kCeiling = 1.9,
                 kAisle = 2.3;       // of the room; its walls are this far away
constexpr double kWoodRise = 0.008;  // of the wooden rail above the highest nose
constexpr double kApron = 0.22;      // depth of the frame below the cloth
constexpr double kFoot = -0.08;      // of the base below it, from the inner edge of the rail
constexpr double kSlope = 0.08;      // [-] of the top of a cushion, which rises towards the rail
constexpr double kLeather = 0.016;   // width of the rim of a pocket
constexpr double kBag = 0.8;         // [radii] of a pocket at its bottom

struct Box {
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    void add(const Vec2& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    bool empty() const { return low.x() > high.x(); }
};

Chain closed_chain(std::vector<Vec2> points, double height) {
    Chain chain;
    chain.heights.assign(points.size(), height);
    chain.points = std::move(points);
    chain.closed = true;
    return chain;
}

// A clockwise rectangle: the frame lies to the left of it.
Chain rectangle(const Vec2& low, const Vec2& high, double height) {
    return closed_chain({low, {low.x(), high.y()}, high, {high.x(), low.y()}}, height);
}

class TableMaker {
  public:
    TableMaker(const Table& table, double R, const std::vector<Vec2>& visited, Edges edges)
        : table_(table), R_(R), visited_(visited), sharp_(edges == Edges::kSharp), builder_(mesh_) {}

    TableMesh make() {
        mesh_.cloth = look::cloth_of(table_.preset);
        std::vector<Chain> chains = join_outline(table_);
        find_bounds();
        for (Chain& chain : chains) add_chain(chain);
        for (const Jaw& jaw : table_.jaws) add_jaw(jaw);
        if (!framed_) {
            if (is_railed(chains))
                add_frame();
            else
                add_endless_cloth();
        }
        for (const Pocket& pocket : table_.pockets) add_pocket(pocket);
        add_table_marks(table_, mesh_, builder_, kCushionWidth + 0.5 * kRailWidth);
        return std::move(mesh_);
    }

  private:
    void find_bounds() {
        for (const Cushion& cushion : table_.cushions) {
            outline_.add(cushion.from);
            outline_.add(cushion.to);
            nose_ = std::max(nose_, cushion.height);
        }
        for (const Vec2& place : visited_) played_.add(place);
        if (played_.empty()) played_ = outline_;
        if (played_.empty()) played_.add(Vec2::Zero());
        const Box& whole = outline_.empty() ? played_ : outline_;
        mesh_.origin = 0.5 * (whole.low + whole.high);
        // With sharp edges the wood is level with the cushions: its inner side would be a strip of at most a
        // pixel.
        mesh_.wood_top = nose_ + (sharp_ ? 0.0 : kWoodRise);
    }

    // Whether the table has rails with jaws around pockets; these get a rectangular frame.
    bool is_railed(const std::vector<Chain>& chains) const {
        return !table_.pockets.empty() &&
               std::any_of(chains.begin(), chains.end(), [](const Chain& chain) { return chain.has_jaw; });
    }

    // The side of an open chain on which the balls are: +1: all left; -1: all right; 0: on both sides, or no
    // balls.
    int side_of_balls(const Chain& chain) const {
        bool left = false, right = false;
        for (const Vec2& ball : visited_) {
            double nearest = 1e300, side = 0.0;
            for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
                const Vec2 &from = chain.points[i], &to = chain.points[i + 1];
                const double distance = distance_to_segment(ball, from, to);
                if (distance < nearest) {
                    nearest = distance;
                    side = cross(to - from, ball - from);
                }
            }
            (side > 0.0 ? left : right) = true;
        }
        if (left == right) return 0;
        return left ? 1 : -1;
    }

    bool holds_balls(const Chain& chain) const {
        return visited_.empty() || std::any_of(visited_.begin(), visited_.end(), [&](const Vec2& ball) {
                   return contains(chain.points, ball);
               });
    }

    void add_chain(Chain& chain) {
        if (chain.closed) {
            const bool around_balls = holds_balls(chain) && !framed_;
            if ((signed_area(chain.points) > 0.0) == around_balls) reverse(chain);
            if (around_balls)
                add_surrounding(chain);
            else
                add_body(chain);
        } else if (chain.has_jaw && chain.points.size() > 2) {
            if (signed_area(chain.points) < 0.0) reverse(chain);
            add_body(chain);
        } else {
            const int side = side_of_balls(chain);
            if (side > 0) reverse(chain);
            add_strip(chain, side == 0 ? kWallHalfWidth : kCushionWidth, side == 0);
            if (side == 0) {
                reverse(chain);
                add_strip(chain, kWallHalfWidth, true);
            }
        }
    }

    // [m] Anything farther behind the nose than half the radius of a jaw would fold over itself there.
    double largest_inset() const {
        double largest = 1.0;
        for (const Jaw& jaw : table_.jaws)
            largest = std::min(largest, jaw.radius > 0.0 ? 0.5 * jaw.radius : 1.0);
        return largest;
    }

    void shade_cloth(const Chain& chain, double foot) {
        Chain ground = chain;
        std::fill(ground.heights.begin(), ground.heights.end(), 0.0004);
        builder_.sweep(ground,
                       {{-kShadeWidth, 0.0, 0.0},
                        {-0.5 * kShadeWidth, 0.0, 0.05},
                        {-0.2 * kShadeWidth, 0.0, 0.16},
                        {0.0, 0.0, 0.42},
                        {foot + 0.003, 0.0, 0.75}},
                       Material::kShade, false);
    }

    // The side towards the balls: from below the nose, over the nose, to the edge of the flat top.
    void add_nose(const Chain& chain, double inset) {
        const std::size_t n = chain.points.size();
        for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < n; ++i)
            mesh_.noses.push_back({chain.points[i], chain.points[(i + 1) % n]});
        Chain ground = chain;
        std::fill(ground.heights.begin(), ground.heights.end(), 0.0);
        const double height = chain.heights.front(),
                     foot = std::min({kUndercut, largest_inset(), 3.0 * inset});
        if (sharp_) {
            builder_.sweep(ground, {{foot, 0.0, 0.0}, {0.0, height, 0.0}}, Material::kCushion, true);
            shade_cloth(chain, foot);
            return;
        }
        builder_.sweep(ground, {{foot, 0.0, 0.0}, {0.0, height - 0.003, 0.0}}, Material::kCushion, true);
        builder_.sweep(ground,
                       {{0.0, height - 0.003, 0.0},
                        {0.0003, height, 0.0},
                        {0.4 * inset, height + 0.0022, 0.0},
                        {inset, height + 0.003, 0.0}},
                       Material::kCushion, true);
        shade_cloth(chain, foot);
    }

    // A cushion whose back is known: its outline, closed by a straight line if it is open. For a body that
    // stands alone on the cloth, the caller chooses a wooden top, because a top of cloth would hardly be
    // visible.
    void add_body(const Chain& chain, Material top = Material::kCushion) {
        const double inset = std::min(0.006, largest_inset());
        if (top == Material::kCushion) bodies_.push_back(chain);
        add_nose(chain, inset);
        if (sharp_)
            builder_.polygon(chain.points, chain.heights.front(), top);
        else
            builder_.polygon(offset_left(chain.points, chain.closed, inset), chain.heights.front() + 0.003,
                             top);
    }

    void add_strip(const Chain& chain, double width, bool wall) {
        const double inset = std::min({0.006, 0.3 * width, largest_inset()});
        const double rise = sharp_ ? 0.0 : (wall ? 0.003 : 0.003 + kSlope * width);
        add_nose(chain, inset);
        const Material material = wall ? Material::kWood : Material::kCushion;
        const ProfileRow back{width, rise, 0.0};
        builder_.sweep(chain, {sharp_ ? ProfileRow{0.0, 0.0, 0.0} : ProfileRow{inset, 0.003, 0.0}, back},
                       material, false);
    }

    // A closed outline with the balls inside: cloth, cushion and wooden rail follow it.
    void add_surrounding(const Chain& chain) {
        builder_.polygon(reversed(offset_left(chain.points, true, 0.025)), 0.0, Material::kCloth);
        add_strip(chain, kCushionWidth, false);
        Chain back = closed_chain(offset_left(chain.points, true, kCushionWidth), 0.0);
        add_wood(back);
    }

    static std::vector<Vec2> reversed(std::vector<Vec2> points) {
        std::reverse(points.begin(), points.end());
        return points;
    }

    void add_wood(const Chain& inner) {
        const double top = mesh_.wood_top;
        std::vector<ProfileRow> rows{{0.0, top - 0.012, 0.0}};
        if (sharp_) {
            rows.insert(rows.end(), {{0.0, top, 0.0}, {kRailWidth, top, 0.0}});
        } else {
            rows.insert(rows.end(), {{0.0, top - 0.002, 0.0},
                                     {0.002, top, 0.0},
                                     {kRailWidth - 0.016, top, 0.0},
                                     {kRailWidth - 0.005, top - 0.004, 0.0},
                                     {kRailWidth, top - 0.014, 0.0}});
        }
        rows.insert(rows.end(),
                    {{kRailWidth, -kApron, 0.0}, {kFoot, -kApron, 0.0}, {kFoot, kFloorLevel, 0.0}});
        builder_.sweep(inner, rows, Material::kWood, false);
        Box box, outer;
        for (const Vec2& p : inner.points) box.add(p);
        for (const Vec2& p : offset_left(inner.points, true, kRailWidth)) outer.add(p);
        mesh_.inner_low = box.low;
        mesh_.inner_high = box.high;
        finish_bounds(outer, 0.02);
        add_room();
        framed_ = true;
    }

    void add_frame() {
        builder_.polygon({outline_.low,
                          {outline_.high.x(), outline_.low.y()},
                          outline_.high,
                          {outline_.low.x(), outline_.high.y()}},
                         0.0, Material::kCloth);
        add_wood(rectangle(outline_.low, outline_.high, 0.0));
    }

    void add_endless_cloth() {
        Box shown = played_;
        if (!outline_.empty() &&
            (outline_.high - outline_.low).norm() < 20.0 * (played_.high - played_.low).norm()) {
            shown.add(outline_.low);
            shown.add(outline_.high);
        }
        const double room = std::max(8.0 * R_, 0.06 * (shown.high - shown.low).maxCoeff());
        finish_bounds(shown, room);
        mesh_.lamp.endless = true;
        const double reach = 40.0 * std::max(1.0, (shown.high - shown.low).maxCoeff());
        const Vec2 low = mesh_.origin - Vec2(reach, reach), high = mesh_.origin + Vec2(reach, reach);
        builder_.polygon({low, {high.x(), low.y()}, high, {low.x(), high.y()}}, 0.0, Material::kCloth);
        mesh_.inner_low = low;
        mesh_.inner_high = high;
    }

    // Floor and walls, visible from inside, and the lamp, which a camera above it does not see.
    void add_room() {
        const Vec2 aisle(kAisle, kAisle);
        add_box(mesh_.bounds.low - aisle, mesh_.bounds.high + aisle, kFloorLevel, kCeiling, Material::kFloor);
        const Vec3& lamp = mesh_.lamp.center;
        const Vec2 low = lamp.head<2>() - mesh_.lamp.half, high = lamp.head<2>() + mesh_.lamp.half;
        constexpr double kRim = 0.03;
        add_box({high.x() + kRim, low.y() - kRim}, {low.x() - kRim, high.y() + kRim}, lamp.z() + 0.004,
                lamp.z() + 0.12, Material::kLamp);
        builder_.quad({low.x(), high.y(), lamp.z()}, {high.x(), high.y(), lamp.z()},
                      {high.x(), low.y(), lamp.z()}, {low.x(), low.y(), lamp.z()}, Material::kLamp, 1.0);
    }

    // The bottom and the four sides of a box, visible from inside; from outside if low.x > high.x.
    void add_box(const Vec2& low, const Vec2& high, double z, double top, Material material) {
        const std::array<Vec2, 4> c{low, Vec2(high.x(), low.y()), high, Vec2(low.x(), high.y())};
        const auto at = [](const Vec2& p, double height) { return Vec3(p.x(), p.y(), height); };
        builder_.quad(at(c[0], z), at(c[1], z), at(c[2], z), at(c[3], z), material);
        for (std::size_t i = 0; i < c.size(); ++i) {
            const Vec2 &a = c[i], &b = c[(i + 1) % c.size()];
            builder_.quad(at(a, z), at(a, top), at(b, top), at(b, z),
                          material == Material::kFloor ? Material::kWall : material);
        }
    }

    void finish_bounds(const Box& box, double room) {
        mesh_.bounds = {box.low - Vec2(room, room), box.high + Vec2(room, room), mesh_.wood_top};
        const Vec2 half = 0.5 * (box.high - box.low);
        mesh_.lamp.center = Vec3(mesh_.origin.x(), mesh_.origin.y(), 0.72 + 0.18 * half.maxCoeff());
        // Long and narrow, along the table.
        mesh_.lamp.half = half.y() > half.x() ? Vec2(0.34 * half.x(), 0.55 * half.y())
                                              : Vec2(0.55 * half.x(), 0.34 * half.y());
    }

    void add_jaw(const Jaw& jaw) {
        // A jaw that is joined to a cushion lies inside it; only free-standing posts are drawn.
        const bool joined =
            std::any_of(table_.cushions.begin(), table_.cushions.end(), [&](const Cushion& cushion) {
                return std::abs((cushion.from - jaw.center).norm() - jaw.radius) < 2e-4 ||
                       std::abs((cushion.to - jaw.center).norm() - jaw.radius) < 2e-4;
            });
        if (joined) return;
        std::vector<Vec2> circle;
        for (int i = 0; i < 64; ++i) {
            const double angle = 6.28318530717958647692 * i / 64;
            circle.push_back(jaw.center + jaw.radius * Vec2(std::cos(angle), std::sin(angle)));
        }
        add_body(closed_chain(std::move(circle), jaw.height), Material::kWood);
    }

    void add_pocket(const Pocket& pocket) {
        const double bottom = -(pocket.depth + R_ + 0.03);
        mesh_.holes.push_back({pocket.center, pocket.radius});
        // Above the cloth, the wall of the hole and its rim exist only where the wooden frame is.
        const Bounds inner{mesh_.inner_low, mesh_.inner_high, 0.0};
        const double rim = mesh_.wood_top + 0.0015;
        builder_.well(pocket.center, pocket.radius, pocket.radius, rim, 0.0, Material::kPocket, &inner);
        builder_.well(pocket.center, pocket.radius, kBag * pocket.radius, 0.0, bottom, Material::kPocket);
        builder_.disc(pocket.center, kBag * pocket.radius, bottom, Material::kPocket, 1.0, 1.0);
        builder_.ring(pocket.center, pocket.radius, pocket.radius + kLeather, rim, Material::kTrim, 0.0,
                      &inner);
        builder_.ring(pocket.center, pocket.radius, pocket.radius + 0.008, 0.0006, Material::kShade, 0.55);
        for (const Chain& body : bodies_) add_cut_end(pocket, body);
    }

    // Where the hole cuts off the end of a cushion: leather from the cloth to its top.
    void add_cut_end(const Pocket& pocket, const Chain& body) {
        constexpr int kPieces = 96;
        const double top = body.heights.front() + (sharp_ ? 0.0 : 0.003);
        const auto at = [&](double piece) {
            const double angle = 2.0 * std::numbers::pi * piece / kPieces;
            return Vec2(pocket.center + pocket.radius * Vec2(std::cos(angle), std::sin(angle)));
        };
        for (int i = 0; i < kPieces; ++i) {
            if (!contains(body.points, at(i + 0.5))) continue;
            const Vec2 a = at(i), b = at(i + 1.0);
            builder_.quad({a.x(), a.y(), 0.0}, {b.x(), b.y(), 0.0}, {b.x(), b.y(), top}, {a.x(), a.y(), top},
                          Material::kPocket);
        }
    }

    const Table& table_;
    double R_;
    const std::vector<Vec2>& visited_;
    bool sharp_;
    TableMesh mesh_;
    MeshBuilder builder_;
    std::vector<Chain> bodies_;  // cushions whose back is known
    Box outline_, played_;
    double nose_ = 0.0;
    bool framed_ = false;
};

}  // namespace

TableMesh make_table_mesh(const Table& table, double R, const std::vector<Vec2>& visited, Edges edges) {
    const Table drawn = without_arcs(table);
    return TableMaker(drawn, R, visited, edges).make();
}

}  // namespace carom::render
