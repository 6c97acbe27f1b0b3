// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/mesh/winding_tree.h>

namespace tetskin::test {
namespace {

constexpr double kDipoleError = 0.03;
const Box3 kAroundSurface(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));

TEST(WindingTree, TellsInsideFromOutside) {
  const WindingTree tree(sphere(16, 0.4, Eigen::Vector3d::Zero()));
  for (const Eigen::Vector3d& p : randomPoints(300, kAroundSurface, 4)) {
    if (std::abs(p.norm() - 0.4) < 0.02) continue;
    EXPECT_NEAR(tree.windingNumber(p), p.norm() < 0.4 ? 1.0 : 0.0, kDipoleError);
  }
}

TEST(WindingTree, TrianglesWithoutAreaDoNotCount) {
  TriangleMesh mesh = sphere(16, 0.4, Eigen::Vector3d::Zero());
  const WindingTree without(mesh);
  for (int k = 0; k < 100; ++k) mesh.triangles.insert(mesh.triangles.begin(), {k, k, k + 1});
  const WindingTree with(mesh);
  for (const Eigen::Vector3d& p : randomPoints(100, kAroundSurface, 5)) {
    EXPECT_EQ(with.windingNumber(p), without.windingNumber(p));
  }
}

TEST(WindingTree, OfNothingSeesNothing) {
  EXPECT_EQ(WindingTree(TriangleMesh()).windingNumber({0, 0, 0}), 0.0);
}

}  // namespace
}  // namespace tetskin::test
