// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "temp_folder.h"

#include <tetskin/io/files.h>

#include <limits>

namespace tetskin::test {
namespace {

TetMesh awkwardMesh() {
  TetMesh mesh;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n = 0; n < 200; ++n) mesh.nodes.emplace_back(number(random), number(random) * 1e-12, number(random) * 1e12);
  mesh.nodes.emplace_back(0.1, -0.0, 5e-324);
  mesh.nodes.emplace_back(-9.9999999999999987e17, -2.2250738585072014e-308, 1.0 / 3.0);
  for (int t = 0; t < 300; ++t) {
    mesh.tets.push_back({int(random() % 202), int(random() % 202), int(random() % 202), int(random() % 202)});
  }
  return mesh;
}

void expectAwkwardMeshReadsBack(const std::string& saved, const std::string& loaded) {
  const TempFolder folder;
  const TetMesh mesh = awkwardMesh();
  const Status status = saveTetMesh(mesh, folder.path(saved));
  ASSERT_TRUE(status.ok()) << status.message;
  const Result<TetMesh> back = loadTetMesh(folder.path(loaded));
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_EQ(back.value().nodes, mesh.nodes);
  EXPECT_EQ(back.value().tets, mesh.tets);
}

TEST(SaveTetMesh, VtkReadsBackExactly) {
  expectAwkwardMeshReadsBack("c.vtk", "c.vtk");
}

TEST(SaveTetMesh, TetgenReadsBackExactlyWhicheverFileIsNamed) {
  expectAwkwardMeshReadsBack("c.node", "c.ele");
  expectAwkwardMeshReadsBack("c.1.ele", "c.1.node");
}

TEST(SaveTetMesh, VtkHasTheLinesThatBulletExpects) {
  const TempFolder folder;
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  ASSERT_TRUE(saveTetMesh(mesh, folder.path("c.vtk")).ok());
  EXPECT_EQ(TempFolder::read(folder.path("c.vtk")),
            "# vtk DataFile Version 2.0\ntetrahedral mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n"
            "POINTS 4 double\n0 0 0\n1 0 0\n0 0.5 0\n0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
}

TEST(SaveTetMesh, TetgenCountsFromZero) {
  const TempFolder folder;
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  ASSERT_TRUE(saveTetMesh(mesh, folder.path("c.ele")).ok());
  EXPECT_EQ(TempFolder::read(folder.path("c.node")), "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 0.5 0\n3 0 0 1\n");
  EXPECT_EQ(TempFolder::read(folder.path("c.ele")), "1 4 0\n0 0 1 2 3\n");
}

TEST(SaveTetMesh, RefusesOtherFormats) {
  const TempFolder folder;
  expectError(saveTetMesh(awkwardMesh(), folder.path("c.vtu")), kUnsupportedFormat, {folder.path("c.vtu"), "use .vtk"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(SaveTetMesh, RefusesMeshesThatCouldNotBeRead) {
  const TempFolder folder;
  const std::string path = folder.path("c.vtk");
  TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}, {}};
  expectError(saveTetMesh(mesh, path), StatusCode::Empty, {path, "without tets"});
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  expectError(saveTetMesh(mesh, path), kIndexOutOfRange, {path, "tet 1 refers to node 4"});
  mesh.tets = {{0, 1, 2, 3}};
  mesh.nodes[2][1] = std::numeric_limits<double>::infinity();
  expectError(saveTetMesh(mesh, path), kNonFinite, {path, "node 2"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(SaveTetMesh, NamesAFolderThatDoesNotExist) {
  const TempFolder folder;
  for (const char* name : {"none/c.vtk", "none/c.ele"}) {
    expectError(saveTetMesh(awkwardMesh(), folder.path(name)), StatusCode::FileNotWritable,
                {folder.path("none/c."), "check that its folder exists"});
  }
}

}  // namespace
}  // namespace tetskin::test
