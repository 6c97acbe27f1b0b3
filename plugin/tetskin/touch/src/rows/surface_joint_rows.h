// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: everything that acts at points of the bodies of one world, as one entry in its list of
// forces, where a DeformableSolver finds it and asks for rows.
#pragma once

#include <tetskin/bullet/src/base/row_source.h>

#include <memory>

namespace tetskin {
class DeformableSolver;
}

namespace tetskin::touch_detail {

using namespace bullet_detail;

/// One force or joint at a point.
class ActiveJoint {
 public:
  virtual ~ActiveJoint() = default;

  /// The body on which it acts; null if the body has been destroyed.
  virtual btSoftBody* body() const = 0;
  /// True if its living body is in the world in which it was made.
  virtual bool isInWorld() const = 0;
  /// Called when a body has left the world of which it is not known whether it will live.
  virtual void drop() = 0;
  /// True if it will not act any more.
  virtual bool spent() const = 0;

  /// Adds the constraints and loads of the step.
  virtual void addJoints(btScalar /*seconds*/, std::vector<PointJoint>& /*joints*/) {}
  /// joints  those that addJoints has added, with their impulses
  virtual void finish(btScalar /*seconds*/, const PointJoint* /*joints*/) {}

  virtual void shift(const btVector3& by) = 0;
  /// Writes or reads what changes, for snapshots.
  virtual void visitState(WorldStream& stream) = 0;
  /// Writes what does not change, and is to be the same in the world that a snapshot is restored in.
  virtual void checkState(WorldStream& stream) = 0;
  /// Writes what it is made of, for recorded runs.
  virtual void describe(BuildStream& stream) = 0;
};

class SurfaceJointRows : public RowSource, public std::enable_shared_from_this<SurfaceJointRows> {
 public:
  explicit SurfaceJointRows(DeformableSolver& solver) : solver_(solver) {}
  ~SurfaceJointRows() override;
  SurfaceJointRows(const SurfaceJointRows&) = delete;
  SurfaceJointRows& operator=(const SurfaceJointRows&) = delete;

  /// The instance in the solver's list, or a new one.
  static std::shared_ptr<SurfaceJointRows> instanceOf(DeformableSolver& solver);
  const DeformableSolver& solver() const { return solver_; }

  /// It acts from the next step on, and stays in the list while any entry does.
  void add(std::shared_ptr<ActiveJoint> joint);
  /// Ignores entries that were dropped.
  void remove(const ActiveJoint& joint);

  std::vector<PointJoint>* joints(btScalar seconds) override;
  void finish(btScalar seconds) override;
  void removeSoftBody(btSoftBody* body) override;
  void shift(const btVector3& by) override;
  void visitState(WorldStream& stream) override;
  void checkState(WorldStream& stream) override;
  const char* builderName() const override { return kBuilderName; }
  void describe(BuildStream& stream) override;
  static constexpr const char* kBuilderName = "springs and welds";

 private:
  void eraseSpent();
  void leave();

  DeformableSolver& solver_;
  std::vector<std::shared_ptr<ActiveJoint>> active_;
  std::vector<PointJoint> joints_;
  std::vector<std::size_t> firsts_;  ///< first index in `joints_`, by part
  bool listed_ = false;
};

}  // namespace tetskin::touch_detail
