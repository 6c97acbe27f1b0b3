// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>
#include <tetskin/core/types.h>

#include <cstdint>
#include <vector>

namespace tetskin {

/// Which parts of a surface an update has to compute: those that depend on a node that has moved since the last one.
/// Each body has its own.
template <class Scalar>
class MovedParts {
 public:
  MovedParts() = default;
  /// stencils  those of the embedding, if the surface is quadratic; null if it is linear
  MovedParts(const Embedding& embedding, const QuadraticStencils<Scalar>* stencils);

  /// Compares the nodes, world space, with those of the last call, and keeps them. Returns whether any has moved. Cost
  /// O(nodes), and where only some have moved O(runs), for quadratic surfaces O(nodes x neighbours); no allocation.
  [[nodiscard]] bool update(const Embedding& embedding, const QuadraticStencils<Scalar>* stencils,
                            PointView<const Scalar> nodes);
  /// Everything counts as moved at the next update.
  void forget() { known_ = false; }

  /// By run of the embedding: 0 where its points stay as they are. Null where all have moved.
  const std::uint8_t* runs() const { return someStill_ ? runs_.data() : nullptr; }
  /// By node with a gradient: 0 where that stays as it is. Null where all have moved.
  const std::uint8_t* gradients() const { return someStill_ ? gradients_.data() : nullptr; }

 private:
  void findRuns(const Embedding& embedding);
  void findRuns(const QuadraticStencils<Scalar>& stencils);

  std::vector<Eigen::Matrix<Scalar, 3, 1>> last_;
  std::vector<std::uint8_t> nodes_, gradients_, edges_, runs_;
  bool known_ = false;  ///< last_ is what the surface was computed from
  bool someStill_ = false;
};

}  // namespace tetskin
