// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: what the contact searches of one body and the solver's steps pass to each other. The
// body carries it, because its search moves with it into another world.
#pragma once

#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/export.h>
#include <tetskin/solver/src/base/point_contacts.h>

#include <memory>
#include <utility>

namespace tetskin::bullet_detail {

class BodyContacts;
class KinematicPaths;
class WorldStream;

class TETSKIN_SOLVER_API BodyChannel final : public BodyCompanion {
 public:
  /// The body's channel, created at the first call. Not while pairs are searched: that may run on several threads.
  static BodyChannel& of(BodyWithTrees& body);

  // The searches for contacts.
  /// Finds contacts of points other than the nodes with rigid objects; expired if nothing does.
  const std::weak_ptr<BodyContacts>& surfaceContacts() const { return surfaceContacts_; }
  void setSurfaceContacts(std::weak_ptr<BodyContacts> contacts) { surfaceContacts_ = std::move(contacts); }
  /// Finds the contacts of the nodes; or null.
  const std::shared_ptr<BodyContacts>& nodeContacts() const { return nodeContacts_; }
  /// size  of the body when they were created
  void setNodeContacts(std::shared_ptr<BodyContacts> contacts, btScalar size) {
    nodeContacts_ = std::move(contacts);
    contactSize_ = size;
  }
  btScalar contactSize() const { return contactSize_; }
  /// The solver that reads the contacts of the nodes; null if Bullet searches for them. If the body names another
  /// solver, it has left its world.
  const btSoftBodySolver* nodesSolver() const { return nodesSolver_; }
  void setNodesSolver(const btSoftBodySolver* solver) { nodesSolver_ = solver; }

  // What a step tells its searches.
  /// The paths of kinematic bodies in the world whose steps search for contacts; expired if there are none.
  const std::weak_ptr<const KinematicPaths>& kinematicPaths() const { return kinematicPaths_; }
  void setKinematicPaths(std::weak_ptr<const KinematicPaths> paths) { kinematicPaths_ = std::move(paths); }
  /// While set, searches wait until all pairs of the step are known, so that those of several bodies run in parallel.
  void setSearchWaits(bool waits) { searchWaits_ = waits; }
  bool searchWaits() const { return searchWaits_; }
  void setReach(btScalar beyondNodes) { reach_ = beyondNodes; }
  btScalar reach() const override { return reach_; }
  /// The distance at which a body's points count as touching while a step searches for contacts, in addition to the
  /// distance that is kept between the objects. It allows for forces that are not known yet: a body that rests on a
  /// resting object is predicted to fall with it, or away from it. 0: none, as outside of steps. Each call begins a new
  /// prediction.
  void setSpeculation(btScalar distance) {
    speculation_ = distance;
    ++predictions_;
  }
  btScalar speculation() const override { return speculation_; }
  /// Grows from step to step. While it stays the same and the speculation is above 0, nodes and their paths stay the
  /// same, too.
  unsigned predictions() const { return predictions_; }

  // What the searches tell the step.
  /// The points that must stay outside of objects in this step. A search adds them; the solver reads them, and clears
  /// them at the beginning of a step.
  PointContacts& pointContacts() { return pointContacts_; }
  const PointContacts& pointContacts() const { return pointContacts_; }

  void dropStep() override;
  void returnToStart() override;
  /// Writes or reads the state that the last step has left.
  void serialize(WorldStream& stream);

 private:
  btScalar reach_ = -1, speculation_ = 0;
  unsigned predictions_ = 0;
  bool searchWaits_ = false;
  PointContacts pointContacts_;
  std::weak_ptr<BodyContacts> surfaceContacts_;
  std::weak_ptr<const KinematicPaths> kinematicPaths_;
  std::shared_ptr<BodyContacts> nodeContacts_;
  btScalar contactSize_ = 0;
  const btSoftBodySolver* nodesSolver_ = nullptr;
};

/// The channel of a body; null if it has none, for instance before its first step. From any thread.
BodyChannel* channelOf(const btSoftBody& body);

}  // namespace tetskin::bullet_detail
