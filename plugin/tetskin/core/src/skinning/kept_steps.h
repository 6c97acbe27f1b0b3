// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <vector>

namespace tetskin {

/// The nodes of a body after its last two steps, for an application that draws frames between them. No memory until a
/// step is kept, then six scalars a node; each skin has its own.
template <class Scalar>
class KeptSteps {
 public:
  /// Keeps the nodes as they are after a step, world space, and lets those kept last be the step before. Returns
  /// whether there are both, so that there is something between them: not the first time, nor after `forget`, nor while
  /// a node of either is not finite or beyond kLargestCoordinate. Allocates the first time, or for another number of
  /// nodes, which begins anew. Cost O(nodes).
  bool keep(PointView<const Scalar> nodes);
  /// The next step does not begin where the last one ended: after a teleport, say.
  void forget() { usable_ = between_ = false; }

  std::size_t size() const { return last_.size(); }
  bool empty() const { return last_.empty(); }
  /// Writes the step before plus alpha times the way to the last one; the last one where there is none before.
  /// alpha  from 0 to 1, where the result is the last step's to the bit; counts as the nearer of the two beyond them,
  ///        and as 1 if it is not a number
  /// out    size() x 3, of the caller's, any stride
  void nodesAt(Scalar alpha, PointView<Scalar> out) const;

 private:
  std::vector<Eigen::Matrix<Scalar, 3, 1>> before_, last_;
  bool usable_ = false;   ///< last_ is where the next step begins
  bool between_ = false;  ///< so was before_ for last_
};

}  // namespace tetskin
