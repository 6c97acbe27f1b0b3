// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/brute_force.h"

#include <tetskin/core/tet_geometry.h>

#include <algorithm>
#include <limits>

namespace tetskin::test {
namespace {

struct Candidate {
  int tet;
  double size;
  double barycentric;
  double distance;
};

std::vector<Candidate> candidatesOf(const TetMesh& cage, const Eigen::Vector3d& v) {
  std::vector<Candidate> all;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const TetCorners p = cornersOf(cage, cage.tets[t]);
    if (isFlat(p)) continue;
    const Eigen::Vector4d b = BarycentricMap(p)(v);
    all.push_back({static_cast<int>(t), tetSize(p), barycentricDistance(b), distanceToTet(v, p, b)});
  }
  return all;
}

BruteHit choose(const std::vector<Candidate>& all, OutsideRule rule) {
  for (const Candidate& c : all) {
    if (c.barycentric <= 0.0) return {c.tet, c.barycentric, 0.0, true};
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) nearest = std::min(nearest, c.distance);
  const Candidate* best = nullptr;
  for (const Candidate& c : all) {
    if (rule == OutsideRule::Nearest && c.distance > nearest + kNearestTie * c.size) continue;
    if (!best || c.barycentric < best->barycentric) best = &c;
  }
  return {best->tet, best->barycentric, best->distance, false};
}

}  // namespace

std::vector<BruteHit> bruteForce(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices, OutsideRule rule) {
  std::vector<BruteHit> hits(vertices.size());
  std::transform(vertices.begin(), vertices.end(), hits.begin(),
                 [&](const Eigen::Vector3d& v) { return choose(candidatesOf(cage, v), rule); });
  return hits;
}

}  // namespace tetskin::test
