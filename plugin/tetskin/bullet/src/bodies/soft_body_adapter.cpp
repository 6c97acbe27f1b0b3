// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/dangling_nodes.h>

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// Index of the node, or -1. Pointers are compared as numbers, because dangling ones must not be subtracted.
int indexOf(const btSoftBody::Node* node, const btSoftBody& body) {
  if (body.m_nodes.size() == 0) return -1;
  const auto address = reinterpret_cast<std::uintptr_t>(node);
  const auto begin = reinterpret_cast<std::uintptr_t>(&body.m_nodes[0]);
  const std::uintptr_t offset = address - begin;
  const std::uintptr_t size = sizeof(btSoftBody::Node);
  const bool inside = address >= begin && offset < size * static_cast<std::uintptr_t>(body.m_nodes.size());
  return inside && offset % size == 0 ? static_cast<int>(offset / size) : -1;
}

}  // namespace

PointView<const btScalar> nodePositions(const btSoftBody& body) {
  if (body.m_nodes.size() == 0) return {};
  return {&body.m_nodes[0].m_x.m_floats[0], static_cast<std::size_t>(body.m_nodes.size()), sizeof(btSoftBody::Node)};
}

TetMesh readTetMesh(const btSoftBody& body) {
  TetMesh mesh;
  mesh.nodes.resize(static_cast<std::size_t>(body.m_nodes.size()));
  for (int i = 0; i < body.m_nodes.size(); ++i) mesh.nodes[i] = toEigen(body.m_nodes[i].m_x);
  mesh.tets.resize(static_cast<std::size_t>(body.m_tetras.size()));
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    for (int k = 0; k < 4; ++k) mesh.tets[t][k] = indexOf(body.m_tetras[t].m_n[k], body);
  }
  return mesh;
}

Status bullet_detail::checkDangling(const TetMesh& read) {
  const auto dangles = [](const Tet& tet) { return std::find(tet.begin(), tet.end(), -1) != tet.end(); };
  const auto count = std::count_if(read.tets.begin(), read.tets.end(), dangles);
  if (count == 0) return {};
  const auto first = std::find_if(read.tets.begin(), read.tets.end(), dangles) - read.tets.begin();
  return {StatusCode::IndexOutOfRange,
          std::to_string(count) + " of the body's " + std::to_string(read.tetCount()) + " tets, tet " +
              std::to_string(first) +
              " the first, refer to nodes where they were before Bullet moved them in memory (appendNode, refine, "
              "cutLink); pass SoftBodySkin::bind a restCage of all nodes of the body, or create the body again"};
}

PointView<float> positionView(const btCPUVertexBufferDescriptor& buffer, std::size_t vertexCount) {
  assert(buffer.hasVertexPositions());
  return {buffer.getBasePointer() + buffer.getVertexOffset(), vertexCount,
          static_cast<std::size_t>(buffer.getVertexStride()) * sizeof(float)};
}

}  // namespace tetskin
