// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/median.h>
#include <tetskin/core/src/search/search_cage.h>

#include <algorithm>
#include <cassert>

namespace tetskin {
namespace {

/// Approximate number of tets whose median is computed. It affects only the cost.
constexpr std::size_t kSample = 1000;

}  // namespace

SearchTet::SearchTet(const TetMesh& mesh, int tetIndex)
    : index(tetIndex),
      corners(cornersOf(mesh, mesh.tets[static_cast<std::size_t>(tetIndex)])),
      box(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2].cwiseMin(corners[3])),
          corners[0].cwiseMax(corners[1]).cwiseMax(corners[2].cwiseMax(corners[3]))) {}

SearchCage::SearchCage(const TetMesh& mesh) : mesh_(mesh) {
  solid_.reserve(mesh.tetCount());
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const SearchTet tet(mesh, static_cast<int>(t));
    if (isFlat(tet.corners)) continue;
    solid_.push_back(tet.index);
    box_.extend(tet.box);
    largestSize_ = std::max(largestSize_, tetSize(tet.corners));
    largestSlack_ = std::max(largestSlack_, tet.slack());
  }
  assert(!solid_.empty());
  std::vector<double> sides;
  for (std::size_t i = 0; i < size(); i += size() / kSample + 1) sides.push_back((*this)[i].box.sizes().maxCoeff());
  medianSide_ = median(std::move(sides));
  assert(medianSide_ > 0.0 && medianSide_ <= box_.sizes().maxCoeff());
}

}  // namespace tetskin
