// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>

#include <vector>

namespace tetskin::test {

struct BruteHit {
  int tet = -1;
  int nearest = -1;  ///< the same without rescues
  double barycentric = 0.0;
  double weight = 0.0;    ///< largest absolute
  double distance = 0.0;  ///< of vertices outside: to the nearest tet, under `Barycentric` to `tet`
  bool inside = false;

  bool rescued() const { return tet != nearest; }
};

/// The binding rule of `embed` by testing every vertex against every tet.
std::vector<BruteHit> bruteForce(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices, OutsideRule rule);

}  // namespace tetskin::test
