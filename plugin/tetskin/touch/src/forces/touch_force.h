// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: all that acts at points of the bodies of one world, in its list of forces, where a
// DeformableSolver finds it and asks for rows.
#pragma once

#include <tetskin/bullet/src/shared/solver/row_source.h>

#include <memory>

namespace tetskin {
class DeformableSolver;
}

namespace tetskin::touch_detail {

/// One of them.
class Acting {
 public:
  virtual ~Acting() = default;

  /// On which it acts; null if it is gone.
  virtual btSoftBody* body() const = 0;
  /// The body has left the world, for good.
  virtual void drop() = 0;
  /// It will not act any more.
  virtual bool spent() const = 0;

  /// What it pushes, or holds, in the step.
  virtual void addJoints(btScalar /*seconds*/, std::vector<PointJoint>& /*joints*/) {}
  /// joints  those that it has added, with their impulses
  virtual void finish(btScalar /*seconds*/, const PointJoint* /*joints*/) {}
};

class TouchForce : public RowSource, public std::enable_shared_from_this<TouchForce> {
 public:
  explicit TouchForce(DeformableSolver& solver) : solver_(solver) {}
  ~TouchForce() override;
  TouchForce(const TouchForce&) = delete;
  TouchForce& operator=(const TouchForce&) = delete;

  /// The one in the solver's list, or a new one.
  static std::shared_ptr<TouchForce> of(DeformableSolver& solver);
  const DeformableSolver& solver() const { return solver_; }

  /// From the next step on; in the list for as long as there is any.
  void add(std::shared_ptr<Acting> part);
  /// The world must be there. Ignores what was dropped.
  void remove(const Acting& part);

  std::vector<PointJoint>* joints(btScalar seconds) override;
  void finish(btScalar seconds) override;
  void removeSoftBody(btSoftBody* body) override;

 private:
  void eraseSpent();
  void leave();

  DeformableSolver& solver_;
  std::vector<std::shared_ptr<Acting>> parts_;
  std::vector<PointJoint> joints_;
  std::vector<std::size_t> firsts_;  ///< in `joints_`, by part
  bool listed_ = false;
};

}  // namespace tetskin::touch_detail
