// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/matrix/tet_stiffness.h>

#include <cassert>

namespace tetskin::elastic_detail {

TetStiffness::TetStiffness(const RestTets& rest, const std::vector<std::uint32_t>& slotOf) {
  std::size_t vectors = 0;
  const auto add = [&](const auto& nodes, std::size_t points) {
    const std::size_t first = slots_.size();
    for (const int n : nodes) slots_.push_back(slotOf[static_cast<std::size_t>(n)]);
    for (std::size_t k = 0; k < points; ++k, vectors += nodes.size()) {
      firstSlots_.push_back(static_cast<std::uint32_t>(first));
      firstVectors_.push_back(static_cast<std::uint32_t>(vectors));
      counts_.push_back(static_cast<std::uint32_t>(nodes.size()));
    }
  };
  for (const Tet& tet : rest.tets) add(tet, 1);
  for (const RestQuadraticTet& tet : rest.quadratic) add(tet.nodes, kQuadraticPoints);
  perLayer_ = vectors;
  vectors_.resize(vectors);
}

/// A point's vectors sum to exactly 0, to the last digit, so that nothing resists a translation.
template <class S>
void TetStiffness::take(const MatrixSource<S>& source) {
  assert(source.corners);
  const RestTets& rest = source.rest;
  ratio_ = source.ratio;
  spread_ = source.spread;
  layers_ = 1 + source.fibres.count;
  vectors_.resize(perLayer_ * layers_);
  std::size_t next = 0;
  const auto addPoint = [&](std::size_t nodes, auto&& component) {
    Eigen::Vector3d& first = vectors_[next];
    first.setZero();
    for (std::size_t n = 1; n < nodes; ++n) {
      Eigen::Vector3d& own = vectors_[next + n];
      for (std::size_t k = 0; k < 3; ++k) own[static_cast<Eigen::Index>(k)] = static_cast<double>(component(n, k));
      first -= own;
    }
    next += nodes;
  };
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    const S* const corners = layer == 0 ? source.corners : source.fibres.corners + (layer - 1) * source.fibres.size;
    for (std::size_t t = 0; t < rest.count(); ++t) {
      addPoint(4, [&](std::size_t n, std::size_t k) { return corners[4 * (4 * t + n) + k]; });
    }
    for (std::size_t t = 0; t < rest.quadratic.size(); ++t) {
      for (std::size_t point = 0; point < kQuadraticPoints; ++point) {
        addPoint(kQuadraticNodes,
                 [&](std::size_t n, std::size_t k) { return corners[4 * (rest.quadraticCorner(t, n) + k) + point]; });
      }
    }
  }
  assert(next == vectors_.size());
}

Eigen::Matrix3d TetStiffness::stress(const Eigen::Matrix3d& gradient, std::size_t layer) const {
  if (layer % 2 == 1) return gradient.trace() * Eigen::Matrix3d::Identity();
  if (layer > 0) return gradient;
  Eigen::Matrix3d sum = spread_ * gradient + gradient.transpose();
  sum.diagonal().array() += ratio_ * gradient.trace();
  return sum;
}

/// Plain numbers, which compilers keep in registers.
void TetStiffness::addProduct(const std::vector<double>& velocities, std::vector<double>& impulses) const {
  assert(velocities.size() == impulses.size());
  forPoints([&](const StiffnessPoint& at) {
    double g[9] = {};
    for (std::size_t n = 0; n < at.nodes; ++n) {
      const double *v = &velocities[3 * at.slots[n]], *a = at.vectors[n].data();
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) g[3 * i + k] += v[i] * a[k];
      }
    }
    if (at.layer > 0) {
      addFibres(at, Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(g), impulses);
      return;
    }
    const double bulk = ratio_ * (g[0] + g[4] + g[8]), more = spread_ - 1.0;
    const double xx = 2.0 * g[0] + bulk, yy = 2.0 * g[4] + bulk, zz = 2.0 * g[8] + bulk;
    const double xy = g[1] + g[3], xz = g[2] + g[6], yz = g[5] + g[7];
    for (std::size_t n = 0; n < at.nodes; ++n) {
      const double* a = at.vectors[n].data();
      double* to = &impulses[3 * at.slots[n]];
      to[0] += xx * a[0] + xy * a[1] + xz * a[2];
      to[1] += xy * a[0] + yy * a[1] + yz * a[2];
      to[2] += xz * a[0] + yz * a[1] + zz * a[2];
      for (int i = 0; i < 3 && more > 0.0; ++i) {
        to[i] += more * (g[3 * i] * a[0] + g[3 * i + 1] * a[1] + g[3 * i + 2] * a[2]);
      }
    }
  });
}

void TetStiffness::addFibres(const StiffnessPoint& at, const Eigen::Matrix3d& gradient,
                             std::vector<double>& impulses) const {
  const Eigen::Matrix3d rate = stress(gradient, at.layer);
  for (std::size_t n = 0; n < at.nodes; ++n) {
    Eigen::Map<Eigen::Vector3d>(&impulses[3 * std::size_t{at.slots[n]}]) += rate * at.vectors[n];
  }
}

#define TETSKIN_INSTANTIATE(Scalar) template void TetStiffness::take<Scalar>(const MatrixSource<Scalar>&);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
