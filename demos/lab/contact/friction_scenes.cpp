// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Rolling, sliding, sticking, compared with the analytic motion of a point mass or a rigid ball.
#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "scenes/input_error.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

/// Gravity on a slope that falls towards +x. The slope itself stays level in the world, so it is exact.
Vector3d gravityOn(double slope) {
  return scenes::kEarth * Vector3d(std::sin(slope), -std::cos(slope), 0);
}

ModelPtr flatBox(int divisions = 16, Copies copies = {}) {
  return makeBox({0.5, 0.25, 0.5}, divisions, copies);
}

struct Rolling {
  double stiffness = 300.0, damping = 0.02, step = kStep, tolerance = 5e-3;
  std::size_t tets = 1000;
};

struct Rolled {
  double overRigid = 0.0;  ///< acceleration, relative to that of a rigid body with the same inertia
  double overBall = 0.0;   ///< acceleration, relative to that of a homogeneous ball
};

/// A ball that has come to rest rolls down a slope of 10 degrees, until it reaches 1 m/s.
Rolled roll(Run& run, const Rolling& rolling) {
  constexpr double kSlope = 10.0 * EIGEN_PI / 180, kRadius = 0.5, kFrom = 0.1, kUntil = 2.5, kSpeed = 1.0;
  MeasuringWorld world(run, gravityOn(0.0));
  world.addFloor();
  BodyOptions options = BodyOptions{rolling.stiffness, 0.8};
  options.damping = 0.05;
  options.tolerance = rolling.tolerance;
  SoftObject& ball = world.addSoftOn(0.0, makeBall(rolling.tets), options, -2.0);
  const double inertia = ball.motion().inertia(2, 2);
  world.simulate(1);
  scenes::require(ball.deformable().setStiffnessDamping(rolling.damping));
  world.setGravity(gravityOn(kSlope));
  double time = 0.0, firstTime = 0.0, firstSpeed = 0.0, speed = 0.0;
  while (time < kUntil && speed < kSpeed) {
    world.step(rolling.step);
    time += rolling.step;
    speed = ball.motion().velocity.x();
    if (time > kFrom && firstTime == 0.0) {
      firstTime = time;
      firstSpeed = speed;
    }
  }
  const double acceleration = (speed - firstSpeed) / (time - firstTime), pull = gravityOn(kSlope).x();
  return {acceleration / (pull / (1.0 + inertia / (kRadius * kRadius))), acceleration / (pull / 1.4)};
}

void rollUndamped(Run& run, double stiffness) {
  Rolling rolling;
  rolling.stiffness = stiffness;
  rolling.damping = 0.0;
  rolling.step = 1.0 / 960;
  const Rolled rolled = roll(run, rolling);
  run.report("acceleration over rigid", rolled.overRigid);
  run.report("over g sin / (1 + 2/5)", rolled.overBall);
}

void rollAsIs(Run& run, double stiffness) {
  Rolling rolling, fine;
  rolling.stiffness = fine.stiffness = stiffness;
  fine.tets = 10000;
  fine.step = 1.0 / 960;
  fine.tolerance = 5e-4;
  const double coarse = roll(run, rolling).overRigid;
  run.report("acceleration over rigid", coarse);
  Run ofFine(run.kind);
  const double reference = roll(ofFine, fine).overRigid;
  run.report("the same with 10,000 tets", reference);
  run.report("ratio of the two", coarse / reference);
}

constexpr double kTableSpin = 1.8;

/// A turntable that keeps its angle.
class Turntable {
 public:
  explicit Turntable(MeasuringWorld& world)
      : world_(world),
        table_(world.makeKinematic(
            world.addRigid(std::make_unique<btCylinderShape>(btVector3(4, btScalar(0.5), 4)), turned(0.0)))) {}

