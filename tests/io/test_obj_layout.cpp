// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "temp_folder.h"

#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <filesystem>

namespace tetskin::test {
namespace {

std::string formatted(const ObjLayout& layout, const std::vector<Eigen::Vector3f>& positions) {
  std::vector<char> buffer;
  return std::string(layout.format(viewOf(positions), buffer));
}

const std::vector<Eigen::Vector3f> kMoved = {{1, 2, 3}, {0.5f, -0.25f, 1e-7f}, {4, 5, 6}};

/// A text rewritten with kMoved as its positions.
std::string rewritten(const std::string& text) {
  const TempFolder folder;
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", text));
  EXPECT_TRUE(layout.ok()) << layout.status().message;
  if (!layout.ok() || layout.value().vertexCount() != kMoved.size()) return {};
  return formatted(layout.value(), kMoved);
}

TEST(ObjLayout, ReplacesPositionsAndDropsNormalsOnly) {
  EXPECT_EQ(
      rewritten(
          "# made by hand\nmtllib none.mtl\no Body\nv 0 0 0\n v 1 0 0\nvt 0 0\nvn 0 0 1\nv\t0 1 0\n\n"
          "g wing left\nusemtl skin\ns 1\nf 1/1/1 2/1/1  3/1/1 # 4/5/6\nf 1//1 2//1 3//1\nf 1 2 3\nf 1/1 2/1 3/1\n"
          "l 1/1 2/1\np 1\nunknown 1/2/3\n"),
      "# made by hand\nmtllib none.mtl\no Body\nv 1 2 3\n v 0.5 -0.25 1e-07\nvt 0 0\nv\t4 5 6\n\n"
      "g wing left\nusemtl skin\ns 1\nf 1/1 2/1  3/1 # 4/5/6\nf 1 2 3\nf 1 2 3\nf 1/1 2/1 3/1\n"
      "l 1/1 2/1\np 1\nunknown 1/2/3\n");
}

TEST(ObjLayout, KeepsColoursAndWeightsBehindThePosition) {
  EXPECT_EQ(rewritten("v 0 0 0 0.1 0.2 0.3\nv 1 0 0 1.0 # w\nv 0 1 0\nf 1 2 3"),
            "v 1 2 3 0.1 0.2 0.3\nv 0.5 -0.25 1e-07 1.0 # w\nv 4 5 6\nf 1 2 3");
}

TEST(ObjLayout, KeepsDosLineBreaksAndContinuedLines) {
  EXPECT_EQ(rewritten("v 0 \\\r\n0 0 \r\nv 1 0 0\r\nv 0 1 0\r\nvn 0 \\\r\n0 1\r\nf 1//1 2//1 \\\r\n 3//1\r\n"),
            "v 1 2 3 \r\nv 0.5 -0.25 1e-07\r\nv 4 5 6\r\nf 1 2 \\\r\n 3\r\n");
}

TEST(ObjLayout, KeepsNegativeIndicesAndDropsAByteOrderMark) {
  EXPECT_EQ(rewritten("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n"),
            "v 1 2 3\nv 0.5 -0.25 1e-07\nv 4 5 6\nvt 0 0\nf -3/-1 -2/-1 -1/-1\n");
}

TEST(ObjLayout, WritesAMeshThatReadsBack) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}, {1, 1, 1.0 / 3.0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 3, 1}};
  mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}, {0.3f, 0.7f}};
  mesh.groups = {{"left wing", "skin", 0, 2}, {"", "", 2, 1}};
  const TempFolder folder;
  const std::string path = folder.path("out.obj");
  ASSERT_TRUE(ObjLayout::create(mesh).writeTo(path, viewOf(std::as_const(mesh.positions))).ok());
  const Result<TriangleMesh> back = loadMesh(path);
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_EQ(back.value().positions, mesh.positions);
  EXPECT_EQ(back.value().triangles, mesh.triangles);
  EXPECT_EQ(back.value().texcoords, mesh.texcoords);
  ASSERT_EQ(back.value().groups.size(), 2u);
  EXPECT_EQ(back.value().groups[0].name, "left_wing");
  EXPECT_EQ(back.value().groups[0].material, "skin");
  EXPECT_EQ(back.value().groups[1].triangleCount, 1u);
}

TEST(ObjLayout, AMeshWithoutGroupsHasNone) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(formatted(ObjLayout::create(mesh), kMoved), "v 1 2 3\nv 0.5 -0.25 1e-07\nv 4 5 6\nf 1 2 3\n");
}

TEST(ObjLayout, AMaterialKeepsToItsOwnGroup) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  mesh.groups = {{"a", "skin", 0, 1}, {"b", "", 1, 1}};
  const TempFolder folder;
  const std::string path = folder.path("out.obj");
  ASSERT_TRUE(ObjLayout::create(mesh).writeTo(path, viewOf(kMoved)).ok());
  const TriangleMesh back = loadMesh(path).value();
  ASSERT_EQ(back.groups.size(), 2u);
  EXPECT_EQ(back.groups[0].material, "skin");
  EXPECT_EQ(back.groups[1].material, "");
}

