// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bar that turns about a pinned node; soft bodies that hang from a multibody's link.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "scenes/input_error.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A bar of 1 m is thrown so that it turns about the middle of its end, where one node is pinned.
void turnPinnedBar(Run& run, double stiffness) {
  const Vector3d pivot(-0.5, 0, 0), spin(0, 1, 5);
  MeasuringWorld world(run, Vector3d::Zero());
  BodyOptions options{stiffness};
  options.pinned = [&](const Vector3d& p) { return (p - pivot).norm() < 1e-6; };
  SoftObject& bar = world.addSoft(makeLattice({8, 2, 2}, 0.125), options, Vector3d(0, 0, 0));
  bar.push(spin.cross(bar.motion().centroid - pivot), spin);
  const Vector3d start = angularMomentumAbout(pivot, bar.soft());
  double off = 0.0, offAtOne = 0.0, time = 0.0;
  world.simulate(4, [&] {
    raise(off, (angularMomentumAbout(pivot, bar.soft()) - start).norm() / start.norm());
    time += kStep;
    if (time < 1.0) offAtOne = off;
  });
  run.report("angular momentum lost in 1 s", offAtOne);
  run.report("angular momentum lost", off);
  run.report("spin over its start", bar.motion().spin.norm() / spin.norm());
}

