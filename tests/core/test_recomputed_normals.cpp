// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "carried_normals.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <limits>

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST(RecomputedNormals, AreThoseOfTheDeformedTriangles) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = test::sphere(16, 0.45, kCentre);
  Carried<double> carried(cage, mesh, Normals::Recomputed);
  const test::SmoothMap twist = test::smoothMaps(kCentre)[0];
  carried.move(twist(cage.nodes));
  std::vector<Eigen::Vector3d> expected(mesh.vertexCount(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = Eigen::Map<const Eigen::Vector3d>(carried.skin.positions()[t[k]]);
    for (const int v : t) expected[v] += (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  }
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((carried.normal(v) - expected[v].normalized()).norm(), 1e-6);
    EXPECT_LT(angle(carried.normal(v), cofactors(twist.gradient(mesh.positions[v])) * (mesh.positions[v] - kCentre)),
              12.0);
  }
}

TEST(RecomputedNormals, AuthoredHardEdgesAreKept) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  const TriangleMesh mesh = box(true);
  Carried<float> carried(cage, mesh, Normals::Recomputed);
  const test::SmoothMap map = test::affineMap(4);
  carried.move(map(cage.nodes));
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT(angle(carried.normal(v), cofactors(map.gradient(kCentre)) * mesh.normals[v].cast<double>()), 0.1);
  }
}

TEST(RecomputedNormals, WithoutAuthoredNormalsTheCornersOfABoxAreSmooth) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (const auto& [authored, hardEdgeDegrees] : {std::pair{false, kHardEdgeDegrees}, std::pair{true, 91.0}}) {
    const TriangleMesh mesh = box(authored);
    Carried<float> carried(cage, mesh, Normals::Recomputed, Interpolation::Linear, hardEdgeDegrees);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const Eigen::Vector3d corner = mesh.positions[v] - kCentre;  // one or two triangles of each face have this corner
      EXPECT_LT(angle(carried.normal(v), corner), 36.0);
      EXPECT_GT((carried.normal(v).cwiseProduct(corner)).minCoeff(), 0.1);
      for (std::size_t w = 0; w < v; ++w) {
        if (mesh.positions[v] == mesh.positions[w]) {
          EXPECT_EQ(carried.normal(v), carried.normal(w));
        }
      }
    }
  }
}

/// Every triangle has separate vertices, as in an STL file; normals at the same position differ slightly, and every
/// fourth has this length.
void expectSmoothSeams(float length) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh whole = authoredSphere(12, 0.52);
  TriangleMesh cut;
  for (const auto& t : whole.triangles) {
    for (const int v : t) {
      cut.positions.push_back(whole.positions[v]);
      // The normals are off by about a degree, as in a coarse file.
      const float off = 0.01f * static_cast<float>(cut.normals.size() % 3);
      const float size = cut.normals.size() % 4 == 0 ? length : 1.0f;
      cut.normals.push_back(size * (whole.normals[v] + off * Eigen::Vector3f::UnitX()).normalized());
    }
    const int last = static_cast<int>(cut.vertexCount());
    cut.triangles.push_back({last - 3, last - 2, last - 1});
  }
  const test::SmoothMap waves = test::smoothMaps(kCentre)[3];
  Carried<float> expected(cage, whole, Normals::Recomputed), carried(cage, cut, Normals::Recomputed);
  EXPECT_EQ(dataOf(*carried.skin.binding()).recomputed->groupCount(), whole.vertexCount());
  expected.move(waves(cage.nodes));
  carried.move(waves(cage.nodes));
  for (std::size_t t = 0; t < whole.triangleCount(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(carried.normal(3 * t + k), expected.normal(whole.triangles[t][k]));
    }
  }
}

TEST(RecomputedNormals, SeamsAreSmoothToTheLastBit) {
  expectSmoothSeams(1.0f);
}

