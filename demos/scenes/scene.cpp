// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/scene.h"

#include <tetskin/reduced/reduced_body.h>

#include <algorithm>
#include <limits>

#include "scenes/input_error.h"

namespace tetskin::scenes {
namespace {

/// Dimensions of the floor's box, in units of the body's size.
constexpr double kFloorHalfSide = 5.0, kFloorHalfHeight = 0.5;

}  // namespace

Scene::Scene(const SceneOptions& options, double gravity)
    : floorY(-std::numeric_limits<double>::infinity()),
      offset(options.offset),
      options_(options),
      world_(options.force, btVector3(0, static_cast<btScalar>(-gravity * options.size / kSize), 0)) {}

double Scene::margin() const {
  return static_cast<double>(body().getCollisionShape()->getMargin());
}

double Scene::nodeSpeed() const {
  return scenes::nodeSpeed(bodies_) / options_.size;
}

int Scene::step(int frame, const Moved& moved) {
  static const Moved kNobody = [] {};
  if (beforeFrame) beforeFrame(frame, moved ? moved : kNobody);
  int steps = 0;
  // One substep at a time, as Bullet's own division of a frame may lose one to rounding.
  for (int k = 1; k <= options_.substeps; ++k) {
    if (beforeSubstep) beforeSubstep(frame - 1 + static_cast<double>(k) / options_.substeps, options_.substep());
    steps += world_.step(options_.substep());
  }
  return steps;
}

Findings Scene::check(PointView<const btScalar> points) const {
  Findings found;
  found.box = boundingBox(points);
  // A Box3 ignores NaN.
  found.finite = firstNonFinite(points) == points.size();
  found.exploded = !found.finite || found.box.sizes().maxCoeff() >= kExploded * extent * options_.size;
  found.aboveFloor = found.box.min().y() >= floorY - margin() - kFloorTolerance * options_.size;
  return found;
}

Findings Scene::check() const {
  Findings all;
  for (const btSoftBody* body : bodies_) {
    const Findings one = check(nodePositions(*body));
    all.box.extend(one.box);
    all.finite = all.finite && one.finite;
    all.exploded = all.exploded || one.exploded;
    all.aboveFloor = all.aboveFloor && one.aboveFloor;
  }
  return all;
}

void Scene::restore() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    for (std::size_t n = 0; n < start_[b].size(); ++n) placeNode(body(b).m_nodes[static_cast<int>(n)], start_[b][n]);
  }
}

btSoftBody& Scene::makeBody(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& pinned,
                            const Eigen::Vector3d& direction) {
  SoftBodyOptions options = options_.body;
  options.pinned = pinned;
  if (options_.force != Force::Reduced) {
    btSoftBody& body = world_.add(cage, options);
    if (direction != Eigen::Vector3d::Zero()) body.translate(toBullet(direction));
    return body;
  }
  if (!options_.reduction)
    throw InputError("a reduced body needs fine tets, from which its vibration modes are computed");
  ReducedBodyOptions reduced;
  reduced.modeCount = options_.modes;
  reduced.mass = options.mass;
  reduced.density = options.density;
  reduced.youngsModulus = options.youngsModulus;
  reduced.relativeStiffness = options.relativeStiffness;
  reduced.stiffnessDamping = options.stiffnessDamping;
  reduced.timeStep = options_.substep();
  reduced.skipFastModes = true;
  reduced.margin = options.margin;
  reduced.friction = options.friction;
  reduced.nodeTets = options_.reduction->nodeTets;
  reduced.placement.setOrigin(toBullet(direction));
  return world_.add(cage, options_.reduction->modes(pinned), reduced);
}

btSoftBody& Scene::add(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& pinned,
                       const Eigen::Vector3d& shift) {
  btSoftBody& body = makeBody(cage, pinned, options_.offset + shift);
  body.setActivationState(DISABLE_DEACTIVATION);
  bodies_.push_back(&body);
  std::vector<btVector3>& start = start_.emplace_back();
  for (int n = 0; n < body.m_nodes.size(); ++n) start.push_back(body.m_nodes[n].m_x);
  return body;
}

void Scene::addFloor(double gap) {
  const double side = kFloorHalfSide * options_.size, height = kFloorHalfHeight * options_.size;
  const Box3 box =
      options_.box.isEmpty() ? boundingBox(nodePositions(body())) : options_.box.translated(options_.offset);
  Eigen::Vector3d centre = box.center();
  floorY = box.min().y() - gap * options_.size;
  centre.y() = floorY - height;
  world_.addBox(centre, {side, height, side});
}

void Scene::placeNodes(const std::function<btVector3(const btVector3&)>& toPosition) {
  for (int n = 0; n < body().m_nodes.size(); ++n) placeNode(body().m_nodes[n], toPosition(body().m_nodes[n].m_x));
}

void placeNode(btSoftBody::Node& node, const btVector3& where) {
  node.m_x = node.m_q = where;
  node.m_v.setZero();
}

int eventFrame(const SceneOptions& options) {
  return std::min(6, options.frames);
}

Box3 layoutBox(const SceneOptions& options, const Cage& cage) {
  return options.box.isEmpty() ? boundingBox(cage.mesh.nodes) : options.box;
}

std::vector<int> nodesWhere(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& chosen) {
  std::vector<int> found;
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    if (chosen(cage.mesh.nodes[n])) found.push_back(static_cast<int>(n));
  }
  if (found.empty()) throw InputError("the scene pins no node of the cage");
  return found;
}

}  // namespace tetskin::scenes
