// The same shot in a Box2D world.
#include "accuracy/box2d_shot.h"

#include <box2d/box2d.h>

#include <cmath>
#include <cstdint>

namespace carom::tools {
namespace {

/// Box2D units per metre. Its constants suit objects of 0.1 to 10 units: 10 reduces its slop to 0.5 mm, and
/// the speed below which nothing bounces to 0.1 m/s, and still allows a ball 12 m/s at 60 Hz.
constexpr double kScale = 10.0;
constexpr int kVelocityIterations = 8, kPositionIterations = 3;  // as its manual suggests

b2Vec2 to_world(const Vec2& r) {
    return {static_cast<float>(kScale * r.x()), static_cast<float>(kScale * r.y())};
}

/// A fixture's user data: ball number + 1, or 0 for fixed parts.
int ball_of(const b2Fixture* fixture) {
    return static_cast<int>(const_cast<b2Fixture*>(fixture)->GetUserData().pointer) - 1;
}

/// Gives each contact the restitution and friction of its pair, and records the first ball hit.
class Contacts : public b2ContactListener {
  public:
    Contacts(const BallParams& balls, int mover) : balls_(balls), mover_(mover) {}

    void BeginContact(b2Contact* contact) override {
        const int a = ball_of(contact->GetFixtureA()), b = ball_of(contact->GetFixtureB());
        const bool pair = a >= 0 && b >= 0;
        contact->SetRestitution(static_cast<float>(pair ? balls_.e_b : balls_.e_c));
        contact->SetFriction(static_cast<float>(pair ? balls_.mu_b : balls_.f_c));
        if (pair && first_ < 0 && (a == mover_ || b == mover_)) first_ = a == mover_ ? b : a;
    }
    int first() const { return first_; }

  private:
    const BallParams& balls_;
    int mover_, first_ = -1;
};

void add_table(b2World& world, const carom::Table& table) {
    b2BodyDef definition;
    b2Body* ground = world.CreateBody(&definition);
    for (const Cushion& cushion : table.cushions) {
        b2EdgeShape edge;
        edge.SetTwoSided(to_world(cushion.from), to_world(cushion.to));
        ground->CreateFixture(&edge, 0.0F);
    }
    for (const Jaw& jaw : table.jaws) {
        b2CircleShape circle;
        circle.m_p = to_world(jaw.center);
        circle.m_radius = static_cast<float>(kScale * jaw.radius);
        ground->CreateFixture(&circle, 0.0F);
    }
}

b2Body* add_ball(b2World& world, const BallState& state, const BallParams& balls, int number) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = to_world({state.position.x(), state.position.y()});
    definition.linearVelocity = to_world({state.velocity.x(), state.velocity.y()});
    definition.angularVelocity = static_cast<float>(state.spin.z());
    definition.bullet = state.velocity.norm() > 0.0;
    definition.allowSleep = false;  // rest is decided below
    b2CircleShape circle;
    circle.m_radius = static_cast<float>(kScale * balls.R);
    b2FixtureDef fixture;
    fixture.shape = &circle;
    fixture.density = 1.0F;
    fixture.restitutionThreshold = 0.0F;
    fixture.userData.pointer = static_cast<std::uintptr_t>(number) + 1;
    b2Body* body = world.CreateBody(&definition);
    body->CreateFixture(&fixture);
    return body;
}

}  // namespace

Box2dOutcome run_box2d(const Record& record, double hz) {
    b2World world({0.0F, 0.0F});
    add_table(world, record.table);
    std::vector<b2Body*> bodies;
    int mover = -1;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState state = record.state_at(static_cast<int>(i), 0.0);
        bodies.push_back(add_ball(world, state, record.balls, static_cast<int>(i)));
        if (mover < 0 && state.velocity.norm() > 0.0) mover = static_cast<int>(i);
    }
    Contacts contacts(record.balls, mover);
    world.SetContactListener(&contacts);

    Box2dOutcome out;
    out.pockets.assign(bodies.size(), -1);
    const double dt = 1.0 / hz, drop = record.balls.mu_r * record.gravity;  // [s], [m/s^2]
    const double limit = 2.0 * record.duration + 1.0;
    bool moving = mover >= 0;
    long step = 0;
    for (; moving && static_cast<double>(step) * dt < limit; ++step) {
        for (b2Body* body : bodies) {
            const double speed = static_cast<double>(body->GetLinearVelocity().Length()) / kScale;
            if (speed <= drop * dt)
                body->SetLinearVelocity({0.0F, 0.0F});
            else
                body->SetLinearDamping(static_cast<float>(drop / speed));
        }
        world.Step(static_cast<float>(dt), kVelocityIterations, kPositionIterations);
        moving = false;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (out.pockets[i] >= 0) continue;
            const Vec2 r(static_cast<double>(bodies[i]->GetPosition().x) / kScale,
                         static_cast<double>(bodies[i]->GetPosition().y) / kScale);
            for (std::size_t p = 0; p < record.table.pockets.size(); ++p) {
                if ((r - record.table.pockets[p].center).norm() >= record.table.pockets[p].radius) continue;
                out.pockets[i] = static_cast<int>(p);
                bodies[i]->SetEnabled(false);
            }
            if (out.pockets[i] < 0)
                moving = moving ||
                         static_cast<double>(bodies[i]->GetLinearVelocity().Length()) / kScale > drop * dt;
        }
    }
    out.duration = static_cast<double>(step) * dt;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (out.pockets[i] >= 0)
            out.positions.push_back(record.table.pockets[out.pockets[i]].center);
        else
            out.positions.emplace_back(static_cast<double>(bodies[i]->GetPosition().x) / kScale,
                                       static_cast<double>(bodies[i]->GetPosition().y) / kScale);
    }
    if (contacts.first() >= 0) out.first_contact = record.tracks[contacts.first()].id;
    return out;
}

}  // namespace carom::tools
