// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes with a body in free space whose nodes are set in motion by hand.
#include <algorithm>

#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

/// The node farthest along x, in the positive or the negative direction.
int endNode(const Cage& cage, double direction) {
  const auto further = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return direction * a.x() < direction * b.x();
  };
  return static_cast<int>(std::max_element(cage.mesh.nodes.begin(), cage.mesh.nodes.end(), further) -
                          cage.mesh.nodes.begin());
}

}  // namespace

std::unique_ptr<Scene> makeSpin(const Cage& cage, const SceneOptions& options) {
  constexpr double kTurnsPerSecond = 100.0, kTwoPi = 6.283185307179586;
  auto scene = std::make_unique<Scene>(options, 0.0);
  btSoftBody& body = scene->add(cage);
  const btVector3 centre = toBullet(boundingBox(nodePositions(body)).center());
  scene->beforeFrame = [event = eventFrame(options), &body, centre](int frame, const Moved&) {
    if (frame != event) return;
    const btVector3 rate(0, 0, static_cast<btScalar>(kTurnsPerSecond * kTwoPi));
    for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_v = rate.cross(body.m_nodes[n].m_x - centre);
  };
  return scene;
}

/// Bullet moves a node without mass by its velocity.
std::unique_ptr<Scene> makePull(const Cage& cage, const SceneOptions& options) {
  constexpr double kLengths = 3.0;
  auto scene = std::make_unique<Scene>(options, 0.0);
  const int end = endNode(cage, 1);
  const Eigen::Vector3d held = cage.mesh.nodes[endNode(cage, -1)], pulled = cage.mesh.nodes[end];
  btSoftBody& body = scene->add(cage, [=](const Eigen::Vector3d& p) { return p == held || p == pulled; });
  const double speed = kLengths * options.size / (options.frames * options.frameSeconds);
  scene->beforeFrame = [&body, end, speed](int, const Moved&) {
    body.m_nodes[end].m_v = btVector3(static_cast<btScalar>(speed), 0, 0);
  };
  scene->extent = 1.0 + kLengths;
  return scene;
}

}  // namespace tetskin::scenes