TEST(RecomputedNormals, SeamsAreSmoothWhereRestNormalsAreNotOfUnitLengthOrAbsent) {
  for (const float length :
       {0.99f, 1e-30f, 1e30f, 0.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    SCOPED_TRACE(length);
    expectSmoothSeams(length);
  }
}

/// Triangles between random vertices: their edges belong to one, two or many of them, with either orientation; some
/// triangles occur twice, some have no area, and some vertices belong to none.
TriangleMesh randomSoup(std::size_t vertexCount, std::size_t triangleCount, unsigned seed) {
  TriangleMesh mesh;
  mesh.positions = test::randomPoints(vertexCount, {Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)}, seed);
  // Duplicates, as at seams.
  for (std::size_t v = 0; v < vertexCount / 5; ++v) mesh.positions.push_back(mesh.positions[2 * v]);
  std::mt19937 random(seed);
  const auto any = [&] { return static_cast<int>(random() % (mesh.vertexCount() - 1)); };
  for (std::size_t t = 0; t < triangleCount; ++t) mesh.triangles.push_back({any(), any(), any()});
  for (std::size_t t = 0; t < triangleCount / 10; ++t) mesh.triangles.push_back(mesh.triangles[3 * t]);
  return mesh;
}

template <class Scalar>
void expectSumsOfTriangles(const TriangleMesh& mesh, double tolerance) {
  const Eigen::Vector3f untouched(7, 8, 9);
  std::vector<Eigen::Matrix<Scalar, 3, 1>> positions;
  for (const Eigen::Vector3d& p : mesh.positions) positions.push_back(p.cast<Scalar>());
  std::vector<Eigen::Vector3d> sums(mesh.vertexCount(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d corner[3];
    for (std::size_t k = 0; k < 3; ++k) corner[k] = positions[static_cast<std::size_t>(t[k])].template cast<double>();
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      for (const int w : t) {
        if (mesh.positions[v] != mesh.positions[static_cast<std::size_t>(w)]) continue;
        sums[v] += (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      }
    }
  }
  std::vector<Eigen::Vector3f> normals(mesh.vertexCount(), untouched);
  std::vector<Scalar> padded(4 * mesh.vertexCount());
  padPoints(viewOf(std::as_const(positions)), padded);
  recomputeNormals(NormalTopology(mesh, {}, kHardEdgeDegrees), padded, viewOf(normals));
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    if (sums[v].isZero()) {
      EXPECT_EQ(normals[v], untouched);
    } else {
      EXPECT_LT((normals[v].cast<double>() - sums[v].normalized()).norm(), tolerance) << "vertex " << v;
    }
  }
}

TEST(RecomputedNormals, AreSumsOfAllTrianglesOnAnySoup) {
  const InstructionSet before = instructionSet();
  for (const InstructionSet set : availableInstructionSets()) {
    SCOPED_TRACE(toString(set));
    setInstructionSet(set);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const TriangleMesh mesh = randomSoup(50, 30 * seed, seed);
      expectSumsOfTriangles<float>(mesh, 1e-5);
      expectSumsOfTriangles<double>(mesh, 2e-7);
    }
  }
  setInstructionSet(before);
}

TEST(NormalTopology, HasOneClosedPathAroundEveryVertexOfAClosedSurface) {
  const TriangleMesh mesh = test::sphere(16, 0.5, kCentre);
  const NormalTopology topology(mesh, {}, kHardEdgeDegrees);
  EXPECT_EQ(topology.groupCount(), mesh.vertexCount());
  EXPECT_EQ(topology.paths().size(), 3 * mesh.triangleCount() + mesh.vertexCount());
  for (std::size_t g = 0; g < topology.groupCount(); ++g) {
    EXPECT_EQ(topology.paths()[topology.groupPaths()[g]], topology.paths()[topology.groupPaths()[g + 1] - 1]);
  }
}

