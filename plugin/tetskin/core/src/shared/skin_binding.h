// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a SkinBinding holds, and the checks that skins share.
#pragma once

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/normals/normals.h>
#include <tetskin/core/src/normals/recomputed_normals.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <optional>

namespace tetskin {

template <class Scalar>
struct SkinParts {
  BindingOptions options;
  Embedding embedding;
  std::optional<QuadraticStencils<Scalar>> quadratic;
  QuadraticReport quadraticReport;
  std::optional<DirectionFactors> normals;   ///< of transformed normals
  std::optional<DirectionFactors> tangents;  ///< likewise, if the mesh has tangents
  std::optional<NormalTopology> recomputed;  ///< of recomputed normals
};

/// Ok if a surface can follow these nodes: NonFinite names the first that is not finite, or beyond kLargestCoordinate.
template <class Scalar>
TETSKIN_CORE_API Status checkNodes(PointView<const Scalar> nodes);

/// Ok if positions can be relative to this.
Status checkOrigin(const Eigen::Vector3d& origin);

/// All that can be known of a skin's options before anything is embedded.
TETSKIN_CORE_API Status checkInstance(const InstanceOptions& options, std::size_t vertexCount);

}  // namespace tetskin
