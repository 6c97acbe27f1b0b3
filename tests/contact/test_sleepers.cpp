// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Events that wake a sleeping body, and events that do not: contact by nodes, by the surface, and with other soft
// bodies.
#include "contact_test.h"
#include "soft_fixtures.h"

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <tetskin/solver/deformable_world.h>

#include <optional>
#include <utility>

namespace tetskin::test {
namespace {

enum class TouchedBy { Nodes, Surface };

/// Steps until all bodies sleep; fails if one does not.
void letSleep(EmptyWorld& world, const std::vector<btSoftBody*>& bodies, int frames = 900) {
  const auto anyAwake = [&] {
    return std::any_of(bodies.begin(), bodies.end(), [](const btSoftBody* body) { return body->isActive(); });
  };
  std::vector<btScalar> thresholds;
  for (const btSoftBody* body : bodies) thresholds.push_back(body->m_sleepingThreshold);
  for (int f = 0; f < frames && anyAwake(); ++f) {
    for (btSoftBody* body : bodies) {
      if (f == 90) body->m_sleepingThreshold = 1;  // so that the test need not wait for the last rocking motion to stop
    }
    step(world, 1);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b]->m_sleepingThreshold = thresholds[b];
    ASSERT_FALSE(bodies[b]->isActive()) << "body " << b;
  }
}

void makeKinematic(btRigidBody& body) {
  body.setCollisionFlags((body.getCollisionFlags() & ~btCollisionObject::CF_STATIC_OBJECT) |
                         btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
}

void moveTo(btRigidBody& body, const btVector3& at) {
  btTransform position = body.getWorldTransform();
  position.setOrigin(at);
  body.setWorldTransform(position);
}

/// A body asleep on a platform high above the floor.
class Sleepers : public testing::TestWithParam<TouchedBy> {
 protected:
  void SetUp() override { rest(btVector3(0, 0, 0)); }

  void rest(const btVector3& at) {
    platform.emplace(world, std::make_unique<btBoxShape>(btVector3(2, 1, 2)), placeAt(at + btVector3(0, 4, 0)));
    makeKinematic(platform->body());
    const bool nodes = GetParam() == TouchedBy::Nodes;
    body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35),
                                          at + btVector3(0, nodes ? btScalar(5.52) : btScalar(5.37), 0));
    if (nodes) body->contact.reset();
    letSleep(world, {&soft()});
  }
  btSoftBody& soft() { return body->body->body(); }
  btRigidBody& rigid() { return platform->body(); }
  /// The height of the surface above the platform.
  double gap() { return body->height() - static_cast<double>(rigid().getWorldTransform().getOrigin().y()) - 1; }

  TetskinWorld world;
  std::optional<Obstacle> platform;
  std::unique_ptr<TouchingBody> body;
};

TEST_P(Sleepers, SleepOnAKinematicBodyThatStands) {
  const std::vector<Eigen::Vector3d> before = body->surface();
  step(world, 240);
  EXPECT_FALSE(soft().isActive());
  EXPECT_EQ(body->surface(), before);
}

TEST_P(Sleepers, AreLiftedAndLoweredAtAnySpeed) {
  const double before = gap();
  for (const btScalar speed : {btScalar(0.5), btScalar(-0.5), btScalar(0.01), btScalar(-0.01)}) {
    const btVector3 from = rigid().getWorldTransform().getOrigin();
    for (int f = 1; f <= 180; ++f) {
      moveTo(rigid(), from + btVector3(0, speed * f / 60, 0));
      step(world, 1);
      ASSERT_NEAR(gap(), before, 0.008) << "frame " << f << " at " << speed << " m/s";
    }
    letSleep(world, {&soft()});
  }
}

