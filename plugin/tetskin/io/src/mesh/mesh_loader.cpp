// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin {

namespace io {

std::string whyNoGltf() {
#ifdef TETSKIN_TINYGLTF
  return {};
#else
  return "tetskin was built without tinygltf; install it (Debian: libtinygltf-dev) and configure again";
#endif
}

namespace {

Result<TriangleMesh> readGltfIfPossible(const std::string& path) {
#ifdef TETSKIN_TINYGLTF
  return readGltf(path);
#else
  return fileError(StatusCode::UnsupportedFormat, path, 0, "cannot be read: " + whyNoGltf());
#endif
}

std::string described(const MeshFileReport::Faces& faces, const std::string& what) {
  if (faces.count == 0) return {};
  return std::to_string(faces.count) + (faces.count == 1 ? " face" : " faces") + what + " (first in line " +
         std::to_string(faces.firstLine) + ")";
}

}  // namespace

}  // namespace io

std::string MeshFileReport::describe() const {
  const std::string dropped = io::described(droppedFaces, " of fewer than 3 corners left out");
  const std::string incomplete =
      io::described(incompleteFaces, " read without texture coordinates or normals that do not exist");
  return dropped + (dropped.empty() || incomplete.empty() ? "" : ", ") + incomplete;
}

Result<TriangleMesh> loadMesh(const std::string& path, MeshFileReport* report) {
  MeshFileReport unread;
  if (!report) report = &unread;
  *report = {};
  const std::string extension = io::lowerExtension(path);
  if (extension == ".obj") return io::readObj(path, *report);
  if (extension == ".ply") return io::readPly(path);
  if (extension == ".off") return io::readOff(path);
  if (extension == ".stl") return io::readStl(path);
  if (extension == ".gltf" || extension == ".glb" || extension == ".vrm") return io::readGltfIfPossible(path);
  if (extension == ".3mf") {  // assimp 5.2.5 frees some images of a package twice
    if (const Result<std::string> bytes = io::readFile(path); !bytes.ok()) return bytes.status();
    return io::fileError(StatusCode::UnsupportedFormat, path, 0,
                         "3MF packages are not supported; save the model as STL or PLY");
  }
  return io::readWithAssimp(path);
}

}  // namespace tetskin
