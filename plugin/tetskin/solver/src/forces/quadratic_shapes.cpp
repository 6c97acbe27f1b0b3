// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/solver/src/forces/quadratic_shapes.h>

#include <Eigen/Core>
#include <cassert>
#include <cmath>
#include <optional>

namespace tetskin::bullet_detail {
namespace {

using elastic_detail::RestQuadraticTet;
using elastic_detail::RestTets;
using Gradients = Eigen::Matrix<double, 4, 3>;  // of the four barycentric weights, one per row

/// By how much the gradients of the eight tets may differ, relatively: more than the rounding of nodes a thousand edges
/// away from the origin, and no more than the error of a quadratic tet itself.
constexpr double kTolerance = 1e-2;

Gradients gradientsOf(const std::array<double, 9>& ofOthers) {
  Gradients all;
  all.bottomRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(ofOthers.data());
  all.row(0) = -all.bottomRows<3>().colwise().sum();
  return all;
}

/// The gradients of the quadratic tet's weights, from the rest shape of one of its parts; empty if it is not a part of
/// it.
std::optional<Gradients> gradientsBy(const RestTets& linear, std::size_t part, const QuadraticTet& tet) {
  const Gradients own = gradientsOf(linear.gradients[part]);
  Gradients whole = Gradients::Zero();
  for (std::size_t a = 0; a < 4; ++a) {
    const std::optional<std::array<double, 4>> weights = weightsOf(tet, linear.tets[part][a]);
    if (!weights) return {};
    whole += Eigen::Map<const Eigen::Vector4d>(weights->data()) * own.row(static_cast<Eigen::Index>(a));
  }
  return whole;
}

/// The quadratic tet with the rest shape that its parts agree on; empty if they do not.
std::optional<RestQuadraticTet> restOf(const RestTets& linear, const QuadraticShape& shape) {
  Gradients mean = Gradients::Zero();
  std::array<Gradients, kSubTets> byPart;
  double volume = 0.0;
  for (std::size_t k = 0; k < kSubTets; ++k) {
    const auto part = static_cast<std::size_t>(shape.tet.tets[k]);
    const std::optional<Gradients> gradients = gradientsBy(linear, part, shape.tet);
    if (!gradients) return {};
    byPart[k] = *gradients;
    mean += *gradients / static_cast<double>(kSubTets);
    volume += linear.volumes[part];
  }
  for (const Gradients& gradients : byPart) {
    if (!((gradients - mean).norm() <= kTolerance * mean.norm())) return {};
  }
  RestQuadraticTet rest = shape.rest;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rest.gradients.data()) = mean.bottomRows<3>();
  rest.volume = shape.share * volume;
  return rest;
}

}  // namespace

Result<std::vector<QuadraticShape>> quadraticShapes(const Cage& cage, const std::vector<double>& stiffnessScale) {
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage);
  if (!tets.ok()) return tets.status();
  std::vector<QuadraticShape> shapes;
  for (RestQuadraticTet& rest : elastic_detail::restQuadraticTets(cage, tets.value(), stiffnessScale)) {
    const double volume = 1.0 / (6.0 * std::abs(gradientsOf(rest.gradients).bottomRows<3>().determinant()));
    const double share = rest.volume / volume;
    shapes.push_back({tets.value()[shapes.size()], rest, share});
  }
  return shapes;
}

RestTets withQuadraticTets(const RestTets& linear, const std::vector<double>& stiffnessScale,
                           const std::vector<QuadraticShape>& shapes) {
  assert(linear.quadratic.empty() && (stiffnessScale.empty() || stiffnessScale.size() == linear.count()));
  RestTets rest;
  rest.nodes = linear.nodes;
  std::vector<char> isLinear(linear.count(), 1);
  for (const QuadraticShape& shape : shapes) {
    std::optional<RestQuadraticTet> whole = restOf(linear, shape);
    if (!whole) continue;
    rest.quadratic.push_back(*whole);
    for (const int t : shape.tet.tets) isLinear[static_cast<std::size_t>(t)] = 0;
  }
  for (std::size_t t = 0; t < linear.count(); ++t) {
    if (!isLinear[t]) continue;
    rest.tets.push_back(linear.tets[t]);
    rest.cageTets.push_back(static_cast<std::uint32_t>(t));
    rest.gradients.push_back(linear.gradients[t]);
    rest.volumes.push_back(linear.volumes[t] * (stiffnessScale.empty() ? 1.0 : stiffnessScale[t]));
  }
  return rest;
}

}  // namespace tetskin::bullet_detail