/// Neither mesh costs more than sorting it: the square of such counts would be noticeable.
TEST(NormalTopology, TakesManyTrianglesAroundOneVertex) {
  constexpr int kMany = 200000;
  TriangleMesh fan, same;
  fan.positions.push_back({0, 1, 0});
  for (int k = 0; k < kMany; ++k) {
    fan.positions.push_back({std::cos(k / (kDegrees * 1000)), 0, std::sin(k / (kDegrees * 1000))});
    fan.triangles.push_back({0, 1 + (k + 1) % kMany, 1 + k});
  }
  const NormalTopology around(fan, {}, kHardEdgeDegrees);
  std::size_t longest = 0;
  for (std::size_t g = 0; g < around.groupCount(); ++g) {
    longest = std::max<std::size_t>(longest, around.groupPaths()[g + 1] - around.groupPaths()[g]);
  }
  EXPECT_EQ(longest, kMany + 1u);
  same.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  same.triangles.assign(kMany, {0, 1, 2});
  for (int k = 0; k < kMany / 2; ++k) same.triangles[static_cast<std::size_t>(k)] = {0, 2, 1};
  EXPECT_EQ(NormalTopology(same, {}, kHardEdgeDegrees).groupCount(), 3u);
}

TEST(NormalTopology, SplitsAPositionByTheFirstNormalOfEachGroup) {
  TriangleMesh mesh;
  mesh.positions.assign(5, {0.1, 0.2, 0.3});
  const auto tilted = [](double degrees) -> Eigen::Vector3f {
    return Eigen::Vector3d(std::sin(degrees / kDegrees), std::cos(degrees / kDegrees), 0.0).cast<float>();
  };
  for (const double degrees : {0.0, 60.0, 3.0, 63.0, 120.0}) mesh.normals.push_back(tilted(degrees));
  const NormalTopology topology(mesh, {}, kHardEdgeDegrees);
  EXPECT_EQ(topology.groupCount(), 3u);
  EXPECT_EQ(topology.indices(), (std::vector<std::uint32_t>{0, 2, 1, 3, 4}));
  EXPECT_EQ(topology.groupPositions(), (std::vector<std::uint32_t>{0, 2, 4, 5}));
  EXPECT_EQ(NormalTopology(mesh, {}, 61.0).groupCount(), 2u);
  EXPECT_EQ(NormalTopology(mesh, {}, 360.0).groupCount(), 1u);
  mesh.normals.clear();
  EXPECT_EQ(NormalTopology(mesh, {}, kHardEdgeDegrees).groupCount(), 1u);
}

/// Such a vertex neither creates hard edges nor softens any: the others are grouped as without it.
TEST(NormalTopology, AVertexWithoutARestNormalJoinsTheFirstGroupOfItsPosition) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TriangleMesh mesh;
  mesh.positions.assign(5, {0.1, 0.2, 0.3});
  mesh.normals = {{0, 0, 0}, {2, 0, 0}, {nan, 1, 0}, {0, 3, 0}, {0.5f, 0, 0}};
  const NormalTopology topology(mesh, {}, kHardEdgeDegrees);
  EXPECT_EQ(topology.indices(), (std::vector<std::uint32_t>{0, 1, 2, 4, 3}));
  EXPECT_EQ(topology.groupPositions(), (std::vector<std::uint32_t>{0, 4, 5}));
  mesh.normals.assign(5, {0, 0, 0});
  EXPECT_EQ(NormalTopology(mesh, {}, kHardEdgeDegrees).groupCount(), 1u);
}

TEST(NormalTopology, EqualRestNormalsMakeNoEdgeWhateverTheAngle) {
  TriangleMesh mesh;
  mesh.positions.assign(1000, {0.1, 0.2, 0.3});
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(0.1f, 1.0f);
  const Eigen::Vector3f normal(any(random), any(random), any(random));
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.normals.push_back(normal * any(random));
  EXPECT_EQ(NormalTopology(mesh, {}, 0.0).groupCount(), 1u);
  mesh.normals[7] += Eigen::Vector3f(0.01f, 0, 0);
  EXPECT_EQ(NormalTopology(mesh, {}, 0.0).groupCount(), 2u);
}

}  // namespace
}  // namespace tetskin::test
