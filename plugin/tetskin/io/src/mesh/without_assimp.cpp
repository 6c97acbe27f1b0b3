// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin::io {

Result<TriangleMesh> readWithAssimp(const std::string& path) {
  const std::string extension = lowerExtension(path);
  const Result<std::string> bytes = readFile(path);
  if (!bytes.ok()) return bytes.status();
  if (extension.empty()) {
    return fileError(StatusCode::UnsupportedFormat, path, 0,
                     "has no file name extension; convert it to OBJ, PLY or glTF");
  }
  return fileError(StatusCode::UnsupportedFormat, path, 0,
                   "unsupported input format " + excerpt(extension) +
                       ", as tetskin was built without assimp (TETSKIN_ASSIMP=OFF); build with it, or convert the "
                       "file to OBJ, PLY or glTF 2.0");
}

}  // namespace tetskin::io
