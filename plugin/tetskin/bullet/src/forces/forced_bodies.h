// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bodies of an ElasticForce, and how their nodes are read.
#pragma once

#include <tetskin/bullet/elastic_force.h>
#include <tetskin/elastic/src/dynamics/body_dynamics.h>

#include <memory>
#include <vector>

class btDeformableBodySolver;

namespace tetskin {

using Dynamics = elastic_detail::BodyDynamics<btScalar>;

/// The state of a body's nodes; `predicted`: at m_q instead of m_x.
void readNodes(const btSoftBody& body, bool predicted, Dynamics& dynamics);

/// One body under an ElasticForce.
struct ElasticBody {
  btSoftBody* body = nullptr;
  std::vector<double> stiffnessScale;  ///< by tet, or empty
  std::unique_ptr<Dynamics> dynamics;
  btScalar restMeasure = 0;  ///< of some tets: another one has been scaled
  bool solved = false;       ///< by a DeformableSolver: the force keeps out of it
  bool alone = false;        ///< no other force needs Bullet's own deformation gradients
  int hiddenTets = -1;       ///< how many are kept from Bullet; -1: none
};

/// Ok, or why nothing can be made of the body's tets.
Status checkTets(const btSoftBody& body, const std::vector<double>& stiffnessScale);
Status checkMaterial(const ElasticMaterial& material);

struct ElasticForce::Parts {
  explicit Parts(const ElasticMaterial& ofMaterial);
  ~Parts();

  /// Makes, or makes anew, what is derived from a body's tets.
  void build(ElasticBody& of) const;
  void applyMaterial(ElasticBody& to) const;
  /// The dynamics of a body, or null; made anew if the body has been changed.
  ElasticBody* find(const btSoftBody* body);

  class Preconditioner;
  void precondition(btDeformableBodySolver& solver, ElasticBody& of);

  ElasticMaterial material;
  SolverLimits limits;
  std::vector<std::unique_ptr<ElasticBody>> bodies;
  std::unique_ptr<Preconditioner> preconditioner;
  bool bodyRemoved = false;  ///< the next reinitialisation is not the beginning of a step
  int knownForces = -1;      ///< in the world, when `alone` was found out
};

}  // namespace tetskin
