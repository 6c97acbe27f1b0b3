// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include "cage_texts.h"

#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

TEST(DamagedCageFiles, RefusesToWriteCagesThatAreNotInOrder) {
  const TempFolder folder;
  Cage cage = smallCage();
  cage.volumeFraction.pop_back();
  expectError(saveCage(cage, folder.path("c.vtk")), kSizeMismatch,
              {folder.path("c.vtk"), "volumeFraction", "check the source of the cage"});
  cage = smallCage();
  cage.mesh.tets[1][2] = 5;
  expectError(saveCage(cage, folder.path("c.vtk")), kIndexOutOfRange, {"tet 1 refers to node 5"});
  expectError(saveCage({}, folder.path("c.vtk")), StatusCode::Empty, {"without tets"});
  EXPECT_EQ(folder.fileCount(), 0u);
  expectError(saveCage(smallCage(), folder.path("none/c.vtk")), StatusCode::FileNotWritable, {"none/c.vtk"});
}

TEST(DamagedCageFiles, RefusesToReadWhatLoadTetMeshRefuses) {
  const TempFolder folder;
  expectError(loadCage(folder.path("c.vtk")), kFileNotFound, {folder.path("c.vtk")});
  expectError(loadCage(folder.path("c.xyz")), kUnsupportedFormat, {"c.xyz"});
  TetFileReport report;
  const std::string surface =
      "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 "
      "1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nCELL_DATA 1\nSCALARS fill double\n1\n";
  expectError(loadCageText(surface, &report), StatusCode::Empty, {"no tets"});
  EXPECT_EQ(report.skippedCells, 1u);
}

TEST(DamagedCageFiles, RefusesArraysOfWrongCounts) {
  const std::string text = textOf(smallCage());
  expectError(loadCageText(with(text, "CELL_DATA 2", "CELL_DATA 3")), kSizeMismatch,
              {"c.vtk:", "data of 3 cells, but there are 2"});
  expectError(loadCageText(with(text, "POINT_DATA 5", "POINT_DATA 4")), kSizeMismatch,
              {"c.vtk:", "data of 4 points, but there are 5"});
  expectError(loadCageText(with(text, "fill double 1", "fill double 2")), kMalformed,
              {"c.vtk:", "2 components in 'fill' in place of 1", "give it another name"});
  expectError(loadCageText(with(text, "fine_fill 64 2", "fine_fill 32 4")), kMalformed, {"32 components", "of 64"});
  expectError(loadCageText(with(text, "fine_fill 64 2", "fine_fill 64 1")), kMalformed, {"1 tuples in 'fine_fill'"});
  expectError(loadCageText(with(text, "mesh_hash 2 1", "mesh_hash 1 2")), kMalformed, {"1 components in 'mesh_hash'"});
  expectError(loadCageText(with(text, "mesh_hash 2 1", "mesh_hash 2 0")), kMalformed, {"c.vtk:"});
  expectError(loadCageText(with(text, "vertex_tets 1 3", "vertex_tets 1 4")), kMalformed, {"c.vtk:24:", "a number"});
  expectError(loadCageText(with(text, "vertex_tets 1 3", "vertex_tets 1 99999")), kMalformed, {"c.vtk:20:", "larger"});
  expectError(loadCageText(with(text, "vertex_tets 1 3", "vertex_tets 4294967296 4294967296")), kMalformed, {"larger"});
  expectError(loadCageText(with(text, "vertex_tets 1 3", "vertex_tets 1 2")), kMalformed, {"c.vtk:23:"});
  expectError(loadCageText(with(text, "LOOKUP_TABLE default\n0.5\n", "LOOKUP_TABLE default\n")), kMalformed,
              {"number"});
  expectError(loadCageText(with(text, "LOOKUP_TABLE default\n0.5\n", "LOOKUP_TABLE default\n0.5\n0.5\n")), kMalformed,
              {"c.vtk:29:", "'1' where data of cells or points are expected", "remove"});
}

