// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to embedding: the cage in the form that the searches use.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin {

inline Box3 grown(const Box3& box, double border) {
  const Eigen::Vector3d b = Eigen::Vector3d::Constant(border);
  return {box.min() - b, box.max() + b};
}

/// Query boxes are larger than the exact ones by this fraction of the sum of their sides, which is at least the tet's
/// size. A weight of a tet just above kFlatTet can be wrong by 1e-7, and a vertex that far outside would still test as
/// inside.
constexpr double kBoxSlack = 1e-6;

/// A tet with the data that every search needs.
struct SearchTet {
  int index;           ///< index in the cage
  TetCorners corners;  ///< rest space
  Box3 box;            ///< of the corners

  SearchTet(const TetMesh& mesh, int tetIndex);
  double slack() const { return kBoxSlack * box.sizes().sum(); }
};

/// The tets of a cage that are not flat. They are read from the cage each time: this is no slower than reading a list
/// of them, and such a list would be as large as millions of vertices.
class SearchCage {
 public:
  /// The cage must be usable and outlive this.
  explicit SearchCage(const TetMesh& mesh);

  const TetMesh& mesh() const { return mesh_; }
  std::size_t size() const { return solid_.size(); }
  SearchTet operator[](std::size_t i) const { return {mesh_, solid_[i]}; }
  /// The corners of any tet of the cage, by its index there.
  TetCorners corners(std::int32_t tet) const { return cornersOf(mesh_, mesh_.tets[static_cast<std::size_t>(tet)]); }

  const Box3& box() const { return box_; }
  double largestSize() const { return largestSize_; }
  double largestSlack() const { return largestSlack_; }
  /// Median of the longest sides of the tets' boxes; of a sample if there are many.
  double medianSide() const { return medianSide_; }

 private:
  const TetMesh& mesh_;
  std::vector<int> solid_;  ///< indices in the cage, ascending
  Box3 box_;
  double largestSize_ = 0.0;
  double largestSlack_ = 0.0;
  double medianSide_ = 0.0;
};

}  // namespace tetskin
