// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh.h>

#include "scenes/bar.h"
#include "scenes/twist.h"

namespace tetskin {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

TEST(Bar, IsAClosedTubeOfTheTrianglesWishedFor) {
  for (const std::size_t wish : {2000, 8000, 60000}) {
    const TriangleMesh bar = scenes::makeBar(wish);
    ASSERT_TRUE(validate(bar).ok());
    EXPECT_NEAR(static_cast<double>(bar.triangleCount()), static_cast<double>(wish), 0.02 * static_cast<double>(wish));
    EXPECT_EQ(bar.normals.size(), bar.vertexCount());
    const Vector3d sides = boundingBox(bar.positions).sizes();
    EXPECT_NEAR(sides.x(), 4.0, 1e-9);
    EXPECT_LT(sides.y(), 1.1);
    double volume = 0.0;  // sum over the triangles' tets with the origin: positive if the triangles face outwards
    for (const auto& t : bar.triangles) {
      volume += bar.positions[t[0]].dot(bar.positions[t[1]].cross(bar.positions[t[2]])) / 6.0;
    }
    EXPECT_NEAR(volume, 3.008, 0.05);
  }
}

TEST(Twist, TurnsPointsEvenlyAndNoFurtherThanItsEnds) {
  scenes::Twist twist = scenes::twistOf(Box3(Vector3d(-1, 0, -1), Vector3d(1, 4, 1)), kPi);
  EXPECT_EQ(twist.axis, 1);
  EXPECT_LT((twist.point({1, 0, 0}) - Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 2, 0}) - Vector3d(0, 2, -1)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 4, 0}) - Vector3d(-1, 4, 0)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 9, 0}) - Vector3d(-1, 9, 0)).norm(), 1e-12);
}

TEST(Twist, NormalsStandOnTheTwistedSurface) {
  const scenes::Twist twist = scenes::twistOf(Box3(Vector3d(-1, -2, -1), Vector3d(1, 2, 1)), 3.0);
  constexpr double kStep = 1e-6;
  for (const Vector3d& n : {Vector3d(1, 2, 3), Vector3d(0, 1, 0), Vector3d(-1, 0.2, 0.5)}) {
    const Vector3d p(0.7, 0.3, -0.4), normal = n.normalized();
    const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
    const Vector3d u = twist.point(p + kStep * a) - twist.point(p - kStep * a);
    const Vector3d v = twist.point(p + kStep * b) - twist.point(p - kStep * b);
    EXPECT_LT((twist.normal(p, normal) - u.cross(v).normalized()).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace tetskin
