// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Damaged files of render meshes: whatever the bytes, the result is a sound mesh or a message. The first byte chooses
// the format: o for OBJ, p for PLY. Other formats are read by assimp, whose authors test them.
#include "fuzz_files.h"

#include <tetskin/io/files.h>

#include <string>
#include <utility>

using namespace tetskin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || (data[0] != 'o' && data[0] != 'p')) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const Result<TriangleMesh> loaded = loadMesh(test::write(data[0] == 'o' ? "m.obj" : "m.ply", bytes));
  if (!loaded.ok()) {
    TETSKIN_FUZZ_EXPECT(!loaded.status().message.empty());
    return 0;
  }
  const TriangleMesh& mesh = loaded.value();
  TETSKIN_FUZZ_EXPECT(!mesh.triangles.empty() && validate(mesh).ok());
  TETSKIN_FUZZ_EXPECT(firstUnusable(viewOf(mesh.positions)) == mesh.vertexCount());
  TETSKIN_FUZZ_EXPECT(mesh.normals.empty() || mesh.normals.size() == mesh.vertexCount());
  TETSKIN_FUZZ_EXPECT(mesh.texcoords.empty() || mesh.texcoords.size() == mesh.vertexCount());
  return 0;
}
