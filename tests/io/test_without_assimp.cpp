// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// loadMesh in a build with TETSKIN_ASSIMP=OFF, instead of test_mesh_loader.cpp.
#include "loaded_texts.h"
#include "temp_folder.h"

#include <tetskin/io/files.h>

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
  for (const char* format : {".fbx", ".dae"}) {
    expectError(loadMeshText(std::string("m") + format, "solid plate\nendsolid plate\n"), kUnsupportedFormat,
                {std::string("m") + format, "'" + std::string(format) + "'", "TETSKIN_ASSIMP=OFF", "convert"});
  }
  expectError(loadMeshText("mesh", "text"), kUnsupportedFormat, {"mesh: ", "no file name extension"});
}

TEST(LoadMeshWithoutAssimp, NamesAMissingFileAndAFolderFirst) {
  const TempFolder folder;
  expectError(loadMesh(folder.path("none.fbx")), kFileNotFound, {folder.path("none.fbx"), "check"});
  std::filesystem::create_directory(folder.path("dir.fbx"));
  expectError(loadMesh(folder.path("dir.fbx")), kFileNotFound, {folder.path("dir.fbx"), "folder"});
  expectError(loadMesh(""), kFileNotFound, {"(empty path)"});
}

}  // namespace
}  // namespace tetskin::test
