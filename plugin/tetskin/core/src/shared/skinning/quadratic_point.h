// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Quadratic skinning of single points, without the rest of the surface.
#pragma once

#include <tetskin/core/embedded_point.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <functional>

namespace tetskin {

/// Current positions by node index, world space.
template <class Scalar>
using NodePositions = std::function<Eigen::Matrix<Scalar, 3, 1>(int node)>;

/// Where `skinQuadratic` puts a point, but for rounding: bends are summed up in double here.
/// embedding  that of the stencils. The point may be another's of the same cage: in a tet without vertices of this
///            embedding nothing is known of bends, and it is where linear skinning has it
/// Cost       some 100 nodes are asked for, no allocation
template <class Scalar>
TETSKIN_CORE_API Eigen::Matrix<Scalar, 3, 1> quadraticPosition(const EmbeddedPoint<Scalar>& point,
                                                               const Embedding& embedding,
                                                               const QuadraticStencils<Scalar>& stencils,
                                                               const NodePositions<Scalar>& positionOf);

}  // namespace tetskin
