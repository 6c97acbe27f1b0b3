// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/skinning.h>

namespace tetskin {

template <class Scalar>
std::size_t PackedNodes<Scalar>::pack(PointView<const Scalar> positions) {
  assert(positions.size() == size());
  Node sum = Node::Zero();
  Scalar check = 0;  // stays 0 unless a coordinate is infinite or not a number
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Scalar* p = positions[i];
    nodes_[i] = {p[0], p[1], p[2], Scalar(0)};
    sum += nodes_[i];
    check += p[0] * 0 + p[1] * 0 + p[2] * 0;
  }
  if (!(check == 0)) return firstNonFinite(positions);
  // Differences to a point among the nodes are nearly exact, however far they all are from the origin.
  const Node mean = sum / static_cast<Scalar>(std::max<std::size_t>(1, size()));
  mean_ = mean.template head<3>();
  for (Node& node : nodes_) node -= mean;
  return size();
}

template class PackedNodes<float>;
template class PackedNodes<double>;

}  // namespace tetskin
