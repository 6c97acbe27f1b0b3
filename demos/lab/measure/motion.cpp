// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/motion.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "measure/extremes.h"

namespace tetskin::measure {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d inertiaOf(const btRigidBody& body) {
  const Matrix3d turn = [&] {
    const btMatrix3x3& basis = body.getWorldTransform().getBasis();
    Matrix3d m;
    for (int k = 0; k < 3; ++k) m.row(k) = toEigen(basis[k]);
    return m;
  }();
  return turn * toEigen(body.getLocalInertia()).asDiagonal() * turn.transpose();
}

/// The edges from a tet's first node to the others, as columns.
/// position  gives that of a node
template <class Position>
Matrix3d edgesOf(const Position& position, const Tet& tet) {
  Matrix3d edges;
  for (std::size_t k = 0; k < 3; ++k) edges.col(static_cast<int>(k)) = position(tet[k + 1]) - position(tet[0]);
  return edges;
}

double massOf(const btSoftBody::Node& node) {
  return node.m_im > 0 ? 1.0 / static_cast<double>(node.m_im) : 0.0;
}

}  // namespace

void Momentum::add(const Vector3d& linearOfBody, const Vector3d& angularOfBody) {
  linear += linearOfBody;
  angular += angularOfBody;
  linearScale += linearOfBody.norm();
  angularScale += angularOfBody.norm();
}

void addMomentum(Momentum& sum, const btSoftBody& body) {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const Vector3d p = massOf(body.m_nodes[n]) * toEigen(body.m_nodes[n].m_v);
    linear += p;
    angular += toEigen(body.m_nodes[n].m_x).cross(p);
  }
  sum.add(linear, angular);
}

void addMomentum(Momentum& sum, const btRigidBody& body) {
  const Vector3d p = toEigen(body.getLinearVelocity()) / static_cast<double>(body.getInvMass());
  sum.add(p, toEigen(body.getCenterOfMassPosition()).cross(p) + inertiaOf(body) * toEigen(body.getAngularVelocity()));
}

void addMomentum(Momentum& sum, const btMultiBody& body) {
  const Vector3d p = static_cast<double>(body.getBaseMass()) * toEigen(body.getBaseVel());
  const btQuaternion toBase = body.getWorldToBaseRot();
  const btVector3 spin = body.getBaseInertia() * quatRotate(toBase, body.getBaseOmega());
  sum.add(p, toEigen(body.getBasePos()).cross(p) + toEigen(quatRotate(toBase.inverse(), spin)));
}

Vector3d angularMomentumAbout(const Vector3d& pivot, const btSoftBody& body) {
  Vector3d sum = Vector3d::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    sum += massOf(node) * (toEigen(node.m_x) - pivot).cross(toEigen(node.m_v));
  }
  return sum;
}

RigidMotion rigidMotionOf(const btSoftBody& body) {
  RigidMotion motion;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double mass = massOf(body.m_nodes[n]);
    motion.mass += mass;
    motion.centroid += mass * toEigen(body.m_nodes[n].m_x);
    motion.velocity += mass * toEigen(body.m_nodes[n].m_v);
  }
  motion.centroid /= motion.mass;
  motion.velocity /= motion.mass;
  Vector3d angular = Vector3d::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double mass = massOf(body.m_nodes[n]);
    const Vector3d arm = toEigen(body.m_nodes[n].m_x) - motion.centroid;
    angular += mass * arm.cross(toEigen(body.m_nodes[n].m_v) - motion.velocity);
    motion.inertia += mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
  }
  motion.spin = motion.inertia.ldlt().solve(angular);
  return motion;
}

double fastestNode(const btSoftBody& body) {
  double fastest = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    raise(fastest, toEigen(body.m_nodes[n].m_v).norm());
  }
  return fastest;
}

