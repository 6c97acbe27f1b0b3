// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/two_plates.h"

#include "cage_texts.h"

#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <limits>

namespace tetskin::test {
namespace {

void expectSame(const Cage& a, const Cage& b) {
  EXPECT_EQ(a.mesh.nodes, b.mesh.nodes);
  EXPECT_EQ(a.mesh.tets, b.mesh.tets);
  EXPECT_EQ(a.vertexTets, b.vertexTets);
  EXPECT_EQ(a.volumeFraction, b.volumeFraction);
  EXPECT_EQ(a.stiffnessFactor, b.stiffnessFactor);
  EXPECT_EQ(a.paintedStiffness, b.paintedStiffness);
  EXPECT_EQ(a.paintedDensity, b.paintedDensity);
  EXPECT_EQ(a.paintedDamping, b.paintedDamping);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(a.component, b.component);
  EXPECT_EQ(a.sourceTet, b.sourceTet);
  EXPECT_EQ(a.quadraticTet, b.quadraticTet);
  EXPECT_EQ(a.fineVolumeFraction, b.fineVolumeFraction);
  EXPECT_EQ(a.meshHash, b.meshHash);
}

void expectCageReadsBack(const Cage& cage) {
  const TempFolder folder;
  const Status saved = saveCage(cage, folder.path("c.vtk"));
  ASSERT_TRUE(saved.ok()) << saved.message;
  const Result<Cage> loaded = loadCage(folder.path("c.vtk"));
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  expectSame(loaded.value(), cage);
  const Result<TetMesh> bare = loadTetMesh(folder.path("c.vtk"));
  ASSERT_TRUE(bare.ok()) << bare.status().message;
  EXPECT_EQ(bare.value().nodes, cage.mesh.nodes);
  EXPECT_EQ(bare.value().tets, cage.mesh.tets);
}

/// Ways to remove some of a cage's data.
const std::vector<std::function<void(Cage&)>>& forgetOne() {
  static const std::vector<std::function<void(Cage&)>> directions = {
      [](Cage& cage) { cage.vertexTets.clear(); },         [](Cage& cage) { cage.volumeFraction.clear(); },
      [](Cage& cage) { cage.stiffnessFactor.clear(); },    [](Cage& cage) { cage.masses.clear(); },
      [](Cage& cage) { cage.component.clear(); },          [](Cage& cage) { cage.sourceTet.clear(); },
      [](Cage& cage) { cage.fineVolumeFraction.clear(); }, [](Cage& cage) { cage.meshHash.reset(); }};
  return directions;
}

TEST(CageFiles, AllThatIsKnownReadsBackExactly) {
  expectCageReadsBack(platesOfCopies().cage);
  expectCageReadsBack(platesOfCopies(1.0).cage);
  expectCageReadsBack(smallCage());
}

TEST(CageFiles, PaintedMapsReadBackExactly) {
  Cage cage = platesOfCopies().cage;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    cage.paintedStiffness.push_back(0.1 + static_cast<double>(t) / 3.0);
    cage.paintedDensity.push_back(1.0 / static_cast<double>(t + 7));
    cage.paintedDamping.push_back(static_cast<double>(t) / 7.0);
  }
  expectCageReadsBack(cage);
  Cage bare(cage.mesh);  // the only data of its cells
  bare.paintedDensity = cage.paintedDensity;
  expectCageReadsBack(bare);
  bare.paintedDensity.clear();
  bare.paintedDamping = cage.paintedDamping;
  expectCageReadsBack(bare);
}

TEST(CageFiles, WhatIsNotKnownIsLeftOut) {
  for (const auto& forget : forgetOne()) {
    Cage cage = smallCage(), nothingElse(TetMesh{cage.mesh.nodes, cage.mesh.tets});
    forget(cage);
    expectCageReadsBack(cage);
    for (const auto& other : forgetOne()) {
      if (&other != &forget) other(cage);
    }
    expectCageReadsBack(cage);
    expectSame(cage, nothingElse);
  }
}

TEST(CageFiles, EachArrayAlone) {
  for (std::size_t kept = 0; kept < forgetOne().size(); ++kept) {
    Cage cage = smallCage();
    for (std::size_t k = 0; k < forgetOne().size(); ++k) {
      if (k != kept) forgetOne()[k](cage);
    }
    expectCageReadsBack(cage);
  }
}

TEST(CageFiles, ExtremeNumbersReadBackExactly) {
  Cage cage = smallCage();
  cage.volumeFraction = {5e-324, 1.0 / 3.0};
  cage.stiffnessFactor = {std::numeric_limits<double>::max(), std::numeric_limits<double>::min()};
  cage.masses = {1e-300, 0.1, 1e300, 2.0 / 3.0, 5e-324};
  cage.component = {0, std::numeric_limits<int>::max()};
  for (const std::uint64_t hash : {std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 32}) {
    cage.meshHash = hash;
    expectCageReadsBack(cage);
  }
}

/// Eight tets of a quadratic tet, and one more.
Cage mixedCage() {
  Cage cage = refineQuadratic(singleTet()).value();
  cage.mesh.nodes.emplace_back(0, -1, 0);
  cage.mesh.tets.push_back({0, cage.mesh.tets[0][1], cage.mesh.tets[0][3], 10});
  cage.quadraticTet.push_back(-1);
  return cage;
}

TEST(CageFiles, QuadraticTetsReadBackExactlyAndAreTetsToOthers) {
  expectCageReadsBack(mixedCage());
  Cage cage = refineQuadratic(jittered(bodyCentredCage(2, 2, 2), 0.2, 3)).value();
  expectCageReadsBack(cage);
  cage.fineVolumeFraction.assign(kFineTets * cage.mesh.tetCount(), 200);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.75);
  expectCageReadsBack(cage);
  const std::string text = textOf(mixedCage());
  EXPECT_NE(text.find("CELL_DATA 9\nSCALARS quadratic_tet int 1\nLOOKUP_TABLE default\n0\n0\n0\n0\n0\n0\n0\n0\n-1\n"),
            std::string::npos)
      << text;
  const TempFolder folder;
  for (const char* name : {"c.ele", "c.node"}) {
    ASSERT_TRUE(saveCage(cage, folder.path(name)).ok());
    const Cage read = loadCage(folder.path(name)).value();
    EXPECT_EQ(read.mesh.tets, cage.mesh.tets);
    EXPECT_TRUE(read.quadraticTet.empty());
  }
}

