// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An application that itself uses Eigen's matrices of dynamic size, together with a part of the library that uses them.
#include <tetskin/cage/create_cage.h>
#include <tetskin/elastic/calibration.h>

#include <Eigen/Dense>
#include <cstdio>

int main() {
  const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(50, 50);
  const Eigen::VectorXd ones = own.partialPivLu().solve(Eigen::VectorXd::Ones(50));
  tetskin::TriangleMesh pyramid;
  pyramid.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  pyramid.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  tetskin::CageOptions options;
  options.targetTets = 200;
  tetskin::Cage cage = tetskin::createCage(pyramid, options).value();
  const auto calibrated = tetskin::calibrate(cage);
  if (!calibrated.ok()) return std::fprintf(stderr, "%s\n", calibrated.status().message.c_str()), 1;
  return ones.isOnes() ? 0 : 1;
}
