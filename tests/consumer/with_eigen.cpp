// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An application that uses Eigen's matrices of any size itself, beside a part of the library that does.
#include <tetskin/cage/stiffness_calibration.h>

#include <Eigen/Dense>
#include <cstdio>

/// A bar of cubes, six tets each.
tetskin::TetMesh makeBar() {
  tetskin::TetMesh bar;
  const auto node = [](int x, int y, int z) { return x + 9 * (y + 3 * z); };
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 9; ++x) bar.nodes.emplace_back(0.25 * x, 0.25 * y, 0.25 * z);
    }
  }
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int cube = 0; cube < 8 * 2 * 2; ++cube) {
    for (const auto& order : orders) {
      int p[3] = {cube % 8, cube / 8 % 2, cube / 16};
      tetskin::Tet tet{node(p[0], p[1], p[2])};
      for (int k = 0; k < 3; ++k) {
        ++p[order[k]];
        tet[k + 1] = node(p[0], p[1], p[2]);
      }
      bar.tets.push_back(tet);
    }
  }
  (void)tetskin::repairTetMesh(bar);
  return bar;
}

int main() {
  const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(50, 50);
  const Eigen::VectorXd ones = own.partialPivLu().solve(Eigen::VectorXd::Ones(50));
  const auto calibrated = tetskin::calibrateStiffness(makeBar());
  if (!calibrated.ok()) return std::fprintf(stderr, "%s\n", calibrated.status().message.c_str()), 1;
  return ones.isOnes() ? 0 : 1;
}
