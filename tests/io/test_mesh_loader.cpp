// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"
#include "temp_folder.h"

#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

TEST(LoadMesh, LeavesOutLinesAndPoints) {
  const Result<TriangleMesh> mesh = loadMeshText(
      "m.dae",
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

TEST(LoadMesh, NamesAMissingFileAndAFolder) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.ply")), kFileNotFound, {folder.path("none.ply"), "check"});
  std::filesystem::create_directory(folder.path("dir.ply"));
  expectError(loadMesh(folder.path("none.3mf")), kFileNotFound, {folder.path("none.3mf"), "check"});
  expectError(loadMesh(""), kFileNotFound, {"(empty path)"});
  expectError(loadMesh(folder.path("dir.ply")), kFileNotFound, {folder.path("dir.ply"), "folder"});
}

TEST(LoadMesh, NamesFormatsThatAreNotRead) {
  expectError(loadMeshText("m.xyzzy", "text"), kUnsupportedFormat, {"m.xyzzy", "'.xyzzy'", "convert"});
  expectError(loadMeshText("m.3mf", "PK"), kUnsupportedFormat, {"m.3mf: 3MF packages", "save the model as STL"});
  expectError(loadMeshText("mesh", "text"), kUnsupportedFormat, {"mesh: ", "no file name extension"});
}

#ifndef TETSKIN_TEST_GLTF
TEST(LoadMesh, RefusesGltfByNameWithoutTinygltf) {
  for (const char* name : {"m.gltf", "m.GLB", "m.vrm"}) {
    expectError(loadMeshText(name, "{}"), kUnsupportedFormat, {name, "tinygltf", "install"});
  }
}
#endif

TEST(LoadMesh, PassesOnWhatAssimpSaysOfABrokenFile) {
  expectError(loadMeshText("m.dae", "{ broken"), kMalformed, {"m.dae: cannot be read: ", "export"});
}

TEST(LoadMesh, NamesAFaceWithAnIndexOutOfRange) {
  expectError(loadMeshText("m.x3d",
                           R"(<?xml version="1.0"?><X3D><Scene><Shape><IndexedFaceSet coordIndex="0 1 2 -1 0 1 9 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/></IndexedFaceSet></Shape></Scene></X3D>)"),
              kIndexOutOfRange, {"m.x3d: ", "face 1", "vertex 9"});
}

}  // namespace
}  // namespace tetskin::test
