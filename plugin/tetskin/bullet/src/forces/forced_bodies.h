// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bodies of `ForceModel::Corotated`, and how their nodes are read.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/elastic/src/shared/dynamics/body_dynamics.h>

#include <memory>
#include <vector>

namespace tetskin {

/// What a body resists deformation with.
struct ElasticMaterial {
  double youngsModulus = 0.0;  ///< in pressure units, above 0
  double poissonRatio = 0.3;   ///< 0 to below 0.5
  double damping = 0.02;       ///< seconds: damping forces are this times the rate of the elastic ones
};

/// How closely the velocities of a step are solved for.
struct SolverLimits {
  double tolerance = 5e-3;  ///< of the residual over that without elasticity; 0 to below 1
  int iterations = 100;     ///< of the conjugate gradient in each pass, at most; at least 1
};

using Dynamics = elastic_detail::BodyDynamics<btScalar>;

/// The state of a body's nodes; `predicted`: at m_q instead of m_x.
void readNodes(const btSoftBody& body, bool predicted, Dynamics& dynamics);

/// The body's tets at rest, by Bullet's numbers: the same whether the body has just been made or scaled since.
/// Cost    O(nodes + tets)
/// Errors  Degenerate: why nothing elastic can be made of them
Result<elastic_detail::RestTets> restTetsOf(const btSoftBody& body);
Status checkMaterial(const ElasticMaterial& material);
/// Whether it is not too stiff for the body's mass: see elastic_detail::checkStiffness.
Status checkStiffness(const btSoftBody& body, const ElasticMaterial& material);

/// One body, and what is derived from it.
struct ForcedBody {
  btSoftBody* body = nullptr;
  std::vector<double> stiffnessScale;  ///< by tet, or empty
  std::unique_ptr<Dynamics> dynamics;
  btScalar restMeasure = 0;  ///< of some tets: another one has been scaled
  /// That it was added in, and what the body would have another of in another world.
  btDeformableMultiBodyDynamicsWorld* world = nullptr;
  const btSoftBodyWorldInfo* worldInfo = nullptr;

  /// Makes, or makes anew, what is derived from the body's tets.
  /// rest  see `restTetsOf`
  void build(elastic_detail::RestTets rest, const ElasticMaterial& material);
  void setMaterial(const ElasticMaterial& material);
  /// Whether that was derived from as many nodes and tets as there are, and from the same rest shapes.
  bool hasItsCounts() const;
  bool hasItsRestShapes() const;
};

}  // namespace tetskin
