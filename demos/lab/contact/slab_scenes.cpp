// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A soft box that slides, and one that rests, on a soft slab that is pinned at its bottom.
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <string>

#include "contact/scene_list.h"
#include "measure/measuring_world.h"
#include "scenes/input_error.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSpeed = 3.0;
const Vector3d kSlabHalf(1.6, 0.2, 0.6);

/// Slab and box of one material. The stiffness k refers to the box and its own size.
struct SlabOptions {
  double stiffness = 50.0, friction = 0.5;
  double gap = 0.001;                        ///< initial gap between the two, m
  Isometry3d turn = Isometry3d::Identity();  ///< rotation of everything about the origin
};

struct BoxOnSlab {
  SoftObject &slab, &box;
};

/// Before the rotation, the slab's upper side is at y = 0, where the box lies with 1.5 m of room along x.
BoxOnSlab addBoxOnSlab(MeasuringWorld& world, const SlabOptions& slab) {
  constexpr double kMass = 1.0, kBehind = 0.9, kBottom = 0.01;
  const ModelPtr boxModel = makeBox({0.5, 0.25, 0.5}), slabModel = makeBox(kSlabHalf, 32);
  const double density = kMass / boxModel->volume;
  BodyOptions options;
  options.friction = slab.friction;
  options.youngsModulus = slab.stiffness * density * scenes::kEarth * boxModel->size;
  options.mass = kMass;
  const Eigen::Translation3d above(0, 0.25 + slab.gap, 0), below(kBehind, -kSlabHalf.y(), 0);
  SoftObject& box = world.addSoft(boxModel, options, slab.turn * Isometry3d(above));
  options.mass = density * slabModel->volume;
  options.pinned = [](const Vector3d& p) { return p.y() < -kSlabHalf.y() + kBottom; };
  SoftObject& held = world.addSoft(slabModel, options, slab.turn * Isometry3d(below));
  for (SoftObject* body : {&box, &held}) world.touchOthers(*body);
  return {held, box};
}

/// The resting box is pushed. Measures how far it slides, relative to a point mass with the same steps.
void slide(Run& run, double stiffness) {
  SlabOptions slab;
  slab.stiffness = stiffness;
  MeasuringWorld world(run);
  const BoxOnSlab bodies = addBoxOnSlab(world, slab);
  world.simulate(1);
  const double from = bodies.box.motion().centroid.x();
  bodies.box.push(Vector3d(kSpeed, 0, 0));
  double speed = kSpeed, point = 0.0, deepest = 0.0;
  world.simulate(1.5, [&] {
    // Implicit Euler stops earlier than v^2 / (2 mu g), by the fraction mu g dt / v of it.
    speed = std::max(0.0, speed - slab.friction * scenes::kEarth * kStep);
    point += speed * kStep;
    deepest = std::min(deepest, world.deepest());
  });
  const double distance = bodies.box.motion().centroid.x() - from;
  run.report("distance over a point's", distance / point);
  run.report("distance over v^2 / (2 mu g)", distance * 2.0 * slab.friction * scenes::kEarth / (kSpeed * kSpeed));
  run.report("least gap, S", deepest);
  run.report("fastest node, S/s", bodies.box.fastest());
}

/// Slides without friction, so that only the slab's own damping reduces the velocity.
void slideFreely(Run& run, double stiffness) {
  SlabOptions slab;
  slab.stiffness = stiffness;
  slab.friction = 0.0;
  MeasuringWorld world(run);
  const BoxOnSlab bodies = addBoxOnSlab(world, slab);
  world.simulate(1);
  const double before = bodies.box.motion().velocity.x();
  bodies.box.push(Vector3d(kSpeed, 0, 0));
  world.simulate(0.3);
  run.report("velocity kept", (bodies.box.motion().velocity.x() - before) / kSpeed);
}

/// Sets the gravity in Bullet's `btSoftBodyWorldInfo` to the value that it has if nobody sets it, which is not the
/// bodies' gravity.
void forgetGravity(MeasuringWorld& world) {
  world.bullet().getWorldInfo().m_gravity = btVector3(0, -10, 0);
}

/// The box glides without any force that presses it onto the slab.
void glide(Run& run, double friction) {
  constexpr double kSlow = 0.5;
  constexpr double kTouching = 5e-5;  // less than the default gravity would close in a step
  SlabOptions slab;
  slab.friction = friction;
  slab.gap = kTouching;
  MeasuringWorld world(run, Vector3d::Zero());
  forgetGravity(world);
  const BoxOnSlab bodies = addBoxOnSlab(world, slab);
  bodies.box.push(Vector3d(kSlow, 0, 0));
  double points = 0.0;
  world.simulate(2, [&] { points += static_cast<double>(world.softContacts().size()); });
  run.report("velocity over its start", bodies.box.motion().velocity.x() / kSlow);
  run.report("contact points", points / static_cast<double>(run.steps));
}

/// Rotates from the slab's own space, in which it lies level.
const Isometry3d kToZ(Eigen::AngleAxisd(0.5 * EIGEN_PI, Vector3d::UnitX()));

/// Reports how fast the box creeps along the slab.
void reportCreep(Run& run, MeasuringWorld& world, const BoxOnSlab& bodies, const Isometry3d& turn) {
  constexpr double kSeconds = 2.0;
  world.simulate(2);
  const Vector3d before = bodies.box.motion().centroid;
  world.simulate(kSeconds);
  Vector3d moved = turn.linear().transpose() * (bodies.box.motion().centroid - before);
  run.report("sinks, m/s", -moved.y() / kSeconds);
  moved.y() = 0.0;
  run.report("creeps, m/s", moved.norm() / kSeconds);
  run.report("fastest node, S/s", bodies.box.fastest());
}

void lie(Run& run, const Isometry3d& turn) {
  SlabOptions slab;
  slab.turn = turn;
  MeasuringWorld world(run, turn * Vector3d(0, -scenes::kEarth, 0));
  forgetGravity(world);
  reportCreep(run, world, addBoxOnSlab(world, slab), turn);
}

/// The bodies' own gravity is perpendicular to the world's.
void lieByOwnGravity(Run& run) {
  SlabOptions slab;
  slab.turn = kToZ;
  const Vector3d down(0, -scenes::kEarth, 0);
  MeasuringWorld world(run, down);
  const BoxOnSlab bodies = addBoxOnSlab(world, slab);
  for (SoftObject* body : {&bodies.slab, &bodies.box}) {
    scenes::require(body->deformable().setGravity(toBullet(Vector3d(kToZ * down))));
  }
  reportCreep(run, world, bodies, kToZ);
}

}  // namespace

void addSlabScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const std::function<void(Run&)>& run) {
    scenes.push_back({name, run, {Kind::Surface}});
  };
  for (const double k : {50.0, 500.0}) {
    add("soft slide/k" + text(k), [=](Run& run) { slide(run, k); });
    add("soft slide/frictionless/k" + text(k), [=](Run& run) { slideFreely(run, k); });
  }
  add("pad/weightless, frictionless", [](Run& run) { glide(run, 0.0); });
  add("pad/weightless, rough", [](Run& run) { glide(run, 0.5); });
  add("pad/gravity along y", [](Run& run) { lie(run, Isometry3d::Identity()); });
  add("pad/gravity along z", [](Run& run) { lie(run, kToZ); });
  add("pad/own gravity", lieByOwnGravity);
}

}  // namespace tetskin::contact_demo
