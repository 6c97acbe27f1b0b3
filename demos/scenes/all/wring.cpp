// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/wring.h"

#include <algorithm>
#include <cmath>

#include "scenes/serpent_spine.h"
#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

constexpr double kFullTurn = 6.28318530717958647692;
/// Share of the length that is held at either end.
constexpr double kHeldShare = 0.1;
/// Seconds. Bullet measures the rate of deformation in a frame that does not turn with the body, so its damping holds
/// up turning as well: with the default of five times this, all of the twist would gather at the moved end, where the
/// body slips through itself and is untwisted again.
constexpr double kDamping = 0.004;

double turnAt(int frame) {
  return kFullTurn * smoothStep(0.0, kTurned, frame);
}

/// Lets go of the moved end.
void release(btSoftBody& body, const Cage& cage, double mass, const Twist& twist, std::vector<int>& held) {
  const std::vector<double> masses = lumpedMasses(cage, mass);
  const auto stays =
      std::partition(held.begin(), held.end(), [&](int n) { return cage.nodes[n][twist.axis] < twist.to; });
  for (auto n = stays; n != held.end(); ++n) setMass(body, *n, static_cast<btScalar>(masses[*n]));
  held.erase(stays, held.end());
}

}  // namespace

Twist wringAt(const Box3& cage, int frame) {
  Twist twist = twistOf(cage, turnAt(frame));
  const double held = kHeldShare * (twist.to - twist.from);
  twist.from += held;
  twist.to -= held;
  return twist;
}

std::unique_ptr<Scene> makeWring(const Cage& cage, const SceneOptions& wished) {
  SceneOptions options = wished;
  options.body.damping = kDamping;
  auto scene = std::make_unique<Scene>(options, 0.0);
  const Twist rest = wringAt(boundingBox(cage.nodes), 0);
  const auto isHeld = [=](const Eigen::Vector3d& p) { return p[rest.axis] <= rest.from || p[rest.axis] >= rest.to; };
  auto held = std::make_shared<std::vector<int>>(nodesWhere(cage, isHeld));
  btSoftBody& body = scene->add(cage, isHeld);
  const double mass = options.body.mass > 0.0 ? options.body.mass : options.body.density * totalVolume(cage);
  scene->beforeFrame = [=, &body](int frame, const Moved&) {
    if (frame == kReleased) release(body, cage, mass, rest, *held);
  };
  scene->beforeSubstep = [=, &body, offset = scene->offset](double frame, double seconds) {
    const int reached = static_cast<int>(std::ceil(frame));
    Twist twist = rest;
    twist.turn = turnAt(reached - 1) + (turnAt(reached) - turnAt(reached - 1)) * (frame - (reached - 1));
    for (const int n : *held) moveHeldNode(body.m_nodes[n], twist.point(cage.nodes[n]) + offset, seconds);
  };
  return scene;
}

}  // namespace tetskin::scenes
