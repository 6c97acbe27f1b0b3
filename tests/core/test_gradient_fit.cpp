// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"
#include "support/two_plates.h"

#include <tetskin/core/src/skinning/gradient_fit.h>

namespace tetskin {
namespace {

using Kind = GradientStencil::Kind;

Eigen::Matrix3d gradientOf(const GradientStencil& stencil, const std::vector<Eigen::Vector3d>& nodes) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < stencil.nodes.size(); ++k) {
    f += nodes[stencil.nodes[k]] * stencil.factors[k].transpose();
  }
  return f;
}

/// Expects every stencil of the cage to be of this kind, and to give the gradient of these maps to rounding.
void expectExact(const TetMesh& cage, Kind kind, double secondDerivatives, double tolerance = 1e-12) {
  CageNeighbours neighbours(cage);
  const test::SmoothMap map = test::quadraticMap(61, secondDerivatives);
  const std::vector<Eigen::Vector3d> nodes = map(cage.nodes);
  for (std::uint32_t n = 0; n < cage.nodeCount(); ++n) {
    const GradientStencil stencil = neighbours.stencilOf(n);
    EXPECT_EQ(stencil.kind, kind) << "node " << n;
    EXPECT_LT((gradientOf(stencil, nodes) - map.gradient(cage.nodes[n])).norm(), tolerance) << "node " << n;
  }
}

TEST(GradientFit, IsExactForQuadraticMapsOnEveryLattice) {
  for (const test::LatticeKind& kind : test::latticeKinds()) {
    SCOPED_TRACE(kind.name);
    expectExact(kind.make(3), Kind::Full, 0.5);
  }
  // Two cubes across are enough, as they give three nodes in a row.
  expectExact(test::latticeCage(2, 2, 2, 0.5), Kind::Full, 0.5);
}

/// A trunk of two cubes, from which two branches continue at the same position.
TEST(GradientFit, StencilsDoNotReachAcrossCopies) {
  Cage cage = test::latticeCage(6, 2, 2);
  const std::size_t trunkNodes = cage.mesh.nodeCount();
  const std::vector<int> copyOf = test::appendCopies(cage, 2.0);
  cage.sourceTet.resize(cage.mesh.tetCount());
  for (std::size_t t = 0; t < copyOf.size(); ++t) {
    cage.sourceTet[t] = cage.sourceTet[static_cast<std::size_t>(copyOf[t])] = static_cast<int>(t);
  }
  // Each branch moves by a different map.
  const auto branchOf = [&](std::uint32_t n) { return n >= trunkNodes ? 2 : cage.mesh.nodes[n].x() > 2.0 ? 1 : 0; };
  std::size_t withoutCopies = 0;
  CageNeighbours neighbours(cage.mesh, cage.sourceTet), blind(cage.mesh);
  for (std::uint32_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    const auto reaches = [&](const GradientStencil& stencil, int branch) {
      return std::any_of(stencil.nodes.begin(), stencil.nodes.end(),
                         [&](std::uint32_t other) { return branchOf(other) == branch; });
    };
    const GradientStencil stencil = neighbours.stencilOf(n);
    if (stencil.kind == Kind::Plain) continue;
    EXPECT_FALSE(reaches(stencil, 1) && reaches(stencil, 2)) << "node " << n;
    EXPECT_FALSE(branchOf(n) > 0 && reaches(stencil, 3 - branchOf(n))) << "node " << n;
    const GradientStencil mixed = blind.stencilOf(n);
    withoutCopies += reaches(mixed, 1) && reaches(mixed, 2);
  }
  EXPECT_GT(withoutCopies, 0u) << "some would, if they did not know of copies";
}

TEST(GradientFit, DoesNotDependOnTheUnit) {
  for (const double size : {1e-6, 1e6}) {
    const TetMesh cage = test::jittered(test::bodyCentredCage(3, 3, 3), 0.2, 62);
    TetMesh scaled = cage;
    for (Eigen::Vector3d& p : scaled.nodes) p *= size;
    CageNeighbours neighbours(scaled);
    const test::SmoothMap map = test::quadraticMap(61, 0.5);
    std::vector<Eigen::Vector3d> nodes = map(cage.nodes);
    for (Eigen::Vector3d& p : nodes) p *= size;
    for (std::uint32_t n = 0; n < cage.nodeCount(); ++n) {
      const GradientStencil stencil = neighbours.stencilOf(n);
      EXPECT_EQ(stencil.kind, Kind::Full);
      EXPECT_LT((gradientOf(stencil, nodes) - map.gradient(cage.nodes[n])).norm(), 1e-12);
    }
  }
}

TEST(GradientFit, IsExactForAffineMapsWhereTheCageIsThin) {
  expectExact(test::singleTet(), Kind::Thin, 0.0);
  expectExact(test::latticeCage(5, 1, 5), Kind::Thin, 0.0);
  expectExact(test::latticeCage(1, 1, 1), Kind::Thin, 0.0);
}

TEST(GradientFit, TakesTheMeanOfTheTetsWhereTheNodesLieInAPlane) {
  TetMesh sliver = test::singleTet();
  sliver.nodes[3] = {0.3, 0.3, 1e-4};
  expectExact(sliver, Kind::Plain, 0.0, 1e-10);
  // The two tets have different volumes, which are their weights.
  TetMesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-2, 0, 0}, {0.3, 0.3, 1e-4}}, {{0, 1, 2, 4}, {0, 2, 3, 4}}};
  expectExact(two, Kind::Plain, 0.0, 1e-10);
}

TEST(GradientFit, PassesByANodeAtTheVeryPlaceOfTheFirst) {
  // A crack: half of the tets around the middle node use a twin of it.
  TetMesh cage = test::latticeCage(4, 4, 4);
  const int centroid = 2 + 5 * (2 + 5 * 2), twin = static_cast<int>(cage.nodeCount());
  cage.nodes.push_back(cage.nodes[centroid]);
  for (Tet& tet : cage.tets) {
    double x = 0.0;
    for (const int n : tet) x += 0.25 * cage.nodes[n].x();
    if (x > 2.0) std::replace(tet.begin(), tet.end(), centroid, twin);
  }
  expectExact(cage, Kind::Full, 0.2);
}

TEST(GradientFit, FlatTetsDoNotTieTogetherWhatIsFarApart) {
  TetMesh cage = test::singleTet();
  const TetMesh lattice = test::latticeCage(3, 3, 3);
  for (const Eigen::Vector3d& p : lattice.nodes) cage.nodes.push_back(p + Eigen::Vector3d(100, 0, 0));
  for (Tet tet : lattice.tets) {
    for (int& n : tet) n += 4;
    cage.tets.push_back(tet);
  }
  cage.tets.push_back({0, 1, 5, 6});  // the nodes lie in a line
  for (const std::uint32_t n : {0u, 1u}) {
    const GradientStencil stencil = CageNeighbours(cage).stencilOf(n);
    EXPECT_EQ(stencil.nodes.size(), 4u);
    EXPECT_LT(*std::max_element(stencil.nodes.begin(), stencil.nodes.end()), 4u);
  }
}

}  // namespace
}  // namespace tetskin
