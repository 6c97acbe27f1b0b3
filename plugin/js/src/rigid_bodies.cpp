// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <facade/shapes.h>

namespace tetskin::js {
namespace {

struct RigidOptions {
  double mass = 0, friction = 0.5;
  Vec3 position{}, velocity{}, angularVelocity{};
  Quaternion rotation{0, 0, 0, 1};
  bool kinematic = false;
};

RigidHandle* add(WorldHandle& handle, const ShapeModel& shape, const RigidOptions& options) {
  const btVector3 velocity = toBullet(options.velocity, "velocity");
  const btVector3 angularVelocity = toBullet(options.angularVelocity, "angularVelocity");
  auto rigid = std::make_unique<RigidHandle>(RigidHandle{handle.world, {}});
  rigid->state = addRigid(*handle.world, shape, options.mass, toBullet(options.position, options.rotation),
                          options.friction, options.kinematic);
  if (options.mass > 0) {
    rigid->state->body->setLinearVelocity(velocity);
    rigid->state->body->setAngularVelocity(angularVelocity);
  }
  return rigid.release();
}

RigidHandle* addPlane(WorldHandle& handle, Vec3 normal, double offset, double friction) {
  RigidOptions options;
  options.friction = friction;
  return add(handle, plane(normal, offset), options);
}
RigidHandle* addBox(WorldHandle& handle, Vec3 halfExtents, RigidOptions options) {
  return add(handle, box(halfExtents), options);
}
RigidHandle* addSphere(WorldHandle& handle, double radius, RigidOptions options) {
  return add(handle, sphere(radius), options);
}
RigidHandle* addCapsule(WorldHandle& handle, double radius, double height, RigidOptions options) {
  return add(handle, capsule(radius, height), options);
}
RigidHandle* addCylinder(WorldHandle& handle, double radius, double height, RigidOptions options) {
  return add(handle, cylinder(radius, height), options);
}
RigidHandle* addConvexHull(WorldHandle& handle, Doubles numbers, RigidOptions options) {
  std::vector<Eigen::Vector3d> points(numbers.count / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Eigen::Vector3d>(numbers.begin() + 3 * i);
    finite({points[i].x(), points[i].y(), points[i].z()}, "points");
  }
  return add(handle, convexHull(points), options);
}
RigidHandle* addMesh(WorldHandle& handle, const MeshModel& mesh, RigidOptions options) {
  return add(handle, meshShape(*mesh.mesh), options);
}

Vec3 position(RigidHandle& rigid) {
  return vectorOf(alive(*rigid.state).getWorldTransform().getOrigin());
}
Quaternion rotation(RigidHandle& rigid) {
  const btQuaternion q = alive(*rigid.state).getWorldTransform().getRotation();
  return {q.x(), q.y(), q.z(), q.w()};
}
void setPosition(RigidHandle& rigid, Vec3 at) {
  facade::setPosition(*rigid.world, *rigid.state, at);
}
void setRotation(RigidHandle& rigid, Quaternion q) {
  facade::setRotation(*rigid.world, *rigid.state, q);
}
Vec3 velocity(RigidHandle& rigid) {
  return vectorOf(alive(*rigid.state).getLinearVelocity());
}
void setVelocity(RigidHandle& rigid, Vec3 velocity) {
  btRigidBody& body = alive(*rigid.state);
  body.setLinearVelocity(toBullet(velocity, "velocity"));
  body.activate(true);
}
Vec3 angularVelocity(RigidHandle& rigid) {
  return vectorOf(alive(*rigid.state).getAngularVelocity());
}
void setAngularVelocity(RigidHandle& rigid, Vec3 velocity) {
  btRigidBody& body = alive(*rigid.state);
  body.setAngularVelocity(toBullet(velocity, "angularVelocity"));
  body.activate(true);
}
double friction(RigidHandle& rigid) {
  return static_cast<double>(alive(*rigid.state).getFriction());
}
void setFriction(RigidHandle& rigid, double friction) {
  facade::setFriction(*rigid.state, friction);
}
double restitution(RigidHandle& rigid) {
  return static_cast<double>(alive(*rigid.state).getRestitution());
}
void setRestitution(RigidHandle& rigid, double restitution) {
  facade::setRestitution(alive(*rigid.state), restitution);
}
double mass(RigidHandle& rigid) {
  return static_cast<double>(alive(*rigid.state).getMass());
}
bool kinematic(RigidHandle& rigid) {
  return alive(*rigid.state).isKinematicObject();
}
void applyImpulse(RigidHandle& rigid, Vec3 impulse, Vec3 arm) {
  btRigidBody& body = alive(*rigid.state);
  const btVector3 push = toBullet(impulse, "impulse"), from = toBullet(arm, "at");
  body.activate(true);
  body.applyImpulse(push, from);
}
void remove(RigidHandle& rigid) {
  rigid.world->remove(*rigid.state);
}

}  // namespace

EMSCRIPTEN_BINDINGS(rigid_bodies) {
  emscripten::value_object<RigidOptions>("RigidOptions")
      .field("mass", &RigidOptions::mass)
      .field("friction", &RigidOptions::friction)
      .field("position", &RigidOptions::position)
      .field("rotation", &RigidOptions::rotation)
      .field("velocity", &RigidOptions::velocity)
      .field("angularVelocity", &RigidOptions::angularVelocity)
      .field("kinematic", &RigidOptions::kinematic);
  emscripten::class_<RigidHandle>("RigidBody");
  expose<&addPlane>("addPlane");
  expose<&addBox>("addBox");
  expose<&addSphere>("addSphere");
  expose<&addCapsule>("addCapsule");
  expose<&addCylinder>("addCylinder");
  expose<&addConvexHull>("addConvexHull");
  expose<&addMesh>("addMesh");
  expose<&position>("rigidPosition");
  expose<&setPosition>("setRigidPosition");
  expose<&rotation>("rigidRotation");
  expose<&setRotation>("setRigidRotation");
  expose<&velocity>("rigidVelocity");
  expose<&setVelocity>("setRigidVelocity");
  expose<&angularVelocity>("rigidAngularVelocity");
  expose<&setAngularVelocity>("setRigidAngularVelocity");
  expose<&friction>("rigidFriction");
  expose<&setFriction>("setRigidFriction");
  expose<&restitution>("rigidRestitution");
  expose<&setRestitution>("setRigidRestitution");
  expose<&mass>("rigidMass");
  expose<&kinematic>("rigidKinematic");
  expose<&applyImpulse>("applyRigidImpulse");
  expose<&remove>("removeRigidBody");
}

}  // namespace tetskin::js
