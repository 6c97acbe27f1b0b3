// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Quadratic skinning within quadratic tets.
#include "support/carried_points.h"
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include "carried_normals.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/skinning/edge_bends.h>

#include <map>
#include <numeric>

namespace tetskin::test {
namespace {

std::vector<int> allTetsOf(const TetMesh& mesh) {
  std::vector<int> tets(mesh.tetCount());
  std::iota(tets.begin(), tets.end(), 0);
  return tets;
}

/// Cages of quadratic tets in which fits of gradients are exact, and others in which they cannot be.
std::vector<Cage> quadraticCages() {
  std::vector<Cage> cages;
  for (const TetMesh& mesh :
       {singleTet(), latticeCage(4, 1, 1, 0.25), jittered(bodyCentredCage(2, 2, 2, 0.5), 0.1, 3)}) {
    cages.push_back(refineQuadratic(mesh).value());
  }
  return cages;
}

/// The last third of the quadratic tets are linear ones.
Cage partlyQuadratic(Cage cage) {
  const int count = *std::max_element(cage.quadraticTet.begin(), cage.quadraticTet.end()) + 1;
  for (int& number : cage.quadraticTet) number = 3 * number < 2 * count ? number : -1;
  return cage;
}

/// Nodes moved at random, by less than makes an edge's vector be limited.
Points shaken(const TetMesh& mesh, double amount, unsigned seed) {
  const Points offsets =
      randomPoints(mesh.nodeCount(), {Eigen::Vector3d::Constant(-amount), Eigen::Vector3d::Constant(amount)}, seed);
  Points nodes = mesh.nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] += offsets[n];
  return nodes;
}

/// By the shape functions of a tet of ten nodes.
Eigen::Vector3d mapped(const QuadraticTet& tet, const TetMesh& rest, const Points& nodes,
                       const Eigen::Vector3d& point) {
  const Eigen::Vector4d b =
      BarycentricMap(cornersOf(rest, {tet.nodes[0], tet.nodes[1], tet.nodes[2], tet.nodes[3]}))(point);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < 4; ++k) x += b[k] * (2.0 * b[k] - 1.0) * nodes[tet.nodes[k]];
  for (std::size_t e = 0; e < 6; ++e) {
    x += 4.0 * b[static_cast<int>(kTetEdges[e][0])] * b[static_cast<int>(kTetEdges[e][1])] * nodes[tet.nodes[4 + e]];
  }
  return x;
}

TEST(EdgeBends, QuadraticMapsAreExactInEveryCage) {
  for (const Cage& cage : quadraticCages()) {
    const std::vector<int> tets = allTetsOf(cage.mesh);
    const Points vertices = pointsIn(cage.mesh, tets, 71);
    CarriedPoints<double> points(cage, vertices, tets);
    CarriedPoints<float> rounded(cage, vertices, tets);
    EXPECT_EQ(points.stencils.plainEdgeCount(), 0u);
    EXPECT_EQ(points.stencils.edgeCount(), uniqueEdges(cage.mesh).size());
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const SmoothMap map = quadraticMap(seed, 0.5);
      points.move(map(cage.mesh.nodes));
      rounded.move(map(cage.mesh.nodes));
      EXPECT_LT(distances(points.quadratic(), map(points.rest)).longest, 1e-12);
      EXPECT_LT(distances(rounded.quadratic(), map(vertices)).longest, 2e-6);
      EXPECT_GT(distances(points.linear(), map(points.rest)).rms, 5e-4);
    }
  }
}

TEST(EdgeBends, TheSurfaceIsThatOfTheTenNodesWhereverTheyAre) {
  for (const Cage& cage : quadraticCages()) {
    const std::vector<int> tets = allTetsOf(cage.mesh);
    CarriedPoints<double> points(cage, pointsIn(cage.mesh, tets, 72), tets);
    const Points nodes = shaken(cage.mesh, 0.004, 73);
    points.move(nodes);
    Points expected;
    for (std::size_t t = 0; t < tets.size(); ++t) {
      expected.push_back(mapped(points.quadraticTets[cage.quadraticTet[t]], cage.mesh, nodes, points.rest[t]));
    }
    EXPECT_LT(distances(points.quadratic(), expected).longest, 1e-14);
    EXPECT_GT(distances(points.linear(), expected).longest, 1e-4);
  }
}

