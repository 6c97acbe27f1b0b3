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
/// Share of the length that is pinned at either end.
constexpr double kPinnedFraction = 0.1;
/// Seconds. Bullet measures the rate of deformation in a frame that does not turn with the body, so its damping resists
/// rotation as well: with the default, five times this, all of the twist would collect at the moved end, where the body
/// slips through itself and untwists.
constexpr double kDamping = 0.004;

double turnAt(int frame) {
  return kFullTurn * smoothStep(0.0, kTurned, frame);
}

/// Releases the moved end.
void release(btSoftBody& body, const Cage& cage, double mass, const Twist& twist, std::vector<int>& pinned) {
  const std::vector<double> masses = lumpedMasses(cage.mesh, mass);
  const auto stays =
      std::partition(pinned.begin(), pinned.end(), [&](int n) { return cage.mesh.nodes[n][twist.axis] < twist.to; });
  for (auto n = stays; n != pinned.end(); ++n) setMass(body, *n, static_cast<btScalar>(masses[*n]));
  pinned.erase(stays, pinned.end());
}

}  // namespace

Twist wringAt(const Box3& cage, int frame) {
  Twist twist = twistOf(cage, turnAt(frame));
  const double held = kPinnedFraction * (twist.to - twist.from);
  twist.from += held;
  twist.to -= held;
  return twist;
}

std::unique_ptr<Scene> makeWring(const Cage& cage, const SceneOptions& desired) {
  SceneOptions options = desired;
  options.body.stiffnessDamping = kDamping;
  auto scene = std::make_unique<Scene>(options, 0.0);
  const Twist rest = wringAt(boundingBox(cage.mesh.nodes), 0);
  const auto isPinned = [=](const Eigen::Vector3d& p) { return p[rest.axis] <= rest.from || p[rest.axis] >= rest.to; };
  auto pinned = std::make_shared<std::vector<int>>(nodesWhere(cage, isPinned));
  btSoftBody& body = scene->add(cage, isPinned);
  const double mass = options.body.mass.value_or(options.body.density * totalVolume(cage.mesh));
  scene->beforeFrame = [=, &body](int frame, const Moved&) {
    if (frame == kReleased) release(body, cage, mass, rest, *pinned);
  };
  scene->beforeSubstep = [=, &body, offset = scene->offset](double frame, double seconds) {
    const int reached = static_cast<int>(std::ceil(frame));
    Twist twist = rest;
    twist.turn = turnAt(reached - 1) + (turnAt(reached) - turnAt(reached - 1)) * (frame - (reached - 1));
    for (const int n : *pinned) movePinnedNode(body.m_nodes[n], twist.point(cage.mesh.nodes[n]) + offset, seconds);
  };
  return scene;
}

}  // namespace tetskin::scenes