TEST_P(Sleepers, ArePushedByAKinematicBody) {
  Obstacle pusher(world, std::make_unique<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.5), 1)),
                  placeAt(btVector3(-3, btScalar(5.6), 0)));
  makeKinematic(pusher.body());
  step(world, 60);
  ASSERT_FALSE(soft().isActive()) << "it was far away";
  for (int f = 1; f <= 180; ++f) {
    moveTo(pusher.body(), btVector3(-3 + btScalar(f) / 60, btScalar(5.6), 0));
    step(world, 1);
  }
  EXPECT_GT(centreOf(soft()).x(), 0.45);
}

TEST_P(Sleepers, AreNotWokenByTriggersNorByWhatTheyDoNotMeet) {
  Obstacle trigger(world, std::make_unique<btBoxShape>(btVector3(1, 1, 1)), placeAt(btVector3(-3, 5, 0)));
  makeKinematic(trigger.body());
  trigger.body().setCollisionFlags(trigger.body().getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  Obstacle stranger(world, std::make_unique<btBoxShape>(btVector3(1, 1, 1)), placeAt(btVector3(-3, 5, 0)));
  makeKinematic(stranger.body());
  soft().setIgnoreCollisionCheck(&stranger.body(), true);
  Obstacle neighbour(world, std::make_unique<btBoxShape>(btVector3(1, 1, 1)), placeAt(btVector3(-3, 8, 0)));
  makeKinematic(neighbour.body());
  btBoxShape zone(btVector3(1, 1, 1));
  btPairCachingGhostObject ghost;
  ghost.setCollisionShape(&zone);
  ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
  ghost.setWorldTransform(placeAt(btVector3(-3, 5, 0)));
  world.deformable().addCollisionObject(&ghost);
  for (int f = 1; f <= 120; ++f) {
    const btScalar x = -3 + btScalar(f) / 20;
    for (btRigidBody* moving : {&trigger.body(), &stranger.body()}) moveTo(*moving, btVector3(x, 5, 0));
    moveTo(neighbour.body(), btVector3(x, 8, 0));
    ghost.setWorldTransform(placeAt(btVector3(x, 5, 0)));
    step(world, 1);
    ASSERT_FALSE(soft().isActive()) << "frame " << f;
  }
  world.deformable().removeCollisionObject(&ghost);
  soft().setIgnoreCollisionCheck(&stranger.body(), false);
}

/// Bodies that are put to sleep as they are added, as in a saved state or a scene.
TEST_P(Sleepers, SleepOnWhereTheyWereAddedAsleep) {
  const std::vector<Eigen::Vector3d> before = body->surface();
  TouchingBody added(world, ballMesh(12, 0.35), btVector3(10, btScalar(0.36), 0));
  if (GetParam() == TouchedBy::Nodes) added.contact.reset();
  added.body->body().forceActivationState(ISLAND_SLEEPING);
  step(world, 20);
  EXPECT_FALSE(added.body->body().isActive());
  EXPECT_FALSE(soft().isActive());
  EXPECT_EQ(body->surface(), before);
}

TEST_P(Sleepers, FallAsleepFarFromTheOrigin) {
  for (const btScalar far : {btScalar(1000), btScalar(10000)}) {
    body.reset();
    platform.reset();
    platform.emplace(world, std::make_unique<btBoxShape>(btVector3(5, 1, 5)), placeAt(btVector3(far, 4, far)));
    body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35), btVector3(far, btScalar(5.6), far));
    if (GetParam() == TouchedBy::Nodes) body->contact.reset();
    step(world, 480);
    EXPECT_FALSE(soft().isActive()) << far;
  }
}

// ---- what falls asleep

TEST_P(Sleepers, FallAsleepAtRestAloneNotInFreeFlight) {
  for (const btScalar gravity : {btScalar(0), btScalar(0.01)}) {
    const btScalar speed = gravity > 0 ? btScalar(0) : btScalar(0.03);
    const auto empty = worldWith(btVector3(0, -gravity, 0));
    TouchingBody flying(*empty, ballMesh(12, 0.35), btVector3(0, 20, 0));
    if (GetParam() == TouchedBy::Nodes) flying.contact.reset();
    flying.body->body().setVelocity(btVector3(speed, 0, 0));
    step(*empty, 300);
    const btVector3 moved = centreOf(flying.body->body()) - btVector3(0, 20, 0);
    EXPECT_NEAR(moved.x(), 5 * speed, 0.001);
    EXPECT_NEAR(moved.y(), -gravity * 25 / 2, 0.002);
    EXPECT_TRUE(flying.body->body().isActive()) << gravity;
  }
}

