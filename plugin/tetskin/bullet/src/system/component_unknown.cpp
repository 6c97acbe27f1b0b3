// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/forces/node_vectors.h>
#include <tetskin/bullet/src/system/component_unknown.h>

#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Stiffness factor from which on the matrix's product with rigid motions is only rounding.
constexpr double kRounded = 1e5;

using Fields = AlignedVector<btScalar>[Dynamics::kRigidMotions];

Eigen::Index indexOf(std::size_t k) {
  return static_cast<Eigen::Index>(k);
}

/// The products of six wide vectors with another one. There is a sum for each lane, as compilers do not change the
/// order of sums.
Vector6 productsOf(const Fields& fields, const btScalar* wide) {
  constexpr auto kLanes = static_cast<std::size_t>(kernels::kGroup);
  Vector6 products;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    const btScalar* field = fields[k].data();
    const std::size_t size = fields[k].size();
    assert(size % kLanes == 0);
    double sums[kLanes] = {};
    for (std::size_t i = 0; i < size; i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        sums[lane] += static_cast<double>(field[i + lane]) * static_cast<double>(wide[i + lane]);
      }
    }
    products[indexOf(k)] = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  }
  return products;
}

/// Adds the sum of the fields, each times its factor.
void addFields(const Fields& fields, const Vector6& factors, btScalar* wide) {
  constexpr auto kLanes = static_cast<std::size_t>(kernels::kGroup);
  btScalar q[Dynamics::kRigidMotions];
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) q[k] = static_cast<btScalar>(factors[indexOf(k)]);
  const btScalar *a = fields[0].data(), *b = fields[1].data(), *c = fields[2].data(), *d = fields[3].data(),
                 *e = fields[4].data(), *f = fields[5].data();
  assert(fields[0].size() % kLanes == 0);
  for (std::size_t i = 0; i < fields[0].size(); i += kLanes) {
    btScalar sums[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = i + lane;
      sums[lane] = wide[at] + q[0] * a[at] + q[1] * b[at] + q[2] * c[at] + q[3] * d[at] + q[4] * e[at] + q[5] * f[at];
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) wide[i + lane] = sums[lane];
  }
}

}  // namespace

std::optional<ComponentUnknown> ComponentUnknown::make(const Dynamics& dynamics, std::size_t component,
                                                       ParallelFor* threads) {
  assert(component < dynamics.componentCount());
  ComponentUnknown unknown;
  Points points;
  if (!dynamics.rigidMotions(component, points)) return std::nullopt;
  const bool rounded = dynamics.stiffnessNumber() > kRounded;
  unknown.findImages(dynamics, points, rounded, threads);
  const auto& matrix = dynamics.matrix();
  AlignedVector<btScalar> right(matrix.wideSize(), btScalar(0));
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    btVector3 began = matrix.mass(n) * fromWide(dynamics.deviation() + matrix.wideOf(n));
    if (!rounded) dynamics.rightSide(n, began.m_floats);
    toWide(began, &right[matrix.wideOf(n)]);
  }
  unknown.began = unknown.motionProducts(right.data());
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    unknown.mass.col(indexOf(k)) = unknown.motionProducts(unknown.images[k].data());
  }
  unknown.mass = (0.5 * (unknown.mass + unknown.mass.transpose())).eval();
  return unknown;
}

/// Elasticity resists rigid motions as far as the matrix belongs to other rotations than the body's, or to a deformed
/// body. For the stiffest bodies, rounding in this product would exceed their mass, so that it is left out.
/// points  the motions, 4 scalars per slot
void ComponentUnknown::findImages(const Dynamics& dynamics, const Points& points, bool rounded, ParallelFor* threads) {
  const auto& matrix = dynamics.matrix();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    motions[k].assign(matrix.wideSize(), btScalar(0));
    images[k].assign(matrix.wideSize(), btScalar(0));
    if (!rounded) matrix.multiply(points[k].data(), images[k].data(), threads);
    for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
      const btVector3 motion = fromPoint(&points[k][4 * matrix.slotOf(n)]);
      toWide(motion, &motions[k][matrix.wideOf(n)]);
      if (rounded) toWide(matrix.mass(n) * motion, &images[k][matrix.wideOf(n)]);
    }
  }
}

Vector6 ComponentUnknown::imageProducts(const btScalar* wide) const {
  return productsOf(images, wide);
}

Vector6 ComponentUnknown::motionProducts(const btScalar* wide) const {
  return productsOf(motions, wide);
}

void ComponentUnknown::addImages(const Vector6& q, btScalar* wide) const {
  addFields(images, q, wide);
}

void ComponentUnknown::addMotions(const Vector6& q, Dynamics& dynamics) const {
  addFields(motions, q, dynamics.matrix().solution());
}

RowMotions ComponentUnknown::motionsAt(const Dynamics& dynamics, const CarriedPoint& point) const {
  assert(point.count > 0);
  RowMotions at;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    at.col(indexOf(k)) = toEigen(
        point.sum([&](int n) { return fromWide(&motions[k][dynamics.matrix().wideOf(static_cast<std::size_t>(n))]); }));
  }
  return at;
}

}  // namespace tetskin::bullet_detail
