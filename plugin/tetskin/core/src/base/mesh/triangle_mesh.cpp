// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>

namespace tetskin {

Status checkTriangleCounts(std::size_t vertices, std::size_t triangles) {
  if (vertices <= Limits::kMaxVertices && triangles <= Limits::kMaxTriangles) return {};
  const bool excess = vertices > Limits::kMaxVertices;
  return {StatusCode::TooLarge, "the mesh has " + std::to_string(excess ? vertices : triangles) +
                                    (excess ? " vertices" : " triangles") + ", more than the " +
                                    std::to_string(excess ? Limits::kMaxVertices : Limits::kMaxTriangles) +
                                    " that are supported; split the mesh"};
}

Status validate(const TriangleMesh& mesh) {
  if (Status status = checkTriangleCounts(mesh.vertexCount(), mesh.triangleCount()); !status.ok()) return status;
  if (mesh.positions.empty()) return {StatusCode::Empty, "the mesh has no vertices"};
  const std::size_t bad = firstNonFinite(viewOf(mesh.positions));
  if (bad < mesh.vertexCount()) {
    return {StatusCode::NonFinite,
            "vertex " + std::to_string(bad) + " of the mesh has a coordinate that is not finite; correct it"};
  }
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertexCount()) continue;
      return {StatusCode::IndexOutOfRange, "triangle " + std::to_string(t) + " refers to vertex " + std::to_string(v) +
                                               ", but the mesh has " + std::to_string(mesh.vertexCount()) +
                                               " vertices; correct the triangle"};
    }
  }
  return {};
}

}  // namespace tetskin
