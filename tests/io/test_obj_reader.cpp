// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"

#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/mesh_readers.h>

#include <set>

namespace tetskin::test {
namespace {

using Triangle = std::array<int, 3>;

Result<TriangleMesh> loadObj(const std::string& text) {
  return loadMeshText("m.obj", text);
}

const char* const kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(LoadObj, KeepsVertexOrderAndUnusedVertices) {
  const Result<TriangleMesh> mesh = loadObj("v 9 9 9\nv 0 1 0\nv 0 0 0\nv 8 8 8\nv 1 0 0\nf 3 5 2\nv 7 7 7\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  const std::vector<Eigen::Vector3d> expected = {{9, 9, 9}, {0, 1, 0}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {7, 7, 7}};
  EXPECT_EQ(mesh.value().positions, expected);
  EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{2, 4, 1}}));
  EXPECT_TRUE(mesh.value().groups.empty());
}

TEST(LoadObj, ReadsTheLineEndsOfOldMacs) {
  for (const char* text :
       {"# a comment\rv 0 0 0\rv 1 0 0\r\rv 0 1 0\rf 1 \\\r2 3\r", "v 0 0 0\rv 1 0 0\rv 0 1 0\nf 1 2 3"}) {
    const Result<TriangleMesh> mesh = loadObj(text);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().positions, (std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}}));
  }
  expectError(loadObj("v 0 0 0\rv 1 0 0\rv 0 x 0\r"), kMalformed, {"m.obj:3:"});
  expectError(loadObj("v 0 0 0\r\r\nv 1 0 0\r\nv 0 x 0\r\n"), kMalformed, {"m.obj:3:"});
}

TEST(LoadObj, NamesTheLineOfACoordinateThatIsTooFar) {
  expectError(loadObj("v 0 0 0\nv 1 0 0\nv 0 1e31 0\nf 1 2 3\n"), kNonFinite,
              {"m.obj:3:", "vertex 2", "beyond 1e18", "Correct it"});
  EXPECT_TRUE(loadObj("v 0 0 0\nv 1e18 0 0\nv 0 -1e18 0\nf 1 2 3\n").ok());
}

TEST(LoadObj, ReadsPositionsExactlyInDouble) {
  const TriangleMesh mesh = loadObj("v 0.1 +1.0 -2.5e-3\nv 1234567.890123456 1E2 .5\nv 0 1 0\nf 1 2 3\n").value();
  ASSERT_EQ(mesh.vertexCount(), 3u);
  EXPECT_EQ(mesh.positions[0], Eigen::Vector3d(0.1, 1.0, -2.5e-3));
  EXPECT_EQ(mesh.positions[1], Eigen::Vector3d(1234567.890123456, 100, 0.5));
}

TEST(LoadObj, ReadsEveryFormOfCorner) {
  const std::string head = std::string(kThree) + "vt 0 0\nvn 0 0 1\n";
  for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f 1/ 2/1/ 3"}) {
    const Result<TriangleMesh> mesh = loadObj(head + face);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}})) << face;
  }
}

TEST(LoadObj, NegativeIndicesCountBackFromTheLastVertex) {
  const TriangleMesh mesh = loadObj(std::string(kThree) + "f -3 -2 -1\nv 5 5 5\nf -4 -2 -1\n").value();
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}}));
}

TEST(LoadObj, FacesMayNameVerticesDefinedLater) {
  const TriangleMesh mesh = loadObj(std::string("f 1 2 3\n") + kThree).value();
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}}));
}

TEST(LoadObj, AcceptsDosLineBreaksTabsAndBlanks) {
  const TriangleMesh mesh = loadObj("\r\n\tv\t0  0\t0\r\n  v 1 0 0 \r\nv 0 1 0\r\n f  1\t2 3 \r\n").value();
  EXPECT_EQ(mesh.vertexCount(), 3u);
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}}));
}

TEST(LoadObj, JoinsContinuedLines) {
  const TriangleMesh mesh = loadObj("v 0 \\\n0 0\nv \\\r\n1 0 0\nv 0 1\\\n 0\nf 1 2 \\\n  3").value();
  ASSERT_EQ(mesh.vertexCount(), 3u);
  EXPECT_EQ(mesh.positions[2], Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}}));
}

