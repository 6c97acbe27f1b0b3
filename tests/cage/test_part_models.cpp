// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Are the models what the tests of cages take them for?
#include "support/part_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/odd_meshes.h"
#include "support/surface_checks.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

bool isOpen(const PartModel& model) {
  return model.name.find("sheet") != std::string::npos;
}

TEST(PartModels, AreClosedSurfacesButForTheSheets) {
  for (const PartModel& model : partModels()) {
    SCOPED_TRACE(model.name);
    EXPECT_TRUE(checkTriangleMesh(model.mesh).ok());
    EXPECT_EQ(isClosedAndOriented(model.mesh), !isOpen(model));
    EXPECT_GT(flattestTriangle(model.mesh), 0.1);
    EXPECT_TRUE(isOpen(model) || enclosedVolume(model.mesh) > 0.0);
    EXPECT_GT(model.mesh.triangleCount(), 500u);
    EXPECT_LT(model.mesh.triangleCount(), 60000u);
  }
}

/// Triangles alone, which pass through each other unseen, do not tell that crossed boxes are one.
TEST(PartModels, FallIntoTheirPartsBeyondThePlane) {
  for (const PartModel& model : partModels()) {
    const int parts = model.name == "crossed boxes" ? 2 : model.parts;
    EXPECT_EQ(countPartsBeyond(model.mesh, model.plane), parts) << model.name;
  }
}

TEST(PartModels, HangTogetherWhereThereIsAPlane) {
  for (const PartModel& model : partModels()) {
    EXPECT_TRUE(!model.plane || countPartsBeyond(model.mesh) == 1) << model.name;
  }
}

TEST(PartModels, HaveTheVolumeOfTheirShape) {
  const double torus = 2.0 * kPi * kPi;  // of radius 1, over its own radius squared
  EXPECT_NEAR(enclosedVolume(twoPlates(0.1).mesh), 2.0 * 2.0 * 0.3 * 2.0, 1e-9);
  EXPECT_NEAR(enclosedVolume(jaw(0.1).mesh), 4.0 - 3.2 * 0.1 * std::sqrt(2.0) + 0.5 * 0.1 * 0.1 * std::sqrt(2.0), 0.05);
  EXPECT_NEAR(enclosedVolume(chain(3, 0.05).mesh), 3.0 * torus * 0.0625, 0.05);
  EXPECT_NEAR(enclosedVolume(coil(4, 0.05).mesh), 4.0 * torus * 0.04, 0.05);
}

/// Rings are nearest where both have a vertex.
TEST(PartModels, HaveTheGapThatTheyClaim) {
  for (const double gap : {0.03, 0.1}) {
    const TriangleMesh mesh = chain(2, gap).mesh;
    const std::size_t half = mesh.vertexCount() / 2;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < half; ++a) {
      for (std::size_t b = half; b < mesh.vertexCount(); ++b) {
        least = std::min(least, (mesh.positions[a] - mesh.positions[b]).norm());
      }
    }
    EXPECT_NEAR(least, gap, 1e-3);
  }
}

TEST(CountPartsBeyond, ConnectsTetsByNodes) {
  TetMesh two = singleTet();
  for (const Vector3d& p : singleTet().nodes) two.nodes.push_back(p + Vector3d(2.0, 0.0, 0.0));
  two.tets.push_back({4, 5, 6, 7});
  EXPECT_EQ(countPartsBeyond(two), 2);
  EXPECT_EQ(countPartsBeyond(two, Plane(Vector3d::UnitX(), Vector3d::UnitX())), 1);
  EXPECT_EQ(countPartsBeyond(two, Plane(Vector3d::UnitX(), 5.0 * Vector3d::UnitX())), 0);
  two.tets.push_back({3, 4, 5, 6});  // by one node to the first, by three to the second
  EXPECT_EQ(countPartsBeyond(two), 1);
}

}  // namespace
}  // namespace tetskin::test
