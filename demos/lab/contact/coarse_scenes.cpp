// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Boxes drawn with twelve triangles, on objects smaller than these, and under such objects. Everything, including
// gravity, is in units of the size.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "measure/obstacles.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

constexpr double kAside = 0.25;  ///< distance of supports from the middle, S
const Vector3d kCube(0.5, 0.5, 0.5), kThinPlate(0.5, 0.05, 0.5);

/// Solids on both sides of the middle, or at the four corners of a square about it.
struct Support {
  std::function<Solid(double size)> make;
  double top = 0.0;    ///< above its centre, S
  bool isLong = true;  ///< along z: two of them, otherwise four
};

Support onBalls(double radius) {
  return {[=](double size) { return ball(size * radius); }, radius, false};
}
Support onPoles(double radius) {
  return {[=](double size) { return capsule(size * radius, size); }, radius};
}
Support onCylinders(double radius) {
  return {[=](double size) { return cylinder(size * radius, size); }, radius};
}
/// The edges of beams, with sides at 45 degrees.
Support onEdges() {
  const Vector3d half(0.1, 0.1, 1);
  return {[=](double size) { return box(size * half, 0.25 * EIGEN_PI); }, half.x() * std::sqrt(2.0)};
}

/// The tops are at the height 0.
Obstacle obstacleOf(const Support& support, double size) {
  std::vector<Vector3d> centres;
  for (const double x : {-kAside, kAside}) {
    if (support.isLong) {
      centres.push_back(size * Vector3d(x, -support.top, 0));
    } else {
      for (const double z : {-kAside, kAside}) centres.push_back(size * Vector3d(x, -support.top, z));
    }
  }
  return measure::obstacleOf(support.make(size), centres);
}

/// The smallest distance of the drawn triangles, corners and interior, minus the margin, S.
double gapAsDrawn(SoftObject& body, double size, const Distance& distance) {
  constexpr int kParts = 48;
  double minimum = HUGE_VAL;
  const std::vector<Vector3d>& at = body.surface();
  for (const auto& [a, b, c] : body.model().mesh.triangles) {
    const Vector3d &p = at[static_cast<std::size_t>(a)], u = at[static_cast<std::size_t>(b)] - p,
                   v = at[static_cast<std::size_t>(c)] - p;
    for (int i = 0; i <= kParts; ++i) {
      for (int k = 0; i + k <= kParts; ++k) lower(minimum, distance(p + (i * u + k * v) / kParts));
    }
  }
  return (minimum - kMargin * body.model().size) / size;
}

/// A box lies down on supports.
void lieOnSupports(Run& run, const Vector3d& half, const Support& support, double size) {
  constexpr double kFall = 0.01;
  MeasuringWorld world(run, Vector3d(0, -scenes::kEarth * size, 0));
  const Obstacle obstacle = obstacleOf(support, size);
  obstacle.addTo(world);
  // Gravity also grows with the size.
  SoftObject& body =
      world.addSoft(makeCoarseBox(half * size), BodyOptions{500.0 * size}, Vector3d(0, size * (half.y() + kFall), 0));
  double gap = HUGE_VAL;
  for (int tenth = 0; tenth < 30; ++tenth) {
    world.simulate(0.1);
    lower(gap, gapAsDrawn(body, size, obstacle.distance));
  }
  run.report("least gap as drawn, S", gap);
  run.report("fastest node, S/s", body.fastest() / size);
}

/// Balls half as wide as a tet, on a slab that is held at its bottom.
void ballsOnMat(Run& run) {
  constexpr double kHalfHeight = 0.2, kRadius = 0.05, kTouching = 0.005, kMass = 0.01;
  const ModelPtr mat = makeCoarseBox({1.0, kHalfHeight, 1.0}, 3000);
  MeasuringWorld world(run);
  BodyOptions options{500};
  options.pinned = [](const Vector3d& p) { return p.y() < 0.01 - kHalfHeight; };
  SoftObject& body = world.addSoft(mat, options, Vector3d(0, -kHalfHeight, 0));
  std::vector<const btRigidBody*> balls;
  for (const double x : {-0.61, -0.13, 0.37}) {
    for (const double z : {-0.47, 0.11, 0.59}) {
      balls.push_back(&world.addSphere({x, kRadius + kTouching, z}, kRadius, kMass));
    }
  }
  double gap = HUGE_VAL;
  for (int tenth = 0; tenth < 20; ++tenth) {
    world.simulate(0.1);
    lower(gap, gapAsDrawn(body, 1.0, [&](const Vector3d& p) {
            double minimum = HUGE_VAL;
            for (const btRigidBody* at : balls) {
              lower(minimum, (p - toEigen(at->getCenterOfMassPosition())).norm() - kRadius);
            }
            return minimum;
          }));
  }
  double lowest = HUGE_VAL;
  for (const btRigidBody* at : balls) lower(lowest, static_cast<double>(at->getCenterOfMassPosition().y()) - kRadius);
  run.report("least gap as drawn, S", gap);
  run.report("lowest ball, S", lowest);
}

/// A cube on an equal one that is turned by 45 degrees and held at its bottom, so that edges cross.
void cubeOnCube(Run& run) {
  MeasuringWorld world(run);
  BodyOptions options{500};
  Eigen::Isometry3d turned(Eigen::AngleAxisd(0.25 * EIGEN_PI, Vector3d::UnitY()));
  turned.pretranslate(Vector3d(0, 0.51, 0));
  SoftObject& upper = world.addSoft(makeCoarseBox(kCube), options, turned);
  options.pinned = [](const Vector3d& p) { return p.y() < -0.49; };
  SoftObject& held = world.addSoft(makeCoarseBox(kCube), options, Vector3d(0, -0.5, 0));
  for (SoftObject* body : {&upper, &held}) world.touchOthers(*body);
  double gap = HUGE_VAL;
  world.simulate(3, [&] { lower(gap, world.deepest()); });
  run.report("least gap, S", gap);
  run.report("fastest node, S/s", upper.fastest());
}

}  // namespace

void addCoarseScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const Vector3d& half, const Support& support, double size = 1.0) {
    scenes.push_back({"coarse/" + name, [=](Run& run) { lieOnSupports(run, half, support, size); }});
  };
  add("cube on balls", kCube, onBalls(0.1));
  add("cube on poles", kCube, onPoles(0.03));
  add("cube on cylinders", kCube, onCylinders(0.05));
  for (const double size : {0.01, 1.0, 100.0}) add("cube on edges/size " + text(size), kCube, onEdges(), size);
  add("plate on balls", kThinPlate, onBalls(0.05));
  add("plate on edges", kThinPlate, onEdges());
  scenes.push_back({"coarse/balls on a mat", ballsOnMat});
  scenes.push_back({"coarse/cube on cube", cubeOnCube, {Kind::Surface}});
}

}  // namespace tetskin::contact_demo
