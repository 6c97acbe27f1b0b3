// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodySolverVertexBuffer.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/types.h>

namespace tetskin {

// tetskin::bullet was configured for one precision; code that includes this in the other would corrupt memory silently.
#ifdef TETSKIN_BULLET_DOUBLE
static_assert(sizeof(btScalar) == 8, "tetskin was built for Bullet in double; compile with BT_USE_DOUBLE_PRECISION");
#else
static_assert(sizeof(btScalar) == 4, "tetskin was built for Bullet in float; compile without BT_USE_DOUBLE_PRECISION");
#endif

/// The current node positions, world space, in place: valid until the body's nodes are appended to or it is destroyed.
PointView<const btScalar> nodePositions(const btSoftBody& body);

/// The body's tets with its nodes as they are now, by index: node i is `body.m_nodes[i]`, tet t is `body.m_tetras[t]`.
/// Nothing is repaired. A tet whose node pointers do not point into the node array (Bullet leaves them dangling when
/// nodes are appended after tets) gets the index -1, which every check reports. Cost O(nodes + tets).
TetMesh tetMeshOf(const btSoftBody& body);

/// IndexOutOfRange if there are such tets in what `tetMeshOf` has read: how many, why, and what to do.
Status checkDangling(const TetMesh& read);

/// The positions of a Bullet vertex buffer, as a target for skinning: vertexCount points, owned by the buffer's owner.
PointView<float> positionsOf(const btCPUVertexBufferDescriptor& buffer, std::size_t vertexCount);

inline Eigen::Vector3d toEigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
inline btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

}  // namespace tetskin
