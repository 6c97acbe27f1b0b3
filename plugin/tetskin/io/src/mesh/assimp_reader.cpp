// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/shared/mesh/area_vectors.h>
#include <tetskin/io/src/mesh/assimp_reader.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/stated_sizes.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cassert>
#include <exception>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

namespace tetskin::io {

namespace {

/// A mesh of the scene, placed by one of the nodes that show it.
struct Instance {
  const aiMesh* mesh = nullptr;
  const aiNode* node = nullptr;
  Eigen::Affine3d toScene = Eigen::Affine3d::Identity();
};

Eigen::Affine3d affine(const aiMatrix4x4& m) {
  Eigen::Affine3d result;
  result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return result;
}

Eigen::Vector3d vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

/// Matrix of cofactors times the sign of the determinant: a positive multiple of the inverse transpose, which normals
/// need, that exists for flattening transforms as well.
Eigen::Matrix3d normalMatrix(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d cofactors;
  cofactors << m.row(1).cross(m.row(2)), m.row(2).cross(m.row(0)), m.row(0).cross(m.row(1));
  return m.determinant() < 0.0 ? Eigen::Matrix3d(-cofactors) : cofactors;
}

/// Ok if no face names a vertex that its mesh lacks.
Status checkFaces(const std::string& path, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned i = 0; i < mesh.mFaces[f].mNumIndices; ++i) {
        if (mesh.mFaces[f].mIndices[i] < mesh.mNumVertices) continue;
        return fileError(StatusCode::IndexOutOfRange, path, 0,
                         "face " + std::to_string(f) + " of mesh " + std::to_string(m) + " refers to vertex " +
                             std::to_string(mesh.mFaces[f].mIndices[i]) + " of " + std::to_string(mesh.mNumVertices) +
                             "; export the model again");
      }
    }
  }
  return {};
}

bool isSurface(const aiFace& face) {
  return face.mNumIndices >= 3;
}

/// The flags of assimp are wrong for damaged files, so that the faces are tested.
bool hasSurface(const aiMesh& mesh) {
  return std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces, isSurface);
}

/// For each vertex of a mesh, whether it is kept: those that only lines and points use are not.
std::vector<bool> keptVertices(const aiMesh& mesh) {
  std::vector<bool> kept(mesh.mNumVertices, true);
  for (const bool surface : {false, true}) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (isSurface(face) != surface) continue;
      for (unsigned i = 0; i < face.mNumIndices; ++i) kept[face.mIndices[i]] = surface;
    }
  }
  return kept;
}

/// The meshes with surfaces under the scene's nodes, depth first in the file's order.
std::vector<Instance> instances(const aiScene& scene) {
  struct Visit {
    const aiNode* node;
    Eigen::Affine3d toScene;
  };
  std::vector<Instance> result;
  std::vector<Visit> stack;
  if (scene.mRootNode) stack.push_back({scene.mRootNode, affine(scene.mRootNode->mTransformation)});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
      if (visit.node->mMeshes[i] >= scene.mNumMeshes) continue;
      const aiMesh* mesh = scene.mMeshes[visit.node->mMeshes[i]];
      if (!hasSurface(*mesh)) continue;
      result.push_back({mesh, visit.node, visit.toScene});
    }
    for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
      const aiNode* child = visit.node->mChildren[i];
      if (child) stack.push_back({child, visit.toScene * affine(child->mTransformation)});  // RAW files have gaps
    }
  }
  return result;
}

/// Appends smooth normals of the vertices from `firstVertex` on, computed from the triangles from `firstTriangle` on,
/// weighted by area.
void appendSmoothNormals(TriangleMesh& mesh, std::size_t firstVertex, std::size_t firstTriangle) {
  assert(mesh.normals.size() == firstVertex && firstVertex <= mesh.vertexCount());
  std::vector<Eigen::Vector3d> sums(mesh.vertexCount() - firstVertex, Eigen::Vector3d::Zero());
  sumAreaVectors(mesh, firstTriangle, [&](std::size_t v) -> Eigen::Vector3d& { return sums[v - firstVertex]; });
  for (const Eigen::Vector3d& sum : sums) mesh.normals.push_back(unitNormal(sum));
}

void appendTriangles(const Instance& instance, const std::vector<int>& vertices, TriangleMesh& mesh) {
  assert(vertices.size() == instance.mesh->mNumVertices);
  const bool mirrored = instance.toScene.linear().determinant() < 0.0;
  std::vector<int> polygon;
  for (unsigned f = 0; f < instance.mesh->mNumFaces; ++f) {
    const aiFace& face = instance.mesh->mFaces[f];
    if (!isSurface(face)) continue;
    polygon.clear();
    for (unsigned i = 0; i < face.mNumIndices; ++i) polygon.push_back(vertices[face.mIndices[i]]);
    if (mirrored) std::reverse(polygon.begin() + 1, polygon.end());
    appendPolygon(mesh.positions, polygon, mesh.triangles);
  }
}

