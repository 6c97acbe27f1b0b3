// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces connected by triangles stay connected: open sheets of every curvature, tubes, bags, sheets with holes or
// junctions.
#include "cage_checks.h"
#include "cage_models.h"

namespace tetskin::test {
namespace {

using Map = std::function<Eigen::Vector3d(double u, double v)>;
using Hole = std::function<bool(double u, double v)>;

/// A grid of n x m quads over 0 <= u, v <= 1, without those whose centre is in a hole. It is closed where the map
/// returns to the same positions.
TriangleMesh sheetOf(int n, int m, const Map& map, const Hole& hole = {}) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) mesh.positions.push_back(map(static_cast<double>(i) / n, static_cast<double>(j) / m));
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      if (hole && hole((i + 0.5) / n, (j + 0.5) / m)) continue;
      const int a = i * (m + 1) + j, b = a + m + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  // So that closed surfaces are closed to the last bit.
  for (Eigen::Vector3d& p : mesh.positions) p = (p.array() * 0x1p40).round() * 0x1p-40;
  return mesh;
}

Eigen::Vector3d onTube(double radius, double u, double length) {
  return {radius * std::cos(2.0 * kPi * u), radius * std::sin(2.0 * kPi * u), length};
}

/// How many pieces of tets there are for one piece of a mesh, at its worst over sizes of tets, with and without
/// duplicate elements, fitted or not.
void expectOnePiece(const TriangleMesh& mesh) {
  for (const std::size_t target : {100, 400, 1500}) {
    for (const bool duplicates : {true, false}) {
      CageOptions options;
      options.targetTets = target;
      options.duplicateElements = duplicates;
      options.fit = target != 400;
      CageReport report;
      const Result<Cage> cage = createCage(mesh, options, &report);
      ASSERT_TRUE(cage.ok()) << cage.status().message;
      EXPECT_EQ(faultOfCage(mesh, cage.value(), report), "");
      EXPECT_EQ(report.meshComponents, 1u);
      EXPECT_EQ(report.components, 1u) << target << (duplicates ? " tets, duplicates allowed" : " tets");
    }
  }
}

TEST(OnePiece, ACapOfASphere) {
  const double widths[] = {0.2, 0.5, 0.95};  // of all angles; the last is a bag with a narrow mouth
  for (const double width : widths) expectOnePiece(openSphereMesh(12, width * kPi));
}

TEST(OnePiece, ASaddle) {
  expectOnePiece(sheetOf(12, 12, [](double u, double v) {
    const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
    return Eigen::Vector3d(x, y, 4.0 * x * (x * x - 3.0 * y * y));
  }));
}

TEST(OnePiece, ATube) {
  for (const double radius : {0.02, 0.2}) {
    expectOnePiece(sheetOf(12, 20, [&](double u, double v) { return onTube(radius, u, 3.0 * v); }));
    expectOnePiece(sheetOf(12, 20, [&](double u, double v) { return onTube(radius, 0.5 * u, 3.0 * v); }));
  }
}

TEST(OnePiece, AScrollWhoseTurnsAreNearerThanATet) {
  expectOnePiece(sheetOf(80, 10, [](double u, double v) { return onTube(0.1 + 0.9 * u, 4.0 * u, v); }));
}

TEST(OnePiece, APageWithHoles) {
  const Hole hole = [](double u, double v) { return std::fmod(5.0 * u, 1.0) > 0.3 && std::fmod(5.0 * v, 1.0) > 0.3; };
  expectOnePiece(sheetOf(
      25, 25, [](double u, double v) { return Eigen::Vector3d(u, v, 0.02 * std::sin(9.0 * u)); }, hole));
}

TEST(OnePiece, PleatsThatLieOnEachOther) {
  expectOnePiece(sheetOf(40, 10, [](double u, double v) {
    return Eigen::Vector3d(0.2 * u, v, 0.3 * std::abs(std::fmod(8.0 * u, 2.0) - 1.0));
  }));
}

TEST(OnePiece, ASheetThatStandsOnAnother) {
  const TriangleMesh lying = sheetOf(10, 10, [](double u, double v) { return Eigen::Vector3d(2.0 * u - 1.0, v, 0.0); });
  expectOnePiece(joined(lying, sheetOf(10, 10, [](double u, double v) { return Eigen::Vector3d(0.0, v, u); })));
}

TEST(OnePiece, NothingButTwoTrianglesAtAnEdgeOrACorner) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.2}, {0, -1, 0.3}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  expectOnePiece(mesh);
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {-1, 0.1, 0.3}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  expectOnePiece(mesh);
}

/// Cut in a modeller, which left the vertices of the other half in the file.
TEST(OnePiece, HalfASphereWithTheVerticesOfTheOtherHalf) {
  const TriangleMesh half = openSphereMesh(12, 0.5 * kPi);
  TriangleMesh mesh = half;
  for (const Eigen::Vector3d& p : half.positions) {
    if (p.z() > 1e-9) mesh.positions.emplace_back(p.x(), p.y(), -p.z());
  }
  expectOnePiece(mesh);
}

}  // namespace
}  // namespace tetskin::test