TEST_P(Sleepers, AreWokenByWhatTheApplicationDoesToThem) {
  DeformableBody& deformable = *body->body;
  const btVector3 gravity = world.deformable().getGravity();
  const auto changes = std::vector<std::pair<const char*, std::function<void(btSoftBody&)>>>{
      {"setVelocity", [](btSoftBody& b) { b.setVelocity(btVector3(0, 1, 0)); }},
      {"addVelocity", [](btSoftBody& b) { b.addVelocity(btVector3(0, 1, 0)); }},
      {"a node's velocity", [](btSoftBody& b) { b.m_nodes[7].m_v.setY(1); }},
      {"setLinearVelocity", [](btSoftBody& b) { b.setLinearVelocity(btVector3(0, 1, 0)); }},
      {"translate", [](btSoftBody& b) { b.translate(btVector3(0, btScalar(0.001), 0)); }},
      {"rotate", [](btSoftBody& b) { b.rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.01))); }},
      {"a node's position", [](btSoftBody& b) { b.m_nodes[7].m_x.setY(b.m_nodes[7].m_x.y() + btScalar(0.01)); }},
      {"ten times the mass", [](btSoftBody& b) { b.setTotalMass(10 * b.getTotalMass()); }},
      {"a node's mass", [](btSoftBody& b) { b.m_nodes[7].m_im /= 2; }},
      {"friction", [](btSoftBody& b) { b.m_cfg.kDF /= 2; }},
      {"the platform's friction", [&](btSoftBody&) { rigid().setFriction(btScalar(0.3)); }},
      {"gravity", [&](btSoftBody&) { world.deformable().setGravity(gravity / 2); }},
      {"the world's gravity back", [&](btSoftBody&) { world.deformable().setGravity(gravity); }},
      {"stiffness", [&](btSoftBody&) { (void)deformable.setYoungsModulus(deformable.youngsModulus() * 2); }}};
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    soft().forceActivationState(ISLAND_SLEEPING);
    step(world, 2);
    ASSERT_FALSE(soft().isActive());
    change(soft());
    step(world, 1);
    EXPECT_TRUE(soft().isActive());
  }
}

TEST_P(Sleepers, MoveAsTheyAreToldTo) {
  const btScalar before = centreOf(soft()).y();
  soft().setVelocity(btVector3(0, 2, 0));
  step(world, 6);
  EXPECT_NEAR(centreOf(soft()).y() - before, 0.2 - 0.05, 0.02);
  letSleep(world, {&soft()});
  soft().translate(btVector3(0, 1, 0));
  step(world, 15);
  EXPECT_LT(centreOf(soft()).y(), before + btScalar(0.8));
}

// ---- their weight

TEST_P(Sleepers, KeepTheForcesThatWereReadBefore) {
  const auto forces = std::move(ForceRecord::add(world.deformable()).value());
  soft().activate();
  btVector3 before(0, 0, 0), contacts(0, 0, 0);
  const auto pushed = [&] {
    btVector3 sum(0, 0, 0);
    for (const auto& contact : body->contact->contacts()) sum += contact.impulse;
    return sum;
  };
  for (int f = 0; f < 900 && soft().isActive(); ++f) {
    before = forces->forcesOn(soft()).total().force;
    if (body->contact) contacts = pushed();
    if (f == 90) soft().m_sleepingThreshold = 1;
    step(world, 1);
  }
  ASSERT_FALSE(soft().isActive());
  step(world, 20);
  const btVector3 asleep = forces->forcesOn(soft()).total().force;
  const btScalar weight = soft().getTotalMass() * world.deformable().getGravity().length();
  EXPECT_LT((asleep - before).length(), btScalar(0.02) * weight);
  if (!body->contact) return;
  EXPECT_NEAR(pushed().y(), contacts.y(), 0.05 * contacts.y());
  EXPECT_GT(pushed().y(), 0);
}

