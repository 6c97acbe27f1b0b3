// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Momentum and energy in double precision, by formulas independent of the library.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/elastic/elastic_law.h>

#include <Eigen/Core>

#include "measure/body_model.h"

class btMultiBody;
class btRigidBody;

namespace tetskin::measure {

/// Linear momentum, and angular momentum about the world's origin.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  /// Sums of the bodies' norms, with which errors are compared.
  double linearScale = 0.0, angularScale = 0.0;

  void add(const Eigen::Vector3d& linearOfBody, const Eigen::Vector3d& angularOfBody);
};

void addMomentum(Momentum& sum, const btSoftBody& body);
void addMomentum(Momentum& sum, const btRigidBody& body);
/// Adds the momentum of the base: links are ignored.
void addMomentum(Momentum& sum, const btMultiBody& body);

/// Without pinned nodes.
Eigen::Vector3d angularMomentumAbout(const Eigen::Vector3d& pivot, const btSoftBody& body);

/// How a body moves as a whole; pinned nodes are left out.
struct RigidMotion {
  double mass = 0.0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();  ///< radians per second
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};
RigidMotion rigidMotionOf(const btSoftBody& body);

/// Speed of the fastest node, metres per second.
double fastestNode(const btSoftBody& body);

/// The number of inverted tets.
int invertedTets(const BodyModel& model, const btSoftBody& body);

double kineticEnergy(const btSoftBody& body);
double kineticEnergy(const btRigidBody& body);
double kineticEnergy(const btMultiBody& body);  ///< kinetic energy of its base
/// The energy of elasticity by a law.
/// stiffnessScale  tetCount; empty: 1
double elasticEnergy(const BodyModel& model, const btSoftBody& body, const ElasticModuli& moduli, const ElasticLaw& law,
                     const std::vector<double>& stiffnessScale);

}  // namespace tetskin::measure
