// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/obstacle_mesh.h"

#include <cmath>

#include "scenes/angles.h"
#include "scenes/joined_mesh.h"

namespace tetskin::scenes {

void appendBox(TriangleMesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope) {
  const Eigen::AngleAxisd rotation(slope, Eigen::Vector3d::UnitZ());
  TriangleMesh box;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    box.positions.push_back(centre + rotation * sign.cwiseProduct(halfExtents));
  }
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  box.groups = {{"box", "floor", 0, box.triangleCount()}};
  (void)append(box, mesh);
}

void appendSphere(TriangleMesh& mesh, const Eigen::Vector3d& centre, double radius) {
  constexpr int kRings = 24, kAround = 48;
  TriangleMesh sphere;
  for (int r = 0; r <= kRings; ++r) {
    for (int a = 0; a < kAround; ++a) {
      const double theta = kPi * r / kRings, phi = 2.0 * kPi * a / kAround;
      sphere.positions.push_back(centre + radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                                   std::sin(theta) * std::sin(phi)));
      const int next = (a + 1) % kAround, row = kAround * r;
      if (r > 0) sphere.triangles.push_back({row - kAround + a, row - kAround + next, row + a});
      if (r > 0) sphere.triangles.push_back({row - kAround + next, row + next, row + a});
    }
  }
  sphere.groups = {{"sphere", "dome", 0, sphere.triangleCount()}};
  (void)append(sphere, mesh);
}

}  // namespace tetskin::scenes
