// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "worlds.h"

#include <tuple>

namespace tetskin::facade {

btVector3 toBullet(const Vec3& vector, const char* name) {
  finite(vector, name);
  return {static_cast<btScalar>(vector[0]), static_cast<btScalar>(vector[1]), static_cast<btScalar>(vector[2])};
}

WorldOptions worldOptions(const Vec3& gravity, bool deterministic, bool recordForces, double sleepAfter,
                          int impactParts) {
  WorldOptions options;
  options.gravity = toBullet(gravity, "gravity");
  options.deterministic = deterministic;
  options.recordForces = recordForces;
  options.sleepAfter = static_cast<btScalar>(sleepAfter);
  check(DeformableSolver().setSleepAfter(options.sleepAfter));
  if (impactParts < 1 || impactParts > 64) fail(StatusCode::InvalidOption, "impactParts: must be 1 to 64");
  options.impactParts = impactParts;
  return options;
}

btTransform toBullet(const Vec3& position, const Quaternion& rotation) {
  const btQuaternion q(static_cast<btScalar>(rotation[0]), static_cast<btScalar>(rotation[1]),
                       static_cast<btScalar>(rotation[2]), static_cast<btScalar>(rotation[3]));
  if (!(q.length2() > 1e-12f && q.length2() < 1e12f))
    fail(StatusCode::InvalidOption, "rotation: must be a quaternion x, y, z, w other than 0");
  return btTransform(q.normalized(), toBullet(position, "position"));
}

namespace {

template <class Word, class Value>
void set(const Word& word, Value& value) {
  value = word;
}
template <class Of>
void set(const Choice<Of>& word, Of& value) {
  value = valueOf(word);
}
void set(const std::optional<double>& word, double& value) {
  if (word) value = *word;
}

}  // namespace

std::shared_ptr<World::Body> addBody(World& world, const CageModel& cage, const MeshModel& mesh,
                                     const BodyWords& words) {
  WorldBodyOptions options;
  options.material.faceTree = false;
  Placement place;
  const auto parts = std::tie(options, options.material, options.binding, place);
#define TETSKIN_SET(of, type, name, python, ...) set(words.name, std::get<of&>(parts).name);
  TETSKIN_BODY_OPTIONS(TETSKIN_SET)
#undef TETSKIN_SET
  return take(world.addBody(cage.cage, mesh.mesh, options, placementOf(place.position, place.rotation)));
}

std::shared_ptr<World::RigidBody> addRigid(World& world, const ShapeModel& shape, double mass, const btTransform& pose,
                                           double friction, bool kinematic) {
  auto rigid = world.addRigidBody(shape.shape, mass, pose, friction, kinematic);
  if (!rigid.ok()) throw std::invalid_argument(rigid.status().message);
  return rigid.value();
}

void checkStepped(const Status& status, bool wasInStep) {
  if (status.code == StatusCode::InvalidOption && !wasInStep) throw std::invalid_argument(status.message);
  check(status);
}

btRigidBody& alive(const World::RigidBody& rigid) {
  if (rigid.removed) fail(StatusCode::BodyDeleted, "the rigid body has been removed from its world");
  return *rigid.body;
}

DeformableBody& alive(const World::Body& body) {
  if (body.removed) fail(StatusCode::BodyDeleted, "the body has been removed from its world");
  return *body.body;
}

void checkSurface(const World::Body& body) {
  if (!body.binding) fail(StatusCode::Unbound, "the body has no surface: it was added without a mesh");
}

SoftBodySkin& surfaceOf(World::Body& body) {
  (void)alive(body);
  checkSurface(body);
  return body.skin;
}

const SurfaceTree& treeOf(World& world, World::Body& body) {
  return *take(world.treeOf(body));
}

ImpulseResult radialImpulse(World& world, World::Body& body, const RadialImpulse& impulse) {
  const ImpulseResult result = treeOf(world, body).applyImpulse(body.body->body(), impulse);
  if (result.status != StatusCode::NoHit) check(result.status, "a radial impulse");
  return result;
}

ForceRecord& forcesOf(World& world) {
  if (ForceRecord* const record = world.forces()) return *record;
  fail(StatusCode::NotAdded, "record_forces: the world was made with this false, and records no forces");
}

namespace {

/// Its current position, or that in the next step.
btTransform poseOf(const World::RigidBody& rigid) {
  btTransform pose = alive(rigid).getWorldTransform();
  rigid.motion->getWorldTransform(pose);
  return pose;
}

}  // namespace

void setPosition(World& world, World::RigidBody& rigid, const Vec3& position) {
  btTransform pose = poseOf(rigid);
  pose.setOrigin(toBullet(position, "position"));
  world.setPose(rigid, pose);
}

void setRotation(World& world, World::RigidBody& rigid, const Quaternion& rotation) {
  btTransform pose = poseOf(rigid);
  pose.setRotation(toBullet(Vec3{}, rotation).getRotation());
  world.setPose(rigid, pose);
}

namespace {

void checkNodes(const std::vector<int>& nodes, std::size_t count) {
  for (const int node : nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      fail(StatusCode::IndexOutOfRange, "nodes: there is no node " + std::to_string(node));
  }
}

std::size_t nodeCount(const World::Body& body) {
  return body.cage->mesh.nodeCount();
}

PointView<const double> pointsOf(const double* numbers, std::size_t count, std::size_t nodes, const char* name) {
  if (count != 3 * nodes)
    fail(StatusCode::SizeMismatch,
         std::string(name) + ": " + std::to_string(count) + " numbers for " + std::to_string(nodes) + " nodes");
  const PointView<const double> points(numbers, nodes);
  if (firstUnusable(points) != nodes)
    fail(StatusCode::NonFinite, std::string(name) + ": a number is not finite, or larger than 1e18");
  return points;
}

btVector3 vectorAt(const PointView<const double>& points, std::size_t i) {
  return {static_cast<btScalar>(points[i][0]), static_cast<btScalar>(points[i][1]),
          static_cast<btScalar>(points[i][2])};
}

}  // namespace

void setVelocities(World::Body& body, const double* velocities, std::size_t numbers) {
  btSoftBody& soft = alive(body).body();
  const PointView<const double> points = pointsOf(velocities, numbers, nodeCount(body), "velocities");
  for (std::size_t i = 0; i < points.size(); ++i) {
    btSoftBody::Node& node = soft.m_nodes[static_cast<int>(i)];
    if (node.m_im > 0) node.m_v = vectorAt(points, i);
  }
  soft.activate(true);
}

void setPinned(World::Body& body, const std::vector<int>& nodes, bool pinned) {
  DeformableBody& soft = alive(body);
  checkNodes(nodes, nodeCount(body));
  for (const int node : nodes) check(soft.setPinned(node, pinned));
}

void setPinnedPositions(World::Body& body, const std::vector<int>& nodes, const double* positions,
                        std::size_t numbers) {
  DeformableBody& soft = alive(body);
  checkNodes(nodes, nodeCount(body));
  const PointView<const double> points = pointsOf(positions, numbers, nodes.size(), "positions");
  for (const int node : nodes) {
    if (!soft.isPinned(node)) fail(StatusCode::InvalidOption, "nodes: node " + std::to_string(node) + " is not pinned");
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) check(soft.setPinnedPosition(nodes[i], vectorAt(points, i)));
}

void setPressureSurface(World::Body& body, const MeshModel& mesh) {
  DeformableBody& own = alive(body);
  if (!mesh.mesh) return check(own.setPressureSurface({}, {}));
  Result<Embedding> embedding = embed(*body.cage, *mesh.mesh);
  if (embedding.status().code == StatusCode::CageMismatch) {  // another mesh than that of the cage
    Cage cage = *body.cage;
    cage.vertexTets.clear();
    embedding = embed(cage, *mesh.mesh);
  }
  check(own.setPressureSurface(*mesh.mesh, take(std::move(embedding))));
}

std::vector<unsigned char> pinnedOf(const World::Body& body) {
  const DeformableBody& soft = alive(body);
  std::vector<unsigned char> mask(nodeCount(body));
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = soft.isPinned(static_cast<int>(i));
  return mask;
}

void setFriction(World::Body& body, double friction) {
  btSoftBody& soft = alive(body).body();
  if (!(friction >= 0.0 && friction <= 1.0)) fail(StatusCode::InvalidOption, "friction: must be from 0 to 1");
  soft.m_cfg.kDF = static_cast<btScalar>(friction);
}

void setFriction(World::RigidBody& rigid, double friction) {
  if (!(friction >= 0.0 && friction < 1e6)) throw std::invalid_argument("friction: must be 0 or more, and finite");
  alive(rigid).setFriction(static_cast<btScalar>(friction));
}

void setRestitution(btCollisionObject& object, double restitution) {
  if (!(restitution >= 0.0 && restitution <= 1.0)) fail(StatusCode::InvalidOption, "restitution: must be from 0 to 1");
  object.setRestitution(static_cast<btScalar>(restitution));
}

}  // namespace tetskin::facade