TEST(CageFiles, ABareCageMakesTheFileOfItsTets) {
  const TempFolder folder;
  const Cage cage(latticeCage(2, 1, 1));
  for (const char* name : {"c.vtk", "c.ele"}) {
    ASSERT_TRUE(saveCage(cage, folder.path(name)).ok());
    const std::string text = TempFolder::read(folder.path(name));
    ASSERT_TRUE(saveTetMesh(cage.mesh, folder.path(name)).ok());
    EXPECT_EQ(TempFolder::read(folder.path(name)), text);
  }
}

TEST(CageFiles, ArraysStandBehindTheMesh) {
  Cage cage = smallCage();
  cage.fineVolumeFraction.clear();
  const TempFolder folder;
  ASSERT_TRUE(saveTetMesh(cage.mesh, folder.path("c.vtk")).ok());
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
  cage.sourceTet = {7, 8};  // no duplicates: the map can be computed again
  for (const char* name : {"c.ele", "c.node"}) {
    ASSERT_TRUE(saveCage(cage, folder.path(name)).ok());
    const Result<Cage> loaded = loadCage(folder.path(name));
    ASSERT_TRUE(loaded.ok()) << loaded.status().message;
    expectSame(loaded.value(), Cage(TetMesh{cage.mesh.nodes, cage.mesh.tets}));
  }
}

TEST(CageFiles, OnlyVtkKeepsTheMapOfCopies) {
  const TempFolder folder;
  const Cage cage = platesOfCopies().cage;
  for (const char* name : {"c.ele", "c.node"}) {
    expectError(saveCage(cage, folder.path(name)), kUnsupportedFormat,
                {folder.path(name), "which duplicate of a tet carries which vertex", "use .vtk"});
  }
  expectError(saveCage(cage, folder.path("c.xyz")), kUnsupportedFormat, {"use .vtk, .node or .ele"});
  EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(CageFiles, ReadsOverDataOfEveryOtherKind) {
  const Result<Cage> cage = loadCageText(
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
  EXPECT_EQ(cage.value().volumeFraction, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(cage.value().stiffnessFactor, (std::vector<double>{3, 0.5}));
  EXPECT_EQ(cage.value().masses, (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(CageFiles, ReadsFieldsInFrontOfThePointsAsVtkWritesThem) {
  const std::string field = "FIELD FieldData 2\nmesh_hash 2 1 unsigned_int\n0 9\nvertex_tets 1 3 vtktypeint64\n0 1 1\n";
  const Result<Cage> cage = loadCageText(with(kTwoTets, "POINTS", field + "POINTS"));
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  EXPECT_EQ(cage.value().vertexTets, (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(cage.value().meshHash, 9u);
}

TEST(CageFiles, ValuesOfCellsThatAreNoTetsAreDropped) {
  TetFileReport report;
  const Result<Cage> cage = loadCageText(
      "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "0.1 1 1\nCELLS 4 17\n3 0 1 2\n4 0 1 2 3\n2 0 1\n4 1 2 3 4\nCELL_TYPES 4\n5\n10\n3\n10\nFIELD F 1\n"
      "vertex_tets 1 2 int\n0 1\nCELL_DATA 4\nSCALARS fill float\nLOOKUP_TABLE default\n7 0.25 7 0.75\n"
      "SCALARS lattice_tet int\n-1 5 -1 6\nSCALARS part int\n9 0 9 1\n",
      &report);
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  EXPECT_EQ(report.skippedCells, 2u);
  EXPECT_EQ(cage.value().mesh.tetCount(), 2u);
  EXPECT_EQ(cage.value().vertexTets, (std::vector<int>{0, 1}));
  EXPECT_EQ(cage.value().volumeFraction, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(cage.value().sourceTet, (std::vector<int>{5, 6}));
  EXPECT_EQ(cage.value().component, (std::vector<int>{0, 1}));
}

TEST(CageFiles, AMeshThatIsNotTheCagesIsKnown) {
  const auto plates = platesOfCopies();
  const Cage cage = loadCageText(textOf(plates.cage)).value();
  EXPECT_TRUE(cage.checkMesh(plates.mesh).ok());
  TriangleMesh other = plates.mesh;
  std::swap(other.positions[3], other.positions[4]);
  expectError(cage.checkMesh(other), StatusCode::CageMismatch, {"another order"});
}

}  // namespace
}  // namespace tetskin::test