TEST(LoadObj, CountsTheLinesOfContinuedStatements) {
  const Result<TriangleMesh> mesh = loadObj("v 0 \\\n0 0\n# c\nv 1 0 x\n");
  expectError(mesh, kMalformed, {"m.obj:4:"});
}

TEST(LoadObj, ABackslashDoesNotContinueAComment) {
  const TriangleMesh mesh = loadObj("# C:\\models\\\nv 0 0 0 # origin\nv 1 0 0\nv 0 1 0\nf 1 2 3 # 4 5\n").value();
  EXPECT_EQ(mesh.vertexCount(), 3u);
  EXPECT_EQ(mesh.triangleCount(), 1u);
}

TEST(LoadObj, AcceptsAByteOrderMarkAndAnExtensionInCapitals) {
  const TempFolder folder;
  const TriangleMesh mesh = loadMesh(folder.write("M.OBJ", std::string("\xEF\xBB\xBF") + kThree + "f 1 2 3")).value();
  EXPECT_EQ(mesh.vertexCount(), 3u);
}

TEST(LoadObj, ReadsOverWeightsColoursLinesAndCurves) {
  const TriangleMesh mesh =
      loadObj("v 0 0 0 1\nv 1 0 0 0.5 0.25 1\nv 0 1 0\nl 1 2\np 3\nvp 0.5\ncurv 0 1 1 2\nf 1 2 3").value();
  EXPECT_EQ(mesh.positions[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.triangleCount(), 1u);
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

TEST(LoadObj, FansAConvexPolygonFromItsFirstCorner) {
  const TriangleMesh mesh = loadObj("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv 0 1 0\nf 1 2 3 4 5\n").value();
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(LoadObj, ConcaveQuadsAreNotFoldedWhereverTheyBegin) {
  const std::string points = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\n";  // the vertex numbered 3 is the reflex one
  for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
    const TriangleMesh mesh = loadObj(points + face).value();
    ASSERT_EQ(mesh.triangleCount(), 2u);
    EXPECT_DOUBLE_EQ(area(mesh), 4.0) << face;
  }
}

TEST(LoadObj, APolygonThatCrossesItselfNamesAllItsCorners) {
  std::mt19937 random(1);
  std::string text, face = "f";
  for (int v = 1; v <= 200; ++v) {
    text += "v " + std::to_string(random() % 1000) + " " + std::to_string(random() % 1000) + " 0\n";
    face += " " + std::to_string(v);
  }
  const Result<TriangleMesh> mesh = loadObj(text + face);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 198u);
  std::set<int> named;
  for (const Triangle& t : mesh.value().triangles) named.insert(t.begin(), t.end());
  EXPECT_EQ(named.size(), 200u);
}

TEST(LoadObj, ConcavePolygonsAreNotFolded) {
  const TriangleMesh mesh = loadObj("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 1 0\nv 0 1 0\nf 1 2 3 4 5\n").value();
  ASSERT_EQ(mesh.triangleCount(), 3u);
  EXPECT_DOUBLE_EQ(area(mesh), 5.5);
  // A comb, where no single corner sees everything.
  const TriangleMesh comb =
      loadObj(
          "v 0 0 0\nv 7 0 0\nv 7 0 3\nv 6 0 3\nv 6 0 1\nv 4 0 1\nv 4 0 3\nv 3 0 3\nv 3 0 1\nv 1 0 1\nv 1 0 3\nv 0 0 3\n"
          "f 4 5 6 7 8 9 10 11 12 1 2 3\n")
          .value();
  ASSERT_EQ(comb.triangleCount(), 10u);
  EXPECT_DOUBLE_EQ(area(comb), 13.0);
}

TEST(LoadObj, GroupsAreRunsOfOneNameAndMaterial) {
  const TriangleMesh mesh =
      loadObj(std::string(kThree) +
              "f 1 2 3\no Left wing \nusemtl skin\nf 1 2 3\nf 1 2 3 1\nusemtl claw\ng toe # comment\n"
              "usemtl skin\ng claws\nf 1 2 3\n")
          .value();
  ASSERT_EQ(mesh.groups.size(), 3u);
  EXPECT_EQ(mesh.groups[0].name, "");
  EXPECT_EQ(mesh.groups[0].triangleCount, 1u);
  EXPECT_EQ(mesh.groups[1].name, "Left wing");
  EXPECT_EQ(mesh.groups[1].material, "skin");
  EXPECT_EQ(mesh.groups[1].firstTriangle, 1u);
  EXPECT_EQ(mesh.groups[1].triangleCount, 3u);
  EXPECT_EQ(mesh.groups[2].name, "claws");
  EXPECT_EQ(mesh.groups[2].firstTriangle, 4u);
  EXPECT_EQ(mesh.groups[2].triangleCount, 1u);
}

TEST(LoadObj, TexcoordsAreGivenIfEveryVertexHasOneValue) {
  const std::string head = std::string(kThree) + "v 5 5 5\nvt 0 0\nvt 1 0\nvt 0 0.5\nvt 1 0\nvt 0.25 0.25\n";
  const TriangleMesh one = loadObj(head + "f 1/1 2/2 3/3\nf 1/1 2/4 3/3\n").value();
  const std::vector<Eigen::Vector2f> expected = {{0, 0}, {1, 0}, {0, 0.5f}, {0, 0}};
  EXPECT_EQ(one.texcoords, expected);
  const TriangleMesh seam = loadObj(head + "f 1/1 2/2 3/3\nf 1/1 2/5 3/3\n").value();
  EXPECT_EQ(seam.triangleCount(), 2u);
  EXPECT_TRUE(seam.texcoords.empty());
  const TriangleMesh partly = loadObj(head + "f 1/1 2/2 3/3\nf 1 2 3\n").value();
  EXPECT_EQ(partly.triangleCount(), 2u);
  EXPECT_TRUE(partly.texcoords.empty());
}

TEST(LoadObj, NormalsAreMadeUnitAndHardEdgesLeaveNone) {
  const std::string head = std::string(kThree) + "vn 0 0 2\nvn 0 3 4\nvn nan 0 0\n";
  const TriangleMesh mesh = loadObj(head + "f 1//1 2//2 3//3\n").value();
  const std::vector<Eigen::Vector3f> expected = {{0, 0, 1}, {0, 0.6f, 0.8f}, {0, 0, 0}};
  EXPECT_EQ(mesh.normals, expected);
  EXPECT_TRUE(mesh.texcoords.empty());
  EXPECT_TRUE(loadObj(head + "f 1//1 2//2 3//3\nf 1//2 2//2 3//3\n").value().normals.empty());
}

TEST(LoadObj, NamesAMissingFileAndAFolder) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.obj")), kFileNotFound, {folder.path("none.obj"), "check"});
  std::filesystem::create_directory(folder.path("dir.obj"));
  expectError(loadMesh(folder.path("dir.obj")), kFileNotFound, {folder.path("dir.obj"), "folder"});
}

