// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/assimp_reader.h>
#include <tetskin/io/src/mesh/obj_reader.h>
#include <tetskin/io/src/mesh/ply_reader.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin {

Result<TriangleMesh> loadMesh(const std::string& path) {
  const std::string extension = io::lowerExtension(path);
  if (extension == ".obj") return io::readObj(path);
  return extension == ".ply" ? io::readPly(path) : io::readWithAssimp(path);
}

}  // namespace tetskin
