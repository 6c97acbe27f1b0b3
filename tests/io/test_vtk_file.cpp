// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "raw_bytes.h"

#include <tetskin/io/files.h>

#include <cstdint>
#include <limits>
#include <numeric>

namespace tetskin::test {
namespace {

Result<TetMesh> loadVtk(const std::string& text, TetFileReport* report = nullptr) {
  return loadTetMeshText("c.vtk", text, report);
}

const std::string kVtkHead = "# vtk DataFile Version 2.0\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kPoints = "POINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.1 1 1e0\n";
const std::string kCells = "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\n";
const std::string kTypes = "CELL_TYPES 2\n10\n10\n";

TEST(LoadVtk, ReadsCountedCells) {
  expectTwoTets(loadVtk(kVtkHead + kPoints + kCells + kTypes));
}

TEST(LoadVtk, LineBreaksMeanNothing) {
  expectTwoTets(
      loadVtk("# vtk DataFile Version 3.0\r\n\r\nascii\r\nDATASET unstructured_grid\r\npoints 5 float 0 0 0 1 0 0\r\n"
              "0 1\t0 0 0\r\n1 0.1 1 1\r\n\r\nCells 2 10 4 0 1 2 3 4 1 2 3 4\r\ncell_types 2\r\n10 10"));
}

TEST(LoadVtk, ReadsOffsetsAndConnectivity) {
  const std::string head = "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  expectTwoTets(loadVtk(head + kPoints +
                        "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n"
                        "CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 2 3 4\n" +
                        kTypes));
}

TEST(LoadVtk, WithoutCellTypesAllCellsAreTets) {
  expectTwoTets(loadVtk(kVtkHead + kPoints + kCells));
  const std::string wedge = "CELLS 2 12\n4 0 1 2 3\n6 0 1 2 3 4 0\n";
  expectError(loadVtk(kVtkHead + kPoints + wedge), kMalformed, {"c.vtk:13:", "cell 1", "6 nodes"});
}

// The following tests have files in the form that Bullet's btSoftBodyHelpers::CreateFromVtkFile reads, and that Bullet
// ships.

TEST(LoadVtk, TheMarkNeedsNoBlank) {
  const std::string rest = kVtkHead.substr(kVtkHead.find("vtk"));
  for (const char* mark : {"#", "#  ", "#\t"}) expectTwoTets(loadVtk(mark + rest + kPoints + kCells + kTypes));
  expectError(loadVtk("#vtkDataFile Version 2.0\n"), kMalformed, {"c.vtk:1:"});
  expectError(loadVtk("## vtk DataFile Version 2.0\n"), kMalformed, {"c.vtk:1:"});
}

TEST(LoadVtk, TheStatedSizeOfCellsOfTextMeansNothing) {
  for (const char* size : {"1", "2", "8", "2000000000"}) {
    expectTwoTets(loadVtk(kVtkHead + kPoints + "CELLS 2 " + size + "\n4 0 1 2 3\n4 1 2 3 4\n\n" + kTypes));
  }
}

TEST(LoadVtk, ALoneTypeOfTetsStandsForAllCells) {
  expectTwoTets(loadVtk(kVtkHead + kPoints + kCells + "CELL_TYPES 10\n"));
  expectError(loadVtk(kVtkHead + kPoints + kCells + "CELL_TYPES 12\n"), kMalformed, {"too short"});
  expectError(loadVtk(kVtkHead + kPoints + kCells + "CELL_TYPES 10\n10\n"), kMalformed, {"c.vtk:14:"});
  const std::string wedge = "CELLS 1 7\n6 0 1 2 3 4 0\n";
  expectError(loadVtk(kVtkHead + kPoints + wedge + "CELL_TYPES 10\n"), kMalformed, {"6 nodes"});
}

TEST(LoadVtk, SkipsAndCountsWhatIsNoTet) {
  TetFileReport report;
  expectTwoTets(
      loadVtk(kVtkHead + kPoints + "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 3\n5\n10\n10\n", &report));
  EXPECT_EQ(report.skippedCells, 1u);
  EXPECT_EQ(report.quadraticTets, 0u);
  EXPECT_EQ(report.describe(), "1 cells that are not tets were skipped");
}

/// A tet and the middles of its edges, between them, and a node that no cell names.
const std::string kQuadraticPoints =
    "POINTS 11 float\n0 0 0 .5 0 0 1 0 0 .5 .5 0 0 1 0 0 .5 0 0 0 .5 .5 0 .5 0 .5 .5 0 0 1 7 7 7\n";
const std::string kQuadraticCell = "CELLS 1 11\n10 0 2 4 9 1 3 5 6 7 8\nCELL_TYPES 1\n";