TEST(LoadObj, NamesTheLineOfAnIndexOutOfRange) {
  const std::string three = kThree;
  expectError(loadObj(three + "f 1 2 4\n"), kIndexOutOfRange, {"m.obj:4:", "number 4 of the vertices", "has 3"});
  expectError(loadObj(three + "\nf 1 2 0\n"), kIndexOutOfRange, {"m.obj:5:", "counts from 1"});
  expectError(loadObj(three + "f 1 2 -4\n"), kIndexOutOfRange, {"m.obj:4:", "vertex -4"});
  expectError(loadObj(three + "f 1 2 99999999999\n"), kIndexOutOfRange, {"m.obj:4:", "99999999999"});
}

TEST(LoadObj, FacesThatNameWhatTheFileLacksAreReadWithoutIt) {
  const std::string three = kThree;
  for (const char* face :
       {"f 1/1 2/1 3/1\n", "f 1/-1 2/-1 3/-1\n", "f 1/0 2/0 3/0\n", "f 1//1 2//2 3//99999999999\n"}) {
    const TempFolder folder;
    MeshFileReport report;
    const Result<TriangleMesh> mesh = loadMesh(folder.write("m.obj", three + face + face), &report);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message;
    EXPECT_EQ(mesh.value().triangleCount(), 2u);
    EXPECT_TRUE(mesh.value().texcoords.empty());
    EXPECT_EQ(report.incompleteFaces.count, 2u);
    EXPECT_EQ(report.incompleteFaces.firstLine, 4u);
    EXPECT_EQ(report.describe(),
              "2 faces read without texture coordinates or normals that do not exist (first in line 4)");
  }
  // Vertices defined later exist.
  MeshFileReport report;
  const TempFolder folder;
  const Result<TriangleMesh> mesh = loadMesh(folder.write("m.obj", three + "f 1//1 2//1 3//1\nvn 0 0 1\n"), &report);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().normals.size(), 3u);
  EXPECT_EQ(report.describe(), "");
}

