// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/two_plates.h"

#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tetskin/io/tet_files.h>

#include <functional>
#include <limits>
#include <random>

namespace tetskin {
namespace {

using test::expectError;
using test::platesOfCopies;
using test::TempFolder;

void expectSame(const Cage& a, const Cage& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.vertexTets, b.vertexTets);
  EXPECT_EQ(a.fill, b.fill);
  EXPECT_EQ(a.factor, b.factor);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(a.parts, b.parts);
  EXPECT_EQ(a.latticeTets, b.latticeTets);
  EXPECT_EQ(a.fineFill, b.fineFill);
  EXPECT_EQ(a.meshHash, b.meshHash);
}

void expectRoundTrip(const Cage& cage) {
  const TempFolder folder;
  const Status saved = saveCage(cage, folder.path("c.vtk"));
  ASSERT_TRUE(saved.ok()) << saved.message;
  const Result<Cage> loaded = loadCage(folder.path("c.vtk"));
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  expectSame(loaded.value(), cage);
  const Result<TetMesh> bare = loadTetMesh(folder.path("c.vtk"));
  ASSERT_TRUE(bare.ok()) << bare.status().message;
  EXPECT_EQ(bare.value().nodes, cage.nodes);
  EXPECT_EQ(bare.value().tets, cage.tets);
}

/// Everything is known of two tets, in numbers of one or two digits.
Cage smallCage() {
  Cage cage(TetMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 1, 1}}, {{0, 1, 2, 3}, {1, 2, 3, 4}}});
  cage.vertexTets = {1, 0, 1};
  cage.fill = {0.5, 1};
  cage.factor = {2, 0.25};
  cage.masses = {1, 2, 3, 4, 5};
  cage.parts = {0, 1};
  cage.latticeTets = {7, 7};
  for (std::size_t k = 0; k < 2 * kFineTets; ++k) cage.fineFill.push_back(static_cast<std::uint8_t>(255 - k));
  cage.meshHash = 0x89ABCDEF01234567u;
  return cage;
}

/// Ways to know less.
const std::vector<std::function<void(Cage&)>>& forgetOne() {
  static const std::vector<std::function<void(Cage&)>> ways = {
      [](Cage& cage) { cage.vertexTets.clear(); }, [](Cage& cage) { cage.fill.clear(); },
      [](Cage& cage) { cage.factor.clear(); },     [](Cage& cage) { cage.masses.clear(); },
      [](Cage& cage) { cage.parts.clear(); },      [](Cage& cage) { cage.latticeTets.clear(); },
      [](Cage& cage) { cage.fineFill.clear(); },   [](Cage& cage) { cage.meshHash = 0; }};
  return ways;
}

std::string textOf(const Cage& cage) {
  const TempFolder folder;
  EXPECT_TRUE(saveCage(cage, folder.path("c.vtk")).ok());
  return TempFolder::read(folder.path("c.vtk"));
}

Result<Cage> loadText(const std::string& text, TetFileReport* report = nullptr) {
  const TempFolder folder;
  return loadCage(folder.write("c.vtk", text), report);
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t place = text.find(old);
  EXPECT_NE(place, std::string::npos) << old;
  return place == std::string::npos ? text : text.replace(place, old.size(), replacement);
}

TEST(CageFiles, AllThatIsKnownReadsBackExactly) {
  expectRoundTrip(platesOfCopies().cage);
  expectRoundTrip(platesOfCopies(1.0).cage);
  expectRoundTrip(smallCage());
}

TEST(CageFiles, WhatIsNotKnownIsLeftOut) {
  for (const auto& forget : forgetOne()) {
    Cage cage = smallCage(), nothingElse(TetMesh{cage.nodes, cage.tets});
    forget(cage);
    expectRoundTrip(cage);
    for (const auto& other : forgetOne()) {
      if (&other != &forget) other(cage);
    }
    expectRoundTrip(cage);
    expectSame(cage, nothingElse);
  }
}

TEST(CageFiles, EachArrayAlone) {
  for (std::size_t kept = 0; kept < forgetOne().size(); ++kept) {
    Cage cage = smallCage();
    for (std::size_t k = 0; k < forgetOne().size(); ++k) {
      if (k != kept) forgetOne()[k](cage);
    }
    expectRoundTrip(cage);
  }
}

