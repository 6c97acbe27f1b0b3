// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/component_unknown.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Rounding in the matrix's products with translations, relative to these, from which on all products with rigid
/// motions are left out. From 0.5 on, a cube of 1e9 Pa that lands does not rest, or is thrown off.
constexpr double kRounded = 0.01;

using Fields = AlignedVector<btScalar>[Dynamics::kRigidMotions];

int indexOf(std::size_t k) {
  return static_cast<int>(k);
}

/// The products of six wide vectors with another one. There is a sum for each lane, as compilers do not change the
/// order of sums.
Small6 productsOf(const Fields& fields, const btScalar* wide) {
  constexpr auto kLanes = static_cast<std::size_t>(kernels::kGroup);
  Small6 products;
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
void addFields(const Fields& fields, const Small6& factors, btScalar* wide) {
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

std::vector<ComponentUnknown> ComponentUnknown::makeAll(const Dynamics& dynamics, std::size_t most,
                                                        ParallelFor* threads) {
  std::vector<ComponentUnknown> unknowns;
  Points points, products;
  for (std::size_t component = 0; component < std::min(dynamics.componentCount(), most); ++component) {
    if (dynamics.rigidMotions(component, points)) unknowns.emplace_back().component = component;
  }
  if (unknowns.empty()) return unknowns;
  // For all components at once: the matrix does not connect them.
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    products[k].assign(dynamics.matrix().wideSize(), btScalar(0));
    dynamics.matrix().multiply(points[k].data(), products[k].data(), threads);
  }
  for (ComponentUnknown& unknown : unknowns) {
    unknown.take(dynamics, points, products);
    const bool rounded = unknown.rounding(dynamics) > kRounded;
    if (rounded) unknown.leaveOutElasticity(dynamics);
    unknown.findMass(dynamics, !rounded);
  }
  return unknowns;
}

/// Takes what is the component's.
/// points    motions of all components, 4 scalars per slot
/// products  the matrix times these, in the wide layout
void ComponentUnknown::take(const Dynamics& dynamics, const Points& points, const Points& products) {
  const auto& matrix = dynamics.matrix();
  begin = matrix.wideSize();
  std::size_t end = 0;
  for (std::size_t n = 0; n < dynamics.nodeCount(); ++n) {
    if (dynamics.componentOf(n) != component) continue;
    nodes_.push_back(n);
    const std::size_t chunk = matrix.wideOf(n) / kernels::kWideVector * kernels::kWideVector;
    begin = std::min(begin, chunk);
    end = std::max(end, chunk + kernels::kWideVector);
  }
  assert(begin < end);
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    motions[k].assign(end - begin, btScalar(0));
    images[k].assign(end - begin, btScalar(0));
    for (const std::size_t n : nodes_) {
      toWide(fromPoint(&points[k][4 * matrix.slotOf(n)]), &motions[k][matrix.wideOf(n) - begin]);
      toWide(fromWide(&products[k][matrix.wideOf(n)]), &images[k][matrix.wideOf(n) - begin]);
    }
  }
}

/// What rounding has added to the images of translations, relative to these: nothing elastic resists a translation, so
/// that A Z = M Z. It grows with the stiffness of the tets, in relation to their mass.
double ComponentUnknown::rounding(const Dynamics& dynamics) const {
  const auto& matrix = dynamics.matrix();
  double added = 0.0, all = 0.0;
  for (std::size_t k = 0; k < Dynamics::kTranslations; ++k) {
    for (const std::size_t n : nodes_) {
      const std::size_t at = matrix.wideOf(n) - begin;
      const btVector3 exact = matrix.mass(n) * fromWide(&motions[k][at]);
      added += squaredNorm(toSmall(fromWide(&images[k][at])) - toSmall(exact));
      all += squaredNorm(toSmall(exact));
    }
  }
  return std::sqrt(added / all);
}

/// Elasticity resists rigid motions as far as the matrix belongs to other rotations than the body's, or to a deformed
/// body: little, in a body so stiff that rounding matters.
void ComponentUnknown::leaveOutElasticity(const Dynamics& dynamics) {
  const auto& matrix = dynamics.matrix();
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    for (const std::size_t n : nodes_) {
      const std::size_t at = matrix.wideOf(n) - begin;
      toWide(matrix.mass(n) * fromWide(&motions[k][at]), &images[k][at]);
    }
  }
}

/// elastic  whether the elastic forces count for the momentum; their sum is 0 but for rounding
void ComponentUnknown::findMass(const Dynamics& dynamics, bool elastic) {
  const auto& matrix = dynamics.matrix();
  AlignedVector<btScalar> right(motions[0].size(), btScalar(0));
  for (const std::size_t n : nodes_) {
    btVector3 own = matrix.mass(n) * fromWide(dynamics.deviation() + matrix.wideOf(n));
    if (elastic) dynamics.rightSide(n, own.m_floats);
    toWide(own, &right[matrix.wideOf(n) - begin]);
  }
  began = productsOf(motions, right.data());
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    mass.setColumn(indexOf(k), productsOf(motions, images[k].data()));
  }
  mass = 0.5 * (mass + transposed(mass));
}

Small6 ComponentUnknown::imageProducts(const btScalar* wide) const {
  return productsOf(images, wide + begin);
}

Small6 ComponentUnknown::motionProducts(const btScalar* wide) const {
  return productsOf(motions, wide + begin);
}

void ComponentUnknown::addImages(const Small6& q, btScalar* wide) const {
  addFields(images, q, wide + begin);
}

void ComponentUnknown::addMotions(const Small6& q, Dynamics& dynamics) const {
  addFields(motions, q, dynamics.matrix().solution() + begin);
}

RowMotions ComponentUnknown::motionsAt(const Dynamics& dynamics, const CarriedPoint& point) const {
  assert(point.count > 0);
  RowMotions at;
  for (std::size_t k = 0; k < Dynamics::kRigidMotions; ++k) {
    const btVector3 motion = point.sum([&](int n) {
      const auto node = static_cast<std::size_t>(n);
      if (dynamics.componentOf(node) != component) return btVector3(0, 0, 0);
      return fromWide(&motions[k][dynamics.matrix().wideOf(node) - begin]);
    });
    at.setColumn(indexOf(k), toSmall(motion));
  }
  return at;
}

}  // namespace tetskin::bullet_detail
