// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The tets of a body at rest, linear and quadratic ones, and where each writes its corners for the matrix.
#pragma once

#include <tetskin/elastic/src/base/elastic_kernels.h>
#include <tetskin/elastic/src/tets/rest_quadratic_tets.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetskin::elastic_detail {

/// A body's tets at rest, none of them flat. Linear tets are those that are not part of a quadratic one.
struct RestTets {
  std::vector<Tet> tets;
  std::vector<std::array<double, 9>> gradients;  ///< by rows: of the weights of nodes 1, 2 and 3, rest space
  std::vector<double> volumes;                   ///< above 0: volume times stiffness factor
  std::vector<std::uint32_t> cageTets;           ///< which tet of the cage each is
  std::vector<RestQuadraticTet> quadratic;
  /// Nodes at rest, rest space: the tets have these shapes, to the last digit. Empty: unknown.
  std::vector<Eigen::Vector3d> nodes;

  std::size_t count() const { return tets.size(); }
  bool empty() const { return tets.empty() && quadratic.empty(); }

  // Corners are points from which the matrix is assembled, see kernels::kCorners: those of linear tets, then some that
  // are 0, then those of quadratic tets.
  static constexpr std::size_t kCornersPerNode = kernels::QuadraticPack<float>::kCornersPerNode;
  static std::size_t padded(std::size_t tets) {
    return (tets + kernels::kGroup - 1) / kernels::kGroup * kernels::kGroup;
  }
  std::size_t zeroCorner() const { return 4 * padded(tets.size()); }
  /// The first corner of a quadratic tet, or of one of its nodes.
  std::size_t quadraticCorner(std::size_t tet, std::size_t node = 0) const {
    return zeroCorner() + kCornersPerNode * (1 + kQuadraticNodes * tet + node);
  }
  std::size_t cornerCount() const { return quadraticCorner(padded(quadratic.size())); }
};

/// The tets of a cage without flat ones.
/// quadratic       see `quadraticTets`
/// stiffnessScale  by tet of the cage, above 0; empty: the cage's own
/// Cost            O(T); O(64 T) for partly filled quadratic tets
TETSKIN_ELASTIC_API RestTets restTets(const Cage& cage, const std::vector<QuadraticTet>& quadratic = {},
                                      const std::vector<double>& stiffnessScale = {});

/// Finds nodes at rest from the shapes of linear tets, each component starting at one of its nodes; nodes of no tet are
/// at 0. Does not check whether the shapes fit together: `takeRestShapes` does. Cost O(T)
TETSKIN_ELASTIC_API void findRestNodes(RestTets& linear, std::size_t nodes);

/// Replaces the shapes of linear tets by those of their nodes, in double, if all of them agree already, up to a share
/// of a tet's size if given. Otherwise, or if the nodes make flat tets, the tets stay as they are, without nodes, and
/// the result is false. Cost O(T)
TETSKIN_ELASTIC_API bool takeRestShapes(RestTets& linear, double tolerance = std::numeric_limits<double>::infinity());

}  // namespace tetskin::elastic_detail
