// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Whether the models have the properties that the tests of cages assume.
#include "support/component_models.h"

#include <limits>

#include "cage_models.h"
#include "support/odd_meshes.h"
#include "support/surface_checks.h"

namespace tetskin::test {
namespace {

using test::kPi;

using Eigen::Vector3d;

bool isOpen(const ComponentModel& model) {
  return model.name.find("sheet") != std::string::npos;
}

TEST(PartModels, AreClosedSurfacesButForTheSheets) {
  for (const ComponentModel& model : componentModels()) {
    SCOPED_TRACE(model.name);
    EXPECT_TRUE(validate(model.mesh).ok());
    EXPECT_EQ(isClosedAndOriented(model.mesh), !isOpen(model));
    EXPECT_GT(flattestTriangle(model.mesh), 0.1);
    EXPECT_TRUE(isOpen(model) || enclosedVolume(model.mesh) > 0.0);
    EXPECT_GT(model.mesh.triangleCount(), 500u);
    EXPECT_LT(model.mesh.triangleCount(), 60000u);
  }
}

/// Crossed boxes count as two here: their triangles pass through each other without sharing vertices.
TEST(PartModels, FallIntoTheirPartsBeyondThePlane) {
  for (const ComponentModel& model : componentModels()) {
    const int components = model.name == "crossed boxes" ? 2 : model.components;
    EXPECT_EQ(countComponentsBeyond(model.mesh, model.plane), components) << model.name;
  }
}

TEST(PartModels, HangTogetherWhereThereIsAPlane) {
  for (const ComponentModel& model : componentModels()) {
    EXPECT_TRUE(!model.plane || countComponentsBeyond(model.mesh) == 1) << model.name;
  }
}

TEST(PartModels, HaveTheVolumeOfTheirShape) {
  const double torus = 2.0 * kPi * kPi;  // volume of a torus of radius 1, divided by the square of its tube's radius
  EXPECT_NEAR(enclosedVolume(twoPlates(0.1).mesh), 2.0 * 2.0 * 0.3 * 2.0, 1e-9);
  EXPECT_NEAR(enclosedVolume(jaw(0.1).mesh), 4.0 - 3.2 * 0.1 * std::sqrt(2.0) + 0.5 * 0.1 * 0.1 * std::sqrt(2.0), 0.05);
  EXPECT_NEAR(enclosedVolume(chain(3, 0.05).mesh), 3.0 * torus * 0.0625, 0.05);
  EXPECT_NEAR(enclosedVolume(coil(4, 0.05).mesh), 4.0 * torus * 0.04, 0.05);
}

/// Rings are closest where both have a vertex.
TEST(PartModels, HaveTheGapThatTheyClaim) {
  for (const double gap : {0.03, 0.1}) {
    const TriangleMesh mesh = chain(2, gap).mesh;
    const std::size_t half = mesh.vertexCount() / 2;
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < half; ++a) {
      for (std::size_t b = half; b < mesh.vertexCount(); ++b) {
        minimum = std::min(minimum, (mesh.positions[a] - mesh.positions[b]).norm());
      }
    }
    EXPECT_NEAR(minimum, gap, 1e-3);
  }
}

TEST(CountPartsBeyond, ConnectsTetsByNodes) {
  TetMesh two = singleTet();
  for (const Vector3d& p : singleTet().nodes) two.nodes.push_back(p + Vector3d(2.0, 0.0, 0.0));
  two.tets.push_back({4, 5, 6, 7});
  EXPECT_EQ(countComponentsBeyond(two), 2);
  EXPECT_EQ(countComponentsBeyond(two, Plane(Vector3d::UnitX(), Vector3d::UnitX())), 1);
  EXPECT_EQ(countComponentsBeyond(two, Plane(Vector3d::UnitX(), 5.0 * Vector3d::UnitX())), 0);
  two.tets.push_back({3, 4, 5, 6});  // shares one node with the first tet, and three with the second
  EXPECT_EQ(countComponentsBeyond(two), 1);
}

}  // namespace
}  // namespace tetskin::test
