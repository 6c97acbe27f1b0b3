// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace tetskin::view {

/// The positions of everything at one moment.
struct ViewMoment {
  std::vector<std::vector<Eigen::Vector3d>> bodies;  ///< the nodes of each body
  std::vector<Eigen::Affine3d> props;                ///< one per moving rigid object
};

/// The moments of a run that a page keeps: all frames while they fit into a number of bytes, then every second, every
/// fourth, and so on. The page interpolates between those that it has, so a run may have any length.
class ViewFrames {
 public:
  /// Bytes of a page before base64, which adds a third: enough for two thousand frames of a cage of 3,000 tets, which
  /// has a thousand nodes.
  static constexpr std::size_t kMaxBytes = 12'000'000;

  explicit ViewFrames(std::size_t maxBytes = kMaxBytes) : maxBytes_(maxBytes) {}

  /// Adds the next frame. All frames have as many bodies, nodes and props as the first.
  void keep(const ViewMoment& moment);

  /// The number of moments kept: every `stride`-th frame, beginning with the first.
  std::size_t size() const { return moments_.size(); }
  int stride() const { return stride_; }
  /// The centre of the first moment. It is subtracted from all positions, as pages draw in float.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Coordinates of a body's nodes at a kept moment, three per node.
  const std::vector<float>& nodes(std::size_t moment, std::size_t body) const { return moments_[moment].bodies[body]; }
  /// The box of all bodies' nodes at a kept moment.
  Box3 box(std::size_t moment) const;
  std::size_t bodyCount() const { return moments_.empty() ? 0 : moments_.front().bodies.size(); }
  std::size_t propCount() const { return moments_.empty() ? 0 : moments_.front().props.size(); }
  const Eigen::Matrix4f& prop(std::size_t moment, std::size_t prop) const { return moments_[moment].props[prop]; }

 private:
  struct Moment {
    std::vector<std::vector<float>> bodies;
    std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> props;
  };
  std::size_t bytesOf(const Moment& moment) const;
  void leaveOutEverySecond();

  std::size_t maxBytes_;
  std::vector<Moment> moments_;
  std::size_t told_ = 0;  ///< number of frames given, kept or not
  int stride_ = 1;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

}  // namespace tetskin::view
