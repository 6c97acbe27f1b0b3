// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/tets_around_nodes.h>
#include <tetskin/core/src/skinning/gradient_fit.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

namespace tetskin {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Most rings of neighbours to search, and the smallest sufficient number of neighbours: three more than a fit's
/// unknowns.
constexpr int kMaxRings = 4;
constexpr std::size_t kMinNeighbours = 12;
/// This many nearest neighbours are enough if they determine a fit: compared with all nodes of two rings, they need a
/// third less work per update, and bring the surface a sixth closer to smooth maps, because distant nodes say less
/// about the gradient here. All nodes at the same distance are included, so that the stencils of a lattice are as
/// symmetric as the lattice.
constexpr std::size_t kNearNeighbours = 18;
constexpr double kSameDistance = 1.0 + 1e-6;
/// Ratio of the smallest to the largest singular value above which a fit counts as well conditioned. If no fit is,
/// smaller singular values count as 0: if kept down to 1e-3, those of an uneven layer one cell thick cause errors four
/// times those of the linear surface; 0.05 would cost regular cages half of their gain.
constexpr double kWellConditioned = 0.02;
/// Below this, the offsets themselves lie in a plane, and there is no linear fit either.
constexpr double kFlatOffsets = 1e-3;

/// Terms of a map's Taylor series: gradient, then second derivatives.
Vector9 taylorTerms(const Eigen::Vector3d& d) {
  Vector9 t;
  t << d, 0.5 * d.cwiseProduct(d), d.y() * d.z(), d.x() * d.z(), d.x() * d.y();
  return t;
}

/// The least-squares problem around one node, each neighbour weighted by 1 / distance, in units of the mean distance.
struct Fit {
  std::vector<Eigen::Vector3d> offsets;
  double unit = 0.0;
  Eigen::SelfAdjointEigenSolver<Matrix9> solver;

  explicit Fit(std::vector<Eigen::Vector3d> restOffsets) : offsets(std::move(restOffsets)) {
    for (const Eigen::Vector3d& d : offsets) unit += d.norm();
    unit /= static_cast<double>(offsets.size());
    Matrix9 normal = Matrix9::Zero();
    for (const Eigen::Vector3d& d : offsets) {
      const Vector9 row = weightedRow(d);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    }
    solver.compute(normal);
  }

  double weight(const Eigen::Vector3d& d) const { return unit / d.norm(); }
  Vector9 weightedRow(const Eigen::Vector3d& d) const { return weight(d) * taylorTerms(d / unit); }

  /// Eigenvalues of the normal matrix are squares of singular values.
  bool wellConditioned() const {
    return solver.eigenvalues()[0] >= kWellConditioned * kWellConditioned * solver.eigenvalues()[8];
  }

  /// By neighbour: the derivative of the gradient by its position.
  std::vector<Eigen::Vector3d> gradientFactors() const {
    Vector9 inverse = Vector9::Zero();
    for (int i = 0; i < 9; ++i) {
      const double lambda = solver.eigenvalues()[i];
      if (lambda > kWellConditioned * kWellConditioned * solver.eigenvalues()[8]) inverse[i] = 1.0 / lambda;
    }
    const Eigen::Matrix<double, 3, 9> gradientRows =
        solver.eigenvectors().topRows<3>() * inverse.asDiagonal() * solver.eigenvectors().transpose();
    std::vector<Eigen::Vector3d> factors;
    for (const Eigen::Vector3d& d : offsets) factors.push_back(gradientRows * weightedRow(d) * (weight(d) / unit));
    return factors;
  }