  void simulate(double seconds, const std::function<void()>& after = {}) {
    const auto steps = std::lround(seconds / kStep);
    for (long k = 0; k < steps; ++k) {
      angle_ += kTableSpin * kStep;
      table_.setWorldTransform(turned(angle_));
      world_.step();
      if (after) after();
    }
  }
  /// A point in the frame of the table.
  Vector3d toTable(const Vector3d& p) const { return Eigen::AngleAxisd(-angle_, Vector3d::UnitY()) * p; }

 private:
  static btTransform turned(double angle) {
    return btTransform(btQuaternion(btVector3(0, 1, 0), static_cast<btScalar>(angle)), btVector3(0, btScalar(-0.5), 0));
  }

  MeasuringWorld& world_;
  btRigidBody& table_;
  double angle_ = 0.0;
};

constexpr double kRiderSize = 0.5;

SoftObject& addRider(MeasuringWorld& world, double stiffness, double friction, double radius) {
  return world.addSoftOn(0.0, makeBox(Vector3d(0.25, 0.125, 0.25)), BodyOptions{stiffness, friction}, radius);
}

/// A box rides on the table at 2 m from the axis; this needs a friction coefficient of 0.66.
void ride(Run& run, double stiffness, double friction) {
  constexpr double kRadius = 2.0;
  MeasuringWorld world(run);
  Turntable table(world);
  SoftObject& rider = addRider(world, stiffness, friction, kRadius);
  rider.push(Vector3d(0, 0, -kTableSpin * kRadius), Vector3d(0, kTableSpin, 0));
  table.simulate(1);
  const Vector3d before = table.toTable(rider.motion().centroid);
  table.simulate(3);
  run.report("drift in 3 s, S", (table.toTable(rider.motion().centroid) - before).norm() / kRiderSize);
}

/// A box at rest in the middle of the table is taken along.
void turnAlong(Run& run, double stiffness) {
  MeasuringWorld world(run);
  Turntable table(world);
  SoftObject& rider = addRider(world, stiffness, 0.8, 0.0);
  table.simulate(2);
  double spin = 0.0;
  int steps = 0;
  table.simulate(1, [&] {
    spin += rider.motion().spin.y();
    ++steps;
  });
  run.report("spin over the table's", spin / steps / kTableSpin);
}

/// The lowest vertices of a surface, which lie on the floor.
std::vector<std::size_t> touching(const std::vector<Vector3d>& surface) {
  constexpr double kNear = 0.002;
  double lowest = HUGE_VAL;
  for (const Vector3d& p : surface) lower(lowest, p.y());
  std::vector<std::size_t> vertices;
  for (std::size_t v = 0; v < surface.size(); ++v) {
    if (!(surface[v].y() > lowest + kNear)) vertices.push_back(v);
  }
  return vertices;
}

/// A box on a slope whose downhill force is 2.5 % below the limit of friction.
void creep(Run& run, double stiffness) {
  constexpr double kFriction = 0.5, kFraction = 0.975;
  MeasuringWorld world(run, gravityOn(std::atan(kFraction * kFriction)));
  world.addFloor();
  SoftObject& box = world.addSoftOn(0.0, flatBox(), BodyOptions{stiffness, kFriction});
  world.simulate(1);
  const std::vector<Vector3d> before = box.surface();
  world.simulate(5);
  const std::vector<Vector3d> after = box.surface();
  double largest = 0.0;
  for (const std::size_t v : touching(before)) raise(largest, (after[v] - before[v]).norm());
  run.report("contact points move in 5 s, S", largest);
}

/// Lengths of steps, used in turn.
using Steps = std::function<double()>;

