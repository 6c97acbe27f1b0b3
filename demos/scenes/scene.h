// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene: soft bodies in a world of Bullet's, what is done to them while they are simulated, and what must hold.
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
/// Beyond this many times its rest size a body has exploded: Bullet clamps such a body to finite coordinates.
constexpr double kExploded = 20.0;
/// Contacts are at the cage's nodes: points may pass the floor by the collision margin and this share of the size.
constexpr double kFloorTolerance = 0.01;

/// What a scene is made of. Which nodes are held is the scene's own affair.
struct SceneOptions {
  SoftBodyOptions body = oneKilogram();
  Force force = Force::Elastic;
  int substeps = 4;                      ///< of a frame
  std::shared_ptr<Reduction> reduction;  ///< with Force::Reduced: whose vibrations
  int modes = 20;                        ///< the same: of each body
  double frameSeconds = 1.0 / kFrameRate;
  int frames = 0;          ///< of the whole run, over which the scene spreads what happens; 0: its own
  std::size_t bodies = 1;  ///< in scenes of several
  double harshness = 0.0;  ///< where a scene can be harder or easier, in units of its own; 0: its own
  double size = kSize;     ///< largest side of a body; gravity is in proportion: all sizes fall alike
  Box3 box;                ///< what the scene is laid out by, the same for many cages; empty: the cage's own
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< how far from where the cage is the body is put

  double substep() const { return frameSeconds / substeps; }
};

/// Told when a scene has put nodes elsewhere by hand, before the next step: surfaces are due.
using Moved = std::function<void()>;

/// How a scene stands, by some points of its bodies: nodes or surface, world space.
struct Findings {
  Box3 box;                ///< of the points, if they are finite
  bool finite = true;      ///< all coordinates are
  bool exploded = false;   ///< a box is kExploded times as large as the scene itself can make its body, or not finite
  bool aboveFloor = true;  ///< or less than the tolerance below; true without a floor
};

class Scene {
 public:
  /// An empty one, for the makers of scenes.
  /// gravity  downwards, for bodies of kSize
  Scene(const SceneOptions& options, double gravity);

  const SceneOptions& options() const { return options_; }
  World& world() { return world_; }
  std::size_t bodyCount() const { return bodies_.size(); }
  btSoftBody& body(std::size_t i = 0) { return *bodies_[i]; }
  const btSoftBody& body(std::size_t i = 0) const { return *bodies_[i]; }
  double margin() const;  ///< collision margin
  /// Root mean square of the nodes' speeds, in sizes a second.
  double nodeSpeed() const;

  /// One frame; returns the number of Bullet's steps.
  /// frame  the one reached, from 1
  int step(int frame, const Moved& moved = {});
  /// What must hold after every frame, of points that a body carries, or of all nodes.
  Findings check(PointView<const btScalar> points) const;
  Findings check() const;
  /// Puts all nodes back to where they began, at rest.
  void restore();

  // For the makers.

  /// Adds a body, which never falls asleep: every step is to be seen.
  /// held   nodes to pin, by their place in the cage
  /// shift  from there, beside that of the options
  btSoftBody& add(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& held = {},
                  const Eigen::Vector3d& shift = Eigen::Vector3d::Zero());
  /// A fixed box, its upper side so many sizes below what the scene is laid out by: below the body if the options do
  /// not say, which must have been added then.
  void addFloor(double gap);
  /// Puts all nodes of the first body elsewhere, at rest.
  void placeNodes(const std::function<btVector3(const btVector3&)>& place);

  double extent = 1.0;     ///< largest side that the scene itself gives its body, over that at rest
  double floorY;           ///< upper side of the floor; minus infinity: none
  Eigen::Vector3d offset;  ///< of the body, where it begins, from its cage
  std::function<void(int frame, const Moved&)> beforeFrame;
  /// frame  what will be reached, a fraction between frames
  std::function<void(double frame, double seconds)> beforeSubstep;

 private:
  btSoftBody& makeBody(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& held,
                       const Eigen::Vector3d& way);

  SceneOptions options_;
  World world_;
  std::vector<btSoftBody*> bodies_;
  std::vector<std::vector<btVector3>> start_;  ///< of each body's nodes
};

/// Puts a node elsewhere, at rest.
void placeNode(btSoftBody::Node& node, const btVector3& where);

/// The frame before which a scene's one event happens: the sixth, or the last of a shorter run.
int eventFrame(const SceneOptions& options);

/// What a scene is laid out by.
Box3 layoutBox(const SceneOptions& options, const Cage& cage);

/// Indices of the cage's nodes that a rule chooses. Throws InputError if there are none.
std::vector<int> nodesWhere(const Cage& cage, const std::function<bool(const Eigen::Vector3d&)>& chosen);

}  // namespace tetskin::scenes