const std::string kBody = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// The first line of a text that is written as out/m.obj below the source's folder.
std::string firstLineInSubfolder(const TempFolder& folder, const std::string& text) {
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", text));
  EXPECT_TRUE(layout.ok());
  std::filesystem::create_directories(folder.path("out"));
  EXPECT_TRUE(layout.value().writeTo(folder.path("out/m.obj"), viewOf(kMoved)).ok());
  const std::string written = TempFolder::read(folder.path("out/m.obj"));
  EXPECT_NE(written.find("\nv 1 2 3\nv 0.5 -0.25 1e-07\nv 4 5 6\nf 1 2 3\n"), std::string::npos) << written;
  return written.substr(0, written.find('\n'));
}

TEST(ObjLayout, NamesMaterialLibrariesFromTheOutputFolder) {
  const TempFolder folder;
  folder.write("skin.mtl", "newmtl skin\n");
  folder.write("two words.mtl", "newmtl skin\n");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib skin.mtl\n" + kBody), "mtllib ../skin.mtl");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib two words.mtl\n" + kBody), "mtllib ../two words.mtl");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib none.mtl\n" + kBody), "mtllib none.mtl");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib none.mtl skin.mtl out/../skin.mtl\n" + kBody),
            "mtllib none.mtl ../skin.mtl ../skin.mtl");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib " + folder.path("skin.mtl") + "\n" + kBody),
            "mtllib " + folder.path("skin.mtl"));
}

TEST(ObjLayout, ALibraryNameMayGetShorter) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path("out"));
  folder.write("out/skin.mtl", "newmtl skin\n");
  EXPECT_EQ(firstLineInSubfolder(folder, "mtllib out/skin.mtl\n" + kBody), "mtllib skin.mtl");
}

TEST(ObjLayout, RefusesWhatIsNoModel) {
  const TempFolder folder;
  const std::string path = folder.path("m.obj");
  expectError(ObjLayout::load(path), kFileNotFound, {path});
  folder.write("m.obj", "v 0 0 0\nv 0 0\n");
  expectError(ObjLayout::load(path), kMalformed, {path + ":2:", "3 numbers"});
  folder.write("m.obj", "f 1 2 3\n");
  expectError(ObjLayout::load(path), StatusCode::Empty, {path, "no vertices"});
}

TEST(ObjLayoutFor, TakesTheFileIfItIsObjAndElseTheMesh) {
  const TempFolder folder;
  const std::string path = folder.write("m.Obj", "# kept\n" + kBody);
  const TriangleMesh mesh = loadMesh(path).value();
  const Result<ObjLayout> own = objLayoutFor(path, mesh);
  ASSERT_TRUE(own.ok());
  EXPECT_EQ(formatted(own.value(), kMoved).substr(0, 7), "# kept\n");
  const Result<ObjLayout> other = objLayoutFor("m.ply", mesh);
  ASSERT_TRUE(other.ok());
  EXPECT_EQ(formatted(other.value(), kMoved), "v 1 2 3\nv 0.5 -0.25 1e-07\nv 4 5 6\nf 1 2 3\n");
}

TEST(ObjLayoutFor, NoticesThatTheFileHasChanged) {
  const TempFolder folder;
  const std::string path = folder.write("m.obj", kBody);
  const TriangleMesh mesh = loadMesh(path).value();
  folder.write("m.obj", kBody + "v 1 1 1\n");
  expectError(objLayoutFor(path, mesh), kSizeMismatch, {path, "has 4 vertices", "load the mesh again"});
}

const std::vector<Eigen::Vector3f> kNormals = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};

/// A text rewritten with kMoved and kNormals.
std::string rewrittenWithNormals(const std::string& text) {
  const TempFolder folder;
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", text));
  EXPECT_TRUE(layout.ok()) << layout.status().message;
  std::vector<char> buffer;
  return std::string(layout.value().withNormals().format(viewOf(kMoved), buffer, viewOf(kNormals)));
}

TEST(ObjLayout, WritesCurrentNormalsInPlaceOfAuthoredOnes) {
  EXPECT_EQ(rewrittenWithNormals("# made by hand\nv 0 0 0\n v 1 0 0 0.5 0.5 0.5 # red\nvt 0 0\nvn 0 0 1\nv\t0 1 0\n"
                                 "g wing left\nf 1/1/1 2/1/1  3/1/1 # 4/5/6\nf 1//1 2//1 3//1\nf 1 2 3\nl 1/1 2/1\n"),
            "# made by hand\nv 1 2 3\nvn 0 0 1\n v 0.5 -0.25 1e-07 0.5 0.5 0.5 # red\nvn 0 1 0\nvt 0 0\n"
            "v\t4 5 6\nvn -1 0 0\n"
            "g wing left\nf 1/1/1 2/1/2  3/1/3 # 4/5/6\nf 1//1 2//2 3//3\nf 1//1 2//2 3//3\nl 1/1 2/1\n");
}

