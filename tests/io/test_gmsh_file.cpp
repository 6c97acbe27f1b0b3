// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "raw_bytes.h"

#include <gtest/gtest.h>
#include <tetskin/io/files.h>

#include <algorithm>

namespace tetskin::test {
namespace {

Result<TetMesh> loadGmsh(const std::string& text, TetFileReport* report = nullptr) {
  return loadTetMeshText("c.msh", text, report);
}

const std::string kHead2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kNodes2 = "$Nodes\n5\n10 0 0 0\n20 1 0 0\n15 0 1 0\n40 0 0 1\n1000000 0.1 1 1\n$EndNodes\n";
const std::string kElements2 =
    "$Elements\n4\n1 15 2 0 1 10\n2 2 2 0 1 10 20 15\n3 4 2 0 1 10 20 15 40\n9 4 3 0 1 5 20 15 40 "
    "1000000\n$EndElements\n";

const std::string kHead4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string kNodes4 =
    "$Nodes\n3 5 10 1000000\n2 1 0 3\n10\n20\n15\n0 0 0\n1 0 0\n0 1 0\n2 2 1 1\n40\n0 0 1 0.5 0.25\n3 1 0 1\n1000000\n"
    "0.1 1 1\n$EndNodes\n";
const std::string kElements4 =
    "$Elements\n2 3 1 3\n2 1 2 1\n1 10 20 15\n3 1 4 2\n2 10 20 15 40\n3 20 15 40 1000000\n$EndElements\n";

TEST(LoadGmsh, ReadsVersion2) {
  TetFileReport report;
  expectTwoTets(loadGmsh(kHead2 + kNodes2 + kElements2, &report));
  EXPECT_EQ(report.skippedCells, 2u);
  EXPECT_EQ(report.quadraticTets, 0u);
}

TEST(LoadGmsh, ReadsVersion4WithParametricNodes) {
  TetFileReport report;
  expectTwoTets(loadGmsh(kHead4 + kNodes4 + kElements4, &report));
  EXPECT_EQ(report.skippedCells, 1u);
}

TEST(LoadGmsh, ReadsOverOtherSections) {
  expectTwoTets(loadGmsh("$Comments\nany text, 5 numbers\n$EndComments\n" + kHead4 +
                         "$PhysicalNames\n1\n3 1 \"the $body\"\n$EndPhysicalNames\n$Entities\n0 0 0 0\n$EndEntities\n" +
                         kNodes4 + kElements4 + "$NodeData\n1\n\"T\"\n$EndNodeData\n"));
}

TEST(LoadGmsh, ReadsTheLineEndsOfOldMacs) {
  for (std::string text : {kHead2 + kNodes2 + kElements2, kHead4 + kNodes4 + kElements4}) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    expectTwoTets(loadGmsh(text));
  }
}

TEST(LoadGmsh, NamesTheLineOfACoordinateThatIsTooFar) {
  std::string text = kHead2 + kNodes2 + kElements2;
  text.replace(text.find("0.1 1 1"), 3, "2e18");
  expectError(loadGmsh(text), kNonFinite, {"c.msh:10:", "node 1000000", "beyond 1e18", "Correct it"});
}

TEST(LoadGmsh, SectionsMayComeInAnyOrder) {
  expectTwoTets(loadGmsh(kHead2 + kElements2 + kNodes2));
}

TEST(LoadGmsh, TetsOfSecondOrderAreEightTets) {
  const std::string nodes =
      "$Nodes\n11\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n15 .5 0 0\n16 .5 .5 0\n17 0 .5 0\n18 0 0 .5\n19 .5 0 .5\n20 0 "
      ".5 .5\n7 9 9 9\n$EndNodes\n$Elements\n2\n1 11 2 0 1 1 2 3 4 15 16 17 18 20 19\n2 15 2 0 1 7\n$EndElements\n";
  TetFileReport report;
  const Result<Cage> cage = loadCageText("c.msh", kHead2 + nodes, &report);
  expectQuadraticTet(cage, {0, 1, 2, 3}, {4, 6, 7, 5, 8, 9});
  EXPECT_EQ(cage.value().mesh.nodeCount(), 11u) << "with the node that has nothing to do with the tet";
  EXPECT_EQ(report.movedNodes, 0u);
  EXPECT_EQ(report.describe(),
            "1 cells that are no tets were skipped, 1 tets of second or higher order became quadratic tets, each of "
            "eight tets");
  std::string text = kHead2 + nodes;
  text.replace(text.find(" 20 19\n2 15"), 6, " 20 12");
  expectError(loadGmsh(text), kIndexOutOfRange, {"c.msh:20:", "tet 1 refers to node 12"});
  text.replace(text.find(" 20 12\n2 15"), 6, " 20   ");
  expectError(loadGmsh(text), kMalformed, {"c.msh:"});
}

TEST(LoadGmsh, TetsAboveSecondOrderAreQuadraticBetweenTheirCorners) {
  std::string text = kHead2 + "$Nodes\n20\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
  for (int n = 5; n <= 20; ++n) text += std::to_string(n) + " 0.3 0.1 0.2\n";
  text += "$EndNodes\n$Elements\n1\n1 29 0 1 2 3 4";
  for (int n = 5; n <= 20; ++n) text += ' ' + std::to_string(n);
  TetFileReport report;
  const Result<Cage> cage = loadCageText("c.msh", text + "\n$EndElements\n", &report);
  expectQuadraticTet(cage, {0, 1, 2, 3}, {4, 5, 6, 7, 8, 9});
  EXPECT_EQ(cage.value().mesh.nodeCount(), 10u);
  EXPECT_EQ(report.droppedNodes, 16u);
  EXPECT_NE(report.describe().find("16 nodes above second order were left out"), std::string::npos);
}

TEST(LoadGmsh, ReadsVersion40) {
  expectTwoTets(
      loadGmsh("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n$Nodes\n3 5\n1 2 0 3\n10 0 0 0\n20 1 0 0\n15 0 1 0\n"
               "2 2 1 1\n40 0 0 1 0.5 0.25\n1 3 0 1\n1000000 0.1 1 1\n$EndNodes\n"
               "$Elements\n2 3\n1 2 2 1\n1 10 20 15\n1 3 4 2\n2 10 20 15 40\n3 20 15 40 1000000\n$EndElements\n"));
}

/// A binary file of either version: two tets and a triangle.
std::string binaryGmsh(int version) {
  using I = std::int32_t;
  using L = std::int64_t;
  const std::vector<I> tags = {10, 20, 15, 40, 13};  // 13: a carriage return
  const std::vector<std::string> points = {raw<double>({0, 0, 0}), raw<double>({1, 0, 0}), raw<double>({0, 1, 0}),
                                           raw<double>({0, 0, 1}), raw<double>({0.1, 1, 1})};
  std::string text =
      std::string("$MeshFormat\n") + (version == 2 ? "2.2" : "4.1") + " 1 8\n" + raw<I>({1}) + "\n$EndMeshFormat\n";
  if (version == 2) {
    text += "$Nodes\n5\n";
    for (std::size_t n = 0; n < 5; ++n) text += raw<I>({tags[n]}) + points[n];
    return text + "\n$EndNodes\n$Elements\n3\n" + raw<I>({2, 1, 2, 1, 0, 1, 10, 20, 15}) +
           raw<I>({4, 2, 2, 2, 0, 1, 10, 20, 15, 40, 3, 0, 1, 20, 15, 40, 13}) + "\n$EndElements\n";
  }
  text += "$Entities\n" + raw<L>({0, 0, 0, 0}) + "\r $End\n$EndEntities\n$Nodes\n" + raw<L>({2, 5, 10, 40}) +
          raw<I>({2, 1, 1}) + raw<L>({1, 10}) + points[0] + raw<double>({0.5, 0.5}) + raw<I>({3, 1, 0}) + raw<L>({4});
  for (std::size_t n = 1; n < 5; ++n) text += raw<L>({tags[n]});
  for (std::size_t n = 1; n < 5; ++n) text += points[n];
  return text + "\n$EndNodes\n$Elements\n" + raw<L>({2, 3, 1, 3}) + raw<I>({2, 1, 2}) + raw<L>({1, 1, 10, 20, 15}) +
         raw<I>({3, 1, 4}) + raw<L>({2, 2, 10, 20, 15, 40, 3, 20, 15, 40, 13}) + "\n$EndElements\n";
}

TEST(LoadGmsh, ReadsBinaryOfBothVersions) {
  for (const int version : {2, 4}) {
    TetFileReport report;
    expectTwoTets(loadGmsh(binaryGmsh(version), &report));
    EXPECT_EQ(report.skippedCells, 1u);
  }
}

TEST(LoadGmsh, ReadsBinaryOfSecondOrder) {
  std::string text = "$MeshFormat\n2.2 1 8\n" + raw<std::int32_t>({1}) + "\n$EndMeshFormat\n$Nodes\n10\n";
  for (std::int32_t n = 1; n <= 10; ++n)
    text += raw<std::int32_t>({n}) + raw<double>({1.0 * n, 1.0 * n * n, n == 4 ? 1.0 : 0.0});
  text += "\n$EndNodes\n$Elements\n1\n" + raw<std::int32_t>({11, 1, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) +
          "\n$EndElements\n";
  TetFileReport report;
  const Result<TetMesh> mesh = loadGmsh(text, &report);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().nodeCount(), 10u);
  EXPECT_EQ(mesh.value().tetCount(), 8u);
  EXPECT_EQ(mesh.value().nodes[6], Eigen::Vector3d(7, 49, 0)) << "a mesh of tets keeps nodes where they are";
  EXPECT_EQ(report.movedNodes, 0u);
}

TEST(LoadGmsh, BinaryFilesThatAreCutShortOrDamagedAreErrors) {
  for (const int version : {2, 4}) {
    const std::string sound = binaryGmsh(version);
    const std::size_t last = sound.find("$EndElements");
    for (std::size_t length = 0; length < last; ++length)
      EXPECT_FALSE(loadGmsh(sound.substr(0, length)).ok()) << length;
    for (std::size_t at = 30; at + 4 < last; ++at) {
      std::string damaged = sound;
      damaged.replace(at, 4, "\xFF\xFF\xFF\x7F");
      const Result<TetMesh> mesh = loadGmsh(damaged);
      EXPECT_TRUE(mesh.ok() ? checkTetMesh(mesh.value()).indexOutOfRange.count == 0 : !mesh.status().message.empty());
    }
  }
}

TEST(LoadGmsh, RefusesOtherVersions) {
  expectError(loadGmsh("$MeshFormat\n4.0 1 8\n"), kUnsupportedFormat, {"c.msh:2:", "'4.0', binary", "2.2 or 4.1"});
  expectError(loadGmsh("$MeshFormat\n1.0 0 8\n$EndMeshFormat\n"), kUnsupportedFormat, {"c.msh:2:", "'1.0'"});
  std::string text = binaryGmsh(2);
  text.replace(text.find("$Elements\n3\n") + 12, 4, raw<std::int32_t>({99}));
  expectError(loadGmsh(text), kUnsupportedFormat, {"c.msh: ", "type 99", "ASCII"});
}

TEST(LoadGmsh, RefusesWhatIsNoGmshFile) {
  expectError(loadGmsh(""), kMalformed, {"c.msh:1:", "$MeshFormat"});
  expectError(loadGmsh("(0 \"fluent\")\n"), kMalformed, {"c.msh:1:", "is it a Gmsh file?"});
  expectError(loadGmsh(kNodes2), kMalformed, {"c.msh:1:", "no $MeshFormat before"});
}

TEST(LoadGmsh, NamesTheLineOfANodeThatDoesNotExist) {
  expectError(loadGmsh(kHead2 + kNodes2 + "$Elements\n1\n7 4 2 0 1 10 20 15 16\n$EndElements\n"), kIndexOutOfRange,
              {"c.msh:14:", "tet 7", "node 16"});
  expectError(loadGmsh(kHead4 + kNodes4 + "$Elements\n1 1 1 1\n3 1 4 1\n7 10 20 15 -1\n$EndElements\n"),
              kIndexOutOfRange, {"tet 7", "node -1"});
}

TEST(LoadGmsh, NamesTheLineOfMalformedText) {
  expectError(loadGmsh(kHead2 + "$Nodes\n2\n1 0 0 0\n2 0 x 0\n$EndNodes\n"), kMalformed, {"c.msh:7:", "number"});
  expectError(loadGmsh(kHead2 + "$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n"), kMalformed, {"c.msh:7:", "$EndNodes"});
  expectError(loadGmsh(kHead2 + "$Nodes\n2\n1 0 0 0\n"), kMalformed, {"c.msh:", "complete"});
  expectError(loadGmsh(kHead2 + kNodes2 + "$Elements\n1\n1 4 2 0 1 10 20\n$EndElements\n"), kMalformed,
              {"c.msh:", "number"});
  expectError(loadGmsh(kHead2 + kNodes2 + kElements2 + "$Comments\n"), kMalformed, {"c.msh:", "$EndComments"});
  expectError(loadGmsh(kHead2 + "$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n"), kMalformed, {"c.msh: ", "node 1 twice"});
}

TEST(LoadGmsh, RefusesCountsThatDoNotFit) {
  for (const char* count : {"2000000000", "18446744073709551615", "99999999999999999999", "-1"}) {
    expectError(loadGmsh(kHead2 + "$Nodes\n" + count + "\n1 0 0 0\n"), kMalformed, {"c.msh:5:"});
    expectError(loadGmsh(kHead2 + kNodes2 + "$Elements\n" + count + "\n"), kMalformed, {"c.msh:13:"});
    expectError(loadGmsh(kHead4 + "$Nodes\n1 1 1 1\n3 1 0 " + count + "\n"), kMalformed, {"c.msh:6:"});
  }
}

TEST(LoadGmsh, NamesTheLineOfACoordinateThatIsNotFinite) {
  expectError(loadGmsh(kHead2 + "$Nodes\n1\n7 0 0 nan\n$EndNodes\n"), kNonFinite, {"c.msh:6:", "node 7"});
  expectError(loadGmsh(kHead4 + "$Nodes\n1 1 7 7\n3 1 0 1\n7\n0 inf 0\n$EndNodes\n"), kNonFinite,
              {"c.msh:8:", "node 7"});
}

}  // namespace
}  // namespace tetskin::test
