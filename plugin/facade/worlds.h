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

/// The options of a world, as languages give them; throws for numbers that the library refuses.
WorldOptions worldOptions(const Vec3& gravity, bool deterministic, bool recordForces, double sleepAfter,
                          int impactParts);

/// A collision shape, with the data that it refers to. Shared by bodies.
struct ShapeModel {
  std::shared_ptr<btCollisionShape> shape;
};

/// Where the rest space of a soft body is in the world.
struct Placement {
  Vec3 position{};
  Quaternion rotation{};
};

// All options of a soft body, from which the bindings make their functions: the library's structure, type, name in C++
// and JavaScript, name in Python, default (none for an option that is not given). The test style.options compares the
// types and comments that are written by hand with this table, and this table with the members and defaults of the
// structures.
// clang-format off
#define TETSKIN_BODY_OPTIONS(option)                                                    \
  option(Placement, Vec3, position, position, 0, 0, 0)                                  \
  option(Placement, Quaternion, rotation, rotation, 0, 0, 0, 1)                         \
  option(WorldBodyOptions, std::vector<int>, pinned, pinned)                            \
  option(SoftBodyOptions, std::optional<double>, mass, mass)                            \
  option(SoftBodyOptions, double, density, density, 100)                                \
  option(SoftBodyOptions, std::vector<double>, nodeMasses, node_masses)                 \
  option(SoftBodyOptions, std::optional<double>, youngsModulus, youngs_modulus)         \
  option(SoftBodyOptions, double, relativeStiffness, relative_stiffness, 50)            \
  option(SoftBodyOptions, std::vector<double>, stiffnessScale, stiffness_scale)         \
  option(SoftBodyOptions, double, poissonRatio, poisson_ratio, 0.3)                     \
  option(SoftBodyOptions, double, stiffnessDamping, stiffness_damping, 0.02)            \
  option(SoftBodyOptions, double, friction, friction, 0.5)                              \
  option(SoftBodyOptions, double, restitution, restitution, 0)                          \
  option(SoftBodyOptions, std::optional<double>, margin, margin)                        \
  option(SoftBodyOptions, double, solverTolerance, solver_tolerance, 0.005)             \
  option(SoftBodyOptions, int, maxIterations, max_iterations, 100)                      \
  option(BindingOptions, Choice<Interpolation>, interpolation, interpolation, "linear") \
  option(BindingOptions, Choice<Normals>, normals, normals, "none")                     \
  option(BindingOptions, Choice<OutsideRule>, outside, outside, "nearest")              \
  option(BindingOptions, std::optional<double>, maxDistance, max_distance)              \
  option(BindingOptions, double, hardEdgeDegrees, hard_edge_degrees, 5)                 \
  option(WorldBodyOptions, bool, visible, visible, true)                                \
  option(WorldBodyOptions, bool, surfaceContact, surface_contact, true)                 \
  option(WorldBodyOptions, bool, softContact, soft_contact, false)                      \
  option(WorldBodyOptions, bool, selfContact, self_contact, false)                      \
  option(WorldBodyOptions, std::optional<double>, contactMargin, contact_margin)        \
  option(WorldBodyOptions, std::optional<double>, sampleSpacing, sample_spacing)
// clang-format on

/// The options of a soft body, as languages give them.
struct BodyWords {
#define TETSKIN_FIELD(of, type, name, python, ...) type name{__VA_ARGS__};
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
/// The surface on which pressure acts: a mesh in the body's cage; without one, the boundary of its tets.
void setPressureSurface(World::Body& body, const MeshModel& mesh);
void setFriction(World::Body& body, double friction);
void setFriction(World::RigidBody& rigid, double friction);
void setRestitution(btCollisionObject& object, double restitution);

}  // namespace tetskin::facade