  /// Truncation loses affine exactness, sum_j d_j g_j^T = I; this restores it by the smallest change. Returns false if
  /// the offsets lie in a plane.
  bool makeAffineExact(std::vector<Eigen::Vector3d>& factors) const {
    assert(factors.size() == offsets.size());
    Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero(), moment = Eigen::Matrix3d::Zero();
    for (std::size_t j = 0; j < offsets.size(); ++j) {
      const Eigen::Vector3d d = offsets[j] / unit;
      weighted += weight(offsets[j]) * weight(offsets[j]) * d * d.transpose();
      moment += offsets[j] * factors[j].transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(weighted);
    if (!(axes.eigenvalues()[0] > kFlatOffsets * kFlatOffsets * axes.eigenvalues()[2])) return false;
    const Eigen::Matrix3d missing = (Eigen::Matrix3d::Identity() - moment).transpose() * weighted.inverse();
    for (std::size_t j = 0; j < offsets.size(); ++j) {
      const double w = weight(offsets[j]);
      factors[j] += w * w / (unit * unit) * (missing * offsets[j]);
    }
    return true;
  }
};

/// By node: a number shared by nodes that are the same corner of duplicates of a tet. Empty without duplicates.
std::vector<int> indicesOf(const TetMesh& cage, const std::vector<int>& latticeTets) {
  assert(latticeTets.empty() || latticeTets.size() == cage.tetCount());
  std::map<int, std::size_t> first;  // by lattice tet
  DisjointSets places(latticeTets.empty() ? 0 : cage.nodeCount());
  bool copies = false;
  for (std::size_t t = 0; t < latticeTets.size(); ++t) {
    const auto [entry, isNew] = first.try_emplace(latticeTets[t], t);
    copies |= !isNew;
    for (int k = 0; k < 4; ++k) places.unite(cage.tets[entry->second][k], cage.tets[t][k]);
  }
  std::vector<int> indexOf;
  for (std::size_t n = 0; copies && n < cage.nodeCount(); ++n) indexOf.push_back(places.find(static_cast<int>(n)));
  return indexOf;
}

}  // namespace

CageNeighbours::CageNeighbours(const TetMesh& cage, const std::vector<int>& latticeTets)
    : cage_(cage), indexOf_(indicesOf(cage, latticeTets)), foundFor_(cage.nodeCount(), 0) {
  TetMesh solid;  // without flat tets, which may connect nodes that are far apart
  std::vector<bool> isSolid(cage.tetCount());
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    isSolid[t] = !isFlat(cornersOf(cage, cage.tets[t]));
    if (isSolid[t]) solid.tets.push_back(cage.tets[t]);
  }
  tets_ = tetsAroundNodes(cage, [&](std::uint32_t t) { return isSolid[t]; });
  const auto edges = uniqueEdges(solid);
  edges_ = packLists(cage.nodeCount(), [&](auto&& add) {
    for (const auto& [a, b] : edges) {
      add(static_cast<std::size_t>(a), static_cast<std::uint32_t>(b));
      add(static_cast<std::size_t>(b), static_cast<std::uint32_t>(a));
    }
  });
}

GradientStencil CageNeighbours::stencilOf(std::uint32_t node) {
  assert(tets_.starts[node] < tets_.starts[node + 1]);
  found_.assign(1, node);
  foundFor_[node] = node + 1;
  std::size_t ringStart = 0;
  for (int ring = 1; ring <= kMaxRings; ++ring) {
    const std::size_t before = found_.size();
    addRing(ringStart);
    skipDuplicates(before);
    ringStart = before;
    const bool last = ring == kMaxRings || found_.size() == before;
    if (!last && found_.size() <= kMinNeighbours) continue;

    std::vector<std::uint32_t> neighbours = nearNeighbours();
    Fit fit(offsetsOf(neighbours));
    if (!fit.wellConditioned() && neighbours.size() + 1 < found_.size()) {
      neighbours.assign(found_.begin() + 1, found_.end());
      fit = Fit(offsetsOf(neighbours));
    }
    const bool full = fit.wellConditioned() && neighbours.size() >= kMinNeighbours;
    if (!last && !full) continue;

    GradientStencil stencil;
    stencil.factors = fit.gradientFactors();
    if (!fit.makeAffineExact(stencil.factors)) break;
    stencil.kind = full ? GradientStencil::Kind::Full : GradientStencil::Kind::Thin;
    stencil.nodes = std::move(neighbours);
    Eigen::Vector3d own = Eigen::Vector3d::Zero();  // offsets are relative to the node itself
    for (const Eigen::Vector3d& g : stencil.factors) own -= g;
    stencil.nodes.push_back(node);
    stencil.factors.push_back(own);
    assert(stencil.factors.size() == stencil.nodes.size());
    return stencil;
  }
  return plainStencil(node);
}