// ---- what carries them

/// How far a sleeping body gets in two seconds on a platform that is moved once per frame, or once per step: along the
/// motion, as it may still rock after it has been woken.
TEST_P(Sleepers, AreCarriedFromTheFirstFrameByWhatIsMovedOncePerFrame) {
  const std::vector<std::pair<btVector3, btScalar>> motions = {{btVector3(0, 2, 0), btScalar(0)},
                                                               {btVector3(0, -1, 0), btScalar(0)},
                                                               {btVector3(btScalar(0.005), 0, 0), btScalar(0)},
                                                               {btVector3(0, 0, 0), btScalar(0.02)},
                                                               {btVector3(0, 0, 0), btScalar(0.5)}};
  for (const auto& [velocity, rate] : motions) {
    SCOPED_TRACE(velocity.y() + rate);
    double ways[2] = {0, 0}, gaps[2] = {0, 0};
    for (const int perFrame : {1, 4}) {
      body.reset();
      platform.reset();
      rest(btVector3(0, 0, 0));
      soft().m_cfg.kDF = 1;
      const btVector3 from = rigid().getWorldTransform().getOrigin() + btVector3(btScalar(0.8), 0, 0);
      moveTo(rigid(), from);
      rigid().setInterpolationWorldTransform(rigid().getWorldTransform());
      letSleep(world, {&soft()});
      const auto place = [&, speed = velocity, turns = rate != 0] {
        const btVector3 arm = centreOf(soft()) - from;
        return static_cast<double>(turns ? std::atan2(arm.z(), -arm.x()) : arm.dot(speed.normalized()));
      };
      const double start = place();
      for (int f = 1; f <= 120; ++f) {
        for (int k = 1; k <= perFrame; ++k) {
          const btScalar t = btScalar(f - 1) / 60 + btScalar(k) / (60 * btScalar(perFrame));
          rigid().setWorldTransform(placeAt(from + velocity * t, btQuaternion(btVector3(0, 1, 0), rate * t)));
          world.deformable().stepSimulation(btScalar(1) / (60 * btScalar(perFrame)), 4, btScalar(1) / 240);
        }
      }
      ways[perFrame / 4] = place() - start;
      gaps[perFrame / 4] = gap();
    }
    // Moved once per frame, the platform starts within a frame, and not at once: otherwise round bodies start to roll.
    EXPECT_NEAR(ways[0], ways[1], 0.2 * static_cast<double>(velocity.length() + rate));
    EXPECT_NEAR(gaps[0], gaps[1], 0.0005);
  }
}

INSTANTIATE_TEST_SUITE_P(By, Sleepers, testing::Values(TouchedBy::Nodes, TouchedBy::Surface),
                         [](const auto& by) { return by.param == TouchedBy::Nodes ? "Nodes" : "Surface"; });

/// Two plates, one on the other; the lower one lies on a platform.
struct SoftPile {
  explicit SoftPile(const Eigen::Vector3d& at = {0, 0, 0})
      : platform(*world, std::make_unique<btBoxShape>(btVector3(2, 1, 2)), placeAt(toBullet(at) + btVector3(0, 4, 0))) {
    makeKinematic(platform.body());
    SoftBodyOptions options;
    options.youngsModulus = 3000.0;
    options.margin = 0.002;
    for (int k = 0; k < 2; ++k) {
      TetMesh cage = shifted(plate().cage, at + Eigen::Vector3d(-0.5, 5.01 + 0.125 * k, -0.5));
      bodies.push_back(added(*world, cage, options));
      EXPECT_TRUE(contacts->add(bodies.back()->body(), plate().shape).ok());
    }
  }
  void sleep() { letSleep(*world, {&bodies[0]->body(), &bodies[1]->body()}); }
  bool asleep() const { return !bodies[0]->body().isActive() && !bodies[1]->body().isActive(); }