int invertedTets(const BodyModel& model, const btSoftBody& body) {
  const auto position = [&](int n) { return toEigen(body.m_nodes[n].m_x); };
  return static_cast<int>(std::count_if(model.cage.mesh.tets.begin(), model.cage.mesh.tets.end(),
                                        [&](const Tet& tet) { return !(edgesOf(position, tet).determinant() > 0.0); }));
}

double kineticEnergy(const btSoftBody& body) {
  double energy = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    energy += 0.5 * massOf(body.m_nodes[n]) * toEigen(body.m_nodes[n].m_v).squaredNorm();
  }
  return energy;
}

double kineticEnergy(const btRigidBody& body) {
  const Vector3d spin = toEigen(body.getAngularVelocity());
  return 0.5 * (toEigen(body.getLinearVelocity()).squaredNorm() / static_cast<double>(body.getInvMass()) +
                spin.dot(inertiaOf(body) * spin));
}

double kineticEnergy(const btMultiBody& body) {
  const Vector3d spin = toEigen(quatRotate(body.getWorldToBaseRot(), body.getBaseOmega()));
  return 0.5 * (static_cast<double>(body.getBaseMass()) * toEigen(body.getBaseVel()).squaredNorm() +
                spin.dot(toEigen(body.getBaseInertia()).cwiseProduct(spin)));
}

namespace {

/// The energy per volume as it stands in elastic/src/kernels/hyperelasticity.h, by principal stretches.
double energyOfLaw(const ElasticLaw& law, double mu, double lambda, const Vector3d& stretches) {
  const double squares = stretches.squaredNorm(), grown = stretches.prod() - 1.0;
  const double ofVolume = grown < 3.0 ? 3.0 + 2.0 * grown - grown * grown / 3.0 : 6.0;  // 3 J^(2/3), nearly
  const double distortion = std::max(squares - ofVolume, 0.0), k = std::min(distortion, largestDistortion(law));
  const double stiffened = k * k * (law.c2 + law.c3 * k) + k * (2.0 * law.c2 + 3.0 * law.c3 * k) * (distortion - k);
  const double collapsed = std::pow(std::max(3.0 - squares, 0.0) / 3.0, 3.0);
  const double apart = std::max(1.0 - stretches.sum(), 0.0);
  return 0.5 * mu * (squares - 3.0 + collapsed + stiffened + apart * apart) - mu * grown +
         0.5 * (lambda + mu) * grown * grown;
}

}  // namespace

double elasticEnergy(const BodyModel& model, const btSoftBody& body, const ElasticModuli& moduli, const ElasticLaw& law,
                     const std::vector<double>& stiffnessScale) {
  const double mu = moduli.youngsModulus / (2.0 * (1.0 + moduli.poissonRatio));
  const double lambda = 2.0 * mu * moduli.poissonRatio / (1.0 - 2.0 * moduli.poissonRatio);
  double energy = 0.0;
  for (std::size_t t = 0; t < model.cage.mesh.tets.size(); ++t) {
    const Tet& tet = model.cage.mesh.tets[t];
    const Matrix3d rest = edgesOf([&](int n) { return model.cage.mesh.nodes[static_cast<std::size_t>(n)]; }, tet);
    const Matrix3d gradient = edgesOf([&](int n) { return toEigen(body.m_nodes[n].m_x); }, tet) * rest.inverse();
    // The smallest singular value is negative if the tet is inverted.
    Vector3d strain = Eigen::JacobiSVD<Matrix3d>(gradient).singularValues();
    if (gradient.determinant() < 0.0) strain[2] = -strain[2];
    const double volume = std::abs(rest.determinant()) / 6.0 * (stiffnessScale.empty() ? 1.0 : stiffnessScale[t]);
    if (law.kind != ElasticLaw::Kind::Corotated) {
      energy += volume * energyOfLaw(law, mu, lambda, strain);
      continue;
    }
    strain.array() -= 1.0;
    energy += volume * (mu * strain.squaredNorm() + 0.5 * lambda * strain.sum() * strain.sum());
  }
  return energy;
}

}  // namespace tetskin::measure
