// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the bodies of `ForceModel::Corotated`, and how their nodes are read.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>
#include <tetskin/elastic/src/exported/body_pressure.h>
#include <tetskin/elastic/src/exported/material_changes.h>
#include <tetskin/solver/src/base/placement.h>
#include <tetskin/solver/src/forces/quadratic_shapes.h>

#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

class WorldStream;

struct ElasticMaterial {
  double youngsModulus = 0.0;  ///< in pressure units, above 0
  double poissonRatio = 0.3;   ///< 0 to below 0.5
  double damping = 0.02;       ///< seconds: damping forces are this times the rate of the elastic ones

  bool operator==(const ElasticMaterial& other) const {
    return youngsModulus == other.youngsModulus && poissonRatio == other.poissonRatio && damping == other.damping;
  }
};

/// Tolerance and iteration bound of a step's solve for velocities.
struct SolverSettings {
  double tolerance = 5e-3;  ///< remaining forces relative to acting ones; 0 to below 1
  int iterations = 100;     ///< bound of the conjugate gradient's iterations per pass; at least 1
};

using Dynamics = elastic_detail::BodyDynamics<btScalar>;

/// Moves the nodes of any body, with their velocities, normals and trees, to another place.
/// dynamics  of the body, moved along; or null
void carryNodes(btSoftBody& body, Dynamics* dynamics, const Placement& placement);
/// A measure of the rest shapes of some tets; it changes if the body is scaled.
btScalar restMeasureOf(const btSoftBody& body);

/// The state of a body's nodes.
void readNodes(const btSoftBody& body, Dynamics& dynamics);

/// The body's tets at rest, all of them linear, computed from Bullet's numbers: the same for a new body and for one
/// that was scaled.
/// Cost    O(nodes + tets)
/// Errors  Degenerate: says why the tets cannot be simulated
Result<elastic_detail::RestTets> restTetsOf(const btSoftBody& body);
Status checkMaterial(const ElasticMaterial& material);
/// Ok unless the material, with its changes, is too stiff for the body's mass: see elastic_detail::checkStiffness.
Status checkStiffness(const btSoftBody& body, const ElasticMaterial& material,
                      const elastic_detail::MaterialChanges& changes);
/// Ok unless it is not finite, or too large for the body's mass and size: see elastic_detail::checkPressure.
Status checkPressure(const btSoftBody& body, double pressure);
Status checkGas(const btSoftBody& body, double pressure, double outside);

/// One body, and the data derived from it.
struct ForcedBody {
  btSoftBody* body = nullptr;
  std::vector<double> stiffnessScale;       ///< by tet, or empty
  std::vector<double> paintedDamping;       ///< the same
  std::vector<QuadraticShape> quadratic;    ///< those whose parts are still tets of the body, see `withQuadraticTets`
  elastic_detail::MaterialChanges changes;  ///< what the owner has set
  std::unique_ptr<Dynamics> dynamics;
  elastic_detail::BodyPressure<btScalar> pressure;
  std::size_t tetCount = 0;  ///< tets of the body when `dynamics` was created
  btScalar restMeasure = 0;  ///< measure of some tets: changes if the body is scaled
  /// The world in which it was added; in another world the body would have another force.
  btDeformableMultiBodyDynamicsWorld* world = nullptr;
  const btSoftBodyWorldInfo* worldInfo = nullptr;

  /// Computes, or renews, the data derived from the body's tets. Scale factors and quadratic tets are dropped if the
  /// number of tets has changed.
  /// linear  see `restTetsOf`; its nodes are the cage's, or empty
  void build(const elastic_detail::RestTets& linear, const ElasticMaterial& material);
  void setMaterial(const ElasticMaterial& material);
  /// Gives the tets `changes`.
  void applyChanges(const ElasticMaterial& material);
  /// Gives them growth and muscles alone.
  void applyShapes(const ElasticMaterial& material);
  /// Forgets all steps, as if the body had just been built.
  void reset(const ElasticMaterial& material);
  /// True if the body still has the nodes, tets and rest shapes from which the data was derived.
  bool hasOwnCounts() const;
  bool hasItsRestShapes() const;

  /// The positions of its nodes.
  elastic_detail::BodyProbe<btScalar> probe() const;

  /// Writes or reads the pressure, and what the dynamics remember from step to step. When reading, the nodes and the
  /// material are already the snapshot's.
  void serialize(WorldStream& stream, const ElasticMaterial& material);
};

}  // namespace tetskin::bullet_detail