  std::unique_ptr<TetskinWorld> world = worldWith(btVector3(0, -10, 0));
  Obstacle platform;
  std::unique_ptr<SoftContacts> contacts = contactsIn(*world);
  std::vector<std::unique_ptr<DeformableBody>> bodies;
};

TEST(SleepersOnSoftBodies, FallWhereTheLowerOneIsTakenAway) {
  SoftPile pile;
  pile.sleep();
  const btScalar before = centreOf(pile.bodies[1]->body()).y();
  pile.bodies[0].reset();
  step(*pile.world, 30);
  EXPECT_LT(centreOf(pile.bodies[1]->body()).y(), before - btScalar(0.05));
}

TEST(SleepersOnSoftBodies, AreLiftedTogether) {
  for (const btScalar speed : {btScalar(0.5), btScalar(0.01)}) {
    SoftPile pile;
    pile.sleep();
    const btScalar before = centreOf(pile.bodies[1]->body()).y();
    for (int f = 1; f <= 120; ++f) {
      moveTo(pile.platform.body(), btVector3(0, 4 + speed * f / 60, 0));
      step(*pile.world, 1);
    }
    EXPECT_NEAR(centreOf(pile.bodies[1]->body()).y() - before, 2 * speed, 0.02);
  }
}

/// In whatever order bodies come to rest, they fall asleep together, and their reported forces stay.
TEST(SleepersOnSoftBodies, KeepTheForcesThatWereReadBefore) {
  for (const int substeps : {1, 4}) {
    SoftPile pile;
    const auto forces = std::move(ForceRecord::add(pile.world->deformable()).value());
    btSoftBody &lower = pile.bodies[0]->body(), &upper = pile.bodies[1]->body();
    const auto pushes = [&] {
      btScalar sum = 0;
      for (const SoftContact& contact : pile.contacts->contacts()) sum += contact.impulse;
      return sum;
    };
    btScalar before = 0;
    for (int f = 0; f < 1200 && lower.isActive() && upper.isActive(); ++f) {
      before = pushes();
      if (f == 90) lower.m_sleepingThreshold = 1;
      if (f == 120) upper.m_sleepingThreshold = 1;
      pile.world->deformable().stepSimulation(btScalar(1) / 60, substeps, btScalar(1) / (60 * btScalar(substeps)));
    }
    ASSERT_TRUE(pile.asleep()) << "both in one step";
    for (int f = 0; f < 10; ++f) step(*pile.world, 1);
    ASSERT_TRUE(pile.asleep());
    const btScalar weight = lower.getTotalMass() * 10;
    EXPECT_NEAR(forces->forcesOn(lower).total().force.y(), weight, 0.02 * weight) << substeps;
    EXPECT_NEAR(forces->forcesOn(upper).total().force.y(), weight, 0.02 * weight) << substeps;
    EXPECT_NEAR(-forces->forcesOn(pile.platform.body()).total().force.y(), 2 * weight, 0.03 * weight) << substeps;
    EXPECT_GT(pushes(), 0);
    EXPECT_NEAR(pushes(), before, 0.1 * before);
  }
}

TEST(SleepersOnSoftBodies, FallAsleepFarFromTheOrigin) {
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(3000, 0, 3000), Eigen::Vector3d(10000, 0, 10000), Eigen::Vector3d(0, 10000, 0)}) {
    SoftPile pile(at);
    step(*pile.world, 200);
    EXPECT_TRUE(pile.asleep()) << at.transpose();
  }
}

