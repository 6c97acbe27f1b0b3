// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gaps/gap_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::gaps {
namespace {

using namespace measure;
using Eigen::Vector3d;
using scenes::kSize;

constexpr double kAbove = 0.02;  ///< where the surface begins, over the body's size
constexpr double kOff = 0.1;     ///< distance from the obstacle, over the body's size, at which the body has fallen off
constexpr double kDamping = 0.04;  ///< seconds: leaves half as much rocking as the default
constexpr double kWatched = 0.25;  ///< seconds of an impact that are measured

SoftObject& addAbove(MeasuringWorld& world, const GapObstacle& obstacle, const ModelPtr& body) {
  SoftBodyOptions material = scenes::oneKilogram();
  material.stiffnessDamping = kDamping;
  SoftObject& soft = world.addSoft(body, material);
  soft.soft().setActivationState(DISABLE_DEACTIVATION);
  soft.soft().translate(toBullet(Vector3d(0, kAbove * kSize - boundingBox(body->mesh.positions).min().y(), 0)));
  obstacle.addTo(world);
  world.touchBySurface(soft);
  return soft;
}

/// The end of a figure's name.
std::string byWhat(const Run& run) {
  return run.kind == Kind::Surface ? " by surface" : " by nodes";
}

/// Reports how a body lies after this many seconds, starting from just above the obstacle: the gap, unless it has
/// fallen off, which is the least one of the surface's vertices, and the value farthest from 0 in the last half second;
/// and the root mean square of the nodes' speeds in that time.
void rest(Run& run, const GapObstacle& obstacle, const ModelPtr& body, double seconds) {
  constexpr double kLast = 0.5, kBetween = 1.0 / 60;
  MeasuringWorld world(run);
  SoftObject& soft = addAbove(world, obstacle, body);
  double gap = 0.0, squaredSpeed = 0.0, next = seconds - kLast;
  int count = 0;
  for (double time = 0.0; time < seconds; time += kStep) {
    world.step();
    if (time < next) continue;
    next += kBetween;
    raiseMagnitude(gap, soft.gap(obstacle.distance) / kSize);
    squaredSpeed += std::pow(scenes::nodeSpeed({&soft.soft()}) / kSize, 2);
    ++count;
  }
  if (!(std::abs(gap) >= kOff)) run.report("gap at rest" + byWhat(run), gap);
  run.report("speed at rest" + byWhat(run), std::sqrt(squaredSpeed / std::max(1, count)));
}

/// Reports the least gap over all steps of a body that hits the obstacle at this speed.
void hit(Run& run, const GapObstacle& obstacle, const ModelPtr& body, double speed) {
  MeasuringWorld world(run);
  SoftObject& soft = addAbove(world, obstacle, body);
  soft.soft().setVelocity(btVector3(0, static_cast<btScalar>(-speed * kSize), 0));
  double deepest = HUGE_VAL;
  for (double time = 0.0; time < kWatched; time += kStep) {
    world.step();
    lower(deepest, soft.gap(obstacle.distance) / kSize);
  }
  run.report("least gap in impact" + byWhat(run), deepest);
}

/// By the surface, and by the cage's nodes.
void measureGaps(Run& run, const GapObstacle& obstacle, const ModelPtr& body) {
  constexpr double kSeconds = 6.0, kSpeed = 15.0;
  for (const Kind kind : {Kind::Surface, Kind::Nodes}) {
    run.kind = kind;
    rest(run, obstacle, body, kSeconds);
    hit(run, obstacle, body, kSpeed);
  }
}

}  // namespace

measure::MeasuredScenes gapScenes() {
  measure::MeasuredScenes scenes;
  for (const std::string name : {"serpent", "round", "legs"}) {
    for (const std::size_t tets : {300, 1000, 3000}) {
      const auto body = [name, tets, made = std::make_shared<ModelPtr>()] {
        if (!*made) *made = makeGapBody(name, tets);
        return *made;
      };
      for (const GapObstacle& obstacle : gapObstacles()) {
        if (obstacle.roundOnly && name != "round") continue;
        const auto scene = [&obstacle, body](Run& run) { measureGaps(run, obstacle, body()); };
        const bool quick = name == "round" && tets == 300 && obstacle.name == "floor";
        scenes.push_back({"gap/" + std::to_string(tets) + "/" + obstacle.name + "/" + name,
                          scene,
                          {Kind::Surface},
                          quick ? measure::Often::Quick : measure::Often::Usual});
      }
    }
  }
  return scenes;
}

}  // namespace tetskin::gaps
