// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Worlds for other languages: the calls of tetskin::World with words and numbers of these languages, which throw. The
// bindings hold shares of a world and of an object in it, so that the order of release does not matter. A removed
// object refuses to be used.
#pragma once

#include "models.h"

#include <tetskin/world/world.h>

#include <limits>
#include <vector>

namespace tetskin::facade {

btVector3 toBullet(const Vec3& vector, const char* name);
btTransform toBullet(const Vec3& position, const Quaternion& rotation);

/// A collision shape, with the data that it refers to. Shared by bodies.
struct ShapeModel {
  std::shared_ptr<btCollisionShape> shape;
};

// All options of a soft body, from which the bindings make their functions: type, name in C++ and JavaScript, name in
// Python, default (none for an option that is not given). A test compares the types and the comments that are written
// by hand with this table, and this table with the defaults of the library.
// clang-format off
#define TETSKIN_BODY_OPTIONS(option)                                    \
  option(Vec3, position, position, 0, 0, 0)                             \
  option(Quaternion, rotation, rotation, 0, 0, 0, 1)                    \
  option(std::vector<int>, pinned, pinned)                              \
  option(std::optional<double>, mass, mass)                             \
  option(double, density, density, 100)                                 \
  option(std::vector<double>, nodeMasses, node_masses)                  \
  option(std::optional<double>, youngsModulus, youngs_modulus)          \
  option(double, relativeStiffness, relative_stiffness, 50)             \
  option(std::vector<double>, stiffnessScale, stiffness_scale)          \
  option(double, poissonRatio, poisson_ratio, 0.3)                      \
  option(double, stiffnessDamping, stiffness_damping, 0.02)             \
  option(double, friction, friction, 0.5)                               \
  option(std::optional<double>, margin, margin)                         \
  option(double, solverTolerance, solver_tolerance, 0.005)              \
  option(int, maxIterations, max_iterations, 100)                       \
  option(Choice<Interpolation>, interpolation, interpolation, "linear") \
  option(Choice<Normals>, normals, normals, "none")                     \
  option(Choice<OutsideRule>, outside, outside, "nearest")              \
  option(std::optional<double>, maxDistance, max_distance)              \
  option(bool, visible, visible, true)                                  \
  option(bool, surfaceContact, surface_contact, true)                   \
  option(bool, softContact, soft_contact, false)                        \
  option(bool, selfContact, self_contact, false)                        \
  option(std::optional<double>, contactMargin, contact_margin)          \
  option(std::optional<double>, sampleSpacing, sample_spacing)
// clang-format on

/// The options of a soft body, as languages give them.
struct BodyWords {
#define TETSKIN_FIELD(type, name, python, ...) type name{__VA_ARGS__};
  TETSKIN_BODY_OPTIONS(TETSKIN_FIELD)
#undef TETSKIN_FIELD
};

std::shared_ptr<World::Body> addBody(World& world, const CageModel& cage, const MeshModel& mesh,
                                     const BodyWords& options);
std::shared_ptr<World::RigidBody> addRigid(World& world, const ShapeModel& shape, double mass, const btTransform& pose,
                                           double friction, bool kinematic);

/// An option out of range is an argument's fault, unless the world is within a step.
void checkStepped(const Status& status, bool wasInStep);
/// As `World::step`. stepped  makes the step: directly, or by a recorder
template <class Stepped>
int step(World& world, double dt, int substeps, Stepped&& stepped) {
  const bool inStep = world.inStep();
  Result<int> made = world.step(dt, substeps, std::forward<Stepped>(stepped));
  checkStepped(made.status(), inStep);
  return made.value();
}

/// Throw if the object has been removed from its world.
btRigidBody& alive(const World::RigidBody& rigid);
DeformableBody& alive(const World::Body& body);
void checkSurface(const World::Body& body);
/// The surface of a body that has one; throws otherwise.
SoftBodySkin& surfaceOf(World::Body& body);
const SurfaceTree& treeOf(World& world, World::Body& body);
ImpulseResult radialImpulse(World& world, World::Body& body, const RadialImpulse& impulse);
ForceRecord& forcesOf(World& world);

void setPosition(World& world, World::RigidBody& rigid, const Vec3& position);
void setRotation(World& world, World::RigidBody& rigid, const Quaternion& rotation);

/// By node. Throw, and change nothing, for a wrong count, a number that is not finite, or a node that does not exist.
/// velocities, positions  three numbers for each; velocities of pinned nodes stay
void setVelocities(World::Body& body, const double* velocities, std::size_t numbers);
void setPinned(World::Body& body, const std::vector<int>& nodes, bool pinned);
void setPinnedPositions(World::Body& body, const std::vector<int>& nodes, const double* positions, std::size_t numbers);
std::vector<unsigned char> pinnedOf(const World::Body& body);
void setFriction(World::Body& body, double friction);
void setFriction(World::RigidBody& rigid, double friction);

}  // namespace tetskin::facade
