// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The cost of steps: with many springs, and with many bodies that touch nothing. There are no promises about these
// figures, as they depend on the machine.
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "contact/scene_list.h"
#include "measure/measuring_world.h"
#include "scenes/input_error.h"
#include "scenes/statistics.h"
#include "scenes/timer.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;

double stepMilliseconds(MeasuringWorld& world) {
  const scenes::CpuTimer timer;
  world.step();
  return timer.milliseconds();
}

/// Points on the surface, in random directions from a body's centroid at the origin.
std::vector<SurfacePoint> randomPoints(SoftObject& body, int count) {
  SoftBodySkin skin;
  scenes::require(skin.bind(body.soft(), body.model().binding));
  const SurfaceTree tree = SurfaceTree::create(body.model().binding, body.model().mesh).value();
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<SurfacePoint> points;
  while (static_cast<int>(points.size()) < count) {
    Vector3d direction;
    for (double& x : direction) x = normal(random);
    const SurfaceHit hit = tree.raycast(skin, toBullet(Vector3d(2.0 * direction.normalized())), btVector3(0, 0, 0));
    if (!hit) continue;
    auto point = tree.pointAt(body.soft(), hit);
    scenes::require(point.status());
    points.push_back(std::move(point).value());
  }
  return points;
}

/// A ball hangs from this many springs to points in space: the median time of several steps.
double millisecondsOfSprings(Run& run, int count) {
  constexpr int kWarm = 3, kSteps = 9;
  MeasuringWorld world(run);
  SoftObject& ball = world.addSoft(makeBall(), {}, Vector3d(0, 0, 0));
  std::vector<std::unique_ptr<SurfaceSpring>> springs;
  for (const SurfacePoint& point : randomPoints(ball, count)) {
    auto made = SurfaceSpring::add(world.bullet(), point);
    scenes::require(made.status());
    springs.push_back(std::move(made).value());
  }
  for (int k = 0; k < kWarm; ++k) world.step();
  std::vector<double> milliseconds;
  milliseconds.reserve(kSteps);
  for (int k = 0; k < kSteps; ++k) milliseconds.push_back(stepMilliseconds(world));
  return scenes::median(milliseconds);
}

void manySprings(Run& run) {
  double few = 0.0, many = 0.0;
  for (const int count : {100, 1000, 10000, 64000}) {
    const double milliseconds = millisecondsOfSprings(run, count);
    run.report("ms per step, springs: " + std::to_string(count), milliseconds);
    (count == 1000 ? few : many) = milliseconds;
  }
  run.report("growth from 1,000 to 64,000 over 64", many / few / 64.0);
}

/// A thousand rotating cubes, two of their sizes apart.
void addCubes(MeasuringWorld& world, const ModelPtr& model, bool touching) {
  constexpr int kAlong = 10;
  const double apart = 3.0 * model->size;
  BodyOptions options;
  options.byNodes = true;  // so that the search is only for contact among soft bodies
  for (int k = 0; k < kAlong * kAlong * kAlong; ++k) {
    const Eigen::Vector3i index(k % kAlong, k / kAlong % kAlong, k / (kAlong * kAlong));
    SoftObject& cube = world.addSoft(model, options, Vector3d(apart * index.cast<double>()));
    if (touching) world.touchOthers(cube);
    cube.push(Vector3d(0, 0, 0), Vector3d(1, 2, 0.5));
  }
}

/// The two worlds step in turn, so that other load of the machine affects both.
void apart(Run& run) {
  constexpr int kWarm = 5, kSteps = 61;
  const ModelPtr model = makeLattice({2, 2, 2}, 0.25);
  MeasuringWorld without(run, Vector3d::Zero()), with(run, Vector3d::Zero());
  addCubes(without, model, false);
  addCubes(with, model, true);
  std::vector<double> withoutContact, withContact, ratios;
  for (int k = 0; k < kWarm + kSteps; ++k) {
    const double one = stepMilliseconds(without), other = stepMilliseconds(with);
    if (k < kWarm) continue;
    withoutContact.push_back(one);
    withContact.push_back(other);
    ratios.push_back(other / one);
  }
  run.report("ms per step without contact", scenes::median(withoutContact));
  run.report("ms per step with contact", scenes::median(withContact));
  run.report("contact adds, %", 100.0 * (scenes::median(ratios) - 1.0));
}

}  // namespace

void addCostScenes(ContactScenes& scenes) {
  scenes.push_back({"many springs", manySprings, {Kind::Surface}});
  scenes.push_back({"thousand bodies apart", apart, {Kind::Surface}});
}

}  // namespace tetskin::contact_demo
