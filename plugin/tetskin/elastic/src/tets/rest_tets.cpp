// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// By columns: a tet's nodes relative to its first one.
using EdgesFromFirst = Eigen::Matrix<double, 3, 4>;

EdgesFromFirst edgesOf(const RestTets& rest, std::size_t tet) {
  EdgesFromFirst edges = EdgesFromFirst::Zero();
  edges.rightCols<3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rest.gradients[tet].data()).inverse();
  return edges;
}

}  // namespace

RestTets restTets(const Cage& cage, const std::vector<QuadraticTet>& quadratic,
                  const std::vector<double>& stiffnessScale) {
  assert(stiffnessScale.empty() || stiffnessScale.size() == cage.mesh.tetCount());
  const std::vector<double> scale = stiffnessScale.empty() ? cage.stiffnessScale() : stiffnessScale;
  std::vector<char> isLinear(cage.mesh.tetCount(), 1);
  for (const QuadraticTet& tet : quadratic) {
    for (const int t : tet.tets) isLinear[static_cast<std::size_t>(t)] = 0;
  }
  RestTets rest;
  rest.nodes = cage.mesh.nodes;
  rest.quadratic = restQuadraticTets(cage, quadratic, stiffnessScale);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (!isLinear[t]) continue;
    const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[t]);
    const std::array<Eigen::Vector3d, 4> gradients = BarycentricMap(corners).gradients();
    std::array<double, 9>& g = rest.gradients.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) g[k] = gradients[1 + k / 3][static_cast<Eigen::Index>(k % 3)];
    rest.tets.push_back(cage.mesh.tets[t]);
    rest.cageTets.push_back(static_cast<std::uint32_t>(t));
    rest.volumes.push_back((scale.empty() ? 1.0 : scale[t]) * std::abs(signedVolume(corners)));
  }
  return rest;
}

void findRestNodes(RestTets& linear, std::size_t nodes) {
  assert(linear.quadratic.empty());
  const Lists<> tetsAt = packLists(nodes, [&](auto&& visit) {
    for (std::size_t t = 0; t < linear.count(); ++t) {
      for (const int n : linear.tets[t]) visit(static_cast<std::size_t>(n), static_cast<std::uint32_t>(t));
    }
  });
  std::vector<Eigen::Vector3d>& rest = linear.nodes;
  rest.assign(nodes, Eigen::Vector3d::Zero());
  std::vector<char> known(nodes, 0);
  std::vector<std::size_t> waiting;
  for (std::size_t first = 0; first < nodes; ++first) {
    if (known[first]) continue;
    known[first] = 1;
    waiting.push_back(first);
    while (!waiting.empty()) {
      const std::size_t node = waiting.back();
      waiting.pop_back();
      for (std::uint32_t k = tetsAt.starts[node]; k < tetsAt.starts[node + 1]; ++k) {
        const Tet& tet = linear.tets[tetsAt.values[k]];
        const auto own =
            static_cast<Eigen::Index>(std::find(tet.begin(), tet.end(), static_cast<int>(node)) - tet.begin());
        const EdgesFromFirst edges = edgesOf(linear, tetsAt.values[k]);
        for (Eigen::Index a = 0; a < 4; ++a) {
          const auto other = static_cast<std::size_t>(tet[static_cast<std::size_t>(a)]);
          if (known[other]) continue;
          known[other] = 1;
          rest[other] = rest[node] + edges.col(a) - edges.col(own);
          waiting.push_back(other);
        }
      }
    }
  }
}

bool takeRestShapes(RestTets& linear, double tolerance) {
  assert(linear.quadratic.empty());
  const std::vector<Eigen::Vector3d> nodes = std::move(linear.nodes);
  linear.nodes.clear();
  RestTets own = linear;
  for (std::size_t t = 0; t < linear.count(); ++t) {
    EdgesFromFirst edges = EdgesFromFirst::Zero();
    const Eigen::Vector3d& first = nodes[static_cast<std::size_t>(linear.tets[t][0])];
    for (Eigen::Index a = 1; a < 4; ++a) {
      edges.col(a) = nodes[static_cast<std::size_t>(linear.tets[t][static_cast<std::size_t>(a)])] - first;
    }
    const Eigen::Matrix3d shape = edges.rightCols<3>(), gradients = shape.inverse();
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> before(linear.gradients[t].data());
    if (!((shape * before - Eigen::Matrix3d::Identity()).norm() <= tolerance) || !gradients.allFinite()) return false;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(own.gradients[t].data()) = gradients;
    own.volumes[t] = std::abs(shape.determinant()) / 6.0;
  }
  own.nodes = nodes;
  linear = std::move(own);
  return true;
}

}  // namespace tetskin::elastic_detail
