// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/skinning/skinning.h>

#include <algorithm>
#include <cmath>

namespace tetskin {

template <class Scalar>
std::size_t PackedNodes<Scalar>::pack(PointView<const Scalar> positions) {
  assert(positions.size() == size());
  if (nodes_.empty()) return 0;
  using Four = Eigen::Matrix<Scalar, 4, 1>;
  const auto packed = [&](std::size_t i) { return Eigen::Map<Four, Eigen::Aligned16>(nodes_[i].scalars); };
  // Two sums of each, because an addition would have to wait for the previous one.
  Four sum[2] = {Four::Zero(), Four::Zero()}, largest[2] = {Four::Zero(), Four::Zero()};
  const auto add = [](const Four& p, Four& total, Four& maximum) {
    total += p;
    maximum = maximum.cwiseMax(p.cwiseAbs());  // skips NaN, which the sum does not
  };
  // Each point is read with the scalar behind it, which may not exist for the last one.
  const std::size_t last = size() - 1;
  for (std::size_t i = 0; i + 2 <= last; i += 2) {
    const Four p = Eigen::Map<const Four>(positions[i]), q = Eigen::Map<const Four>(positions[i + 1]);
    packed(i) = p;
    packed(i + 1) = q;
    add(p, sum[0], largest[0]);
    add(q, sum[1], largest[1]);
  }
  for (std::size_t i = last - last % 2; i <= last; ++i) {
    packed(i) << Eigen::Map<const Point>(positions[i]), Scalar(0);
    add(packed(i), sum[0], largest[0]);
  }
  const Point total = (sum[0] + sum[1]).template head<3>();
  const Scalar maximum = largest[0].cwiseMax(largest[1]).template head<3>().maxCoeff();
  if (!total.allFinite() || maximum > static_cast<Scalar>(Limits::kMaxCoordinate)) return firstUnusable(positions);
  // Differences from a point among the nodes are nearly exact, however far they all are from the origin.
  mean_ = total / static_cast<Scalar>(size());
  const Four mean(mean_[0], mean_[1], mean_[2], Scalar(0));
  for (std::size_t i = 0; i < size(); ++i) {
    packed(i) -= mean;
    nodes_[i].scalars[3] = 0;
  }
  return size();
}

TETSKIN_INSTANTIATE_CLASS(PackedNodes)

}  // namespace tetskin
