// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: the common part of springs and welds.
#pragma once

#include <tetskin/touch/src/joints/joint_rows.h>

class btDiscreteDynamicsWorld;

namespace tetskin::touch_detail {

/// Owns a joint among the rows of its world.
class JointOwner {
 public:
  static Status check(const btDiscreteDynamicsWorld& world, const SurfacePoint& point);

  /// The caller has checked the point and the anchor.
  explicit JointOwner(std::shared_ptr<Joint> joint);
  ~JointOwner() { release(); }
  JointOwner(const JointOwner&) = delete;
  JointOwner& operator=(const JointOwner&) = delete;

  Joint& joint() { return *joint_; }
  const Joint& joint() const { return *joint_; }
  StatusCode status() const;
  void release();

 private:
  std::shared_ptr<Joint> joint_;
  std::shared_ptr<SurfaceJointRows> force_;
  bool released_ = false;
};

}  // namespace tetskin::touch_detail
