// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies and rigid balls that fall on each other: the common part of all scenes of tetskin_pile. The benchmarks
// also run them.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/threads/thread_pool.h>

#include <Eigen/Geometry>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pile/pile_options.h"
#include "pile/pile_scenes.h"
#include "scenes/deepest_vertex.h"
#include "scenes/recording.h"
#include "scenes/stage_times.h"
#include "scenes/world.h"

namespace tetskin::scenes {

/// A model about the origin, in lengths of the world, and what all bodies of it share.
struct PileModel {
  /// touches  its bodies meet other soft bodies, and themselves if the options say so
  PileModel(Model placed, const SoftBodyOptions& madeOf, bool touches);

  Model model;
  SoftBodyOptions material;
  std::optional<SurfaceContactOptions> contact;  ///< nothing: that of `World::touchBySurface`
  std::shared_ptr<const ContactShape> shape;     ///< null: its bodies touch no soft bodies
  std::shared_ptr<const SoftBodyBinding> binding;
};

/// A rigid ball.
struct PileBall {
  double radius;  ///< metres
  double mass;    ///< kg
  const char* material;
  int level;  ///< of the icosphere by which it is drawn and measured
};

class Pile {
 public:
  /// Makes the scene that the options name.
  explicit Pile(const PileOptions& options);

  // The parts of a scene.

  World& world() { return world_; }
  /// Returns the number of the model.
  std::size_t addModel(PileModel model);
  void addBody(std::size_t model, const Eigen::Vector3d& at, const Eigen::Quaterniond& turn);
  void addBall(const PileBall& ball, const Eigen::Vector3d& at);
  /// Depressions are measured from this height, that of the upper side of something soft.
  void setTop(double height) { top_ = height; }
  /// The first view of a page.
  void setFocus(const Box3& focus) { focus_ = focus; }

  /// From now on nothing falls asleep.
  void keepAwake();
  /// Simulates a frame. Returns false if a body has exploded.
  bool step();

  // How the pile is at present.

  const PileScene& scene() const { return scene_; }
  const World& world() const { return world_; }
  /// Soft bodies and balls in the order of drawing.
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleMesh& obstacles() const { return world_.obstacles(); }
  std::vector<Eigen::Vector3d> surface() const;
  /// Tests every vertex against the surfaces of all other bodies and balls; the depth is in the scene's unit.
  DeepestVertex deepestVertex() const;
  /// Distance at the deepest contact between soft bodies, in the scene's unit; 0 or negative.
  double deepestContact() const;
  /// How far the lowest ball lies below the top that the scene has set, metres; nothing without balls.
  std::optional<double> deepestDent() const;
  std::size_t bodyCount() const { return bodies_.size(); }
  std::size_t ballCount() const { return balls_.size(); }
  std::size_t tetCount() const { return tetCount_; }
  std::size_t contactCount() const { return world_.softContacts().size(); }
  /// Pairs of soft bodies that touch each other.
  std::size_t pairCount() const;
  /// Bodies and balls that sleep.
  std::size_t asleepCount() const;
  /// Root mean square of the nodes' speeds, in the scene's units per second.
  double nodeSpeed() const { return scenes::nodeSpeed(softBodies_) / scene_.unit(); }
  /// Of all nodes and balls, metres per second.
  double fastest() const;
  /// Of all steps so far.
  StageTimes stageTimes() const;

  /// Records the run that follows. Bodies of one model share it there.
  Recording record(const PileOptions& options, const std::string& view) const;
  ViewMoment moment() const;

 private:
  struct Body {
    std::size_t model;
    btSoftBody* body;
  };
  struct Ball {
    btRigidBody* body;
    double radius;
    TriangleMesh mesh;  ///< about the origin
  };

  const PileScene& scene_;
  Contact contact_;
  bool touchThemselves_;
  double top_ = 0.0;
  Box3 focus_;
  std::optional<ThreadPool> threads_;
  World world_;
  std::deque<PileModel> models_;
  std::vector<Body> bodies_;
  std::vector<btSoftBody*> softBodies_;  ///< the same, in the same order
  std::vector<Ball> balls_;
  std::size_t tetCount_ = 0;
  std::deque<SoftBodySkin> skins_;
  std::vector<SoftBodySkin*> skinPointers_;
  std::vector<StatusCode> statuses_;  ///< of the last updates
  double skinSeconds_ = 0.0;          ///< of all updates so far
  TriangleMesh mesh_;
};

}  // namespace tetskin::scenes
