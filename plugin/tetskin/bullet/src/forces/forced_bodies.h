// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bodies of an ElasticForce, and how their nodes are read.
#pragma once

#include <tetskin/bullet/elastic_force.h>
#include <tetskin/elastic/src/dynamics/body_dynamics.h>

#include <memory>
#include <vector>

namespace tetskin {

using Dynamics = elastic_detail::BodyDynamics<btScalar>;

/// The state of a body's nodes; `predicted`: at m_q instead of m_x.
void readNodes(const btSoftBody& body, bool predicted, Dynamics& dynamics);

/// Ok, or why nothing can be made of the body's tets.
Status checkTets(const btSoftBody& body, const std::vector<double>& stiffnessScale);
Status checkMaterial(const ElasticMaterial& material);
/// Whether it is not too stiff for the body's mass: see elastic_detail::checkStiffness.
Status checkStiffness(const btSoftBody& body, const ElasticMaterial& material);

/// One body under an ElasticForce.
struct ForcedBody {
  btSoftBody* body = nullptr;
  std::vector<double> stiffnessScale;  ///< by tet, or empty
  std::unique_ptr<Dynamics> dynamics;
  btScalar restMeasure = 0;  ///< of some tets: another one has been scaled
  /// That it was added in, and what the body would have another of in another world; null: not known.
  btDeformableMultiBodyDynamicsWorld* world = nullptr;
  const btSoftBodyWorldInfo* worldInfo = nullptr;
  bool solved = false;  ///< by a DeformableSolver: the force keeps out of it
  bool alone = false;   ///< no other force needs Bullet's own deformation gradients
  int hiddenTets = -1;  ///< how many are kept from Bullet; -1: none

  /// Makes, or makes anew, what is derived from the body's tets.
  void build(const ElasticMaterial& material);
  void setMaterial(const ElasticMaterial& material);
  void know(btDeformableMultiBodyDynamicsWorld& in);
  /// Whether that was derived from as many nodes and tets as there are, and from the same rest shapes.
  bool hasItsCounts() const;
  bool hasItsRestShapes() const;

  /// Bullet updates deformation gradients of its own between `reinitialize` and the first force of a step, which takes
  /// as long as all that we do, and only its own forces read them. It finds no tets then.
  void hideTets();
  void showTets();
};

}  // namespace tetskin
