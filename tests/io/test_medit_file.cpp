// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"

#include <gtest/gtest.h>
#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

Result<TetMesh> loadMedit(const std::string& text, TetFileReport* report = nullptr) {
  return loadTetMeshText("c.mesh", text, report);
}

const std::string kMeditHead = "MeshVersionFormatted 2\nDimension 3\n";
const std::string kVertices = "Vertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 0\n.1 1 1 0\n";
const std::string kTetrahedra = "Tetrahedra\n2\n1 2 3 4 7\n2 3 4 5 7\n";

TEST(LoadMedit, ReadsVerticesAndTets) {
  expectTwoTets(loadMedit(kMeditHead + kVertices + kTetrahedra + "End\n"));
  expectTwoTets(loadMedit("MeshVersionFormatted 1\n# any\nDimension\n3\n" + kTetrahedra + kVertices));
}

TEST(LoadMedit, ReadsOverOtherSections) {
  TetFileReport report;
  expectTwoTets(loadMedit(kMeditHead + kVertices + "Triangles 1\n1 2 3 0\nCorners 2\n1\n2\nRequiredVertices\n0\n" +
                              kTetrahedra + "Normals\n1\n0 0 1\nEdges\n1\n1 2 0\nEnd\nanything",
                          &report));
  EXPECT_EQ(report.skippedCells, 2u);
}

TEST(LoadMedit, TetsOfSecondOrderAreEightTets) {
  const std::string vertices =
      "Vertices\n10\n0 0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 0\n.5 0 0 0\n.5 .5 0 0\n0 .5 0 0\n0 0 .5 0\n"
      ".5 0 .5 0\n0 .5 .5 0\n";
  // Programs differ in their order.
  for (const char* order : {"5 6 7 8 9 10", "5 7 8 6 9 10", "10 9 8 7 6 5"}) {
    const std::string tets = std::string("TetrahedraP2\n1\n1 2 3 4 ") + order + " 0\n";
    for (const std::string& text : {vertices + tets, tets + vertices}) {
      expectQuadraticTet(loadCageText("c.mesh", kMeditHead + text), {0, 1, 2, 3}, {4, 6, 7, 5, 8, 9});
    }
  }
  for (const char* bad : {"0", "11", "-3"}) {
    expectError(loadMedit(kMeditHead + vertices + "TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 " + bad + " 0\n"),
                kIndexOutOfRange, {"c.mesh:17:", "tet 1"});
  }
}

TEST(LoadMedit, NamesTheLineOfAFault) {
  expectError(loadMedit("$MeshFormat\n"), kMalformed, {"c.mesh:1:", "Medit"});
  expectError(loadMedit("MeshVersionFormatted 1\nDimension 2\n"), kUnsupportedFormat, {"c.mesh:2:", "dimension 2"});
  expectError(loadMedit(kMeditHead + "Vertices\n2000000000\n0 0 0 1\n"), kMalformed, {"c.mesh:4:", "too short"});
  expectError(loadMedit(kMeditHead + "Vertices\n2\n0 0 0 1\n0 x 0 1\n"), kMalformed, {"c.mesh:6:"});
  expectError(loadMedit(kMeditHead + "Vertices\n1\n0 inf 0 1\n"), kNonFinite, {"c.mesh:5:", "node 1"});
  for (const char* tet : {"0 1 2 3", "1 2 3 6", "1 2 3 -5"}) {
    expectError(loadMedit(kMeditHead + kVertices + "Tetrahedra\n1\n" + tet + " 0\n"), kIndexOutOfRange,
                {"c.mesh:12:", "tet 1"});
  }
  expectError(loadMedit(kMeditHead + kVertices), StatusCode::Empty, {"c.mesh: ", "no tets"});
}

}  // namespace
}  // namespace tetskin::test
