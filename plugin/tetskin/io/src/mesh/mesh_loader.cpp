// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <array>
#include <cmath>

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

Result<TriangleMesh> readGltfIfPossible(const std::string& path, MapRequest* map = nullptr) {
#ifdef TETSKIN_TINYGLTF
  return readGltf(path, map);
#else
  (void)map;
  return fileError(StatusCode::UnsupportedFormat, path, 0, "cannot be read: " + whyNoGltf());
#endif
}

std::string described(const MeshFileReport::Faces& faces, const std::string& what) {
  if (faces.count == 0) return {};
  return std::to_string(faces.count) + (faces.count == 1 ? " face" : " faces") + what + " (first in line " +
         std::to_string(faces.firstLine) + ")";
}

/// The mesh with a map on it.
Result<TriangleMesh> readWithMap(const std::string& path, MapRequest& map) {
  const std::string extension = lowerExtension(path);
  MeshFileReport unread;
  if (extension == ".obj") return readObj(path, unread, &map);
  if (extension == ".ply") return readPly(path, &map);
  if (extension == ".gltf" || extension == ".glb" || extension == ".vrm") return readGltfIfPossible(path, &map);
  return fileError(
      StatusCode::UnsupportedFormat, path, 0,
      "cannot have a map that is read here; save the model as PLY or glTF, or pass the values as an array");
}

/// Ok if each vertex has a finite value.
Status checkMap(const std::string& path, const MapRequest& map, std::size_t vertices) {
  const std::string name = excerpt(map.name);
  if (map.present.count(map.name) == 0) {
    std::string others;
    for (const std::string& other : map.present) others += (others.empty() ? "" : ", ") + excerpt(other);
    return fileError(
        StatusCode::InvalidOption, path, 0,
        "has no map " + name + " on its vertices; " +
            (others.empty() ? "it has none: export the model with it (Blender: Attributes or Vertex Colors)"
                            : "name one that it has: " + others));
  }
  if (map.values.size() != vertices) {
    return fileError(StatusCode::InvalidOption, path, 0,
                     "has a map " + name + " on only " + std::to_string(map.values.size()) + " of " +
                         std::to_string(vertices) + " vertices; paint it on all of the model");
  }
  const auto bad = std::find_if_not(map.values.begin(), map.values.end(), [](double v) { return std::isfinite(v); });
  if (bad == map.values.end()) return {};
  return fileError(StatusCode::NonFinite, path, 0,
                   "has a value in its map " + name + " that is not finite, at vertex " +
                       std::to_string(bad - map.values.begin()) + "; correct it");
}

}  // namespace

int colourChannel(std::string_view name) {
  constexpr std::array<std::string_view, 4> kChannels = {"red", "green", "blue", "alpha"};
  const auto found = std::find(kChannels.begin(), kChannels.end(), name);
  return found == kChannels.end() ? -1 : static_cast<int>(found - kChannels.begin());
}

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

Result<std::vector<double>> loadVertexMap(const std::string& path, const std::string& name) {
  io::MapRequest map{name, {}, {}};
  const Result<TriangleMesh> mesh = io::readWithMap(path, map);
  if (!mesh.ok()) return mesh.status();
  if (Status status = io::checkMap(path, map, mesh.value().vertexCount()); !status.ok()) return status;
  return std::move(map.values);
}

}  // namespace tetskin
