// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <functional>
#include <vector>

#include "stress/stress_world.h"

namespace tetskin::stress {

/// Whether the event needs weight and something to fall on; the others happen in free space.
bool hasFloor(Event event);
/// Largest side that the event itself gives the body, over that at rest.
double extentOf(Event event);
/// For `SoftBodyOptions::pinned`: the nodes that the event holds; empty if none.
std::function<bool(const Eigen::Vector3d&)> heldNodes(Event event, const TetMesh& cage);

/// What is done to a body by hand, between frames.
class EventScript {
 public:
  /// Sets the scene: floor, box, first velocities.
  EventScript(const StressCase& stressCase, const StressModel& model, StressWorld& world);

  /// Before a frame; returns true if it put nodes elsewhere, so that the surface is due.
  bool before(int frame);
  /// Takes back what was only for one update: the node that is not finite. Returns true if there was any.
  bool takeBack();
  /// Puts all nodes back to where they began, at rest.
  void restore();

 private:
  void placeNodes(const std::function<btVector3(const btVector3&)>& place);
  void placeNode(int node, const btVector3& where);
  void permute();
  void startSpinning();
  void pull();
  bool spoil();

  const StressCase& case_;
  const StressModel& model_;
  StressWorld& world_;
  std::vector<btVector3> start_;
  btVector3 centre_;
  int pulled_ = -1;
  int spoiled_ = -1;
  btVector3 unspoiled_;
};

}  // namespace tetskin::stress
