// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Damaged files of render meshes: whatever the bytes, the result is a sound mesh or a message. The first byte chooses
// the format: o for OBJ, p for PLY, f for OFF, s for STL, g for glTF, b for GLB. Other formats are read by assimp,
// whose authors test them.
#include "fuzz_files.h"

#include <tetskin/io/files.h>

#include <string>
#include <utility>
#include <vector>

using namespace tetskin;

namespace {

/// The name of a file for a format; null if there is no such format.
const char* nameFor(std::uint8_t format) {
  switch (format) {
    case 'o':
      return "m.obj";
    case 'p':
      return "m.ply";
    case 'f':
      return "m.off";
    case 's':
      return "m.stl";
    case 'g':
      return "m.gltf";
    case 'b':
      return "m.glb";
    default:
      return nullptr;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const char* name = nameFor(data[0]);
  if (!name) return 0;
  const std::string path = test::write(name, bytes);
  const Result<TriangleMesh> loaded = loadMesh(path);
  const Result<std::vector<double>> map = loadVertexMap(path, "red");
  TETSKIN_FUZZ_EXPECT(map.ok() ? loaded.ok() && map.value().size() == loaded.value().vertexCount()
                               : !map.status().message.empty());
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
