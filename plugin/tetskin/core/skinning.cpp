// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/skinning.h>

#include <algorithm>
#include <cmath>

namespace tetskin {

template <class Scalar>
std::size_t PackedNodes<Scalar>::pack(PointView<const Scalar> positions) {
  assert(positions.size() == size());
  Point sum = Point::Zero();
  Scalar largest[3] = {};  // one for each axis, as one for all would be a chain of three times the length
  Scalar* to = nodes_.empty() ? nullptr : nodes_.front().data();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Scalar* p = positions[i];
    for (int k = 0; k < 3; ++k) {
      to[4 * i + static_cast<std::size_t>(k)] = p[k];
      sum[k] += p[k];
      largest[k] = std::max(largest[k], std::abs(p[k]));  // passes over what is not a number: the sum does not
    }
  }
  const bool tooLarge = std::max({largest[0], largest[1], largest[2]}) > static_cast<Scalar>(kLargestCoordinate);
  if (!sum.allFinite() || tooLarge) return firstUnusable(positions);
  // Differences to a point among the nodes are nearly exact, however far they all are from the origin.
  mean_ = sum / static_cast<Scalar>(std::max<std::size_t>(1, size()));
  const Node mean(mean_[0], mean_[1], mean_[2], Scalar(0));
  for (Node& node : nodes_) node -= mean;
  return size();
}

template class PackedNodes<float>;
template class PackedNodes<double>;

}  // namespace tetskin
