// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tetskin/io/files.h>

#include <cstring>

namespace tetskin {
namespace {

using test::expectError;
using test::TempFolder;
using Triangle = std::array<int, 3>;

Result<TriangleMesh> loadText(const std::string& name, const std::string& text) {
  const TempFolder folder;
  return loadMesh(folder.write(name, text));
}

const std::string kCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(LoadMesh, KeepsTheThreeVerticesOfEveryStlTriangle) {
  const TriangleMesh mesh =
      loadText("m.STL",
               "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 "
               "0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 "
               "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid plate\n")
          .value();
  EXPECT_EQ(mesh.vertexCount(), 6u);
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[5], Eigen::Vector3f(0, 0, 1));
}

TEST(LoadMesh, ASolidWithoutTrianglesDoesNoHarm) {
  const Result<TriangleMesh> mesh =
      loadText("m.stl",
               "solid empty\nendsolid empty\nsolid plate\nfacet normal 0 0 1\nouter "
               "loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid "
               "plate\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
}

TEST(LoadMesh, ReadsOff) {
  const Result<TriangleMesh> mesh = loadText("m.off", "OFF\n4 1 0\n" + kCorners + "3 0 1 2\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
}

std::string base64(const std::string& bytes) {
  const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

template <class Number>
std::string raw(std::initializer_list<Number> values) {
  std::string bytes(values.size() * sizeof(Number), '\0');
  std::memcpy(&bytes[0], values.begin(), bytes.size());
  return bytes;
}

/// Two meshes of the same triangle in the plane z = 1: "lit" has slanted normals and texture coordinates, "plain" has
/// neither. `nodes` is the list of the scene's nodes; the first is its root.
std::string gltf(const std::string& nodes) {
  const std::string buffer = raw<float>({0, 0, 1, 2, 0, 1, 0, 1, 1}) +
                             raw<float>({0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f}) +
                             raw<float>({0, 0, 0.5f, 0, 0, 0.25f}) + raw<std::uint16_t>({0, 1, 2, 0});
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
         R"(],"materials":[{"name":"skin"}],"meshes":[
{"name":"lit","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]},
{"name":"plain","primitives":[{"attributes":{"POSITION":0},"indices":3}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,1],"max":[2,1,1]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":3,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
{"buffer":0,"byteOffset":72,"byteLength":24},{"buffer":0,"byteOffset":96,"byteLength":8}],
"buffers":[{"byteLength":104,"uri":"data:application/octet-stream;base64,)" +
         base64(buffer) + "\"}]}";
}

TEST(LoadMesh, AppliesTheTransformsOfAllNodes) {
  const Result<TriangleMesh> loaded = loadText(
      "m.gltf", gltf(R"({"children":[1,2],"translation":[10,0,0]},{"mesh":0,"scale":[3,1,1]},{"children":[3]},)"
                     R"({"mesh":0,"rotation":[0,0,0.70710678118,0.70710678118]})"));
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  const TriangleMesh& mesh = loaded.value();
  ASSERT_EQ(mesh.vertexCount(), 6u);
  EXPECT_EQ(mesh.positions[1], Eigen::Vector3d(16, 0, 1));
  EXPECT_LT((mesh.positions[4] - Eigen::Vector3d(10, 2, 1)).norm(), 1e-6);
  EXPECT_EQ(mesh.triangles, std::vector<Triangle>({{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(mesh.normals.size(), 6u);
  // When stretched by three along x, a normal's x component shrinks by a factor of three.
  EXPECT_LT((mesh.normals[0] - Eigen::Vector3f(0.2f, 0, 0.8f).normalized()).norm(), 1e-6f);
  EXPECT_LT((mesh.normals[3] - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 1e-6f);
  ASSERT_EQ(mesh.texcoords.size(), 6u);
  EXPECT_EQ(mesh.texcoords[4][0], 0.5f);
}

TEST(LoadMesh, NamesGroupsAfterMeshesAndMaterials) {
  const TriangleMesh mesh =
      loadText("m.gltf", gltf(R"({"children":[1,2]},{"mesh":0},{"mesh":1,"translation":[0,0,1]})")).value();
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "lit");
  EXPECT_EQ(mesh.groups[0].material, "skin");
  EXPECT_EQ(mesh.groups[0].firstTriangle, 0u);
  EXPECT_EQ(mesh.groups[0].triangleCount, 1u);
  EXPECT_EQ(mesh.groups[1].name, "plain");
  EXPECT_EQ(mesh.groups[1].material, "");
  EXPECT_EQ(mesh.groups[1].firstTriangle, 1u);
}

TEST(LoadMesh, AMirroredMeshStaysTheRightWayOut) {
  const TriangleMesh mesh = loadText("m.gltf", gltf(R"({"mesh":0,"scale":[1,1,-1]})")).value();
  ASSERT_EQ(mesh.triangleCount(), 1u);
  const Triangle& t = mesh.triangles[0];
  const Eigen::Vector3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
  EXPECT_EQ(a[2], -1.0);
  EXPECT_LT((b - a).cross(c - a)[2], 0.0);
  EXPECT_LT((mesh.normals[0] - Eigen::Vector3f(0.6f, 0, -0.8f)).norm(), 1e-6f);
}

TEST(LoadMesh, FillsWhatOnlySomeMeshesHave) {
  const TriangleMesh mesh = loadText("m.gltf", gltf(R"({"children":[1,2]},{"mesh":1},{"mesh":0})")).value();
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_LT((mesh.normals[3] - Eigen::Vector3f(0.6f, 0, 0.8f)).norm(), 1e-6f);
  ASSERT_EQ(mesh.texcoords.size(), 6u);
  EXPECT_EQ(mesh.texcoords[1], Eigen::Vector2f(0, 0));
  const TriangleMesh plain = loadText("m.gltf", gltf(R"({"mesh":1})")).value();
  EXPECT_EQ(plain.triangleCount(), 1u);
  EXPECT_TRUE(plain.normals.empty());
  EXPECT_TRUE(plain.texcoords.empty());
}

TEST(LoadMesh, LeavesOutLinesAndPoints) {
  const Result<TriangleMesh> mesh =
      loadText("m.dae",
               R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g" name="part"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 1 1 0 9 9 9</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 3</p></lines></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
  EXPECT_EQ(mesh.value().vertexCount(), 3u);
}

TEST(LoadMesh, FacesWithoutCornersDoNoHarm) {
  const Result<TriangleMesh> mesh = loadText("m.off", "OFF\n4 3 0\n" + kCorners + "3 0 1 2\n0\n0\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
}

TEST(LoadMesh, RefusesMeshesWithoutTriangles) {
  expectError(loadText("lines.off", "OFF\n4 1 0\n" + kCorners + "2 0 1\n").status(), StatusCode::Empty,
              {"lines.off", "no triangles", "export"});
}

TEST(LoadMesh, RefusesCountsThatTheFileCannotHold) {
  for (const char* header : {"OFF\n2000000000 1 0\n", "OFF 4 # vertices\n2000000000 0\n", "2000000000\n1\n",
                             "STCNnOFF\n3\n18446744073709551615 1 0\n", "OFF\n4 2 0\n"}) {
    expectError(loadText("m.off", header + kCorners + "3 0 1 2\n").status(), StatusCode::Malformed,
                {"m.off: states ", " vertices and ", "but contains 5 lines", "complete"});
  }
  EXPECT_TRUE(loadText("m.off", "# one\nOFF # two\n\n4\n1 0\n" + kCorners + "3 0 1 2").ok());
  const auto glb = [](std::uint32_t scene) { return "glTF" + raw<std::uint32_t>({2, 24, scene}) + "JSON" + "{}  "; };
  expectError(loadText("m.glb", glb(2000000000)).status(), StatusCode::Malformed,
              {"m.glb: states a scene of 2000000000 bytes", "contains 24 bytes", "complete"});
  expectError(loadText("m.glb", glb(5)).status(), StatusCode::Malformed, {"m.glb: states a scene of 5 bytes"});
  expectError(loadText("m.glb", glb(4)).status(), StatusCode::Malformed, {"m.glb: cannot be read: "});
  expectError(loadText("m.glb", "glTF").status(), StatusCode::Malformed, {"m.glb: cannot be read: "});
  const std::string triangle = raw<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}) + std::string(2, '\0');
  const auto stl = [&](std::uint32_t triangles, const std::string& mark) {
    return mark + std::string(80 - mark.size(), '\0') + raw<std::uint32_t>({triangles}) + triangle;
  };
  // In 32-bit arithmetic, 2147483649 triangles take as many bytes as one.
  for (const std::uint32_t count : {2u, 2000000000u, 2147483649u, 4294967295u}) {
    for (const char* mark : {"", "solid"}) {
      expectError(loadText("m.stl", stl(count, mark)).status(), StatusCode::Malformed,
                  {"m.stl: states " + std::to_string(count) + " triangles", "contains 134 bytes", "complete"});
    }
  }
  EXPECT_EQ(loadText("m.stl", stl(1, "solid")).value().triangleCount(), 1u);
  // A reader that takes the leading digits for a number would read two thousand million faces here.
  expectError(loadText("m.off", "OFF\n1 2000000000.5 0\n0 0 0\n").status(), StatusCode::Malformed,
              {"m.off: has '2000000000.5'", "whole number"});
}

TEST(LoadMesh, ReadsStlTextThatBeginsWithABlank) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part\n";
  for (const char* begin : {"solid part\n", " solid part\n", "\t solid part\n"}) {
    EXPECT_EQ(loadText("m.stl", begin + facet).value().triangleCount(), 1u) << begin;
  }
}

TEST(LoadMesh, NamesAMissingFileAndAFolder) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.ply")).status(), StatusCode::FileNotFound, {folder.path("none.ply"), "check"});
  std::filesystem::create_directory(folder.path("dir.ply"));
  expectError(loadMesh("").status(), StatusCode::FileNotFound, {"(empty path)"});
  expectError(loadMesh(folder.path("dir.ply")).status(), StatusCode::FileNotFound, {folder.path("dir.ply"), "folder"});
}

TEST(LoadMesh, NamesFormatsThatAreNotRead) {
  expectError(loadText("m.xyzzy", "text").status(), StatusCode::UnsupportedFormat, {"m.xyzzy", "'.xyzzy'", "convert"});
  expectError(loadText("mesh", "text").status(), StatusCode::UnsupportedFormat, {"mesh: ", "no file name extension"});
}

TEST(LoadMesh, PassesOnWhatAssimpSaysOfABrokenFile) {
  expectError(loadText("m.gltf", "{ broken").status(), StatusCode::Malformed, {"m.gltf: cannot be read: ", "export"});
  expectError(loadText("m.stl", "").status(), StatusCode::Malformed, {"m.stl: cannot be read: "});
}

TEST(LoadMesh, NamesAVertexThatIsNotFinite) {
  expectError(loadText("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n").status(), StatusCode::NonFinite,
              {"m.off: vertex 2", "correct it"});
}

TEST(LoadMesh, NamesAVertexThatIsTooFar) {
  expectError(loadText("m.stl",
                       "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1e31 "
                       "0\nendloop\nendfacet\nendsolid plate\n")
                  .status(),
              StatusCode::NonFinite, {"m.stl: vertex 2", "beyond 1e18", "orrect"});
}

TEST(LoadMesh, NamesAFaceWithAnIndexOutOfRange) {
  expectError(loadText("m.x3d",
                       R"(<?xml version="1.0"?><X3D><Scene><Shape><IndexedFaceSet coordIndex="0 1 2 -1 0 1 9 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/></IndexedFaceSet></Shape></Scene></X3D>)")
                  .status(),
              StatusCode::IndexOutOfRange, {"m.x3d: ", "face 1", "vertex 9"});
}

}  // namespace
}  // namespace tetskin