TEST(LoadVtk, TetsOfSecondOrderAreEightTets) {
  for (const char* type : {"24", "71", "79"}) {
    TetFileReport report;
    const std::string text = kVtkHead + kQuadraticPoints + kQuadraticCell + type + "\n";
    const Result<Cage> cage = loadCageText("c.vtk", text, &report);
    expectQuadraticTet(cage, {0, 2, 4, 9}, {1, 5, 6, 3, 7, 8});
    ASSERT_EQ(cage.value().mesh.nodeCount(), 11u) << "in the order of the file";
    EXPECT_EQ(cage.value().mesh.nodes[3], Eigen::Vector3d(0.5, 0.5, 0));
    EXPECT_EQ(report.quadraticTets, 1u);
    EXPECT_EQ(report.movedNodes, 0u);
    EXPECT_EQ(report.describe(), "1 tets of second order became quadratic tets, each of eight tets");
    const Result<TetMesh> mesh = loadVtk(text);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().tets, cage.value().mesh.tets);
  }
}

TEST(LoadVtk, TetsOfAnyOrderMayBeOfTheFirst) {
  for (const char* type : {"71", "79"}) {
    TetFileReport report;
    const std::string cell = std::string("CELLS 1 5\n4 0 2 4 9\nCELL_TYPES 1\n") + type + "\n";
    const Result<Cage> cage = loadCageText("c.vtk", kVtkHead + kQuadraticPoints + cell, &report);
    ASSERT_TRUE(cage.ok()) << cage.status().message;
    EXPECT_EQ(cage.value().mesh.tetCount(), 1u);
    EXPECT_EQ(report.quadraticTets, 0u);
  }
}

TEST(LoadVtk, NamesTheCellOfSecondOrderThatIsFaulty) {
  const auto load = [](const std::string& cells) { return loadVtk(kVtkHead + kQuadraticPoints + cells); };
  expectError(load("CELLS 1 10\n9 0 2 4 9 1 3 5 6 7\nCELL_TYPES 1\n24\n"), kMalformed,
              {"c.vtk:8:", "cell 0 has 9 nodes where a tet of second order has 10"});
  expectError(load("CELLS 1 5\n4 0 2 4 9\nCELL_TYPES 1\n24\n"), kMalformed, {"cell 0 has 4 nodes"});
  expectError(load("CELLS 1 12\n11 0 2 4 9 1 3 5 6 7 8 10\nCELL_TYPES 1\n24\n"), kMalformed, {"11 nodes"});
  expectError(load("CELLS 1 8\n7 0 2 4 9 1 3 5\nCELL_TYPES 1\n71\n"), kMalformed,
              {"7 nodes where a tet of second order has 10"});
  expectError(load("CELLS 1 12\n11 0 2 4 9 1 3 5 6 7 8 10\nCELL_TYPES 1\n71\n"), kUnsupportedFormat,
              {"c.vtk:8:", "cell 0 is a tet above second order", "save the mesh"});
  expectError(load("CELLS 1 11\n10 0 2 4 9 1 3 5 6 7 11\nCELL_TYPES 1\n24\n"), kIndexOutOfRange,
              {"c.vtk:8:", "cell 0 refers to node 11"});
  expectError(load("CELLS 1 11\n10 0 2 4 9 1 3 5 6 7 1\nCELL_TYPES 1\n24\n"), kMalformed,
              {"c.vtk:8:", "tet 0", "names a node twice"});
}

TEST(LoadVtk, ExpandsTheDataOfTetsOfSecondOrder) {
  const Result<Cage> cage = loadCageText(
      "c.vtk",
      kVtkHead + "POINTS 14" + kQuadraticPoints.substr(9) +
          "8 7 7 7 8 7 7 7 8\n"
          "CELLS 3 21\n4 10 11 12 13\n3 0 2 4\n10 0 2 4 9 1 3 5 6 7 8\nCELL_TYPES 3\n10\n5\n24\nCELL_DATA 3\n"
          "SCALARS fill float\nLOOKUP_TABLE default\n.25 9 .5\nSCALARS part int\nLOOKUP_TABLE default\n"
          "0 0 1\nPOINT_DATA 14\nSCALARS mass float\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8 9 10 11 12 13 14\n");
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  std::vector<double> fill(1, 0.25), masses(14);
  std::iota(masses.begin(), masses.end(), 1.0);
  std::vector<int> component(1, 0), numbers(1, -1);
  fill.resize(9, 0.5);
  component.resize(9, 1);
  numbers.resize(9, 0);
  EXPECT_EQ(cage.value().volumeFraction, fill);
  EXPECT_EQ(cage.value().component, component);
  EXPECT_EQ(cage.value().quadraticTet, numbers);
  EXPECT_EQ(cage.value().masses, masses);
}

