// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_texts.h"

#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

TEST(LoadTetMesh, TellsTheFormatByTheExtensionInAnyCase) {
  const TempFolder folder;
  ASSERT_TRUE(saveTetMesh(twoTets(), folder.path("c.vtk")).ok());
  std::filesystem::rename(folder.path("c.vtk"), folder.path("C.VTK"));
  const Result<TetMesh> mesh = loadTetMesh(folder.path("C.VTK"));
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().tets, twoTets().tets);
}

TEST(LoadTetMesh, RefusesOtherFormatsByName) {
  expectError(loadTetMesh("cage.vtu"), kUnsupportedFormat, {"cage.vtu", "XML", "save it as legacy VTK"});
  expectError(loadTetMesh("cage.xyz"), kUnsupportedFormat, {"cage.xyz", ".node"});
  expectError(loadTetMesh("cage.msh"), kUnsupportedFormat, {"cage.msh", "meshio convert in.msh out.vtk"});
  expectError(loadTetMesh("cage"), kUnsupportedFormat, {"cage: "});
}

TEST(LoadTetMesh, NamesAMissingFile) {
  const TempFolder folder;
  for (const char* name : {"c.vtk", "c.node", "c.ele"}) {
    expectError(loadTetMesh(folder.path(name)), kFileNotFound, {folder.path("c."), "check the path"});
  }
}

TEST(LoadTetMesh, ResetsTheReport) {
  const TempFolder folder;
  ASSERT_TRUE(saveTetMesh(twoTets(), folder.path("c.vtk")).ok());
  TetFileReport report;
  report.skippedCells = 7;
  ASSERT_TRUE(loadTetMesh(folder.path("c.vtk"), &report).ok());
  EXPECT_EQ(report.skippedCells, 0u);
  EXPECT_EQ(report.describe(), "");
}

/// The corner tet with coordinates of one byte each.
std::string binaryVtk() {
  const auto bytes = [](std::initializer_list<char> values) { return std::string(values); };
  const auto word = [](char value) { return std::string(3, '\0') + value; };
  return "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 char\n" +
         bytes({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) + "\nCELLS 1 5\n" + word(4) + word(0) + word(1) + word(2) +
         word(3) + "\nCELL_TYPES 1\n" + word(10) + "\n";
}

/// Sound files of every form; the last is a cage with all possible data.
std::vector<std::pair<std::string, std::string>> validFiles() {
  const TempFolder folder;
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* name : {"c.vtk", "c.node", "c.ele"}) {
    EXPECT_TRUE(saveTetMesh(twoTets(), folder.path(name)).ok());
    files.emplace_back(name, TempFolder::read(folder.path(name)));
  }
  files.emplace_back(
      "c.vtk",
      "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD F 1\nT 1 1 double\n0\nPOINTS 4 "
      "float\n0 0 0 1 0 0 0 1 0 0 0 1\nMETADATA\nINFORMATION 0\n\nCELLS 2 4\nOFFSETS vtktypeint64\n0 "
      "4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n");
  files.emplace_back("c.vtk", binaryVtk());
  files.emplace_back("c.vtk", textOf(smallCage()));
  return files;
}

/// Whether a file is read as a cage, and then is sound.
bool loads(const TempFolder& folder, const std::string& name, const std::string& bytes) {
  const std::string file = folder.write(name, bytes);
  const Result<TetMesh> mesh = loadTetMesh(file);
  const Result<Cage> cage = loadCage(file);
  EXPECT_TRUE(mesh.ok() || !cage.ok());
  EXPECT_TRUE(cage.ok() ? validateAttributes(cage.value()).ok() : !cage.status().message.empty());
  if (mesh.ok()) {
    const TetMeshReport report = checkTetMesh(mesh.value());
    EXPECT_EQ(report.indexOutOfRange.count + report.nonFiniteNodes.count, 0u);
    EXPECT_GT(mesh.value().tetCount(), 0u);
  }
  return cage.ok();
}

/// Cut short anywhere, and with any bytes changed.
TEST(LoadTetMesh, SurvivesDamagedFiles) {
  std::mt19937 random(5);
  for (const auto& [name, bytes] : validFiles()) {
    const TempFolder folder;
    ASSERT_TRUE(saveTetMesh(twoTets(), folder.path("c.node")).ok());
    EXPECT_TRUE(loads(folder, name, bytes)) << name;
    std::size_t refused = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length)
      refused += !loads(folder, name, bytes.substr(0, length));
    EXPECT_GT(refused, bytes.size() / 2) << name;
    refused = 0;
    for (int i = 0; i < 400; ++i) {
      std::string mutated = i % 2 == 0 ? damaged(bytes, random) : bytes;
      const char plausible[] = "0123456789 -.e\n";
      for (int k = 0; i % 2 != 0 && k < 3; ++k) {
        mutated[random() % mutated.size()] = plausible[random() % (sizeof(plausible) - 1)];
      }
      refused += !loads(folder, name, mutated);
    }
    EXPECT_GT(refused, 30u) << name;
    EXPECT_LT(refused, 400u) << name;
  }
}

}  // namespace
}  // namespace tetskin::test