TEST(ObjLayout, CountsNormalsBackwardsWhereVerticesAre) {
  EXPECT_EQ(rewrittenWithNormals("v 0 0 0\r\nv 1 0 0\r\nvn 0 0 1\r\nf -1//-1 -2//-1 \\\r\n 3//-1\r\nv 0 1 0"),
            "v 1 2 3\r\nvn 0 0 1\nv 0.5 -0.25 1e-07\r\nvn 0 1 0\nf -1//-1 -2//-2 \\\r\n 3//3\r\n"
            "v 4 5 6\nvn -1 0 0\n");
}

TEST(ObjLayout, NormalsReadBackAndLibrariesStayNamed) {
  const TempFolder folder;
  folder.write("skin.mtl", "newmtl skin\n");
  const std::string text = "v 0 0 0\nv 1 0 0\nmtllib skin.mtl\nv 0 1 0\nf 1 2 3\n";
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", text));
  ASSERT_TRUE(layout.ok());
  std::filesystem::create_directories(folder.path("out"));
  const std::string path = folder.path("out/m.obj");
  ASSERT_TRUE(layout.value().withNormals().writeTo(path, viewOf(kMoved), viewOf(kNormals)).ok());
  EXPECT_NE(TempFolder::read(path).find("\nmtllib ../skin.mtl\n"), std::string::npos);
  const TriangleMesh back = loadMesh(path).value();
  ASSERT_EQ(back.normals.size(), 3u);
  for (int v = 0; v < 3; ++v) EXPECT_EQ(back.normals[v], kNormals[v]);
  for (int v = 0; v < 3; ++v) EXPECT_EQ(back.positions[v].cast<float>(), kMoved[v]);
}

TEST(ObjLayout, NamesALibraryInFrontAndLeavesAllElseInPlace) {
  const TempFolder folder;
  folder.write("skin.mtl", "newmtl skin\n");
  const std::string text = "v 0 0 0\nv 1 0 0\nmtllib skin.mtl\nv 0 1 0\nf 1 2 3\n";
  const ObjLayout layout = ObjLayout::load(folder.write("m.obj", text)).value();
  std::filesystem::create_directories(folder.path("out"));
  const std::string path = folder.path("out/m.obj");
  for (const ObjLayout& both :
       {layout.withMaterialLibrary("a b.mtl").withNormals(), layout.withNormals().withMaterialLibrary("a b.mtl")}) {
    ASSERT_TRUE(both.writeTo(path, viewOf(kMoved), viewOf(kNormals)).ok());
    const std::string written = TempFolder::read(path);
    EXPECT_EQ(written.rfind("mtllib a_b.mtl\nv 1 2 3\nvn ", 0), 0u) << written;
    EXPECT_NE(written.find("\nmtllib ../skin.mtl\n"), std::string::npos) << written;
    EXPECT_EQ(loadMesh(path).value().positions[2].cast<float>(), kMoved[2]);
  }
}

TEST(ObjLayout, RefusesNormalsThatDoNotBelong) {
  const TempFolder folder;
  const Result<ObjLayout> layout = ObjLayout::load(folder.write("m.obj", kBody));
  ASSERT_TRUE(layout.ok());
  const ObjLayout withNormals = layout.value().withNormals();
  EXPECT_FALSE(layout.value().hasNormals());
  EXPECT_TRUE(withNormals.hasNormals());
  const std::string path = folder.path("out.obj");
  const std::vector<Eigen::Vector3f> two(2, Eigen::Vector3f::UnitX()), bad(3, Eigen::Vector3f::Constant(NAN));
  expectError(layout.value().writeTo(path, viewOf(kMoved), viewOf(kNormals)), kSizeMismatch, {path, "withNormals"});
  expectError(withNormals.writeTo(path, viewOf(kMoved)), kSizeMismatch, {path, "0 normals", "3 vertices"});
  expectError(withNormals.writeTo(path, viewOf(kMoved), viewOf(two)), kSizeMismatch, {path, "2 normals"});
  expectError(withNormals.writeTo(path, viewOf(kMoved), viewOf(bad)), kNonFinite, {path, "vertex 0"});
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ObjLayout, FormatsTwiceWithoutAllocating) {
  TriangleMesh mesh;
  mesh.positions.assign(50, Eigen::Vector3d(0, 0, 0));
  mesh.triangles = {{0, 1, 2}};
  const ObjLayout layout = ObjLayout::create(mesh);
  std::vector<char> buffer;
  const std::vector<Eigen::Vector3d> shortest(50, Eigen::Vector3d(0, 0, 0));
  const std::vector<Eigen::Vector3d> longest(50, Eigen::Vector3d::Constant(-2.2250738585072014e-308));
  const std::size_t size = layout.format(viewOf(shortest), buffer).size();
  const char* memory = buffer.data();
  EXPECT_EQ(layout.format(viewOf(longest), buffer).size(), size + 50 * 3 * 23);
  EXPECT_EQ(buffer.data(), memory);
}

}  // namespace
}  // namespace tetskin::test
