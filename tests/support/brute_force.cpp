// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/brute_force.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/search/tolerances.h>

#include <algorithm>
#include <utility>

namespace tetskin::test {
namespace {

struct Candidate {
  int tet;
  double size;
  double barycentric;
  double weight;
  double distance;
};

std::vector<Candidate> candidatesOf(const TetMesh& cage, const Eigen::Vector3d& v) {
  std::vector<Candidate> all;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const TetCorners p = cornersOf(cage, cage.tets[t]);
    if (isFlat(p)) continue;
    const Eigen::Vector4d b = BarycentricMap(p)(v);
    all.push_back({static_cast<int>(t), tetSize(p), -b.minCoeff(), std::max(b.maxCoeff(), -b.minCoeff()),
                   distanceToTet(v, p, b)});
  }
  return all;
}

/// Data about a cage that the binding rules need.
struct CageScale {
  double edge = 0.0;      ///< mean over the six edges of each tet
  double rounding = 0.0;  ///< distances up to this count as zero

  explicit CageScale(const TetMesh& cage) {
    std::size_t edges = 0;
    for (const Tet& t : cage.tets) {
      const TetCorners p = cornersOf(cage, t);
      if (isFlat(p)) continue;
      double sum = 0.0;
      for (const auto& [a, b] : {std::pair(0, 1), {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}) sum += (p[a] - p[b]).norm();
      edge += sum;
      edges += 6;
      for (const Eigen::Vector3d& corner : p)
        rounding = std::max(rounding, kInsideTolerance * corner.cwiseAbs().maxCoeff());
    }
    edge /= static_cast<double>(edges);
  }
};

/// The first candidate with the least value of a property among those for which `in` holds; there must be one.
template <class In>
const Candidate& least(const std::vector<Candidate>& all, double Candidate::*property, In&& in) {
  const Candidate* best = nullptr;
  for (const Candidate& c : all) {
    if (in(c) && (!best || c.*property < best->*property)) best = &c;
  }
  return *best;
}

BruteHit choose(const std::vector<Candidate>& all, const CageScale& cage, OutsideRule rule) {
  for (const Candidate& c : all) {
    if (c.barycentric <= 0.0) return {c.tet, c.tet, c.barycentric, c.weight, 0.0, true};
  }
  const auto any = [](const Candidate&) { return true; };
  if (rule == OutsideRule::Barycentric) {
    const Candidate& best = least(all, &Candidate::barycentric, any);
    return {best.tet, best.tet, best.barycentric, best.weight, best.distance, best.distance <= cage.rounding};
  }
  const double distance = least(all, &Candidate::distance, any).distance;
  const Candidate& nearest = least(all, &Candidate::barycentric,
                                   [&](const Candidate& c) { return c.distance <= distance + kNearestTie * c.size; });
  const bool inside = distance <= cage.rounding;
  const bool reassignByWeight = !inside && nearest.weight > kMaxWeight;
  const Candidate& best = !reassignByWeight ? nearest : least(all, &Candidate::weight, [&](const Candidate& c) {
    return c.distance <= distance + cage.edge;
  });
  return {best.tet, nearest.tet, best.barycentric, best.weight, distance, inside};
}

}  // namespace

std::vector<BruteHit> bruteForce(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices, OutsideRule rule) {
  const CageScale scale(cage);
  std::vector<BruteHit> hits(vertices.size());
  std::transform(vertices.begin(), vertices.end(), hits.begin(),
                 [&](const Eigen::Vector3d& v) { return choose(candidatesOf(cage, v), scale, rule); });
  return hits;
}

}  // namespace tetskin::test
