// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>

#include <vector>

namespace tetskin::test {

struct BruteHit {
  int tet = -1;
  double barycentric = 0.0;
  double distance = 0.0;
  bool inside = false;
};

/// The binding rule of `embed` by testing every vertex against every tet.
std::vector<BruteHit> bruteForce(const TetMesh& cage, const std::vector<Eigen::Vector3d>& vertices, OutsideRule rule);

}  // namespace tetskin::test
