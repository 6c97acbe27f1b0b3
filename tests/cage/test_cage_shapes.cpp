// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Every kind of surface at 300 and 3,000 tets, some at 30,000, both fitted and not.
#include "cage_checks.h"
#include "cage_models.h"
#include "copy_checks.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using test::kPi;

const char* const kNoFault = "";
/// Debug builds are a hundred times slower, especially with sanitizers.
#ifdef NDEBUG
constexpr std::size_t kMany = 30000;
#else
constexpr std::size_t kMany = 6000;
#endif

Cage wholeCage(const TriangleMesh& mesh, std::size_t target, bool fit) {
  CageOptions options;
  options.targetTets = target;
  options.fit = fit;
  options.duplicateElements = false;
  return createCage(mesh, options).value();
}

void expectCages(const TriangleMesh& mesh) {
  for (const std::size_t target : {300, 3000}) {
    EXPECT_EQ(buildFault(mesh, target), kNoFault);
    EXPECT_EQ(buildFault(mesh, target, false), kNoFault);
  }
  EXPECT_EQ(faultOfTopology(wholeCage(mesh, 1000, false).mesh), kNoFault);
}

/// Expects sound cages for a shape that does not come close to itself: with duplicate elements allowed, none are made,
/// and the cage is the same as without.
void expectWholeCages(const TriangleMesh& mesh) {
  for (const std::size_t target : {300, 3000}) {
    for (const bool fit : {true, false}) {
      CageOptions options;
      options.targetTets = target;
      options.fit = fit;
      CageReport report;
      const Cage cage = createCage(mesh, options, &report).value();
      EXPECT_EQ(faultOfCage(mesh, cage, report), kNoFault);
      EXPECT_TRUE(report.targetMet()) << report.describe();
      EXPECT_EQ(report.duplicateTets, 0u);
      EXPECT_TRUE(sameCage(cage, wholeCage(mesh, target, fit)));
      EXPECT_EQ(faultOfTopology(cage.mesh), kNoFault);
    }
  }
}

TriangleMesh singleTriangle() {
  return {{{0.0, 0.0, 0.0}, {1.0, 0.1, 0.0}, {0.3, 0.8, 0.4}}, {{0, 1, 2}}, {}, {}, {}, {}};
}

TriangleMesh line() {
  return {{{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}, {2.0, 4.0, 6.0}}, {{0, 1, 2}, {0, 0, 2}}, {}, {}, {}, {}};
}

TriangleMesh scatteredTriangles() {
  TriangleMesh mesh;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int t = 0; t < 100; ++t) {
    const Eigen::Vector3d centre(uniform(random), uniform(random), uniform(random));
    for (int i = 0; i < 3; ++i) {
      mesh.positions.push_back(centre + 0.1 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random)));
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

TriangleMesh degenerateTrianglesAmongGoodOnes() {
  TriangleMesh mesh = unitSphere(16);
  for (int v = 2; v < 100; ++v) {
    mesh.triangles.push_back({v, v, v + 1});
    mesh.triangles.push_back({v, v, v});
  }
  mesh.positions.push_back(0.5 * (mesh.positions[0] + mesh.positions[1]));
  mesh.triangles.push_back({0, static_cast<int>(mesh.positions.size()) - 1, 1});
  return mesh;
}

TriangleMesh verticesOnLatticeFriendlyCoordinates() {
  TriangleMesh mesh;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y)
      mesh = joined(mesh, transformed(boxMesh({1, 1, 1}), 1.0, Eigen::Vector3d(x, y, (x + y) % 3)));
  }
  return mesh;
}

