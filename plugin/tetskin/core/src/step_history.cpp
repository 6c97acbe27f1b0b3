// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/instantiate.h>

#include <algorithm>

namespace tetskin {

template <class Scalar>
bool StepHistory<Scalar>::record(PointView<const Scalar> nodes) {
  if (nodes.size() != size()) clear();
  before_.swap(last_);
  for (auto* copy : {&before_, &last_}) copy->resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) std::copy_n(nodes[i], 3, last_[i].data());
  const bool begun = usable_;
  usable_ = firstUnusable(viewOf(std::as_const(last_))) == size();
  between_ = begun && usable_;
  return between_;
}

template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> StepHistory<Scalar>::nodeAt(std::size_t node, Scalar alpha) const {
  assert(node < size());
  if (!between_ || !(alpha < 1)) return last_[node];
  return before_[node] + std::max(alpha, Scalar(0)) * (last_[node] - before_[node]);
}

template <class Scalar>
void StepHistory<Scalar>::nodesAt(Scalar alpha, PointView<Scalar> out) const {
  assert(out.size() == size());
  for (std::size_t i = 0; i < size(); ++i) std::copy_n(nodeAt(i, alpha).data(), 3, out[i]);
}

TETSKIN_INSTANTIATE_CLASS(StepHistory)

}  // namespace tetskin
