// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>

#include <vector>

namespace tetskin::test {

struct BruteHit {
  int tet = -1;
  int nearest = -1;  ///< the tet before any reassignment
  double barycentric = 0.0;
  double weight = 0.0;    ///< largest absolute weight
  double distance = 0.0;  ///< of a vertex outside: to the nearest tet; under `Barycentric` to `tet`
  bool inside = false;

  bool reassigned() const { return tet != nearest; }
};

/// The binding rule of `embed`, found by testing every vertex against every tet.
std::vector<BruteHit> bruteForce(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices, OutsideRule rule);

}  // namespace tetskin::test