TEST(EdgeBends, LinearTetsBesideQuadraticOnesJoinWithoutAGap) {
  const Cage cage = partlyQuadratic(refineQuadratic(jittered(latticeCage(3, 2, 2, 0.3), 0.03, 5)).value());
  Points vertices;
  std::vector<std::int32_t> oneSide, otherSide;
  std::map<std::array<int, 3>, int> first;
  std::size_t mixed = 0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Tet& tet = cage.mesh.tets[t];
      std::array<int, 3> face{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::sort(face.begin(), face.end());
      const auto [entry, isNew] = first.try_emplace(face, static_cast<int>(t));
      if (isNew) continue;
      vertices.push_back((cage.mesh.nodes[face[0]] + 2 * cage.mesh.nodes[face[1]] + cage.mesh.nodes[face[2]]) / 4);
      oneSide.push_back(entry->second);
      otherSide.push_back(static_cast<std::int32_t>(t));
      mixed += (cage.quadraticTet[t] < 0) != (cage.quadraticTet[entry->second] < 0);
    }
  }
  ASSERT_GT(mixed, 4u);
  CarriedPoints<double> one(cage, vertices, oneSide), other(cage, vertices, otherSide);
  EXPECT_GT(one.stencils.plainEdgeCount(), 0u);
  EXPECT_GT(one.stencils.edgeCount(), one.stencils.plainEdgeCount());
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Points nodes = shaken(cage.mesh, 0.02, seed);
    one.move(nodes);
    other.move(nodes);
    EXPECT_LT(distances(one.quadratic(), other.quadratic()).longest, 4e-8) << "weights are float";
    EXPECT_GT(distances(one.linear(), one.quadratic()).rms, 1e-3);
  }
  const SmoothMap map = quadraticMap(4, 0.25);
  one.move(map(cage.mesh.nodes));
  EXPECT_LT(distances(one.quadratic(), map(one.rest)).longest, 1e-12) << "in linear tets, too, if fits are exact";
}

TEST(EdgeBends, NormalsFollowTheMapOfTheTets) {
  for (const Cage& cage :
       {refineQuadratic(latticeCage(1, 1, 1)).value(), refineQuadratic(latticeCage(3, 1, 1)).value()}) {
    const TriangleMesh mesh = authoredSphere(12, 0.45);
    Carried<float> single(cage, mesh, Normals::Transformed);
    Carried<double> twice(cage, mesh, Normals::Transformed);
    EXPECT_EQ(single.fit.outside, 0u);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const SmoothMap map = quadraticMap(seed, 0.4);
      single.move(map(cage.mesh.nodes));
      twice.move(map(cage.mesh.nodes));
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        const Eigen::Matrix3d gradient = map.gradient(mesh.positions[v]);
        const Eigen::Vector3d normal = cofactors(gradient) * mesh.normals[v].cast<double>();
        EXPECT_LT(angle(single.normal(v), normal), 2e-3);
        EXPECT_LT(angle(twice.normal(v), normal), 1e-3);
        EXPECT_LT(angle(twice.tangent(v), gradient * mesh.tangents[v].head<3>().cast<double>()), 1e-3);
      }
    }
  }
}

TEST(EdgeBends, FactorsOfAnEdgeSumToNothing) {
  const Cage cage = refineQuadratic(singleTet()).value();
  const std::vector<QuadraticTet> tets = quadraticTets(cage).value();
  const QuadraticEdges edges(cage.mesh, tets);
  std::map<std::size_t, int> lengths;
  for (const auto& [a, b] : uniqueEdges(cage.mesh)) {
    const CageEdge edge{static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b))};
    ASSERT_TRUE(edges.contains(edge));
    const EdgeBend bend = edges.bendOf(edge);
    EXPECT_EQ(std::accumulate(bend.factors.begin(), bend.factors.end(), 0.0), 0.0);
    ++lengths[bend.nodes.size()];
  }
  EXPECT_EQ(lengths, (std::map<std::size_t, int>{{3, 24}, {10, 1}})) << "the diagonal's alone is of all ten nodes";
  EXPECT_FALSE(edges.contains({0, 1}));
}

TEST(EdgeBends, ASkinRefusesNumbersThatMakeNoSense) {
  Cage cage = refineQuadratic(latticeCage(1, 1, 1)).value();
  const TriangleMesh mesh = authoredSphere(6, 0.4);
  cage.quadraticTet[3] = -1;
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  const auto binding = SkinBinding<float>::create(cage, mesh, options);
  ASSERT_FALSE(binding.ok());
  EXPECT_EQ(binding.status().code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin::test
