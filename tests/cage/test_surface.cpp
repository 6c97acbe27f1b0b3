// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_models.h"
#include "support/odd_meshes.h"

#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

namespace tetskin::test {
namespace {

using test::kPi;

using cage_detail::prepareSurface;
using cage_detail::Surface;

/// The allowed error of the winding number; see WindingTree.
constexpr double kDipoleError = 0.03;
const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

double windingAt(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  return windingTreeOf(prepareSurface(mesh)).windingNumber(p);
}

TEST(Surface, WeldsAndMeasures) {
  const Surface surface = prepareSurface(unwelded(boxMesh({1, 2, 3})));
  EXPECT_EQ(surface.points.size(), 8u);
  EXPECT_EQ(surface.solidCount, 12u);
  EXPECT_EQ(surface.components, 1u);
  EXPECT_EQ(surface.openEdges, 0u);
  EXPECT_TRUE(surface.oriented);
  EXPECT_DOUBLE_EQ(surface.area, 22.0);
  EXPECT_DOUBLE_EQ(surface.volume, 6.0);
}

TEST(Surface, CountsComponentsAndOpenEdges) {
  EXPECT_EQ(prepareSurface(joined(unitSphere(8), sphere(8, 1.0, {5, 0, 0}))).components, 2u);
  EXPECT_EQ(prepareSurface(openSphereMesh(8, kPi / 2)).openEdges, 16u);
  EXPECT_EQ(prepareSurface(sheetMesh(4)).openEdges, 16u);
  EXPECT_EQ(prepareSurface(sheetMesh(4)).volume, 0.0);
}

TEST(Surface, DropsDoubledFacesOfEitherOrientation) {
  const TriangleMesh box = boxMesh({1, 1, 1});
  EXPECT_EQ(prepareSurface(joined(box, box)).solidCount, 12u);
  const Surface twoSided = prepareSurface(joined(box, invertedMesh(box)));
  EXPECT_EQ(twoSided.solidCount, 12u);
  EXPECT_DOUBLE_EQ(twoSided.volume, 1.0);
}

TEST(Surface, KeepsDegenerateTrianglesApart) {
  TriangleMesh mesh = boxMesh({1, 1, 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  const Surface surface = prepareSurface(mesh);
  EXPECT_EQ(surface.solidCount, 12u);
  EXPECT_EQ(surface.triangles.size(), 13u) << "one is a line, the other a point";
  EXPECT_EQ(surface.openEdges, 0u);
}

TEST(Surface, LeavesOutVerticesThatNoTriangleUses) {
  const TriangleMesh box = boxMesh({1, 1, 1});
  TriangleMesh mesh = box;
  mesh.positions.insert(mesh.positions.begin(), Eigen::Vector3d(-9, 9, 9));
  for (auto& t : mesh.triangles) {
    for (int& v : t) ++v;
  }
  mesh.positions.push_back(mesh.positions[3]);  // at the position of a vertex that is used
  mesh.positions.emplace_back(7, 7, 7);
  mesh.triangles.push_back({10, 10, 10});  // a point
  const Surface surface = prepareSurface(mesh);
  EXPECT_EQ(surface.points, box.positions);
  EXPECT_EQ(surface.looseVertices, 2u);
  EXPECT_EQ(surface.pointOf, (std::vector<int>{-1, 0, 1, 2, 3, 4, 5, 6, 7, 2, -1}));
  EXPECT_EQ(surface.box.max(), Eigen::Vector3d(0.5, 0.5, 0.5));
  EXPECT_EQ(surface.components, 1u);
}

TEST(Orientation, RandomIsRepaired) {
  const Surface surface = prepareSurface(shuffledOrientation(unitSphere(12)));
  EXPECT_EQ(surface.openEdges, 0u);
  EXPECT_TRUE(surface.oriented);
  EXPECT_NEAR(windingTreeOf(surface).windingNumber({0.1, 0.2, 0.3}), 1.0, kDipoleError);
}

TEST(Orientation, InsideOutIsTurned) {
  EXPECT_NEAR(windingAt(invertedMesh(unitSphere(12)), kZero), 1.0, kDipoleError);
  const TriangleMesh overlap = joined(unitSphere(12), invertedMesh(sphere(12, 1.0, {1, 0, 0})));
  EXPECT_NEAR(windingAt(overlap, {0.5, 0, 0}), 2.0, 2.0 * kDipoleError);
}

TEST(Orientation, CavityIsKept) {
  const TriangleMesh shell = joined(unitSphere(12), invertedMesh(sphere(12, 0.5, kZero)));
  EXPECT_NEAR(windingAt(shell, kZero), 0.0, kDipoleError);
  EXPECT_NEAR(windingAt(shell, {0.75, 0, 0}), 1.0, kDipoleError);
}

TEST(Orientation, OpenPatchesThatAgreeAreLeftAlone) {
  const TriangleMesh bowl = invertedMesh(openSphereMesh(12, 0.8 * kPi));
  EXPECT_LT(windingAt(bowl, kZero), -0.5);
}

TEST(WindingTree, AgreesWithTheSumOverAllTriangles) {
  const Surface surface = prepareSurface(figurineMesh(24));
  const WindingTree tree = windingTreeOf(surface);
  Surface one = surface;
  for (const Eigen::Vector3d& p : randomPoints(50, surface.box, 1)) {
    double sum = 0.0;
    for (std::size_t t = 0; t < surface.solidCount; ++t) {
      one.triangles.assign(1, surface.triangles[t]);
      one.solidCount = 1;
      sum += windingTreeOf(one).windingNumber(p);
    }
    EXPECT_NEAR(tree.windingNumber(p), sum, kDipoleError);
  }
}

TEST(WindingTree, HemisphereSeesHalfAtItsCentre) {
  EXPECT_NEAR(windingAt(openSphereMesh(24, kPi / 2), kZero), 0.5, 0.01);
}

}  // namespace
}  // namespace tetskin::test
