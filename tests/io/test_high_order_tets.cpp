// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Files of tets of second order, whatever the format.
#include "support/odd_meshes.h"

#include "cage_texts.h"

#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <sstream>

namespace tetskin::test {
namespace {

using Node = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// A VTK file of a mesh, whose tets are of second order where `isQuadratic` says so.
/// moved  where a node at the middle of an edge is
std::string fileOf(const TetMesh& mesh, const std::function<bool(std::size_t)>& isQuadratic, const Node& moved) {
  const Refinement fine = refineUniformly(mesh);
  const std::size_t corners = mesh.nodeCount();
  std::map<std::array<int, 2>, std::size_t> middleOf;
  for (std::size_t e = 0; e < fine.edges.size(); ++e) {
    const auto [a, b] = std::minmax(fine.edges[e][0], fine.edges[e][1]);
    middleOf[{a, b}] = corners + e;
  }
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << fine.mesh.nodeCount()
       << " double\n";
  for (std::size_t n = 0; n < fine.mesh.nodeCount(); ++n) {
    text << (n < corners ? fine.mesh.nodes[n] : moved(fine.mesh.nodes[n])).transpose() << "\n";
  }
  std::string cells, types;
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    cells += isQuadratic(t) ? "10" : "4";
    for (const int node : tet) cells += ' ' + std::to_string(node);
    for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}) {
      if (!isQuadratic(t)) break;
      cells += ' ' + std::to_string(middleOf[{std::min(tet[a], tet[b]), std::max(tet[a], tet[b])}]);
    }
    cells += '\n';
    types += isQuadratic(t) ? "24\n" : "10\n";
  }
  const std::string count = std::to_string(mesh.tetCount());
  return text.str() + "CELLS " + count + " 1\n" + cells + "CELL_TYPES " + count + "\n" + types;
}

bool always(std::size_t) {
  return true;
}

Eigen::Vector3d unmoved(const Eigen::Vector3d& p) {
  return p;
}

TEST(HighOrderTets, AreThoseOfARefinedMesh) {
  const TetMesh mesh = jittered(bodyCentredCage(2, 2, 2), 0.1, 3);
  TetFileReport report;
  const Result<Cage> read = loadCageText("c.vtk", fileOf(mesh, always, unmoved), &report);
  ASSERT_TRUE(read.ok()) << read.status().message;
  const Cage expected = refineQuadratic(mesh).value();
  EXPECT_EQ(read.value().mesh.nodes, expected.mesh.nodes);
  EXPECT_EQ(read.value().mesh.tets, expected.mesh.tets);
  EXPECT_EQ(read.value().quadraticTet, expected.quadraticTet);
  EXPECT_EQ(report.quadraticTets, mesh.tetCount());
  EXPECT_EQ(report.movedNodes, 0u);
  EXPECT_TRUE(validate(read.value()).ok());
}

TEST(HighOrderTets, CurvedEdgesOfACageAreStraightened) {
  const TetMesh mesh = latticeCage(2, 2, 2);
  const auto bulge = [](const Eigen::Vector3d& p) {
    return p.x() == 0.5 ? Eigen::Vector3d(p + Eigen::Vector3d(0, 0, 0.125 * (1.0 + p.y()))) : p;
  };
  const std::string text = fileOf(mesh, always, bulge);
  TetFileReport report;
  const Result<Cage> read = loadCageText("c.vtk", text, &report);
  ASSERT_TRUE(read.ok()) << read.status().message;
  const Cage expected = refineQuadratic(mesh).value();
  EXPECT_EQ(read.value().mesh.nodes, expected.mesh.nodes);
  EXPECT_EQ(read.value().quadraticTet, expected.quadraticTet);
  const auto moved = std::count_if(expected.mesh.nodes.begin(), expected.mesh.nodes.end(),
                                   [](const Eigen::Vector3d& p) { return p.x() == 0.5; });
  EXPECT_EQ(report.movedNodes, static_cast<std::size_t>(moved));
  EXPECT_EQ(report.farthestMove, 0.375);
  EXPECT_NE(report.describe().find(std::to_string(moved) + " nodes on curved edges were moved to their middles, by up "
                                                           "to 0.375"),
            std::string::npos)
      << report.describe();
  EXPECT_EQ(report.describe().find('\n'), std::string::npos);
  // A mesh of tets alone keeps them: it may be deformed.
  const Result<TetMesh> tets = loadTetMeshText("c.vtk", text, &report);
  ASSERT_TRUE(tets.ok()) << tets.status().message;
  EXPECT_EQ(tets.value().tets, expected.mesh.tets);
  for (std::size_t n = 0; n < expected.mesh.nodeCount(); ++n) {
    EXPECT_EQ(tets.value().nodes[n], n < mesh.nodeCount() ? mesh.nodes[n] : bulge(expected.mesh.nodes[n]));
  }
  EXPECT_EQ(report.movedNodes, 0u);
  // A ten-thousandth of the edge, here of 1 to 1.74, counts as straight.
  for (const double way : {0.9e-4, 1.8e-4}) {
    const auto aside = [way](const Eigen::Vector3d& p) {
      return p.x() == 0.5 ? Eigen::Vector3d(p + Eigen::Vector3d(0, 0, way)) : p;
    };
    ASSERT_TRUE(loadCageText("c.vtk", fileOf(mesh, always, aside), &report).ok());
    EXPECT_EQ(report.movedNodes, static_cast<std::size_t>(way < 1e-4 ? 0 : moved)) << way;
  }
}

