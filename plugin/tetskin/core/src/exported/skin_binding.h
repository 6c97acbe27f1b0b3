// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The data of a SkinBinding, and checks that skins share.
#pragma once

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/normals/normals.h>
#include <tetskin/core/src/normals/recomputed_normals.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <optional>
#include <vector>

namespace tetskin {

template <class Scalar>
struct SkinData {
  BindingOptions options;
  Embedding embedding;
  std::vector<Scalar> restNodes;  ///< 4 per node: its rest position, and a 0
  std::optional<QuadraticStencils<Scalar>> quadratic;
  QuadraticReport quadraticReport;
  std::optional<DirectionFactors> normals;   ///< for transformed normals
  std::optional<DirectionFactors> tangents;  ///< for tangents, if the mesh has any
  std::optional<NormalTopology> recomputed;  ///< for recomputed normals
};

template <class Scalar>
struct Access<SkinBinding<Scalar>> {
  static const SkinData<Scalar>& data(const SkinBinding<Scalar>& binding) { return *binding.data_; }
};

/// The contents of a binding, valid as long as the binding.
template <class Scalar>
const SkinData<Scalar>& dataOf(const SkinBinding<Scalar>& binding) {
  return Access<SkinBinding<Scalar>>::data(binding);
}

/// Ok if a surface can follow these nodes. NonFinite names the first node that is not finite or beyond
/// Limits::kMaxCoordinate.
template <class Scalar>
TETSKIN_CORE_API Status checkNodes(PointView<const Scalar> nodes);

/// Ok if positions can be relative to this origin.
Status checkOrigin(const Eigen::Vector3d& origin);

/// All checks of a skin's options that are possible before anything is embedded.
TETSKIN_CORE_API Status checkInstance(const InstanceOptions& options, std::size_t vertexCount);

}  // namespace tetskin
