// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies that fall asleep, and bodies that must not; objects that wake them, and objects that carry them from the first
// frame on.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

constexpr double kFrame = 1.0 / 60;
constexpr int kLongest = 30 * 60;  ///< frames in which bodies must have fallen asleep

BodyOptions sleepingBody() {
  BodyOptions options{300.0};
  options.sleeps = true;
  return options;
}

/// Four steps, after the scene has made its one-time moves.
void frame(MeasuringWorld& world) {
  world.bullet().stepSimulation(static_cast<btScalar>(kFrame), 4, static_cast<btScalar>(kStep));
}

bool sleepAll(const std::vector<SoftObject*>& bodies) {
  for (const SoftObject* body : bodies) {
    if (body->soft().isActive()) return false;
  }
  return true;
}

/// Bodies that come to rest on each other, and everything that carries them.
struct Pile {
  std::vector<SoftObject*> bodies;
  std::vector<const btRigidBody*> supports;
  double carried = 0.0;  ///< mass of the rigid bodies in it
};

/// The largest deviation of a body's force, or of the supports' sum, from the carried weight, divided by the weight of
/// a body.
double forceError(const Pile& pile, const ForceRecord& forces) {
  double error = 0.0, all = pile.carried * scenes::kEarth, weight = 0.0, held = 0.0;
  for (const SoftObject* body : pile.bodies) {
    weight = body->motion().mass * scenes::kEarth;
    all += weight;
    const auto up = static_cast<double>(forces.forcesOn(body->soft()).total().force.y());
    raise(error, std::abs(up - weight) / weight);
  }
  for (const btRigidBody* support : pile.supports) {
    held -= static_cast<double>(forces.forcesOn(*support).total().force.y());
  }
  raise(error, std::abs(held - all) / weight);
  return error;
}

void weigh(Run& run, const std::function<Pile(MeasuringWorld&)>& make) {
  MeasuringWorld world(run);
  const auto forces = std::move(ForceRecord::add(world.bullet()).value());
  const Pile pile = make(world);
  if (run.kind == Kind::Surface) {
    for (SoftObject* body : pile.bodies) world.touchOthers(*body);
  }
  for (int f = 0; f < kLongest && !sleepAll(pile.bodies); ++f) frame(world);
  for (int f = 0; f < 30; ++f) frame(world);
  run.report("asleep", sleepAll(pile.bodies) ? 1.0 : 0.0);
  run.report("force error, weights", forceError(pile, *forces));
}

ModelPtr cube() {
  return makeBox({0.5, 0.5, 0.5});
}

Pile stackOf(MeasuringWorld& world, int count) {
  Pile pile;
  pile.supports.push_back(&world.addFloor());
  for (int k = 0; k < count; ++k) pile.bodies.push_back(&world.addSoftOn(1.003 * k, cube(), sleepingBody()));
  return pile;
}

Pile onFourSupports(MeasuringWorld& world) {
  Pile pile;
  for (const double x : {-0.35, 0.35}) {
    for (const double z : {-0.35, 0.35}) pile.supports.push_back(&world.addBox({x, -0.5, z}, {0.15, 0.5, 0.15}));
  }
  pile.bodies.push_back(&world.addSoftOn(0.0, cube(), sleepingBody()));
  return pile;
}

Pile plankOnTwoCubes(MeasuringWorld& world) {
  Pile pile;
  pile.supports.push_back(&world.addFloor());
  for (const double x : {-1.0, 1.0}) pile.bodies.push_back(&world.addSoftOn(0.0, cube(), sleepingBody(), x));
  pile.bodies.push_back(&world.addSoftOn(1.003, makeBox({1.5, 0.1, 0.3}), sleepingBody()));
  return pile;
}

Pile rigidBetween(MeasuringWorld& world) {
  Pile pile;
  pile.supports.push_back(&world.addFloor());
  pile.bodies.push_back(&world.addSoftOn(0.0, cube(), sleepingBody()));
  pile.carried = 1.0;
  world.addBox({0, 1.105, 0}, {0.4, 0.1, 0.4}, pile.carried).forceActivationState(ACTIVE_TAG);
  pile.bodies.push_back(&world.addSoftOn(1.21, cube(), sleepingBody()));
  return pile;
}

/// A ball that nothing touches: its way in five seconds over that of a point.
void fly(Run& run, double gravity, double speed) {
  MeasuringWorld world(run, Vector3d(0, -gravity, 0));
  SoftObject& ball = world.addSoft(makeBall(), sleepingBody(), Vector3d(0, 0, 0));
  ball.push(Vector3d(speed, 0, 0));
  for (int f = 0; f < 300; ++f) frame(world);
  const Vector3d way = ball.motion().centroid;
  run.report("way over a point's", speed > 0.0 ? way.x() / (5 * speed) : -way.y() / (gravity * 25 / 2));
}

/// A cube that sleeps on a kinematic plate, 1 m from its axis.
struct SleeperOnPlate {
  explicit SleeperOnPlate(Run& run) : world(run) {
    for (int f = 0; f < kLongest && !sleepAll({&body}); ++f) frame(world);
  }
  double gap() {
    const auto y = static_cast<double>(plate.getWorldTransform().getOrigin().y());
    return body.gap([&](const Vector3d& p) { return p.y() - y - 0.2; });
  }