TEST(CageFiles, ExtremeNumbersReadBackExactly) {
  Cage cage = smallCage();
  cage.fill = {5e-324, 1.0 / 3.0};
  cage.factor = {std::numeric_limits<double>::max(), std::numeric_limits<double>::min()};
  cage.masses = {1e-300, 0.1, 1e300, 2.0 / 3.0, 5e-324};
  cage.parts = {0, std::numeric_limits<int>::max()};
  for (const std::uint64_t hash : {std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 32}) {
    cage.meshHash = hash;
    expectRoundTrip(cage);
  }
}

TEST(CageFiles, ABareCageMakesTheFileOfItsTets) {
  const TempFolder folder;
  const Cage cage(test::latticeCage(2, 1, 1));
  for (const char* name : {"c.vtk", "c.msh", "c.ele"}) {
    ASSERT_TRUE(saveCage(cage, folder.path(name)).ok());
    const std::string text = TempFolder::read(folder.path(name));
    ASSERT_TRUE(saveTetMesh(cage, folder.path(name)).ok());
    EXPECT_EQ(TempFolder::read(folder.path(name)), text);
  }
}

TEST(CageFiles, ArraysStandBehindTheMesh) {
  Cage cage = smallCage();
  cage.fineFill.clear();
  const TempFolder folder;
  ASSERT_TRUE(saveTetMesh(cage, folder.path("c.vtk")).ok());
  EXPECT_EQ(textOf(cage),
            TempFolder::read(folder.path("c.vtk")) +
                "FIELD FieldData 2\nmesh_hash 2 1 unsigned_int\n2309737967 19088743\nvertex_tets 1 3 int\n1\n0\n1\n"
                "CELL_DATA 2\nSCALARS fill double 1\nLOOKUP_TABLE default\n0.5\n1\n"
                "SCALARS factor double 1\nLOOKUP_TABLE default\n2\n0.25\nSCALARS part int 1\nLOOKUP_TABLE default\n0\n"
                "1\nSCALARS lattice_tet int 1\nLOOKUP_TABLE default\n7\n7\n"
                "POINT_DATA 5\nSCALARS mass double 1\nLOOKUP_TABLE default\n1\n2\n3\n4\n5\n");
}

TEST(CageFiles, OtherFormatsKeepTheTetsAlone) {
  const TempFolder folder;
  Cage cage = smallCage();
  cage.latticeTets = {7, 8};  // no copies: the map can be found again
  for (const char* name : {"c.msh", "c.ele", "c.node"}) {
    ASSERT_TRUE(saveCage(cage, folder.path(name)).ok());
    const Result<Cage> loaded = loadCage(folder.path(name));
    ASSERT_TRUE(loaded.ok()) << loaded.status().message;
    expectSame(loaded.value(), Cage(TetMesh{cage.nodes, cage.tets}));
  }
}

