// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace tetskin::scenes {

/// Where everything is at one moment.
struct ViewMoment {
  std::vector<std::vector<Eigen::Vector3d>> bodies;  ///< by body: its nodes
  std::vector<Eigen::Affine3d> props;                ///< by rigid thing that moves
};

/// The moments of a run that a page keeps: all frames while they fit into some bytes, then every second of them, every
/// fourth, and so on: the page goes evenly between those that it has. So a run may be of any length.
class ViewFrames {
 public:
  /// Bytes of a page before base64, which takes a third more: a cage of 3,000 tets, which has a thousand nodes, for two
  /// thousand frames.
  static constexpr std::size_t kMostBytes = 12'000'000;

  explicit ViewFrames(std::size_t mostBytes = kMostBytes) : mostBytes_(mostBytes) {}

  /// The next frame; all have as many bodies, nodes and props as the first.
  void keep(const ViewMoment& moment);

  /// Kept; every `stride`-th frame, the first among them.
  std::size_t size() const { return moments_.size(); }
  int stride() const { return stride_; }
  /// Subtracted from all of them, as pages draw in float: the middle of the first.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Coordinates of a body's nodes at a kept moment, three a node.
  const std::vector<float>& nodes(std::size_t moment, std::size_t body) const { return moments_[moment].bodies[body]; }
  /// Of all bodies' nodes at a kept moment.
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

  std::size_t mostBytes_;
  std::vector<Moment> moments_;
  std::size_t told_ = 0;  ///< frames, kept or not
  int stride_ = 1;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

}  // namespace tetskin::scenes
