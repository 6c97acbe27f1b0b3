// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Momentum and energy, in double, by formulas of their own.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include <Eigen/Core>

#include "contact/body_model.h"

class btMultiBody;
class btRigidBody;

namespace tetskin::contact_demo {

/// Angular momentum is about the world's origin.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  /// Sums of the bodies' norms: what errors are compared with.
  double linearScale = 0.0, angularScale = 0.0;

  void add(const Eigen::Vector3d& linearOfBody, const Eigen::Vector3d& angularOfBody);
};

void addMomentum(Momentum& sum, const btSoftBody& body);
void addMomentum(Momentum& sum, const btRigidBody& body);
/// Of its base: links are not looked at.
void addMomentum(Momentum& sum, const btMultiBody& body);

/// How a body moves as a whole; nodes that are held are left out.
struct RigidMotion {
  double mass = 0.0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();  ///< radians a second
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};
RigidMotion rigidMotionOf(const btSoftBody& body);

/// Of the fastest node, metres a second.
double fastestNode(const btSoftBody& body);

/// Of its tets, those that are inside out.
int invertedTets(const BodyModel& model, const btSoftBody& body);

double kineticEnergy(const btSoftBody& body);
double kineticEnergy(const btRigidBody& body);
double kineticEnergy(const btMultiBody& body);  ///< of its base
/// Of corotated elasticity.
/// stiffnessScale  tetCount; empty: 1
double elasticEnergy(const BodyModel& model, const btSoftBody& body, double youngsModulus, double poissonRatio,
                     const std::vector<double>& stiffnessScale);

}  // namespace tetskin::contact_demo