/// The time until all sleep, in seconds; `most` if some do not.
double secondsUntilAsleep(EmptyWorld& world, const std::vector<btSoftBody*>& bodies, int most) {
  for (int f = 0; f < 60 * most; ++f) {
    if (std::none_of(bodies.begin(), bodies.end(), [](const btSoftBody* b) { return b->isActive(); })) return f / 60.0;
    step(world, 1);
  }
  return most;
}

/// Soft cubes of 0.4 m, which lean and sway for longer than they are watched.
TEST(SleepersOnSoftBodies, ComeToRestInTowersThatSway) {
  const double side = 0.4;
  const TetMesh cage = shifted(latticeCage(3, 3, 3, side / 3), Eigen::Vector3d(-side / 2, 0, -side / 2));
  const TriangleMesh mesh = [&] {
    TriangleMesh box = boxMesh(Eigen::Vector3d::Constant(side / 2));
    for (Eigen::Vector3d& p : box.positions) p.y() += side / 2;
    return box;
  }();
  const auto shape = std::move(ContactShape::create(cage, mesh)).value();
  for (const auto& [count, stiffness] : {std::pair(4, 5e5), std::pair(8, 5e5), std::pair(8, 2e6)}) {
    const auto world = worldWith(btVector3(0, btScalar(-9.81), 0));
    Obstacle floor(*world, std::make_unique<btBoxShape>(btVector3(2, 1, 2)), placeAt(btVector3(0, -1, 0)));
    const auto contacts = contactsIn(*world);
    const auto forces = std::move(ForceRecord::add(world->deformable()).value());
    std::vector<std::unique_ptr<DeformableBody>> made;
    std::vector<btSoftBody*> bodies;
    for (int k = 0; k < count; ++k) {
      SoftBodyOptions options;
      options.youngsModulus = stiffness;
      options.mass = 100 * side * side * side;
      const Eigen::Vector3d at(k % 2 ? 0.004 : 0.0, 0.002 + 1.005 * side * k, k % 3 ? 0.003 : 0.0);
      made.push_back(added(*world, shifted(cage, at), options));
      bodies.push_back(&made.back()->body());
      ASSERT_TRUE(contacts->add(*bodies.back(), shape).ok());
    }
    EXPECT_LT(secondsUntilAsleep(*world, bodies, 12), count == 4 ? 2.0 : 6.0) << count << ' ' << stiffness;
    const double weight = 9.81 * 100 * side * side * side;
    for (const btSoftBody* body : bodies) {
      EXPECT_NEAR(static_cast<double>(forces->forcesOn(*body).total().force.y()) / weight, 1.0, 0.005);
    }
    const std::vector<btVector3> asleep = nodesOf(*bodies.back());
    for (btSoftBody* body : bodies) body->setActivationState(DISABLE_DEACTIVATION);
    step(*world, 180);
    const std::vector<btVector3> later = nodesOf(*bodies.back());
    for (std::size_t n = 0; n < later.size(); ++n) {
      ASSERT_LT((later[n] - asleep[n]).length(), 0.02 * side) << count << ' ' << stiffness << ": would have moved on";
    }
  }
}

/// A ball rocks for many seconds, by less and less.
TEST(SleepersOnSoftBodies, NeedNotWaitForTheLastRockingOfABall) {
  TetskinWorld world;
  TouchingBody ball(world, ballMesh(12, 0.35), btVector3(0, btScalar(0.6), 0));
  btSoftBody& body = ball.body->body();
  body.setVelocity(btVector3(btScalar(0.2), 0, 0));
  EXPECT_LT(secondsUntilAsleep(world, {&body}, 20), 6.0);
  const std::vector<btVector3> asleep = nodesOf(body);
  body.setActivationState(DISABLE_DEACTIVATION);
  step(world, 240);
  const std::vector<btVector3> later = nodesOf(body);
  for (std::size_t n = 0; n < later.size(); ++n) {
    ASSERT_LT((later[n] - asleep[n]).length(), 0.01) << "would have moved on";
  }
}

}  // namespace
}  // namespace tetskin::test
