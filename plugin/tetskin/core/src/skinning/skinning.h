// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The common part of linear and quadratic skinning: the current nodes as the kernels read them, and where the points
// go.
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/types.h>

#include <vector>

namespace tetskin {

/// Current node positions side by side, each padded to four scalars, relative to their mean, for the kernels. A Bullet
/// node has some 400 bytes; gathering the positions once is cheaper than striding over them for every tet.
template <class Scalar>
class PackedNodes {
 public:
  using Point = Eigen::Matrix<Scalar, 3, 1>;

  explicit PackedNodes(std::size_t nodeCount = 0) : nodes_(nodeCount) {}

  /// Copies positions, whose number must be size(). Returns the index of the first that is not finite or is beyond
  /// Limits::kMaxCoordinate (the packed nodes are then unusable), or size(). Cost O(nodeCount), no allocation.
  [[nodiscard]] std::size_t pack(PointView<const Scalar> positions);

  std::size_t size() const { return nodes_.size(); }
  /// size() x 3, four scalars apart: positions computed for packing may be written here, and packed in place.
  PointView<Scalar> memory() { return {nodes_.empty() ? nullptr : nodes_.front().scalars, size(), 4 * sizeof(Scalar)}; }
  /// size() x 4: position minus mean(), and a 0.
  const Scalar* data() const { return nodes_.empty() ? nullptr : nodes_.front().scalars; }
  const Point& mean() const { return mean_; }

 private:
  /// Not an Eigen type: its alignment, and how Eigen frees it, depend on the flags with which each file is compiled, in
  /// the application and here.
  struct alignas(4 * sizeof(Scalar)) Node {
    Scalar scalars[4] = {};
  };
  std::vector<Node> nodes_;
  Point mean_ = Point::Zero();
};

/// Size of the scratch memory, in scalars, for a number of vertices.
constexpr std::size_t scratchSize(std::size_t vertexCount) {
  return 3 * vertexCount + 1;
}

/// Where and how the points of an update are written.
template <class Scalar, class Out>
struct SkinOutput {
  /// vertexCount x 3, caller-owned, any stride; never read. Memory between and beyond the points is not changed.
  PointView<Out> points;
  VertexOrder order = VertexOrder::Mesh;
  /// World space; subtracted from every result before it is rounded to Out: a local origin near the body keeps float
  /// output exact far from the world's origin.
  Eigen::Matrix<Scalar, 3, 1> origin = Eigen::Matrix<Scalar, 3, 1>::Zero();
  /// scratchSize(vertexCount) scalars of the caller's, overwritten. Contiguous points of type Scalar in sorted order
  /// are written directly and need none; all others are copied to their positions from here. Without it, memory is
  /// allocated each time.
  Scalar* scratch = nullptr;
  /// If not null, vertexCount x 4 scalars of the caller's that also get the points, in the same order, each with one
  /// meaningless scalar, for callers that need to read them. All points are then written to the scratch memory first.
  Scalar* padded = nullptr;
};

}  // namespace tetskin
