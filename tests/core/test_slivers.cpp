// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Surfaces just outside cages with slivers at their boundary, and outside cages without slivers.
#include "support/brute_force.h"
#include "support/cage_surface.h"
#include "support/carried_points.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/search/tolerances.h>

namespace tetskin::test {
namespace {

constexpr double kAspect = 1e4;

double diagonalOf(const TetMesh& cage) {
  return boundingBox(cage.nodes).diagonal().norm();
}

/// A ball of diameter 2: a body-centred lattice whose cubic shells become spheres.
TetMesh ballCage(int across) {
  TetMesh cage = test::bodyCentredCage(across, across, across, 2.0 / across);
  for (Eigen::Vector3d& p : cage.nodes) {
    p -= Eigen::Vector3d::Ones();
    if (p.norm() > 0.0) p *= p.lpNorm<Eigen::Infinity>() / p.norm();
  }
  return cage;
}

/// Adds a node just above a face, and a tet that joins it to the face.
void coverWithCap(TetMesh& cage, const std::array<int, 3>& face) {
  const Eigen::Vector3d &a = cage.nodes[face[0]], &b = cage.nodes[face[1]], &c = cage.nodes[face[2]];
  const double size = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
  const Eigen::Vector3d tip = (a + b + c) / 3.0 + size / kAspect * (b - a).cross(c - a).normalized();
  cage.tets.push_back({face[0], face[1], face[2], static_cast<int>(cage.nodeCount())});
  cage.nodes.push_back(tip);
}

/// Moves d so that all four nodes lie nearly in a plane, and covers the two faces that share the edge ab with one tet.
void coverWithQuad(TetMesh& cage, int a, int b, int c, int d) {
  const Eigen::Vector3d &pa = cage.nodes[a], &pb = cage.nodes[b], &pc = cage.nodes[c];
  const Eigen::Vector3d normal = (pb - pa).cross(pc - pa).normalized();
  const double size = std::max({(pa - pb).norm(), (pb - pc).norm(), (pc - cage.nodes[d]).norm()});
  cage.nodes[d] -= ((cage.nodes[d] - pa).dot(normal) - size / kAspect) * normal;
  cage.tets.push_back({a, b, c, d});
}

/// Adds `count` slivers at the boundary, alternately of both kinds, which share no node; all tets are positive.
TetMesh withSlivers(TetMesh cage, int count) {
  const auto faces = boundaryFaces(cage);
  std::vector<bool> used(cage.nodeCount(), false);
  const auto take = [&](std::initializer_list<int> nodes) {
    if (std::any_of(nodes.begin(), nodes.end(), [&](int n) { return used[n]; })) return false;
    for (const int n : nodes) used[n] = true;
    return true;
  };
  int made = 0;
  for (std::size_t f = 0; f < faces.size() && made < count; ++f) {
    const auto& [a, b, c] = faces[f];
    if (made % 2 == 0) {
      if (take({a, b, c})) coverWithCap(cage, faces[f]), ++made;
      continue;
    }
    for (const auto& [k, l, m] : faces) {  // the face on the other side of the edge ab
      const int d = k == b && l == a ? m : l == b && m == a ? k : m == b && k == a ? l : -1;
      if (d >= 0 && take({a, b, c, d})) coverWithQuad(cage, a, b, c, d), ++made;
    }
  }
  EXPECT_EQ(made, count);
  static_cast<void>(repairTetMesh(cage));
  return cage;
}

/// The longest distance between a surface and the position to which the boundary takes it, after each node has moved by
/// `amount`.
double strayed(const TetMesh& cage, const Points& vertices, const std::vector<std::int32_t>& tetOf, double amount) {
  test::CarriedPoints<double> carried(cage, vertices, tetOf);
  const Points nodes = test::movedAtRandom(cage.nodes, amount, 5);
  carried.move(nodes);
  return test::distances(carried.linear(), test::BoundaryFollower(cage, vertices).positions(nodes)).longest;
}

std::vector<std::int32_t> tetsOf(const Embedding& embedding) {
  std::vector<std::int32_t> tets;
  for (const VertexBinding& b : embedding.bindings()) tets.push_back(b.inside ? b.tet : ~b.tet);
  return tets;
}

TEST(Slivers, CarryNoVertexThatAnotherTetNearbyCarriesWell) {
  const TetMesh cage = withSlivers(ballCage(6), 30);
  const double size = boundingBox(cage.nodes).sizes().maxCoeff(), distance = 0.01 * diagonalOf(cage);
  const TriangleMesh mesh = test::surfaceBeside(cage, distance);
  Embedding embedding;
  // Vertices that are reassigned are no farther from the cage than others.
  const Fit report = embedInto(cage, mesh, {OutsideRule::Nearest, 1.001 * distance}, embedding);
  ASSERT_TRUE(report.ok()) << report.status.message;
  EXPECT_GT(report.outside, 0.99 * static_cast<double>(mesh.vertexCount()));
  EXPECT_LT(strayed(cage, mesh.positions, tetsOf(embedding), 0.01 * size), 0.03 * size);
  EXPECT_GT(report.reassignedByWeight, 300u);
  EXPECT_LT(report.maxWeight, 2.0);
  const std::string count = std::to_string(report.reassignedByWeight) + " vertices outside";
  EXPECT_NE(report.describe().find(count), std::string::npos) << report.describe();
}

TEST(Slivers, AreAvoidedAsTestingAllPairsWould) {
  const TetMesh cage = withSlivers(ballCage(4), 12);
  Points vertices;
  for (const double fraction : {-0.01, 1e-5, 0.003, 0.01, 0.1, 2.0}) {
    const Points layer = test::surfaceBeside(cage, fraction * diagonalOf(cage), 1).positions;
    vertices.insert(vertices.end(), layer.begin(), layer.end());
  }
  Embedding embedding;
  const Fit report = embedInto(cage, viewOf(vertices), {}, embedding);
  const auto expected = test::bruteForce(cage, vertices, OutsideRule::Nearest);
  const auto bindings = embedding.bindings();
  std::size_t reassigned = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_EQ(bindings[v].tet, expected[v].tet) << "vertex " << v;
    EXPECT_EQ(bindings[v].inside, expected[v].inside) << "vertex " << v;
    reassigned += expected[v].reassigned();
  }
  EXPECT_EQ(report.reassignedByWeight, reassigned);
  EXPECT_GT(reassigned, 500u);
}

/// Surfaces 1 % outside of cages without slivers are carried as well as by the nearest tets alone.
TEST(Slivers, MakeNoDifferenceWhereThereAreNone) {
  std::vector<TetMesh> cages{ballCage(4), test::thinLayerCage(0.125), test::latticeCage(2, 9, 2, 0.25),
                             test::singleTet()};
  for (const test::LatticeKind& kind : test::latticeKinds()) cages.push_back(kind.make(3));
  ASSERT_EQ(cages.size(), 10u);
  for (std::size_t c = 0; c < cages.size(); ++c) {
    const double diagonal = diagonalOf(cages[c]);
    const Points vertices = test::surfaceBeside(cages[c], 0.01 * diagonal, 1).positions;
    Embedding embedding;
    ASSERT_TRUE(embedInto(cages[c], viewOf(vertices), {}, embedding).ok());
    std::vector<std::int32_t> nearest;
    for (const test::BruteHit& hit : test::bruteForce(cages[c], vertices, OutsideRule::Nearest)) {
      nearest.push_back(hit.inside ? hit.nearest : ~hit.nearest);
    }
    EXPECT_LE(strayed(cages[c], vertices, tetsOf(embedding), 0.01 * diagonal),
              strayed(cages[c], vertices, nearest, 0.01 * diagonal))
        << "cage " << c;
  }
}

/// Two plates at z in [-depth, 0] and [0.1, 0.6], the first with a layer of slivers at its boundary.
TetMesh plates(double depth) {
  TetMesh cage = test::latticeCage(4, 4, 2, 0.25);
  TetMesh upper = cage;
  for (Eigen::Vector3d& p : cage.nodes) p.z() = p.z() > 0.3 ? 0.0 : p.z() > 0.1 ? -1e-5 : -depth;
  for (Eigen::Vector3d& p : upper.nodes) p.z() += 0.1;
  const int shift = static_cast<int>(cage.nodeCount());
  cage.nodes.insert(cage.nodes.end(), upper.nodes.begin(), upper.nodes.end());
  for (Tet tet : upper.tets) {
    for (int& n : tet) n += shift;
    cage.tets.push_back(tet);
  }
  return cage;
}

/// A sheet above the lower plate, with columns of vertices side by side at these heights.
TriangleMesh sheetAt(const std::vector<double>& heights) {
  TriangleMesh mesh;
  constexpr int kRows = 7;
  for (std::size_t column = 0; column < heights.size(); ++column) {
    for (int row = 0; row < kRows; ++row) {
      mesh.positions.emplace_back(0.23 + 0.09 * static_cast<double>(column), 0.2 + 0.09 * row, heights[column]);
    }
  }
  for (int v = 0; v + kRows + 1 < static_cast<int>(mesh.vertexCount()); ++v) {
    if (v % kRows + 1 == kRows) continue;
    mesh.triangles.push_back({v, v + kRows, v + 1});
    mesh.triangles.push_back({v + 1, v + kRows, v + kRows + 1});
  }
  return mesh;
}

std::size_t inUpperPlate(const TetMesh& cage, const Embedding& embedding) {
  const auto bindings = embedding.bindings();
  return static_cast<std::size_t>(std::count_if(bindings.begin(), bindings.end(), [&](const VertexBinding& b) {
    return cage.nodes[cage.tets[b.tet][0]].z() > 0.05;
  }));
}

TEST(Slivers, ARescueStaysWithTheNeighbours) {
  // The lower plate carries the vertices above it well, but the upper plate does so better.
  const TetMesh cage = plates(0.03);
  for (const TriangleMesh& mesh : {sheetAt({-0.02, -0.01, 0.04, 0.04}), sheetAt({2e-5, 2e-5, 0.04, 0.04})}) {
    Embedding embedding;
    const Fit alone = embedInto(cage, viewOf(mesh.positions), {}, embedding);
    EXPECT_EQ(alone.reassignedByWeight, 14u);
    EXPECT_GT(inUpperPlate(cage, embedding), 7u);
    const Fit report = embedInto(cage, mesh, {}, embedding);
    EXPECT_EQ(report.reassignedByWeight, 14u);
    EXPECT_EQ(inUpperPlate(cage, embedding), 0u);
    EXPECT_GT(report.reassignedByConnectivity, 7u);
  }
}

TEST(Slivers, NoVertexIsKeptWithItsNeighboursByOne) {
  const TetMesh cage = plates(0.5);
  // The last two columns are closer to the upper plate; the layer of slivers on the lower one is too thin for them.
  const TriangleMesh mesh = sheetAt({-0.2, -0.1, 0.06, 0.07});
  Embedding embedding;
  EXPECT_EQ(embedInto(cage, viewOf(mesh.positions), {}, embedding).reassignedByWeight, 0u);
  EXPECT_EQ(inUpperPlate(cage, embedding), 14u);
  const Fit report = embedInto(cage, mesh, {}, embedding);
  EXPECT_EQ(report.reassignedByConnectivity, 14u);
  EXPECT_EQ(inUpperPlate(cage, embedding), 0u);
  EXPECT_LT(report.maxWeight, kMaxWeight);
}

TEST(Slivers, AVertexStaysWithAnotherPartWhereItsOwnIsAllSlivers) {
  TetMesh cage = plates(0.5);
  const auto belowTheSkin = [&](const Tet& tet) {
    return std::any_of(tet.begin(), tet.end(), [&](int n) { return cage.nodes[n].z() < -0.4; });
  };
  cage.tets.erase(std::remove_if(cage.tets.begin(), cage.tets.end(), belowTheSkin), cage.tets.end());
  const TriangleMesh mesh = sheetAt({-5e-6, -4e-6, 0.06, 0.07});
  const Fit report = embedInto(cage, mesh);
  EXPECT_EQ(report.inside, 14u);
  EXPECT_EQ(report.reassignedByConnectivity, 0u);
  EXPECT_LT(report.maxWeight, kMaxWeight);
}

}  // namespace
}  // namespace tetskin::test
