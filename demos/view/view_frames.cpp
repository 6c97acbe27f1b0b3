// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "view/view_frames.h"

#include <cassert>

namespace tetskin::view {

void ViewFrames::keep(const ViewMoment& moment) {
  if (told_ == 0) {
    Box3 box;
    for (const auto& nodes : moment.bodies) box.extend(boundingBox(nodes));
    if (!box.isEmpty()) origin_ = box.center();
  }
  if (told_++ % static_cast<std::size_t>(stride_) != 0) return;
  assert(moments_.empty() || (moment.bodies.size() == bodyCount() && moment.props.size() == propCount()));
  Moment& kept = moments_.emplace_back();
  for (const auto& nodes : moment.bodies) {
    std::vector<float>& numbers = kept.bodies.emplace_back();
    numbers.reserve(3 * nodes.size());
    for (const Eigen::Vector3d& p : nodes) {
      for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<float>(p[k] - origin_[k]));
    }
  }
  for (Eigen::Affine3d where : moment.props) {
    where.pretranslate(-origin_);
    kept.props.emplace_back(where.matrix().cast<float>());
  }
  if (moments_.size() > 2 && moments_.size() * bytesOf(kept) > maxBytes_) leaveOutEverySecond();
}

Box3 ViewFrames::box(std::size_t moment) const {
  Box3 box;
  for (const std::vector<float>& nodes : moments_[moment].bodies) {
    if (!nodes.empty()) box.extend(boundingBox(PointView<const float>(nodes.data(), nodes.size() / 3)));
  }
  return box;
}

/// Bytes in the page: 16 bits per coordinate, 12 floats per prop.
std::size_t ViewFrames::bytesOf(const Moment& moment) const {
  std::size_t bytes = moment.props.size() * 12 * sizeof(float);
  for (const std::vector<float>& nodes : moment.bodies) bytes += 2 * nodes.size();
  return bytes;
}

void ViewFrames::leaveOutEverySecond() {
  const std::size_t count = (moments_.size() + 1) / 2;
  for (std::size_t k = 1; k < count; ++k) moments_[k] = std::move(moments_[2 * k]);
  moments_.resize(count);
  stride_ *= 2;
}

}  // namespace tetskin::view