/// The nearest of the nodes that were found.
std::vector<std::uint32_t> CageNeighbours::nearNeighbours() const {
  std::vector<std::pair<double, std::uint32_t>> byDistance;
  for (std::size_t k = 1; k < found_.size(); ++k) {
    byDistance.emplace_back((cage_.nodes[found_[k]] - cage_.nodes[found_[0]]).norm(), found_[k]);
  }
  std::sort(byDistance.begin(), byDistance.end());
  std::vector<std::uint32_t> near;
  for (const auto& [distance, other] : byDistance) {
    if (near.size() >= kNearNeighbours && distance > kSameDistance * byDistance[kNearNeighbours - 1].first) break;
    near.push_back(other);
  }
  return near;
}

std::vector<Eigen::Vector3d> CageNeighbours::offsetsOf(const std::vector<std::uint32_t>& neighbours) const {
  std::vector<Eigen::Vector3d> offsets;
  offsets.reserve(neighbours.size());
  for (const std::uint32_t other : neighbours) offsets.push_back(cage_.nodes[other] - cage_.nodes[found_[0]]);
  return offsets;
}

/// Appends the nodes that share an edge with those found from index `from` on. A node at exactly the position of the
/// first one (a crack) contributes nothing, and is skipped.
void CageNeighbours::addRing(std::size_t from) {
  const std::uint32_t centre = found_.front();
  for (std::size_t k = from, end = found_.size(); k < end; ++k) {
    for (std::uint32_t e = edges_.starts[found_[k]]; e < edges_.starts[found_[k] + 1]; ++e) {
      const std::uint32_t other = edges_.values[e];
      if (foundFor_[other] == centre + 1 || cage_.nodes[other] == cage_.nodes[centre]) continue;
      foundFor_[other] = centre + 1;
      found_.push_back(other);
    }
  }
}

/// Of the nodes found from index `from` on, removes those that have the position of another found node, in this ring or
/// an earlier one.
void CageNeighbours::skipDuplicates(std::size_t from) {
  if (indexOf_.empty()) return;
  const auto isCopy = [&](std::size_t k) {
    for (std::size_t j = 0; j < found_.size(); ++j) {
      if (j != k && indexOf_[found_[j]] == indexOf_[found_[k]]) return true;
    }
    return false;
  };
  std::vector<std::uint32_t> kept;
  for (std::size_t k = from; k < found_.size(); ++k) {
    if (!isCopy(k)) kept.push_back(found_[k]);
  }
  found_.resize(from);
  found_.insert(found_.end(), kept.begin(), kept.end());
}

GradientStencil CageNeighbours::plainStencil(std::uint32_t node) const {
  std::map<std::uint32_t, Eigen::Vector3d> factors;
  double volume = 0.0;
  for (std::uint32_t k = tets_.starts[node]; k < tets_.starts[node + 1]; ++k) {
    const Tet& tet = cage_.tets[tets_.values[k]];
    const TetCorners corners = cornersOf(cage_, tet);
    const std::array<Eigen::Vector3d, 4> gradients = BarycentricMap(corners).gradients();
    const double v = std::abs(signedVolume(corners));
    volume += v;
    for (std::size_t n = 0; n < 4; ++n) {
      const auto [entry, isNew] = factors.try_emplace(static_cast<std::uint32_t>(tet[n]), Eigen::Vector3d::Zero());
      entry->second += v * gradients[n];
    }
  }
  GradientStencil stencil;
  stencil.kind = GradientStencil::Kind::Plain;
  assert(volume > 0.0);
  for (const auto& [n, factor] : factors) {
    stencil.nodes.push_back(n);
    stencil.factors.push_back(factor / volume);
  }
  return stencil;
}

}  // namespace tetskin