TEST(DamagedCageFiles, RefusesArraysOfWrongTypes) {
  const std::string text = textOf(smallCage());
  expectError(loadCageText(with(text, "part int", "part double")), kMalformed,
              {"c.vtk:", "'part' of type 'double' in place of integers"});
  expectError(loadCageText(with(text, "vertex_tets 1 3 int", "vertex_tets 1 3 string")), kMalformed,
              {"'vertex_tets' of type 'string' in place of integers"});
  expectError(loadCageText(with(text, "fill double", "fill string")), kMalformed, {"'fill' of type 'string'"});
  expectError(loadCageText(with(text, "int 1\nLOOKUP_TABLE default\n0", "int 1\nLOOKUP_TABLE default\n0.5")),
              kMalformed, {"something other than a number"});
  expectError(loadCageText(with(text, "\n255 254", "\n256 254")), kMalformed,
              {"has 256 in 'fine_fill', whose largest value is 255"});
  expectError(loadCageText(with(text, "\n255 254", "\n-1 254")), kMalformed, {"has -1 in 'fine_fill'"});
  expectError(loadCageText(with(text, "\n2309737967 ", "\n4294967296 ")), kMalformed, {"4294967296 in 'mesh_hash'"});
}

TEST(DamagedCageFiles, RefusesValuesThatMakeNoSense) {
  const std::string text = textOf(smallCage()), fill = "LOOKUP_TABLE default\n0.5\n1\n";
  for (const std::string bad : {"1.5", "-1", "nan", "inf", "1e999"}) {
    expectError(loadCageText(with(text, fill, "LOOKUP_TABLE default\n0.5\n" + bad + "\n")), StatusCode::InvalidOption,
                {"c.vtk: the cage's volumeFraction[1] must be from 0 to 1; correct"});
  }
  expectError(loadCageText(with(text, "\n1\n2\n3\n4\n5\n", "\n1\n2\n0\n4\n5\n")), StatusCode::InvalidOption,
              {"c.vtk: the cage's masses[2] must be above 0"});
  expectError(loadCageText(with(text, "int\n1\n0\n1\n", "int\n1\n2\n1\n")), kIndexOutOfRange,
              {"c.vtk: ", "map assigns tet 2 to vertex 1"});
  expectError(loadCageText(with(text, "\n7\n7\n", "\n7\n-7\n")), StatusCode::InvalidOption, {"sourceTet[1]"});
}

TEST(DamagedCageFiles, RefusesNumbersOfQuadraticTetsThatMakeNoSense) {
  const std::string text = textOf(refineQuadratic(latticeCage(1, 1, 1)).value());
  expectError(loadCageText(with(text, "default\n0\n0\n", "default\n0\n1\n")), StatusCode::InvalidOption,
              {"c.vtk: the cage's quadraticTet is 0 for 7 tets, the first of which is tet 0", "correct the array"});
  expectError(loadCageText(with(text, "default\n0\n0\n", "default\n0\n-2\n")), StatusCode::InvalidOption,
              {"c.vtk: the cage's quadraticTet[1] must be"});
  expectError(loadCageText(with(text, "default\n0\n0\n", "default\n0\n99999999999\n")), kMalformed,
              {"'quadratic_tet'", "largest value"});
  expectError(loadCageText(with(text, "quadratic_tet int 1", "quadratic_tet double 1")), kMalformed,
              {"'quadratic_tet' of type 'double' in place of integers"});
  expectError(loadCageText(with(text, "\n0.5 0 0\n", "\n0.6 0 0\n")), StatusCode::InvalidOption,
              {"c.vtk: ", "tet ", "nodes at the middles of its edges"});
}

TEST(DamagedCageFiles, WhatLoadCageRefusesLoadTetMeshReads) {
  const TempFolder folder;
  for (const std::string bad : {"CELL_DATA 3\n", "CELL_DATA 2\nSCALARS fill double\n7 7\n", "POINT_DATA 5\nnonsense"}) {
    folder.write("c.vtk", kTwoTets + bad);
    EXPECT_FALSE(loadCage(folder.path("c.vtk")).ok()) << bad;
    EXPECT_TRUE(loadTetMesh(folder.path("c.vtk")).ok()) << bad;
  }
}

}  // namespace
}  // namespace tetskin::test