TEST(CageFiles, OnlyVtkKeepsTheMapOfCopies) {
  const TempFolder folder;
  const Cage cage = platesOfCopies().cage;
  for (const char* name : {"c.msh", "c.ele", "c.node"}) {
    expectError(saveCage(cage, folder.path(name)), StatusCode::UnsupportedFormat,
                {folder.path(name), "which copy of a tet carries which vertex", "use .vtk"});
  }
  expectError(saveCage(cage, folder.path("c.xyz")), StatusCode::UnsupportedFormat, {"use .vtk, .node, .ele or .msh"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(CageFiles, RefusesToWriteCagesThatAreNotInOrder) {
  const TempFolder folder;
  Cage cage = smallCage();
  cage.fill.pop_back();
  expectError(saveCage(cage, folder.path("c.vtk")), StatusCode::SizeMismatch,
              {folder.path("c.vtk"), "fill", "check where the cage comes from"});
  cage = smallCage();
  cage.tets[1][2] = 5;
  expectError(saveCage(cage, folder.path("c.vtk")), StatusCode::IndexOutOfRange, {"tet 1 names node 5"});
  expectError(saveCage({}, folder.path("c.vtk")), StatusCode::Empty, {"without tets"});
  EXPECT_EQ(folder.fileCount(), 0u);
  expectError(saveCage(smallCage(), folder.path("none/c.vtk")), StatusCode::FileNotWritable, {"none/c.vtk"});
}

TEST(CageFiles, RefusesToReadWhatLoadTetMeshRefuses) {
  const TempFolder folder;
  expectError(loadCage(folder.path("c.vtk")).status(), StatusCode::FileNotFound, {folder.path("c.vtk")});
  expectError(loadCage(folder.path("c.xyz")).status(), StatusCode::UnsupportedFormat, {"c.xyz"});
  TetFileReport report;
  const std::string surface =
      "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 "
      "1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nCELL_DATA 1\nSCALARS fill double\n1\n";
  expectError(loadText(surface, &report).status(), StatusCode::Empty, {"no linear tets"});
  EXPECT_EQ(report.skippedCells, 1u);
}

const std::string kTwoTets =
    "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "0.1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n";

TEST(CageFiles, ReadsOverDataOfEveryOtherKind) {
  const Result<Cage> cage = loadText(
      kTwoTets +
      "FIELD FieldData 3\nTIME 1 1 double\n0.5\nNAMES 1 2 string\nfill\n\nfill 1 2 double\n1 1\n"
      "CELL_DATA 2\nSCALARS mass int 1\nLOOKUP_TABLE default\n1 2\nSCALARS loose float\n1 2\nSCALARS rgb float 3\n"
      "LOOKUP_TABLE fill\n1 2 3 4 5 6\nLOOKUP_TABLE fill 2\n0 0 0 1 1 1 1 1\nCOLOR_SCALARS c 3\n0 0 0 1 1 1\n"
      "VECTORS v double\n1 2 3 4 5 6\nNORMALS n double\n1 2 3 4 5 6\nTEXTURE_COORDINATES t 2 float\n1 2 3 4\n"
      "TENSORS s float\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\nTENSORS6 s6 float\n1 2 3 4 5 6\n1 2 3 4 5 6\n"
      "GLOBAL_IDS g vtkIdType\n1 2\nPEDIGREE_IDS p vtkIdType\n1 2\nEDGE_FLAGS e int\n1 2\n"
      "METADATA\nINFORMATION 1\nNAME x\n\nFIELD FieldData 3\nvertex_tets 1 2 int\n8 8\n"
      "METADATA\nINFORMATION 0\n\nEMPTY 0 2 int\nfactor 1 2 float\n3 0.5\n"
      "POINT_DATA 5\nFIELD FieldData 1\nmass 1 5 int\n1 2 3 4 5\nCELL_DATA 2\nSCALARS fill float\n0.5 1\n");
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  EXPECT_TRUE(cage.value().vertexTets.empty());
  EXPECT_EQ(cage.value().fill, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(cage.value().factor, (std::vector<double>{3, 0.5}));
  EXPECT_EQ(cage.value().masses, (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(CageFiles, ReadsFieldsInFrontOfThePointsAsVtkWritesThem) {
  const std::string field = "FIELD FieldData 2\nmesh_hash 2 1 unsigned_int\n0 9\nvertex_tets 1 3 vtktypeint64\n0 1 1\n";
  const Result<Cage> cage = loadText(with(kTwoTets, "POINTS", field + "POINTS"));
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  EXPECT_EQ(cage.value().vertexTets, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(cage.value().meshHash, 9u);
}

TEST(CageFiles, ValuesOfCellsThatAreNoTetsAreDropped) {
  TetFileReport report;
  const Result<Cage> cage = loadText(
      "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "0.1 1 1\nCELLS 4 17\n3 0 1 2\n4 0 1 2 3\n2 0 1\n4 1 2 3 4\nCELL_TYPES 4\n5\n10\n3\n10\nFIELD F 1\n"
      "vertex_tets 1 2 int\n0 1\nCELL_DATA 4\nSCALARS fill float\nLOOKUP_TABLE default\n7 0.25 7 0.75\n"
      "SCALARS lattice_tet int\n-1 5 -1 6\nSCALARS part int\n9 0 9 1\n",
      &report);
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  EXPECT_EQ(report.skippedCells, 2u);
  EXPECT_EQ(cage.value().tetCount(), 2u);
  EXPECT_EQ(cage.value().vertexTets, (std::vector<int>{0, 1}));
  EXPECT_EQ(cage.value().fill, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(cage.value().latticeTets, (std::vector<int>{5, 6}));
  EXPECT_EQ(cage.value().parts, (std::vector<int>{0, 1}));
}

TEST(CageFiles, RefusesArraysOfWrongCounts) {
  const std::string text = textOf(smallCage());
  const StatusCode code = StatusCode::Malformed;
  expectError(loadText(with(text, "CELL_DATA 2", "CELL_DATA 3")).status(), StatusCode::SizeMismatch,
              {"c.vtk:", "data of 3 cells, but there are 2"});
  expectError(loadText(with(text, "POINT_DATA 5", "POINT_DATA 4")).status(), StatusCode::SizeMismatch,
              {"c.vtk:", "data of 4 points, but there are 5"});
  expectError(loadText(with(text, "fill double 1", "fill double 2")).status(), code,
              {"c.vtk:", "2 components in 'fill' in place of 1", "give it another name"});
  expectError(loadText(with(text, "fine_fill 64 2", "fine_fill 32 4")).status(), code, {"32 components", "of 64"});
  expectError(loadText(with(text, "fine_fill 64 2", "fine_fill 64 1")).status(), code, {"1 tuples in 'fine_fill'"});
  expectError(loadText(with(text, "mesh_hash 2 1", "mesh_hash 1 2")).status(), code, {"1 components in 'mesh_hash'"});
  expectError(loadText(with(text, "mesh_hash 2 1", "mesh_hash 2 0")).status(), code, {"c.vtk:"});
  expectError(loadText(with(text, "vertex_tets 1 3", "vertex_tets 1 4")).status(), code, {"c.vtk:24:", "a number"});
  expectError(loadText(with(text, "vertex_tets 1 3", "vertex_tets 1 99999")).status(), code, {"c.vtk:20:", "larger"});
  expectError(loadText(with(text, "vertex_tets 1 3", "vertex_tets 4294967296 4294967296")).status(), code, {"larger"});
  expectError(loadText(with(text, "vertex_tets 1 3", "vertex_tets 1 2")).status(), code, {"c.vtk:23:"});
  expectError(loadText(with(text, "LOOKUP_TABLE default\n0.5\n", "LOOKUP_TABLE default\n")).status(), code, {"number"});
  expectError(loadText(with(text, "LOOKUP_TABLE default\n0.5\n", "LOOKUP_TABLE default\n0.5\n0.5\n")).status(), code,
              {"c.vtk:29:", "'1' where data of cells or points should begin", "remove"});
}

TEST(CageFiles, RefusesArraysOfWrongTypes) {
  const std::string text = textOf(smallCage());
  const StatusCode code = StatusCode::Malformed;
  expectError(loadText(with(text, "part int", "part double")).status(), code,
              {"c.vtk:", "'part' of type 'double' in place of integers"});
  expectError(loadText(with(text, "vertex_tets 1 3 int", "vertex_tets 1 3 string")).status(), code,
              {"'vertex_tets' of type 'string' in place of integers"});
  expectError(loadText(with(text, "fill double", "fill string")).status(), code, {"'fill' of type 'string'"});
  expectError(loadText(with(text, "int 1\nLOOKUP_TABLE default\n0", "int 1\nLOOKUP_TABLE default\n0.5")).status(), code,
              {"something else than a number"});
  expectError(loadText(with(text, "\n255 254", "\n256 254")).status(), code,
              {"has 256 in 'fine_fill', whose values go up to 255"});
  expectError(loadText(with(text, "\n255 254", "\n-1 254")).status(), code, {"has -1 in 'fine_fill'"});
  expectError(loadText(with(text, "\n2309737967 ", "\n4294967296 ")).status(), code, {"4294967296 in 'mesh_hash'"});
}

TEST(CageFiles, RefusesValuesThatMakeNoSense) {
  const std::string text = textOf(smallCage()), fill = "LOOKUP_TABLE default\n0.5\n1\n";
  for (const std::string bad : {"1.5", "-1", "nan", "inf", "1e999"}) {
    expectError(loadText(with(text, fill, "LOOKUP_TABLE default\n0.5\n" + bad + "\n")).status(),
                StatusCode::InvalidOption, {"c.vtk: the cage's fill[1] must be from 0 to 1; correct"});
  }
  expectError(loadText(with(text, "\n1\n2\n3\n4\n5\n", "\n1\n2\n0\n4\n5\n")).status(), StatusCode::InvalidOption,
              {"c.vtk: the cage's masses[2] must be above 0"});
  expectError(loadText(with(text, "int\n1\n0\n1\n", "int\n1\n2\n1\n")).status(), StatusCode::IndexOutOfRange,
              {"c.vtk: ", "map names tet 2 for vertex 1"});
  expectError(loadText(with(text, "\n7\n7\n", "\n7\n-7\n")).status(), StatusCode::InvalidOption, {"latticeTets[1]"});
}

TEST(CageFiles, WhatLoadCageRefusesLoadTetMeshReads) {
  const TempFolder folder;
  for (const std::string bad : {"CELL_DATA 3\n", "CELL_DATA 2\nSCALARS fill double\n7 7\n", "POINT_DATA 5\nnonsense"}) {
    folder.write("c.vtk", kTwoTets + bad);
    EXPECT_FALSE(loadCage(folder.path("c.vtk")).ok()) << bad;
    EXPECT_TRUE(loadTetMesh(folder.path("c.vtk")).ok()) << bad;
  }
}

TEST(CageFiles, SurvivesFilesCutShortAnywhere) {
  const std::string text = textOf(smallCage());
  std::size_t read = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const Result<Cage> cage = loadText(text.substr(0, length));
    read += cage.ok();
    if (cage.ok()) {
      EXPECT_TRUE(cage.value().check().ok());
    } else {
      EXPECT_NE(cage.status().message.find("c.vtk"), std::string::npos);
    }
  }
  EXPECT_LT(read, 40u);  // where an array ends, or within its last number
}

TEST(CageFiles, SurvivesDamagedBytes) {
  const std::string text = textOf(smallCage());
  std::mt19937 random(8);
  std::size_t refused = 0;
  for (int i = 0; i < 500; ++i) {
    std::string damaged = text;
    const char plausible[] = "0123456789 -.e\n";
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = plausible[random() % (sizeof(plausible) - 1)];
    const Result<Cage> cage = loadText(damaged);
    refused += !cage.ok();
    EXPECT_EQ(cage.ok(), cage.status().message.empty());
    if (cage.ok()) {
      EXPECT_TRUE(cage.value().check().ok());
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_LT(refused, 500u);
}

TEST(CageFiles, AMeshThatIsNotTheCagesIsKnown) {
  const auto plates = platesOfCopies();
  const Cage cage = loadText(textOf(plates.cage)).value();
  EXPECT_TRUE(cage.checkMesh(plates.mesh).ok());
  TriangleMesh other = plates.mesh;
  std::swap(other.positions[3], other.positions[4]);
  expectError(cage.checkMesh(other), StatusCode::CageMismatch, {"in another order"});
}

/// Big-endian bytes of integers.
std::string big(std::initializer_list<std::uint32_t> values) {
  std::string bytes;
  for (const std::uint32_t value : values) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  }
  return bytes;
}

std::string binaryCage() {
  const std::uint32_t one = 0x3F800000, half = 0x3F000000;  // floats
  std::string bytes(kFineTets, '\xF0');
  return "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n" +
         big({0, 0, 0, one, 0, 0, 0, one, 0, 0, 0, one}) + "\nCELLS 2 9\n" + big({3, 0, 1, 2, 4, 0, 1, 2, 3}) +
         "\nCELL_TYPES 2\n" + big({5, 10}) + "\nFIELD FieldData 2\nmesh_hash 2 1 unsigned_int\n" +
         big({0xFFFFFFFF, 2}) + "\nvertex_tets 1 3 int\n" + big({0, 0, 0}) +
         "\nCELL_DATA 2\nSCALARS fill float\nLOOKUP_TABLE default\n" + big({one, half}) +
         "\nCOLOR_SCALARS c 2\nabcd\nLOOKUP_TABLE l 1\nabcd\nVECTORS v float\n" + big({0, 1, 2, 3, 4, 5}) +
         "\nSCALARS part int 1\n" + big({9, 1}) + "\nFIELD FieldData 1\nfine_fill 64 2 " + "unsigned_char\n" +
         std::string(kFineTets, 'x') + bytes +
         "\nMETADATA\nINFORMATION 0\n\nPOINT_DATA 4\nSCALARS mass float 1\nLOOKUP_TABLE default\n" +
         big({one, half, one, half}) + "\n";
}

TEST(CageFiles, ReadsBinaryData) {
  const Result<Cage> read = loadText(binaryCage());
  ASSERT_TRUE(read.ok()) << read.status().message;
  const Cage& cage = read.value();
  EXPECT_EQ(cage.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(cage.meshHash, 0xFFFFFFFF00000002u);
  EXPECT_EQ(cage.vertexTets, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(cage.fill, (std::vector<double>{0.5}));
  EXPECT_EQ(cage.parts, (std::vector<int>{1}));
  EXPECT_EQ(cage.fineFill, std::vector<std::uint8_t>(kFineTets, 0xF0));
  EXPECT_EQ(cage.masses, (std::vector<double>{1, 0.5, 1, 0.5}));
}

TEST(CageFiles, SurvivesBinaryDataCutShortAnywhere) {
  const std::string bytes = binaryCage();
  std::size_t read = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) read += loadText(bytes.substr(0, length)).ok();
  EXPECT_LT(read, 40u);
  expectError(loadText(with(bytes, "mass float", "mass bit")).status(), StatusCode::Malformed,
              {"'mass' of type 'bit'"});
  expectError(loadText(with(bytes, "VECTORS v float", "VECTORS v bit")).status(), StatusCode::UnsupportedFormat,
              {"'bit'", "save it as ASCII"});
}

}  // namespace
}  // namespace tetskin