TEST(LoadVtk, ReadsOverFieldsAndData) {
  expectTwoTets(loadVtk(
      kVtkHead + "FIELD FieldData 3\nTIME 1 1 double\n0.5\nNAMES 1 2 string\nPOINTS\n\nEMPTY 0 0 int\n" + kPoints +
      kCells + kTypes + "CELL_DATA 2\nSCALARS m int 1\nLOOKUP_TABLE default\n1 2\nPOINT_DATA 5\nnonsense"));
}

std::string binaryTwoTets() {
  return "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nTIME 1 1 double\n" +
         big(0.5) + "\nPOINTS 5 double\n" + bigAll<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.1, 1, 1}) +
         "\nCELLS 3 14\n" + bigAll<std::int32_t>({4, 0, 1, 2, 3, 3, 0, 1, 2, 4, 1, 2, 3, 4}) + "\nCELL_TYPES 3\n" +
         bigAll<std::int32_t>({10, 5, 10}) + "\nPOINT_DATA 5\n";
}

TEST(LoadVtk, ReadsBinaryCountedCells) {
  TetFileReport report;
  expectTwoTets(loadVtk(binaryTwoTets(), &report));
  EXPECT_EQ(report.skippedCells, 1u);
}

TEST(LoadVtk, ReadsBinaryOffsetsAndFloats) {
  const Result<TetMesh> mesh =
      loadVtk("# vtk DataFile Version 5.1\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n" +
              bigAll<float>({0, 0, 0, 0.1, 0, 0, 0, 1, 0, 0, 0, 1}) +
              "\nMETADATA\nINFORMATION 0\n\nCELLS 2 4\nOFFSETS vtktypeint64\n" + bigAll<std::int64_t>({0, 4}) +
              "\nCONNECTIVITY vtktypeint64\n" + bigAll<std::int64_t>({3, 1, 2, 0}) + "\nCELL_TYPES 1\n" +
              bigAll<std::int32_t>({10}) + "\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().nodes[1], Eigen::Vector3d(0.1f, 0, 0));
  EXPECT_EQ(mesh.value().tets, std::vector<Tet>({{3, 1, 2, 0}}));
}

TEST(LoadVtk, RefusesBinaryFilesThatAreDamaged) {
  const std::string text = binaryTwoTets();
  expectError(loadVtk(text.substr(0, text.find("CELLS") - 8)), kMalformed, {"c.vtk:", "too short"});
  std::string nan = text;
  nan.replace(nan.find("POINTS 5 double\n") + 16 + 24, 8, big(std::numeric_limits<double>::quiet_NaN()));
  expectError(loadVtk(nan), kNonFinite, {"c.vtk: ", "node 1"});
  std::string index = text;
  index.replace(index.find("CELLS 3 14\n") + 11 + 4, 4, big(std::int32_t(-2)));
  expectError(loadVtk(index), kIndexOutOfRange, {"c.vtk: ", "cell 0", "node -2"});
  std::string type = text;
  type.replace(type.find("POINTS 5 double") + 9, 6, "string");
  expectError(loadVtk(type), kUnsupportedFormat, {"c.vtk:", "'string'", "save it as ASCII"});
}

TEST(LoadVtk, RefusesOtherKindsOfFiles) {
  expectError(loadVtk("solid x\n"), kMalformed, {"c.vtk:1:", "legacy VTK"});
  expectError(loadVtk(""), kMalformed, {"c.vtk:1:"});
  expectError(loadVtk("<?xml version=\"1.0\"?>\n"), kUnsupportedFormat, {"c.vtk:", "XML"});
  expectError(loadVtk("# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\n"), kUnsupportedFormat,
              {"c.vtk:4:", "'polydata'", "UNSTRUCTURED_GRID"});
  expectError(loadVtk("# vtk DataFile Version 2.0\nt\nBASE64\n"), kMalformed, {"c.vtk:3:", "'base64'"});
}

TEST(LoadVtk, NamesTheLineOfAnIndexOutOfRange) {
  expectError(loadVtk(kVtkHead + kPoints + "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 5\n" + kTypes), kIndexOutOfRange,
              {"c.vtk:13:", "cell 1", "node 5", "there are 5"});
  expectError(
      loadVtk(kVtkHead + kPoints + "CELLS 2 4\nOFFSETS int\n0 4\nCONNECTIVITY int\n0 1\n-1 3\nCELL_TYPES 1\n10"),
      kIndexOutOfRange, {"c.vtk:16:", "cell 0", "node -1"});
}

TEST(LoadVtk, RefusesBinaryCellsThatBelieTheirSize) {
  const std::string text = binaryTwoTets();
  std::string longer = text;
  longer.replace(text.find("CELLS 3 14\n") + 11, 4, big(std::int32_t(9)));
  expectError(loadVtk(longer), kMalformed, {"c.vtk: ", "cell 2 of 3", "counts"});
  std::string fewer = text;
  fewer.replace(text.find("CELLS 3"), 7, "CELLS 2");
  expectError(loadVtk(fewer), kMalformed, {"c.vtk:", "after the last of its 2 cells"});
}

TEST(LoadVtk, NamesTheLineOfACoordinateThatIsNotFinite) {
  expectError(loadVtk(kVtkHead + "POINTS 2 float\n0 0 0\n0 nan 0\n"), kNonFinite, {"c.vtk:7:", "node 1"});
  expectError(loadVtk(kVtkHead + "POINTS 2 float\n0 0 0\n0 -1e19 0\n"), kNonFinite,
              {"c.vtk:7:", "node 1", "beyond 1e18", "Correct it"});
  std::string far = binaryTwoTets();
  far.replace(far.find("POINTS 5 double\n") + 16 + 24, 8, big(1e19));
  expectError(loadVtk(far), kNonFinite, {"c.vtk: ", "node 1", "beyond 1e18"});
}

TEST(LoadVtk, ReadsTheLineEndsOfOldMacs) {
  std::string text = kVtkHead + "METADATA\n\n" + kPoints + kCells + kTypes;
  std::replace(text.begin(), text.end(), '\n', '\r');
  expectTwoTets(loadVtk(text));
}

TEST(LoadVtk, KeepsCarriageReturnsInBinaryData) {
  std::string text = binaryTwoTets();
  text.replace(text.find("POINTS 5 double\n") + 16, 8, big(-0.0).replace(7, 1, "\r"));
  const Result<TetMesh> mesh = loadVtk(text);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().nodes[0].x(), -13 * 4.9406564584124654e-324);
}