enum class Cages { Whole, Any };
struct ShapeCase {
  const char* name;
  Cages cages;
  bool many;  ///< also with kMany tets
  TriangleMesh (*mesh)();
};
const ShapeCase kShapes[] = {
    {"Sphere", Cages::Whole, true, [] { return unitSphere(24); }},
    {"Torus", Cages::Whole, false, [] { return torusMesh(32); }},
    {"BoxOfTwelveTriangles", Cages::Whole, true,
     [] {
       return boxMesh({1.0, 1.0, 1.0});
     }},
    {"FlatBox", Cages::Whole, true,
     [] {
       return boxMesh({1.0, 1.0, 0.01});
     }},
    {"ThinRod", Cages::Whole, true,
     [] {
       return boxMesh({100.0, 1.0, 1.0});
     }},
    {"FlatSheet", Cages::Whole, true, [] { return sheetMesh(20); }},
    {"SheetOfTwoTriangles", Cages::Whole, false, [] { return sheetMesh(1); }},
    {"SingleTriangle", Cages::Whole, false, singleTriangle},
    {"DoubledFaces", Cages::Whole, false, [] { return joined(unitSphere(16), unitSphere(16)); }},
    {"DoubledInvertedFaces", Cages::Whole, false, [] { return joined(unitSphere(16), invertedMesh(unitSphere(16))); }},
    {"Line", Cages::Any, false, line},
    {"OpenHemisphere", Cages::Any, false, [] { return openSphereMesh(16, kPi / 2.0); }},
    {"TwoSpheresApart", Cages::Any, false,
     [] {
       return joined(unitSphere(16), sphere(16, 0.5, {3.0, 0.2, 0.1}));
     }},
    {"SpheresOverlapping", Cages::Any, false,
     [] {
       return joined(unitSphere(16), sphere(16, 0.8, {0.9, 0.1, 0.2}));
     }},
    {"SpheresTouching", Cages::Any, false,
     [] {
       return joined(unitSphere(16), sphere(16, 1.0, {2.0, 0.0, 0.0}));
     }},
    {"InvertedSphere", Cages::Any, false, [] { return invertedMesh(unitSphere(16)); }},
    {"RandomOrientation", Cages::Any, false, [] { return shuffledOrientation(unitSphere(16)); }},
    {"UnweldedSoup", Cages::Any, false, [] { return shuffledOrientation(unwelded(figurineMesh(16))); }},
    {"FinnedSphere", Cages::Any, true, finnedSphereMesh},
    {"Figurine", Cages::Any, true, [] { return figurineMesh(40); }},
    {"ScatteredTriangles", Cages::Any, false, scatteredTriangles},
    {"DegenerateTriangles", Cages::Any, false, degenerateTrianglesAmongGoodOnes},
    {"LatticeFriendlyCoordinates", Cages::Any, false, verticesOnLatticeFriendlyCoordinates},
};
void PrintTo(const ShapeCase& shape, std::ostream* out) {
  *out << shape.name;
}

class CageShapes : public testing::TestWithParam<ShapeCase> {};

TEST_P(CageShapes, HaveSoundCages) {
  const TriangleMesh mesh = GetParam().mesh();
  GetParam().cages == Cages::Whole ? expectWholeCages(mesh) : expectCages(mesh);
  if (GetParam().many) {
    EXPECT_EQ(buildFault(mesh, kMany), kNoFault);
  }
}

INSTANTIATE_TEST_SUITE_P(, CageShapes, testing::ValuesIn(kShapes), [](const auto& one) { return one.param.name; });

TEST(CageShapesOf, AnyUnitAndPlace) {
  const TriangleMesh mesh = figurineMesh(16);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    EXPECT_EQ(buildFault(transformed(mesh, scale, Eigen::Vector3d::Zero()), 1000), kNoFault) << scale;
    EXPECT_EQ(buildFault(transformed(mesh, scale, {1e6, -1e6, 1e6}), 1000), kNoFault) << scale << " far away";
  }
  EXPECT_EQ(buildFault(transformed(mesh, 1e-20, Eigen::Vector3d::Zero()), 1000), kNoFault);
  EXPECT_EQ(buildFault(transformed(mesh, 1e17, Eigen::Vector3d::Zero()), 1000), kNoFault);
}

}  // namespace
}  // namespace tetskin::test
