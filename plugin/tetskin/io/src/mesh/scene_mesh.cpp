// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/area_vectors.h>
#include <tetskin/io/src/mesh/scene_mesh.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>

#include <cassert>
#include <utility>

namespace tetskin::io {

namespace {

/// Appends smooth normals of the vertices from `firstVertex` on, computed from the triangles from `firstTriangle` on,
/// weighted by area.
void appendSmoothNormals(TriangleMesh& mesh, std::size_t firstVertex, std::size_t firstTriangle) {
  assert(mesh.normals.size() == firstVertex && firstVertex <= mesh.vertexCount());
  std::vector<Eigen::Vector3d> sums(mesh.vertexCount() - firstVertex, Eigen::Vector3d::Zero());
  sumAreaVectors(mesh, firstTriangle, [&](std::size_t v) -> Eigen::Vector3d& { return sums[v - firstVertex]; });
  for (const Eigen::Vector3d& sum : sums) mesh.normals.push_back(unitNormal(sum));
}

void append(const ScenePart& part, bool normals, bool texcoords, TriangleMesh& mesh) {
  assert(part.normals.empty() || part.normals.size() == part.positions.size());
  assert(part.texcoords.empty() || part.texcoords.size() == part.positions.size());
  const std::size_t firstVertex = mesh.vertexCount(), firstTriangle = mesh.triangleCount();
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  for (const std::array<int, 3>& corners : part.triangles) {
    const int first = static_cast<int>(firstVertex);
    mesh.triangles.push_back({corners[0] + first, corners[1] + first, corners[2] + first});
  }
  for (TriangleGroup group : part.groups) {
    group.firstTriangle += firstTriangle;
    mesh.groups.push_back(std::move(group));
  }
  mesh.texcoords.insert(mesh.texcoords.end(), part.texcoords.begin(), part.texcoords.end());
  if (texcoords) mesh.texcoords.resize(mesh.vertexCount(), Eigen::Vector2f::Zero());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  if (normals && part.normals.empty()) appendSmoothNormals(mesh, firstVertex, firstTriangle);
}

}  // namespace

Eigen::Matrix3d normalMatrix(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d cofactors;
  cofactors << m.row(1).cross(m.row(2)), m.row(2).cross(m.row(0)), m.row(0).cross(m.row(1));
  return m.determinant() < 0.0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

Result<TriangleMesh> joinParts(const std::string& path, std::vector<ScenePart>& parts) {
  bool texcoords = false, normals = false;
  std::size_t vertexCount = 0, triangleCount = 0;
  for (const ScenePart& part : parts) {
    texcoords = texcoords || !part.texcoords.empty();
    normals = normals || !part.normals.empty();
    vertexCount += part.positions.size();
    triangleCount += part.triangles.size();
  }
  if (vertexCount > Limits::kMaxVertices) {
    return fileError(StatusCode::UnsupportedFormat, path, 0, "has more than 2147483647 vertices; split the model");
  }
  if (triangleCount == 0) {
    return fileError(StatusCode::Empty, path, 0, "has no triangles; export the model as a surface of polygons");
  }
  TriangleMesh mesh;
  mesh.positions.reserve(vertexCount);
  mesh.triangles.reserve(triangleCount);
  for (ScenePart& part : parts) {
    append(std::exchange(part, {}), normals, texcoords, mesh);
    assert((normals ? mesh.vertexCount() : 0) == mesh.normals.size());
    assert((texcoords ? mesh.vertexCount() : 0) == mesh.texcoords.size());
  }
  if (mesh.groups.size() == 1 && mesh.groups[0].name.empty() && mesh.groups[0].material.empty()) mesh.groups.clear();
  const Status status = validate(mesh);
  if (!status.ok()) return fileError(status.code, path, 0, status.message + " in the model, or export it again");
  const PointView<const double> positions = viewOf(std::as_const(mesh.positions));
  if (const std::string fault = coordinateFault(positions); !fault.empty()) {
    return fileError(StatusCode::NonFinite, path, 0, "vertex " + std::to_string(firstUnusable(positions)) + fault);
  }
  return mesh;
}

}  // namespace tetskin::io
