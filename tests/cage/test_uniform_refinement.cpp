// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include "support/odd_meshes.h"

namespace tetskin {
namespace {

TEST(UniformRefinement, CutsEveryTetIntoEightOfAnEighth) {
  for (const TetMesh& coarse : {test::singleTet(), test::latticeCage(3, 2, 2), test::bodyCentredCage(2, 2, 2)}) {
    const Refinement fine = refineUniformly(coarse);
    ASSERT_EQ(fine.mesh.tetCount(), 8 * coarse.tetCount());
    EXPECT_EQ(fine.mesh.nodeCount(), coarse.nodeCount() + fine.edges.size());
    EXPECT_TRUE(checkTetMesh(fine.mesh).clean()) << checkTetMesh(fine.mesh).describe();
    for (std::size_t t = 0; t < fine.mesh.tetCount(); ++t) {
      const double whole = signedVolume(cornersOf(coarse, coarse.tets[t / 8]));
      EXPECT_NEAR(signedVolume(cornersOf(fine.mesh, fine.mesh.tets[t])), whole / 8.0, 1e-12);
    }
    for (std::size_t k = 0; k < fine.edges.size(); ++k) {
      const auto [a, b] = fine.edges[k];
      const Eigen::Vector3d centroid = 0.5 * (coarse.nodes[a] + coarse.nodes[b]);
      EXPECT_LT((fine.mesh.nodes[coarse.nodeCount() + k] - centroid).norm(), 1e-12);
    }
  }
}

TEST(UniformRefinement, TetsStillShareWholeFaces) {
  const TetMesh coarse = test::jittered(test::latticeCage(3, 2, 2), 0.2, 1);
  const TetMesh fine = refineUniformly(coarse).mesh;
  EXPECT_EQ(boundaryFaces(fine).size(), 4 * boundaryFaces(coarse).size());
}

TEST(UniformRefinement, RepeatedTetsDoNotGetThinner) {
  TetMesh mesh = test::singleTet();
  const double once = dihedralRange(refineUniformly(mesh).mesh).minDeg;
  for (int k = 0; k < 4; ++k) mesh = refineUniformly(mesh).mesh;
  EXPECT_GT(dihedralRange(mesh).minDeg, 0.8 * once);
}

TEST(UniformRefinement, OfNothingIsNothing) {
  EXPECT_EQ(refineUniformly({}).mesh.tetCount(), 0u);
}

}  // namespace
}  // namespace tetskin
