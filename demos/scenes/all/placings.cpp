// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes with a body in free space whose nodes are moved to other positions by hand.
#include <limits>
#include <random>

#include "scenes/table.h"

namespace tetskin::scenes {
namespace {

/// The new position of a node, from its present one and the centre of the body's box.
using Position = std::function<btVector3(const btVector3& node, const btVector3& centre)>;

std::unique_ptr<Scene> makeFree(const Cage& cage, const SceneOptions& options) {
  auto scene = std::make_unique<Scene>(options, 0.0);
  scene->add(cage);
  return scene;
}

/// All nodes are moved once.
std::unique_ptr<Scene> makePlacing(const Cage& cage, const SceneOptions& options, const Position& toPosition) {
  auto scene = makeFree(cage, options);
  const btVector3 centre = toBullet(boundingBox(nodePositions(scene->body())).center());
  scene->beforeFrame = [s = scene.get(), centre, toPosition](int frame, const Moved& moved) {
    if (frame != eventFrame(s->options())) return;
    s->placeNodes([&](const btVector3& node) { return toPosition(node, centre); });
    moved();
  };
  return scene;
}

std::unique_ptr<Scene> makeLonger(const Cage& cage, const SceneOptions& options, double factor) {
  const auto longer = static_cast<btScalar>(factor);
  return makePlacing(cage, options, [longer](const btVector3& p, const btVector3& c) {
    return btVector3(c.x() + longer * (p.x() - c.x()), p.y(), p.z());
  });
}

/// For one update, a node has a coordinate that no surface can follow.
std::unique_ptr<Scene> makeDamaged(const Cage& cage, const SceneOptions& options, btScalar coordinate) {
  auto scene = makeFree(cage, options);
  scene->beforeFrame = [s = scene.get(), coordinate](int frame, const Moved& moved) {
    if (frame != eventFrame(s->options())) return;
    btSoftBody::Node& node = s->body().m_nodes[s->body().m_nodes.size() / 3];
    const btVector3 before = node.m_x;
    node.m_x.setZ(coordinate);
    moved();
    placeNode(node, before);
    moved();
  };
  return scene;
}

}  // namespace

std::unique_ptr<Scene> makePluck(const Cage& cage, const SceneOptions& options) {
  return makeLonger(cage, options, 1.01);
}

std::unique_ptr<Scene> makeStretch(const Cage& cage, const SceneOptions& options) {
  constexpr double kStretch = 10.0;
  auto scene = makeLonger(cage, options, kStretch);
  scene->extent = kStretch;
  return scene;
}

std::unique_ptr<Scene> makeSquashFlat(const Cage& cage, const SceneOptions& options) {
  return makePlacing(cage, options,
                     [](const btVector3& p, const btVector3& c) { return btVector3(p.x(), c.y(), p.z()); });
}

std::unique_ptr<Scene> makeMirror(const Cage& cage, const SceneOptions& options) {
  return makePlacing(cage, options,
                     [](const btVector3& p, const btVector3& c) { return btVector3(2 * c.x() - p.x(), p.y(), p.z()); });
}

std::unique_ptr<Scene> makePermute(const Cage& cage, const SceneOptions& options) {
  auto scene = makeFree(cage, options);
  scene->beforeFrame = [s = scene.get()](int frame, const Moved& moved) {
    if (frame != eventFrame(s->options())) return;
    std::mt19937 generator(17);
    std::vector<btVector3> positions;
    positions.reserve(static_cast<std::size_t>(s->body().m_nodes.size()));
    for (int n = 0; n < s->body().m_nodes.size(); ++n) positions.push_back(s->body().m_nodes[n].m_x);
    for (std::size_t k = positions.size(); k > 1; --k) std::swap(positions[k - 1], positions[generator() % k]);
    auto next = positions.begin();
    s->placeNodes([&](const btVector3&) { return *next++; });
    moved();
  };
  return scene;
}

std::unique_ptr<Scene> makeTeleport(const Cage& cage, const SceneOptions& options) {
  constexpr double kLengths = 1000.0;
  auto scene = makeFree(cage, options);
  scene->beforeFrame = [s = scene.get()](int frame, const Moved& moved) {
    const int away = eventFrame(s->options()), back = 2 * away - 1;
    if (frame != away && frame != back) return;
    const double up = (frame == back ? -kLengths : kLengths) * s->options().size;
    s->body().translate(btVector3(0, static_cast<btScalar>(up), 0));
    moved();
  };
  return scene;
}

std::unique_ptr<Scene> makeNodeNaN(const Cage& cage, const SceneOptions& options) {
  return makeDamaged(cage, options, std::numeric_limits<btScalar>::quiet_NaN());
}

std::unique_ptr<Scene> makeNodeInfinite(const Cage& cage, const SceneOptions& options) {
  return makeDamaged(cage, options, -std::numeric_limits<btScalar>::infinity());
}

std::unique_ptr<Scene> makeNodeTooFar(const Cage& cage, const SceneOptions& options) {
  return makeDamaged(cage, options, btScalar(1e30));
}

}  // namespace tetskin::scenes
