// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/solver/component_unknown.h>

#include <cassert>

namespace tetskin {
namespace {

/// Stiffness factor from which on the matrix's product with rigid motions is only rounding.
constexpr double kRounded = 1e5;

Eigen::Index indexOf(std::size_t k) {
  return static_cast<Eigen::Index>(k);
}

}  // namespace

std::optional<ComponentUnknown> ComponentUnknown::make(const Dynamics& dynamics, std::size_t component,
                                                       ParallelFor* threads) {
  assert(component < dynamics.componentCount());
  ComponentUnknown unknown;
  if (!dynamics.rigidMotions(component, unknown.motions)) return std::nullopt;
  const bool rounded = dynamics.stiffnessNumber() > kRounded;
  unknown.findImages(dynamics, rounded, threads);
  const auto& matrix = dynamics.matrix();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    btVector3 began = matrix.mass(n) * fromWide(dynamics.deviation() + matrix.wideOf(n));
    if (!rounded) dynamics.rightSide(n, began.m_floats);
    for (std::size_t i = 0; i < Dynamics::kRigidMotions; ++i) {
      const Eigen::Vector3d motion = toEigen(fromPoint(&unknown.motions[i][4 * matrix.slotOf(n)]));
      unknown.began[indexOf(i)] += motion.dot(toEigen(began));
      for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
        unknown.mass(indexOf(i), indexOf(k)) += motion.dot(toEigen(fromWide(&unknown.images[k][matrix.wideOf(n)])));
      }
    }
  }
  unknown.mass = (0.5 * (unknown.mass + unknown.mass.transpose())).eval();
  return unknown;
}

/// Elasticity resists rigid motions as far as the matrix belongs to other rotations than the body's, or to a deformed
/// body. For the stiffest bodies, rounding in this product would exceed their mass, so that it is left out.
void ComponentUnknown::findImages(const Dynamics& dynamics, bool rounded, ParallelFor* threads) {
  const auto& matrix = dynamics.matrix();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    images[k].assign(matrix.wideSize(), btScalar(0));
    if (!rounded) {
      matrix.multiply(motions[k].data(), images[k].data(), threads);
      continue;
    }
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
      toWide(matrix.mass(n) * fromPoint(&motions[k][4 * matrix.slotOf(n)]), &images[k][matrix.wideOf(n)]);
    }
  }
}

Vector6 ComponentUnknown::imageProducts(const btScalar* wide) const {
  Vector6 sums = Vector6::Zero();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    for (std::size_t i = 0; i < images[k].size(); ++i) {
      sums[indexOf(k)] += static_cast<double>(images[k][i]) * static_cast<double>(wide[i]);
    }
  }
  return sums;
}

Vector6 ComponentUnknown::motionProducts(const Dynamics& dynamics, const btScalar* wide) const {
  Vector6 sums = Vector6::Zero();
  const auto& matrix = dynamics.matrix();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    const Eigen::Vector3d vector = toEigen(fromWide(wide + matrix.wideOf(n)));
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      sums[indexOf(k)] += toEigen(fromPoint(&motions[k][4 * matrix.slotOf(n)])).dot(vector);
    }
  }
  return sums;
}

void ComponentUnknown::addImages(const Vector6& q, btScalar* wide) const {
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    const auto factor = static_cast<btScalar>(q[indexOf(k)]);
    for (std::size_t i = 0; i < images[k].size(); ++i) wide[i] += factor * images[k][i];
  }
}

void ComponentUnknown::addMotions(const Vector6& q, Dynamics& dynamics) const {
  auto& matrix = dynamics.matrix();
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    btScalar* to = matrix.solution() + matrix.wideOf(n);
    btVector3 moved = fromWide(to);
    for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
      moved += static_cast<btScalar>(q[indexOf(k)]) * fromPoint(&motions[k][4 * matrix.slotOf(n)]);
    }
    toWide(moved, to);
  }
}

RowMotions ComponentUnknown::motionsAt(const Dynamics& dynamics, const RowEnd& end) const {
  assert(end.isSoft() && end.body == body);
  RowMotions at;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    btVector3 sum(0, 0, 0);
    for (std::uint32_t n = 0; n < end.nodeCount; ++n) {
      const std::size_t slot = dynamics.matrix().slotOf(static_cast<std::size_t>(end.nodes[n]));
      sum += end.weights[n] * fromPoint(&motions[k][4 * slot]);
    }
    at.col(indexOf(k)) = toEigen(sum);
  }
  return at;
}

}  // namespace tetskin
