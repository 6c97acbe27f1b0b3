// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: the springs and welds of one world, as one entry in its list of forces, in which a
// DeformableSolver finds it and asks for rows.
#pragma once

#include <tetskin/touch/src/joints/joint.h>

#include <memory>

namespace tetskin {
class DeformableSolver;
}

namespace tetskin::touch_detail {

class SurfaceJointRows : public bullet_detail::RowSource, public std::enable_shared_from_this<SurfaceJointRows> {
 public:
  explicit SurfaceJointRows(DeformableSolver& solver) : solver_(solver) {}
  ~SurfaceJointRows() override;
  SurfaceJointRows(const SurfaceJointRows&) = delete;
  SurfaceJointRows& operator=(const SurfaceJointRows&) = delete;

  /// The instance in the solver's list, or a new one.
  static std::shared_ptr<SurfaceJointRows> instanceOf(DeformableSolver& solver);
  const DeformableSolver& solver() const { return solver_; }

  /// It acts from the next step on, and stays in the list while any entry does.
  void add(std::shared_ptr<Joint> joint);
  /// Ignores entries that were dropped.
  void remove(const Joint& joint);

  std::vector<bullet_detail::PointJoint>* joints(btScalar seconds) override;
  void finish(btScalar seconds) override;
  void removeSoftBody(btSoftBody* body) override;
  void shift(const btVector3& by) override;
  void serialize(bullet_detail::WorldStream& stream) override;
  void checkState(bullet_detail::WorldStream& stream) override;

 private:
  void eraseSpent();
  void leave();

  DeformableSolver& solver_;
  std::vector<std::shared_ptr<Joint>> active_;
  std::vector<bullet_detail::PointJoint> joints_;
  std::vector<std::size_t> firsts_;  ///< first index in `joints_`, by part
  bool listed_ = false;
};

}  // namespace tetskin::touch_detail
