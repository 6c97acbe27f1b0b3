// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/animation/glb_scene.h>

#include <functional>

namespace tetskin::io {

/// The number of a material, by its name, and whether the mesh has texture coordinates.
using MaterialNumber = std::function<std::size_t(const std::string& name, bool textured)>;

/// A mesh in GLB form: triangles by material, without those that name a vertex twice.
/// origin  subtracted from every position
GlbMesh rigidGeometry(const std::string& name, const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                      const MaterialNumber& materialNumber);

/// The same with the four bones of each vertex. `bones` are the nodes of the cage that carry vertices, ascending: a
/// vertex refers to them by their index in this list.
GlbMesh skinnedGeometry(const std::string& name, const Cage& cage, const TriangleMesh& mesh, const Embedding& embedding,
                        Interpolation interpolation, const std::vector<std::size_t>& bones,
                        const Eigen::Vector3d& origin, const MaterialNumber& materialNumber);

/// The nodes that have a weight in some vertex, ascending.
std::vector<std::size_t> bonesOf(const Embedding& embedding);

/// A name as UTF-8, which glTF requires: if it is not valid, each byte that is not ASCII becomes a question mark.
std::string asUtf8(std::string name);

}  // namespace tetskin::io
