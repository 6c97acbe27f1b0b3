// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tetskin/core/mesh.h>
#include <tetskin/io/files.h>

#include <random>

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

/// Files of every format, also of versions that are not written.
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
  return files;
}

/// Loads bytes under a name, beside the intact second file of a pair in the case of TetGen. Returns whether they were
/// read.
bool loads(const TempFolder& folder, const std::string& name, const std::string& bytes) {
  const Result<TetMesh> mesh = loadTetMesh(folder.write(name, bytes));
  if (!mesh.ok()) {
    EXPECT_FALSE(mesh.status().message.empty());
    return false;
  }
  const TetMeshReport report = checkTetMesh(mesh.value());
  EXPECT_EQ(report.indexOutOfRange.count, 0u);
  EXPECT_EQ(report.nonFiniteNodes.count, 0u);
  EXPECT_GT(mesh.value().tetCount(), 0u);
  return true;
}

TEST(LoadTetMesh, SurvivesFilesCutShortAnywhere) {
  for (const auto& [name, bytes] : validFiles()) {
    const TempFolder folder;
    ASSERT_TRUE(saveTetMesh(twoTets(), folder.path("c.node")).ok());
    EXPECT_TRUE(loads(folder, name, bytes)) << name;
    std::size_t refused = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length)
      refused += !loads(folder, name, bytes.substr(0, length));
    EXPECT_GT(refused, bytes.size() / 2) << name;
  }
}

TEST(LoadTetMesh, SurvivesDamagedBytes) {
  std::mt19937 random(5);
  for (const auto& [name, bytes] : validFiles()) {
    const TempFolder folder;
    ASSERT_TRUE(saveTetMesh(twoTets(), folder.path("c.node")).ok());
    std::size_t refused = 0;
    for (int i = 0; i < 300; ++i) {
      std::string mutated = bytes;
      for (unsigned k = 0; k <= random() % 3; ++k) {
        // Digits and blanks leave the text plausible, so that the damage passes the first check.
        const char plausible[] = "0123456789 -.e\n";
        const bool plain = random() % 2 == 0;
        mutated[random() % mutated.size()] =
            plain ? plausible[random() % (sizeof(plausible) - 1)] : static_cast<char>(random() % 256);
      }
      refused += !loads(folder, name, mutated);
    }
    EXPECT_GT(refused, 20u) << name;
    EXPECT_LT(refused, 300u) << name;
  }
}

}  // namespace
}  // namespace tetskin::test
