// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/scene_mesh.h>
#include <tetskin/io/src/mesh/unit_normal.h>
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

/// Assimp's flags are wrong for damaged files, so the faces are tested.
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

/// vertices  by vertex of the mesh: its number in the part, or -1
void appendTriangles(const Instance& instance, const std::vector<int>& vertices, ScenePart& part) {
  assert(vertices.size() == instance.mesh->mNumVertices);
  const bool mirrored = instance.toScene.linear().determinant() < 0.0;
  std::vector<int> polygon;
  for (unsigned f = 0; f < instance.mesh->mNumFaces; ++f) {
    const aiFace& face = instance.mesh->mFaces[f];
    if (!isSurface(face)) continue;
    polygon.clear();
    for (unsigned i = 0; i < face.mNumIndices; ++i) polygon.push_back(vertices[face.mIndices[i]]);
    if (mirrored) std::reverse(polygon.begin() + 1, polygon.end());
    appendPolygon(part.positions, polygon, part.triangles);
  }
}

TriangleGroup groupOf(const aiScene& scene, const Instance& instance) {
  TriangleGroup group;
  group.name = instance.mesh->mName.length > 0 ? instance.mesh->mName.C_Str() : instance.node->mName.C_Str();
  if (instance.mesh->mMaterialIndex < scene.mNumMaterials) {
    group.material = scene.mMaterials[instance.mesh->mMaterialIndex]->GetName().C_Str();
  }
  // The material that assimp adds to a file without materials does not count.
  if (group.material == AI_DEFAULT_MATERIAL_NAME) group.material.clear();
  return group;
}

ScenePart partOf(const aiScene& scene, const Instance& instance) {
  const aiMesh& mesh = *instance.mesh;
  const std::vector<bool> kept = keptVertices(mesh);
  const Eigen::Matrix3d normals = normalMatrix(instance.toScene.linear());
  ScenePart part;
  std::vector<int> vertices(mesh.mNumVertices, -1);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    if (!kept[v]) continue;
    vertices[v] = static_cast<int>(part.positions.size());
    part.positions.emplace_back(instance.toScene * vector(mesh.mVertices[v]));
    if (mesh.HasNormals()) part.normals.push_back(unitNormal(normals * vector(mesh.mNormals[v])));
    if (mesh.HasTextureCoords(0)) part.texcoords.emplace_back(mesh.mTextureCoords[0][v].x, mesh.mTextureCoords[0][v].y);
  }
  appendTriangles(instance, vertices, part);
  part.groups.push_back(groupOf(scene, instance));
  part.groups.back().triangleCount = part.triangles.size();
  return part;
}

Result<TriangleMesh> collect(const std::string& path, const aiScene& scene) {
  std::vector<ScenePart> parts;
  for (const Instance& instance : instances(scene)) parts.push_back(partOf(scene, instance));
  return joinParts(path, parts);
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
  if (!status.ok()) return status;
  // Otherwise a file that contains only bones would appear as a mesh of its bones.
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