/// A box at rest is pushed to 3 m/s. Measures how far it slides, relative to a point mass with the same steps.
double slide(Run& run, const ModelPtr& model, BodyOptions options, const Steps& steps) {
  constexpr double kFriction = 0.5, kSpeed = 3.0, kSeconds = 1.5;
  options.friction = kFriction;
  MeasuringWorld world(run);
  world.addFloor();
  SoftObject& box = world.addSoftOn(0.0, model, options);
  world.simulate(1);
  const double from = box.motion().centroid.x();
  box.push(Vector3d(kSpeed, 0, 0));
  double time = 0.0, speed = kSpeed, point = 0.0;
  while (time < kSeconds) {
    const double step = steps();
    world.step(step);
    time += step;
    // Implicit Euler stops earlier than v^2 / (2 mu g), by the fraction mu g dt / v of it.
    speed = std::max(0.0, speed - kFriction * scenes::kEarth * step);
    point += speed * step;
  }
  return (box.motion().centroid.x() - from) / point;
}

Steps equalSteps() {
  return [] { return kStep; };
}

Steps alternatingSteps() {
  return [odd = false]() mutable {
    odd = !odd;
    return odd ? 1.0 / 500 : 1.0 / 60;
  };
}

Steps randomSteps() {
  return [random = std::mt19937(5)]() mutable {
    constexpr double kMin = 1.0 / 1000, kMax = 1.0 / 50;
    return kMin + (kMax - kMin) * static_cast<double>(random()) / std::mt19937::max();
  };
}

void stop(Run& run, double stiffness, const Steps& steps) {
  run.report("distance over a point's", slide(run, flatBox(), BodyOptions{stiffness, 0.5}, steps));
}

/// How far a ball rolls in 1.5 seconds.
double rollDistance(Run& run, const ModelPtr& model, const BodyOptions& options) {
  MeasuringWorld world(run, gravityOn(10.0 * EIGEN_PI / 180));
  world.addFloor();
  SoftObject& ball = world.addSoftOn(0.0, model, options);
  const double from = ball.motion().centroid.x();
  world.simulate(1.5);
  return ball.motion().centroid.x() - from;
}

/// Compares meshes in which the same vertices are repeated several times.
void copies(Run& run, const std::function<double(Copies)>& distance) {
  const double once = distance({1});
  for (const int count : {10, 300}) {
    run.report(std::to_string(count) + " of each: distance error", std::abs(distance({count}) / once - 1.0));
  }
}

void copiesThatRoll(Run& run) {
  copies(run, [&](Copies count) { return rollDistance(run, makeBall(1000, 2, count), BodyOptions{50.0, 0.8}); });
}

void copiesThatStop(Run& run) {
  copies(run, [&](Copies count) { return slide(run, flatBox(8, count), {}, equalSteps()); });
}

}  // namespace

void addFrictionScenes(ContactScenes& scenes) {
  for (const double k : {300.0, 3000.0}) {
    scenes.push_back({"roll/undamped/k" + text(k), [=](Run& run) { rollUndamped(run, k); }});
    scenes.push_back({"roll/by default/k" + text(k), [=](Run& run) { rollAsIs(run, k); }});
  }
  for (const double k : {50.0, 500.0}) {
    const std::string end = "/k" + text(k);
    scenes.push_back({"table/0.8" + end, [=](Run& run) { ride(run, k, 0.8); }});
    scenes.push_back({"table/0.6" + end, [=](Run& run) { ride(run, k, 0.6); }});
    scenes.push_back({"table/in its middle" + end, [=](Run& run) { turnAlong(run, k); }});
    scenes.push_back({"creep" + end, [=](Run& run) { creep(run, k); }});
    scenes.push_back({"stop/equal steps" + end, [=](Run& run) { stop(run, k, equalSteps()); }});
    scenes.push_back({"stop/steps in turn" + end, [=](Run& run) { stop(run, k, alternatingSteps()); }});
    scenes.push_back({"stop/random steps" + end, [=](Run& run) { stop(run, k, randomSteps()); }});
  }
  scenes.push_back({"copies/rolling", copiesThatRoll});
  scenes.push_back({"copies/stopping", copiesThatStop});
}

}  // namespace tetskin::contact_demo