/// A rod of 1 m on a hinge in the origin, about z; a soft cube hangs from its lower end, by the centre of a side.
class Pendulum {
 public:
  /// damping  of the rod, 1/s
  Pendulum(MeasuringWorld& world, double angle, double stiffness, double damping)
      : model_(makeBox(Vector3d::Constant(kHalf))) {
    auto shape = std::make_unique<btBoxShape>(toBullet(kRodHalf));
    btVector3 inertia;
    shape->calculateLocalInertia(kRodMass, inertia);
    inertia_ = static_cast<double>(inertia.z());
    auto rod = std::make_unique<btMultiBody>(1, 0, btVector3(1, 1, 1), true, false);
    rod->setupRevolute(0, kRodMass, inertia, -1, btQuaternion::getIdentity(), btVector3(0, 0, 1), btVector3(0, 0, 0),
                       toBullet(Vector3d(0, -kRodHalf.y(), 0)), true);
    rod->finalizeMultiDof();
    rod->setLinearDamping(static_cast<btScalar>(damping));
    rod->setAngularDamping(0);
    rod->setJointPos(0, static_cast<btScalar>(angle));
    rod_ = &world.addMultiBody(std::move(rod), 0, std::move(shape));
    const Isometry3d turn(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
    cube_ =
        &world.addSoft(model_, BodyOptions{stiffness}, turn * Eigen::Translation3d(0, -2.0 * kRodHalf.y() - kHalf, 0));
  }

  SoftObject& cube() { return *cube_; }
  double angle() const { return static_cast<double>(rod_->getJointPos(0)); }
  btMultiBodyLinkCollider& link() { return *rod_->getLink(0).m_collider; }
  /// The lower end of the rod, in the link's space.
  static Vector3d tip() { return {0, -kRodHalf.y(), 0}; }
  /// The centre of the cube's upper side.
  SurfacePoint top() {
    const SurfaceTree tree = SurfaceTree::create(model_->binding, model_->mesh).value();
    auto point = tree.pointAtRest(cube_->soft(), Vector3d(0, kHalf, 0));
    scenes::require(point.status());
    return std::move(point).value();
  }
  /// The period for small angles, with the cube as a rigid part of the rod.
  double rigidPeriod() const {
    const double mass = cube_->motion().mass, arm = 2.0 * kRodHalf.y() + kHalf, rodArm = kRodHalf.y();
    const double inertia = inertia_ + kRodMass * rodArm * rodArm + mass * (arm * arm + 2.0 * kHalf * kHalf / 3.0);
    return 2.0 * EIGEN_PI * std::sqrt(inertia / (scenes::kEarth * (kRodMass * rodArm + mass * arm)));
  }

 private:
  static constexpr double kHalf = 0.25, kRodMass = 2.0;
  inline static const Vector3d kRodHalf{0.05, 0.5, 0.05};

  ModelPtr model_;
  btMultiBody* rod_;
  SoftObject* cube_;
  double inertia_ = 0.0;
};

std::unique_ptr<SurfaceWeld> weld(MeasuringWorld& world, Pendulum& pendulum) {
  auto made = SurfaceWeld::add(world.bullet(), pendulum.top(), pendulum.link());
  scenes::require(made.status());
  return std::move(made).value();
}

std::unique_ptr<SurfaceSpring> spring(MeasuringWorld& world, Pendulum& pendulum) {
  auto made = SurfaceSpring::add(world.bullet(), pendulum.top(), pendulum.link(), toBullet(Pendulum::tip()));
  scenes::require(made.status());
  return std::move(made).value();
}

double separation(const SurfaceWeld& weld) {
  return static_cast<double>(weld.separation());
}

double separation(const SurfaceSpring& spring) {
  return static_cast<double>(spring.stretch());
}

double turn(const SurfaceWeld& weld) {
  return static_cast<double>(weld.angle());
}

/// A spring does not constrain the angle.
double turn(const SurfaceSpring&) {
  return 0.0;
}

/// Four seconds to settle, and one of measurement: a joint at a point holds a cube, which keeps swinging a little.
template <class Join>
void hang(Run& run, const Join& join) {
  MeasuringWorld world(run);
  Pendulum pendulum(world, 0.0, 50.0, 5.0);
  const auto joint = join(world, pendulum);
  world.simulate(4);
  const double size = pendulum.cube().model().size, weight = pendulum.cube().motion().mass * scenes::kEarth;
  double apart = 0.0, turned = 0.0, pull = 0.0;
  int steps = 0;
  world.simulate(1, [&] {
    raise(apart, separation(*joint));
    raise(turned, turn(*joint));
    pull += static_cast<double>(joint->force().y());
    ++steps;
  });
  run.report("separation, S", apart / size);
  run.report("rotation, rad", turned);
  run.report("pull over weight", pull / steps / weight);
}

/// The period of the first full swing, counted from when it first hangs straight.
double periodOf(MeasuringWorld& world, const Pendulum& pendulum, const std::function<void()>& after) {
  std::vector<double> crossings;
  double time = 0.0, before = pendulum.angle();
  world.simulate(4, [&] {
    time += kStep;
    const double now = pendulum.angle();
    if ((now < 0.0) != (before < 0.0)) crossings.push_back(time - kStep * now / (now - before));
    before = now;
    after();
  });
  return crossings.size() < 3 ? std::nan("") : crossings[2] - crossings[0];
}

/// A stiff cube swings with the rod as one rigid body would.
void swing(Run& run) {
  MeasuringWorld world(run);
  Pendulum pendulum(world, 0.2, 5000.0, 0.0);
  const auto joint = weld(world, pendulum);
  double apart = 0.0, turned = 0.0;
  const double rigid = pendulum.rigidPeriod();
  const double period = periodOf(world, pendulum, [&] {
    raise(apart, separation(*joint));
    raise(turned, turn(*joint));
  });
  run.report("period over a rigid pendulum's", period / rigid);
  run.report("separation, S", apart / pendulum.cube().model().size);
  run.report("rotation, rad", turned);
}

}  // namespace

void addJointScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const std::function<void(Run&)>& run) {
    scenes.push_back({name, run, {Kind::Surface}});  // joints belong to the library's solver
  };
  for (const double k : {50.0, 500.0}) {
    add("held bar/k" + text(k), [=](Run& run) { turnPinnedBar(run, k); });
  }
  add("links/welded", [](Run& run) { hang(run, weld); });
  add("links/spring", [](Run& run) { hang(run, spring); });
  add("links/welded and swinging", swing);
}

}  // namespace tetskin::contact_demo
