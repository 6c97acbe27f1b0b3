// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// loadMesh in a build with TETSKIN_ASSIMP=OFF, instead of test_mesh_loader.cpp.
#include "loaded_texts.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/text/binary_numbers.h>

namespace tetskin::test {
namespace {

TEST(LoadMeshWithoutAssimp, ReadsObjPlyAndOff) {
  EXPECT_EQ(loadMeshText("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").value().triangleCount(), 1u);
  EXPECT_EQ(loadMeshText("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").value().triangleCount(), 1u);
  EXPECT_EQ(loadMeshText("m.ply",
                         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                         "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
                         "0\n0 1 0\n3 0 1 2\n")
                .value()
                .triangleCount(),
            1u);
}

TEST(LoadMeshWithoutAssimp, NamesTheFormatAndTheOption) {
  for (const char* format : {".fbx", ".dae", ".3mf"}) {
    expectError(loadMeshText(std::string("m") + format, "solid plate\nendsolid plate\n"), kUnsupportedFormat,
                {std::string("m") + format, "'" + std::string(format) + "'", "TETSKIN_ASSIMP=OFF", "convert"});
  }
  expectError(loadMeshText("mesh", "text"), kUnsupportedFormat, {"mesh: ", "no file name extension"});
}

const std::string kFacet =
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 0\n  endloop\n endfacet\n";

/// A binary file of one triangle that states so many.
std::string binaryStl(std::uint32_t triangles, const std::string& begin = "") {
  std::string bytes = begin + std::string(80 - begin.size(), ' ');
  io::appendLittleEndian(triangles, bytes);
  for (const float number : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.5f}) {
    io::appendLittleEndian(number, bytes);
  }
  return bytes + std::string(2, '\0');
}

TEST(LoadMeshWithoutAssimp, ReadsStlOfBothKinds) {
  const TriangleMesh text = loadMeshText("m.STL", "solid two\n" + kFacet + kFacet + "endsolid two\n").value();
  EXPECT_EQ(text.vertexCount(), 6u);
  EXPECT_EQ(text.triangles[1], (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(text.positions[5], Eigen::Vector3d(0, 1, 0));
  for (const char* begin : {"", "solid", "any"}) {
    const TriangleMesh binary = loadMeshText("m.stl", binaryStl(1, begin)).value();
    ASSERT_EQ(binary.triangleCount(), 1u) << begin;
    EXPECT_EQ(binary.positions[2], Eigen::Vector3d(0, 1, 0.5)) << begin;
  }
}

TEST(LoadMeshWithoutAssimp, RefusesDamagedStl) {
  for (const std::uint32_t count : {2u, 0xFFFFFFFFu}) {
    expectError(loadMeshText("m.stl", binaryStl(count)), kMalformed,
                {"m.stl: states " + std::to_string(count) + " triangles", "contains 134 bytes", "complete"});
  }
  expectError(loadMeshText("m.stl", "solid x\n facet\n outer loop\n vertex 0 0 0\n"), kMalformed,
              {"m.stl:4: ", "within"});
  expectError(loadMeshText("m.stl", "solid x\n vertex 0 0\n"), kMalformed, {"m.stl:2: ", "three numbers"});
  expectError(loadMeshText("m.stl", "solid x\n vertex 0 0 1e30\n"), kNonFinite, {"vertex 0"});
  for (const char* empty : {"", "solid x\nendsolid x\n", "# nothing"}) {
    expectError(loadMeshText("m.stl", empty), StatusCode::Empty, {"m.stl", "no triangles"});
  }
}

TEST(LoadMeshWithoutAssimp, NamesAMissingFileAndAFolderFirst) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.stl")), kFileNotFound, {folder.path("none.stl"), "check"});
  std::filesystem::create_directory(folder.path("dir.stl"));
  expectError(loadMesh(folder.path("dir.stl")), kFileNotFound, {folder.path("dir.stl"), "folder"});
  expectError(loadMesh(""), kFileNotFound, {"(empty path)"});
}

#ifdef TETSKIN_TEST_GLTF
TEST(LoadMeshWithoutAssimp, NamesGltfOfTheFirstVersion) {
  expectError(loadMeshText("m.gltf", R"({"asset": {"version": "1.0"}, "meshes": {}})"), kUnsupportedFormat,
              {"m.gltf", "glTF 1.0", "TETSKIN_ASSIMP=OFF"});
}
#endif

}  // namespace
}  // namespace tetskin::test
