// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Quadratic skinning of single points, without the rest of the surface.
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <functional>

namespace tetskin {

/// Current positions by node index, world space.
template <class Scalar>
using NodePositions = std::function<Eigen::Matrix<Scalar, 3, 1>(int node)>;

/// The position that `skinPoints` gives a point, except for rounding: edge vectors are summed in double here.
/// embedding  that of the stencils. The point may belong to another embedding of the same cage: a tet without vertices
///            of this embedding has no edge vectors, so the position is that of linear skinning
/// Cost       reads some 100 nodes, no allocation
template <class Scalar>
TETSKIN_CORE_API Eigen::Matrix<Scalar, 3, 1> quadraticPosition(const EmbeddedPoint<Scalar>& point,
                                                               const Embedding& embedding,
                                                               const QuadraticStencils<Scalar>& stencils,
                                                               const NodePositions<Scalar>& positionOf);

}  // namespace tetskin