  MeasuringWorld world;
  btRigidBody& plate = MeasuringWorld::makeKinematic(world.addBox({0, -0.2, 0}, {3, 0.2, 3}));
  SoftObject& body = world.addSoftOn(0.0, cube(), sleepingBody(), 1.0);
};

/// How far a body stays behind until friction has given it the speed of what carries it.
double takenUp(double speed) {
  constexpr double kFriction = 0.5;
  return speed * speed / (2 * kFriction * scenes::kEarth);
}

/// The plate is moved once per frame, for two seconds.
void lift(Run& run, const Vector3d& velocity) {
  SleeperOnPlate sleeper(run);
  const double before = sleeper.gap();
  const Vector3d from = sleeper.body.motion().centroid;
  double change = 0.0;
  for (int f = 1; f <= 120; ++f) {
    const Vector3d at = Vector3d(0, -0.2, 0) + f * kFrame * velocity;
    sleeper.plate.setWorldTransform(btTransform(btQuaternion::getIdentity(), toBullet(at)));
    frame(sleeper.world);
    if (f > 30) raise(change, std::abs(sleeper.gap() - before));
  }
  run.report("gap's change, S", change);
  const Vector3d moved = sleeper.body.motion().centroid - from;
  const bool isLevel = velocity.y() == 0.0;
  run.report("way over the plate's",
             moved.dot(velocity.normalized()) / (2 * velocity.norm() - (isLevel ? takenUp(velocity.norm()) : 0.0)));
}

void turn(Run& run, double rate) {
  SleeperOnPlate sleeper(run);
  const Vector3d from = sleeper.body.motion().centroid;
  for (int f = 1; f <= 120; ++f) {
    const btQuaternion turned(btVector3(0, 1, 0), static_cast<btScalar>(f * kFrame * rate));
    sleeper.plate.setWorldTransform(btTransform(turned, btVector3(0, btScalar(-0.2), 0)));
    frame(sleeper.world);
  }
  const Vector3d to = sleeper.body.motion().centroid;
  const double angle = std::atan2(-to.z(), to.x()) - std::atan2(-from.z(), from.x());
  run.report("way over the plate's", angle / (2 * rate - takenUp(rate)));
}

void wake(Run& run, const std::function<void(MeasuringWorld&, btSoftBody&)>& change) {
  SleeperOnPlate sleeper(run);
  const bool slept = sleepAll({&sleeper.body});
  change(sleeper.world, sleeper.body.soft());
  frame(sleeper.world);
  run.report("asleep before, awake after", slept && sleeper.body.soft().isActive() ? 1.0 : 0.0);
}

}  // namespace

void addSleepScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, std::function<void(Run&)> scene) {
    scenes.push_back({"sleep/" + name, std::move(scene), {Kind::Surface, Kind::Nodes}});
  };
  const auto addPile = [&](const std::string& name, const std::function<Pile(MeasuringWorld&)>& make) {
    add("forces/" + name, [=](Run& run) { weigh(run, make); });
  };
  addPile("cube", [](MeasuringWorld& world) { return stackOf(world, 1); });
  addPile("four supports", onFourSupports);
  addPile("rigid between", rigidBetween);
  // With contact at nodes, soft bodies do not collide.
  const auto addSoftPile = [&](const std::string& name, const std::function<Pile(MeasuringWorld&)>& make) {
    scenes.push_back({"sleep/forces/" + name, [=](Run& run) { weigh(run, make); }, {Kind::Surface}});
  };
  addSoftPile("stack of five", [](MeasuringWorld& world) { return stackOf(world, 5); });
  addSoftPile("plank on two cubes", plankOnTwoCubes);

  add("flight/drifts at 0.03", [](Run& run) { fly(run, 0.0, 0.03); });
  add("flight/falls at 0.01", [](Run& run) { fly(run, 0.01, 0.0); });
  for (const double v : {0.5, 2.0, -1.0}) {
    add("carried/lift " + text(v), [=](Run& run) { lift(run, Vector3d(0, v, 0)); });
  }
  for (const double v : {0.005, 0.2}) {
    add("carried/belt " + text(v), [=](Run& run) { lift(run, Vector3d(v, 0, 0)); });
  }
  for (const double w : {0.02, 0.05, 0.5}) add("carried/turntable " + text(w), [=](Run& run) { turn(run, w); });

  using Change = std::function<void(MeasuringWorld&, btSoftBody&)>;
  const auto addWaking = [&](const std::string& name, const Change& change) {
    add("woken/" + name, [=](Run& run) { wake(run, change); });
  };
  const btVector3 up(0, btScalar(0.1), 0);
  addWaking("setVelocity", [=](MeasuringWorld&, btSoftBody& body) { body.setVelocity(up); });
  addWaking("addVelocity", [=](MeasuringWorld&, btSoftBody& body) { body.addVelocity(up); });
  addWaking("a node's velocity", [=](MeasuringWorld&, btSoftBody& body) { body.m_nodes[0].m_v = up; });
  addWaking("translate", [=](MeasuringWorld&, btSoftBody& body) { body.translate(up); });
  addWaking("rotate",
            [](MeasuringWorld&, btSoftBody& body) { body.rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.1))); });
  addWaking("mass", [](MeasuringWorld&, btSoftBody& body) { body.setTotalMass(10 * body.getTotalMass()); });
  addWaking("gravity", [](MeasuringWorld& world, btSoftBody&) { world.setGravity(Vector3d(0, -1, 0)); });
}

}  // namespace tetskin::contact_demo
