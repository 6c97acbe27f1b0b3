// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/skinning/skinning.h>

namespace tetskin {

/// Writes the current position of every vertex, x(v) = p3 + b0 (p0-p3) + b1 (p1-p3) + b2 (p2-p3).
///
/// embedding  shared, read only
/// nodes      nodeCount current positions, world space
/// bounds     if given, becomes the box of the positions written
/// threads    if given, lends its threads to large meshes
/// Cost       O(vertexCount), no allocation; cannot fail, sizes are asserted
template <class Scalar, class Out>
void skinLinear(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const SkinOutput<Scalar, Out>& output,
                Box3* bounds = nullptr, ParallelFor* threads = nullptr);

}  // namespace tetskin