TriangleGroup groupOf(const aiScene& scene, const Instance& instance, const TriangleMesh& mesh, std::size_t first) {
  assert(first <= mesh.triangleCount());
  TriangleGroup group;
  group.name = instance.mesh->mName.length > 0 ? instance.mesh->mName.C_Str() : instance.node->mName.C_Str();
  if (instance.mesh->mMaterialIndex < scene.mNumMaterials) {
    group.material = scene.mMaterials[instance.mesh->mMaterialIndex]->GetName().C_Str();
  }
  // The material that assimp adds to a file without materials does not count.
  if (group.material == AI_DEFAULT_MATERIAL_NAME) group.material.clear();
  group.firstTriangle = first;
  group.triangleCount = mesh.triangleCount() - first;
  return group;
}

/// Appends the normals of the mesh, if it has any, or smooth ones.
void appendNormals(const Instance& instance, const std::vector<bool>& kept, std::size_t firstVertex,
                   std::size_t firstTriangle, TriangleMesh& mesh) {
  const aiMesh& part = *instance.mesh;
  if (!part.HasNormals()) return appendSmoothNormals(mesh, firstVertex, firstTriangle);
  const Eigen::Matrix3d toScene = normalMatrix(instance.toScene.linear());
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    if (kept[v]) mesh.normals.push_back(unitNormal(toScene * vector(part.mNormals[v])));
  }
}

void append(const Instance& instance, bool texcoords, bool normals, TriangleMesh& mesh) {
  const aiMesh& part = *instance.mesh;
  const std::vector<bool> kept = keptVertices(part);
  const std::size_t firstVertex = mesh.vertexCount(), firstTriangle = mesh.triangleCount();
  std::vector<int> vertices(part.mNumVertices, -1);
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    if (!kept[v]) continue;
    vertices[v] = static_cast<int>(mesh.vertexCount());
    mesh.positions.emplace_back(instance.toScene * vector(part.mVertices[v]));
    if (!texcoords) continue;
    const aiVector3D texcoord = part.HasTextureCoords(0) ? part.mTextureCoords[0][v] : aiVector3D();
    mesh.texcoords.emplace_back(texcoord.x, texcoord.y);
  }
  appendTriangles(instance, vertices, mesh);
  if (normals) appendNormals(instance, kept, firstVertex, firstTriangle, mesh);
}

Result<TriangleMesh> collect(const std::string& path, const aiScene& scene) {
  const std::vector<Instance> parts = instances(scene);
  bool texcoords = false, normals = false;
  std::size_t vertexCount = 0;
  for (const Instance& part : parts) {
    texcoords = texcoords || part.mesh->HasTextureCoords(0);
    normals = normals || part.mesh->HasNormals();
    vertexCount += part.mesh->mNumVertices;
  }
  if (vertexCount > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return fileError(StatusCode::UnsupportedFormat, path, 0, "has more than 2147483647 vertices; split the model");
  }
  TriangleMesh mesh;
  mesh.positions.reserve(vertexCount);
  for (const Instance& part : parts) {
    const std::size_t firstTriangle = mesh.triangleCount();
    append(part, texcoords, normals, mesh);
    assert((normals ? mesh.vertexCount() : 0) == mesh.normals.size());
    assert((texcoords ? mesh.vertexCount() : 0) == mesh.texcoords.size());
    mesh.groups.push_back(groupOf(scene, part, mesh, firstTriangle));
  }
  if (mesh.triangles.empty()) {
    return fileError(StatusCode::Empty, path, 0, "has no triangles; export the model as a surface of polygons");
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

Status checkPath(const std::string& path, const Assimp::Importer& importer) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return fileError(StatusCode::FileNotFound, path, 0, "does not exist; check the path");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    return fileError(StatusCode::FileNotFound, path, 0, "is a folder; give the path of a file");
  }
  const std::string extension = lowerExtension(path);
  if (!extension.empty() && importer.IsExtensionSupported(extension)) return {};
  return fileError(
      StatusCode::UnsupportedFormat, path, 0,
      (extension.empty() ? "has no file name extension" : "unsupported input format " + excerpt(extension)) +
          "; convert it to OBJ, PLY, STL or glTF");
}

Result<TriangleMesh> importFile(const std::string& path) {
  Assimp::Importer importer;
  Status status = checkPath(path, importer);
  if (status.ok()) status = checkStatedSizes(path);
  if (!status.ok()) return status;
  // A file that contains only bones would otherwise appear as a mesh of its bones.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // None of assimp's post-processing is used: it trusts the scene, and aborts on damaged ones.
  const aiScene* scene = importer.ReadFile(path, 0);
  if (!scene) {
    return fileError(StatusCode::Malformed, path, 0,
                     "cannot be read: " + std::string(importer.GetErrorString()) + "; export the model again");
  }
  status = checkFaces(path, *scene);
  if (!status.ok()) return status;
  return collect(path, *scene);
}

}  // namespace

Result<TriangleMesh> readWithAssimp(const std::string& path) {
  try {
    return importFile(path);
  } catch (const std::exception& error) {
    return fileError(StatusCode::Malformed, path, 0,
                     "cannot be read: " + std::string(error.what()) + "; export the model again");
  } catch (...) {
    return fileError(StatusCode::Malformed, path, 0, "cannot be read; export the model again");
  }
}

}  // namespace tetskin::io
