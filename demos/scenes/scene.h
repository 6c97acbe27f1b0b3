// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene: soft bodies in a Bullet world, the actions on them during the simulation, and the conditions that must hold.
// `sceneTable` (scenes/table.h) lists them all.
#pragma once

#include <tetskin/core/cage.h>
#include <functional>
#include <memory>
#include <vector>

#include "scenes/reduction.h"
#include "scenes/world.h"

namespace tetskin::scenes {

constexpr double kFrameRate = 60.0;
/// A body more than this many times as large as at rest has exploded: Bullet clamps such a body to finite coordinates.
constexpr double kExploded = 20.0;
/// Contacts are at the cage's nodes: points may pass the floor by the collision margin plus this share of the body's
/// size.
constexpr double kFloorTolerance = 0.01;

/// The inputs of a scene. The scene itself decides which nodes are pinned.
struct SceneOptions {
  SoftBodyOptions body = oneKilogram();
  Force force = Force::Elastic;
  int substeps = 4;                      ///< per frame
  std::shared_ptr<Reduction> reduction;  ///< for Force::Reduced: the source of the modes
  int modes = 20;                        ///< for Force::Reduced: modes per body
  double frameSeconds = 1.0 / kFrameRate;
  int frames = 0;          ///< length of the run, over which the scene spreads its events; 0: the scene's own
  std::size_t bodies = 1;  ///< used by scenes with several bodies
  double harshness = 0.0;  ///< how hard the scene is, in units of its own; 0: the scene's own
  double size = kSize;     ///< largest side of a body; gravity is scaled with it, so that all sizes fall equally
  Box3 box;                ///< the box by which the scene is laid out, the same for many cages; empty: the cage's own
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< shift of the body from where its cage is

  double substep() const { return frameSeconds / substeps; }
};

/// Called when a scene has moved nodes by hand, before the next step: surfaces need an update.
using Moved = std::function<void()>;

/// The state of a scene, judged by some points of its bodies: nodes or surface, world space.
struct Findings {
  Box3 box;                ///< of the points; empty if they are not finite
  bool finite = true;      ///< all coordinates are finite
  bool exploded = false;   ///< a box is kExploded times as large as the scene itself can make its body, or not finite
  bool aboveFloor = true;  ///< no point is farther below the floor than the tolerance; true without a floor
};

class Scene {
 public:
  /// An empty scene, to which the functions that make scenes add.
  /// gravity  downwards, for bodies of size kSize
  Scene(const SceneOptions& options, double gravity);

  const SceneOptions& options() const { return options_; }
  World& world() { return world_; }
  std::size_t bodyCount() const { return bodies_.size(); }
  btSoftBody& body(std::size_t i = 0) { return *bodies_[i]; }
  const btSoftBody& body(std::size_t i = 0) const { return *bodies_[i]; }
  double margin() const;  ///< collision margin
  /// Root mean square of the nodes' speeds, in body lengths per second.
  double nodeSpeed() const;

  /// Simulates one frame; returns the number of Bullet's steps.
  /// frame  the number of the frame that is reached, from 1
  int step(int frame, const Moved& moved = {});
  /// Checks what must hold after every frame, for points that a body carries, or for all nodes.
  Findings check(PointView<const btScalar> points) const;
  Findings check() const;
  /// Moves all nodes back to their initial positions, at rest.
  void restore();

  // For the functions that make scenes.

  /// Adds a body that never falls asleep, so that every step shows.
  /// pinned  chooses the pinned nodes by their positions in the cage
  /// shift   from the cage's position, added to the offset of the options
  btSoftBody& add(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& pinned = {},
                  const Eigen::Vector3d& shift = Eigen::Vector3d::Zero());
  /// Adds a fixed box whose upper side is `gap` times the body's size below the layout box: below the body, which must
  /// have been added before, if the options have no such box.
  void addFloor(double gap);
  /// Moves all nodes of the first body to new positions, at rest.
  void placeNodes(const std::function<btVector3(const btVector3&)>& toPosition);

  double extent = 1.0;     ///< largest side that the scene itself gives its body, relative to that at rest
  double floorY;           ///< upper side of the floor; minus infinity: no floor
  Eigen::Vector3d offset;  ///< of the body's initial position from its cage
  std::function<void(int frame, const Moved&)> beforeFrame;
  /// frame  the time at the end of the substep, in frames, may be fractional
  std::function<void(double frame, double seconds)> beforeSubstep;

 private:
  btSoftBody& makeBody(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& pinned,
                       const Eigen::Vector3d& direction);

  SceneOptions options_;
  World world_;
  std::vector<btSoftBody*> bodies_;
  std::vector<std::vector<btVector3>> start_;  ///< initial node positions of each body
};

/// Moves a node to a new position, at rest.
void placeNode(btSoftBody::Node& node, const btVector3& where);

/// The frame before which a scene's single event happens: the sixth, or the last of a shorter run.
int eventFrame(const SceneOptions& options);

/// The box by which a scene is laid out.
Box3 layoutBox(const SceneOptions& options, const Cage& cage);

/// Indices of the cage's nodes that a rule chooses. Throws InputError if there are none.
std::vector<int> nodesWhere(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& chosen);

}  // namespace tetskin::scenes
