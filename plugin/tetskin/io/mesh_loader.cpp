// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/assimp_reader.h>
#include <tetskin/io/file_text.h>
#include <tetskin/io/mesh_loader.h>
#include <tetskin/io/obj_reader.h>

namespace tetskin {

Result<TriangleMesh> loadMesh(const std::string& path) {
  return io::lowerExtension(path) == ".obj" ? io::readObj(path) : io::readWithAssimp(path);
}

}  // namespace tetskin
