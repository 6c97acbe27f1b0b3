// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Damaged files of render meshes: whatever the bytes, the result is a sound mesh or a message. The first byte chooses
// the format: o for OBJ, p for PLY, f for OFF, g for glTF, b for GLB, z for what is taken out of a package of 3MF.
// Other formats are read by assimp, whose authors test them; so are files of glTF 1.0, which are left out here.
#include "fuzz_files.h"

#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/gltf_text.h>
#include <tetskin/io/src/mesh/zip_entries.h>

#include <string>
#include <utility>

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
    case 'g':
      return "m.gltf";
    case 'b':
      return "m.glb";
    default:
      return nullptr;
  }
}

bool isFirstGltf(const std::string& bytes) {
  Result<io::GltfText> text = io::splitGltf("m", bytes);
  return text.ok() && io::keepShape("m", text.value()).ok() && text.value().firstVersion;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'z') {
    const Result<io::Models3mf> models = io::modelsOf3mf("m.3mf", bytes);
    TETSKIN_FUZZ_EXPECT(models.ok() || !models.status().message.empty());
    return 0;
  }
  const char* name = nameFor(data[0]);
  if (!name || ((data[0] == 'g' || data[0] == 'b') && isFirstGltf(bytes))) return 0;
  const Result<TriangleMesh> loaded = loadMesh(test::write(name, bytes));
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