TEST(LoadVtk, RefusesCountsThatDoNotFit) {
  expectError(loadVtk(kVtkHead + "POINTS 2000000000 float\n0 0 0\n"), kMalformed, {"c.vtk:5:", "too short"});
  expectError(loadVtk(kVtkHead + "POINTS 99999999999999999999 float\n"), kMalformed, {"c.vtk:5:"});
  expectError(loadVtk(kVtkHead + "POINTS 18446744073709551615 float\n"), kMalformed, {"c.vtk:5:"});
  expectError(loadVtk(kVtkHead + "POINTS 4 float\n0 0 0 1\n0 0 0 1 0 x 0 1\n"), kMalformed, {"c.vtk:7:", "number"});
  expectError(loadVtk(kVtkHead + kPoints + "CELLS 9 10\n4 0 1 2 3\n4 1 2 3 4\n" + kTypes), kMalformed,
              {"c.vtk:14:", "cell 2 of 9", "counts"});
  expectError(loadVtk(kVtkHead + kPoints + "CELLS 2 10\n4 0 1 2 3\n5 1 2 3 4\n" + kTypes), kMalformed,
              {"c.vtk:13:", "cell 1"});
  expectError(loadVtk(kVtkHead + kPoints + "CELLS 1 10\n4 0 1 2 3\n4 1 2 3 4\n"), kMalformed,
              {"c.vtk:13:", "'4'", "section"});
  expectError(loadVtk(kVtkHead + kPoints + kCells + "CELL_TYPES 1\n10\n"), kMalformed, {"1 cell types for 2 cells"});
  expectError(loadVtk(kVtkHead + "POINTS 1 float\n0 0 0\n1 1 1\n"), kMalformed, {"c.vtk:7:", "'1'", "section"});
  expectError(loadVtk(kVtkHead + kPoints), kMalformed, {"ends before CELLS"});
  expectError(loadVtk(kVtkHead + kPoints + "CELLS 3 8\nOFFSETS int\n0 4 9\nCONNECTIVITY int\n0 1 2 3 1 2 3 4\n"),
              kMalformed, {"cell 1", "offsets"});
}

TEST(LoadVtk, RefusesAMeshWithoutTets) {
  TetFileReport report;
  const Result<TetMesh> mesh = loadVtk(kVtkHead + kPoints + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n", &report);
  expectError(mesh, StatusCode::Empty, {"c.vtk: ", "no tets", "1 cells"});
  EXPECT_EQ(report.skippedCells, 1u);
}

}  // namespace
}  // namespace tetskin::test