TEST(HighOrderTets, TetsOfFirstOrderWithTheirEdgesAreRefused) {
  const TetMesh mesh = latticeCage(3, 1, 1);
  const auto inFirstCube = [](std::size_t t) { return t < 6; };
  expectError(loadCageText("c.vtk", fileOf(mesh, inFirstCube, unmoved)), kUnsupportedFormat,
              {"c.vtk: ", "tets of first order with the same edges, such as tet ", "at second order, or none"});
}

TEST(HighOrderTets, TetsOfFirstOrderThatDoNotTouchThemStay) {
  TetMesh mesh = singleTet();
  for (int k = 0; k < 4; ++k) mesh.nodes.push_back(mesh.nodes[k] + Eigen::Vector3d(5, 0, 0));
  mesh.tets.push_back({4, 5, 6, 7});
  TetFileReport report;
  const Result<Cage> read = loadCageText("c.vtk",
                                         fileOf(
                                             mesh, [](std::size_t t) { return t == 0; }, unmoved),
                                         &report);
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().mesh.tetCount(), 9u);
  EXPECT_EQ(read.value().quadraticTet, (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, -1}));
}

const std::string kThirteenPoints =
    "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 13 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    ".5 0 0\n.5 .5 0\n0 .5 0\n0 0 .5\n.5 0 .5\n0 .5 .5\n0 -1 0\n.5 0 0\n0 -.5 0\n";

TEST(HighOrderTets, TetsOfFirstOrderBetweenTheirMiddlesFitAsTheyAre) {
  // A corner of the quadratic tet, and its mirror image on the other side of a face.
  TetFileReport report;
  const Result<Cage> read = loadCageText(
      "c.vtk", kThirteenPoints + "CELLS 2 16\n10 0 1 2 3 4 5 6 7 8 9\n4 0 4 12 7\nCELL_TYPES 2\n24 10\n", &report);
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().mesh.tetCount(), 9u);
}

TEST(HighOrderTets, NodesThatCannotBeOnTheirEdgesAreErrors) {
  const auto load = [](const std::string& cells) { return loadCageText("c.vtk", kThirteenPoints + cells); };
  const std::string good = "10 0 1 2 3 4 5 6 7 8 9\n", types = "CELL_TYPES 2\n24 24\n";
  expectError(load("CELLS 2 22\n" + good + "10 0 1 3 10 11 8 7 12 5 6\n" + types), kMalformed,
              {"c.vtk:21:", "different nodes in the middle of an edge that they share", "merge"});
  expectError(load("CELLS 2 22\n" + good + "10 1 2 3 10 5 9 8 4 6 7\n" + types), kMalformed,
              {"c.vtk:2", "a node is in the middle of two edges", "order of the nodes"});
  expectError(load("CELLS 2 22\n" + good + "10 1 2 3 1 5 9 8 4 6 7\n" + types), kMalformed,
              {"c.vtk:21:", "tet 1 of the file", "names a node twice"});
}

TEST(HighOrderTets, FlatOnesAreEightFlatTets) {
  std::string text = fileOf(singleTet(), always, unmoved);
  text = with(text, "0 0 1\n", "1 1 0\n");
  TetFileReport report;
  const Result<Cage> read = loadCageText("c.vtk", text, &report);
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().mesh.tetCount(), 8u);
  EXPECT_TRUE(read.value().quadraticTet.empty());
  EXPECT_EQ(report.quadraticTets, 0u);
}

TEST(HighOrderTets, NegativeOnesAreQuadraticToo) {
  TetMesh mesh = singleTet();
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  const Result<Cage> read = loadCageText("c.vtk", fileOf(mesh, always, unmoved));
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(quadraticTets(read.value()).value().size(), 1u);
}

}  // namespace
}  // namespace tetskin::test
