// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/types.h>

#include <vector>

namespace tetskin {

/// Current node positions side by side, each padded to four scalars: what the skinning kernels read. A Bullet node is
/// some 400 bytes; gathering the positions once is cheaper than striding over them for every tet.
template <class Scalar>
using PackedNodes = std::vector<Eigen::Matrix<Scalar, 4, 1>, Eigen::aligned_allocator<Eigen::Matrix<Scalar, 4, 1>>>;

/// Copies positions into `packed`, whose size must be theirs. Returns false if one is not finite; `packed` is written
/// all the same. Cost O(nodeCount), no allocation.
template <class Scalar>
bool packNodes(PointView<const Scalar> positions, PackedNodes<Scalar>& packed);

/// Writes the current position of every vertex, x(v) = p3 + b0 (p0-p3) + b1 (p1-p3) + b2 (p2-p3), and returns their
/// box.
///
/// embedding  shared, read only
/// nodes      nodeCount current positions, world space
/// origin     subtracted from every result before it is rounded to Out: a local origin near the body keeps float
///            output exact far from the world's origin
/// out        vertexCount x 3, caller-owned, any stride; each point is written exactly once, in the mesh's order
/// Cost       O(vertexCount), no allocation; cannot fail, sizes are asserted
template <class Scalar, class Out>
Box3 skinLinear(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const Eigen::Matrix<Scalar, 3, 1>& origin,
                PointView<Out> out);

}  // namespace tetskin