TEST(LoadObj, FacesOfFewerThanThreeCornersAreLeftOut) {
  const TempFolder folder;
  MeshFileReport report;
  const std::string text = std::string(kThree) + "g a\nf 1 2\nf 1 2 3\nf\nf 3\nf 3/1 2 1\n";
  const Result<TriangleMesh> mesh = loadMesh(folder.write("m.obj", text), &report);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}, {2, 1, 0}}));
  ASSERT_EQ(mesh.value().groups.size(), 1u);
  EXPECT_EQ(mesh.value().groups[0].triangleCount, 2u);
  EXPECT_EQ(report.describe(),
            "3 faces of fewer than 3 corners left out (first in line 5), 1 face read without texture coordinates or "
            "normals that do not exist (first in line 9)");
  expectError(loadObj(std::string(kThree) + "f 1 2\n"), StatusCode::Empty, {"m.obj: ", "no faces"});
}

TEST(LoadObj, NamesTheLineOfMalformedText) {
  const std::string three = kThree;
  expectError(loadObj(three + "v 1 2,5 3\n"), kMalformed, {"m.obj:4:", "'2,5' is not a number"});
  expectError(loadObj(three + "v 1 2\nf 1 2 3\n"), kMalformed, {"m.obj:4:", "needs 3 numbers and has 2"});
  expectError(loadObj(three + "vn 1 2\nf 1 2 3\n"), kMalformed, {"m.obj:4:", "'vn' needs 3"});
  expectError(loadObj(three + "vt\nf 1 2 3\n"), kMalformed, {"m.obj:4:", "'vt' needs 1"});
  expectError(loadObj(three + "f 1/x 2 3\n"), kMalformed, {"m.obj:4:", "'x'", "texture coordinate"});
  expectError(loadObj(three + "f 1 2 3x\n"), kMalformed, {"m.obj:4:", "'3x'"});
  expectError(loadObj(three + "vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n"), kMalformed, {"m.obj:6:", "'1/1/1/1'"});
}

TEST(LoadObj, NamesTheLineOfACoordinateThatIsNotFinite) {
  expectError(loadObj("v 0 0 0\nv 1 nan 0\n"), kNonFinite, {"m.obj:2:", "vertex 1"});
  expectError(loadObj("v 0 0 -inf\n"), kNonFinite, {"m.obj:1:", "vertex 0"});
  expectError(loadObj("v 0 0 1e999\n"), kNonFinite, {"m.obj:1:", "vertex 0"});
}

TEST(LoadObj, RefusesFilesWithoutVerticesOrFaces) {
  expectError(loadObj(""), StatusCode::Empty, {"m.obj: ", "no vertices"});
  expectError(loadObj("# nothing\nvt 0 0\n"), StatusCode::Empty, {"m.obj: ", "no vertices"});
  expectError(loadObj(std::string(kThree) + "l 1 2\n"), StatusCode::Empty, {"m.obj: ", "no faces"});
}

TEST(LoadObj, RefusesBinaryFiles) {
  expectError(loadObj(std::string("v 0 0 0\n\0\1", 10)), kMalformed, {"m.obj: ", "is binary"});
}

}  // namespace
}  // namespace tetskin::test
