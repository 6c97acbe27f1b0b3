// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How the tets of a body are stretched along given directions.
#pragma once

#include <tetskin/elastic/src/tets/rest_tets.h>

#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

/// By tet of the cage: the number of its linear tet at rest; those of quadratic ones, for their parts, follow.
std::vector<std::uint32_t> tetNumbers(const RestTets& rest);

/// Lives no longer than what it refers to.
struct TetStretches {
  const RestTets& rest;
  const std::vector<std::uint32_t>& numbers;  ///< see `tetNumbers`
  const std::vector<std::uint32_t>& slotOf;   ///< by node
  const double* places;                       ///< positions, 3 scalars by slot

  /// The length of F v, with F the mean deformation gradient of the tet, or of the quadratic tet that it is a part of.
  /// tet  of the cage
  double length(std::size_t tet, const Eigen::Vector3d& v) const;
};

}  // namespace tetskin::elastic_detail
