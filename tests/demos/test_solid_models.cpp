// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The built-in models without clefts that are made by formula.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "scenes/beam.h"
#include "scenes/hoop_and_star.h"
#include "support/component_models.h"
#include "support/surface_checks.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

TEST(Beam, IsFilledExactlyByConformingTets) {
  const TriangleMesh mesh = makeBeam(2000);
  EXPECT_TRUE(test::isClosedAndOriented(mesh));
  EXPECT_NEAR(test::enclosedVolume(mesh), 4.0, 1e-12);
  EXPECT_GE(mesh.triangleCount(), 2000u);
  for (const std::size_t tets : {kMinBeamTets, std::size_t{160}, std::size_t{4320}}) {
    const TetMesh filling = makeBeamTets(tets);
    EXPECT_EQ(filling.tetCount(), tets);
    EXPECT_TRUE(checkTetMesh(filling).clean()) << checkTetMesh(filling).describe();
    EXPECT_NEAR(totalVolume(filling), 4.0, 1e-12);
    TriangleMesh boundary;
    boundary.positions = filling.nodes;
    boundary.triangles = boundaryFaces(filling);
    EXPECT_TRUE(test::isClosedAndOriented(boundary));
    EXPECT_NEAR(test::enclosedVolume(boundary), 4.0, 1e-12);
  }
  EXPECT_EQ(makeBeamTets(400).tetCount(), 540u) << "of 160 and 540 the nearer one";
}

/// How thick the mesh is along a line through it: the way between the first two faces that it meets.
double thicknessAlong(const TriangleMesh& mesh, const Vector3d& from, const Vector3d& direction) {
  std::set<double> ways;
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.positions[t[0]], u = mesh.positions[t[1]] - a, v = mesh.positions[t[2]] - a;
    const Vector3d normal = u.cross(v);
    if (std::abs(normal.dot(direction)) < 1e-12) continue;
    const double way = normal.dot(a - from) / normal.dot(direction);
    const Vector3d p = from + way * direction - a;
    const double s = normal.dot(p.cross(v)) / normal.squaredNorm(), r = normal.dot(u.cross(p)) / normal.squaredNorm();
    if (way > 0.0 && s >= 0.0 && r >= 0.0 && s + r <= 1.0) ways.insert(way);
  }
  EXPECT_GE(ways.size(), 2u);
  return *std::next(ways.begin()) - *ways.begin();
}

TEST(Hoop, IsAClosedBandThatIsThinAtItsTop) {
  const TriangleMesh mesh = makeHoop(8000);
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_TRUE(test::isClosedAndOriented(mesh));
  EXPECT_EQ(test::countComponentsBeyond(mesh), 1);
  EXPECT_EQ(static_cast<long>(mesh.vertexCount()) - static_cast<long>(mesh.triangleCount()) / 2, 0) << "one hole";
  EXPECT_NEAR(static_cast<double>(mesh.triangleCount()), 8000.0, 400.0);
  EXPECT_NEAR(thicknessAlong(mesh, Vector3d(0.003, 0.0, 0.007), Vector3d::UnitY()), 0.12, 0.01);
  EXPECT_NEAR(thicknessAlong(mesh, Vector3d(0.003, 0.0, 0.007), -Vector3d::UnitY()), 0.36, 0.01);
}

TEST(Star, IsClosedWithTwoArmsAndALeg) {
  const TriangleMesh mesh = makeStar(8000);
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_TRUE(test::isClosedAndOriented(mesh));
  EXPECT_EQ(test::countComponentsBeyond(mesh), 1);
  EXPECT_EQ(static_cast<long>(mesh.vertexCount()) - static_cast<long>(mesh.triangleCount()) / 2, 2) << "as a ball";
  EXPECT_EQ(test::countComponentsBeyond(mesh, Eigen::Hyperplane<double, 3>(Vector3d::UnitY(), -0.3)), 2);
  EXPECT_EQ(test::countComponentsBeyond(mesh, Eigen::Hyperplane<double, 3>(-Vector3d::UnitY(), -0.3)), 1);
  EXPECT_NEAR(boundingBox(mesh.positions).min().y(), -1.15 - 0.32, 0.01);
}

}  // namespace
}  // namespace tetskin::scenes
