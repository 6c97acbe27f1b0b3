// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The Bullet worlds of the demos' scenes, and the bodies that are added to them.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/stage_times.h"
#include "scenes/stepping.h"

class btBroadphaseInterface;
class btCollisionConfiguration;
class btCollisionShape;
class btConstraintSolver;
class btDeformableBodySolver;
class btDeformableLagrangianForce;
class btDeformableMultiBodyDynamicsWorld;
class btDiscreteDynamicsWorld;
class btDispatcher;
class btRigidBody;

namespace tetskin {
class DeformableBody;
class DeformableSolver;
class ReducedBody;
struct ReducedBodyOptions;
struct ReductionReport;
struct SurfaceContactOptions;
struct VibrationModes;
class ParallelFor;
class ContactShape;
class SoftContacts;
class SurfaceContact;
struct SoftContact;
}  // namespace tetskin

namespace tetskin::scenes {

/// Largest side of a body in Bullet's world, which has absolute constants (sleep thresholds, clamps).
constexpr double kSize = 2.0;
/// Acceleration of gravity, in lengths per second squared.
constexpr double kEarth = 9.81;

/// The library's defaults for a body of 1 kg, to which all figures of the demos refer.
inline SoftBodyOptions oneKilogram() {
  SoftBodyOptions options;
  options.mass = 1.0;
  return options;
}

/// The elastic model of soft bodies, which determines the world that they need.
enum class Force {
  MassSpring,        ///< Bullet's classic world
  LinearElasticity,  ///< in the deformable world, as are all of the following
  NeoHookean,
  BulletCorotated,  ///< Bullet's own, which the library does not offer: it has no damping, and no implicit form
  Elastic,          ///< the library's model, in its solver
  Reduced,          ///< no elastic force: vibration modes of fine tets, in Bullet's reduced solver
};

/// Which part of a soft body touches rigid ones: its surface, or its cage's nodes.
enum class Contact { Surface, Cage };

/// Totals of the library's solver over the steps so far.
struct SolveTotals {
  int steps = 0;  ///< 0: another solver is in use, or no step was made
  long iterations = 0;
  long passes = 0;      ///< of the contact solve
  int unconverged = 0;  ///< steps in which the contact solve of any body did not converge

  double iterationsPerStep() const { return static_cast<double>(iterations) / steps; }
  double passesPerStep() const { return static_cast<double>(passes) / steps; }
};

/// A world of the kind that a force needs, with everything required to make one, and its bodies, all owned here.
class World {
 public:
  World(Force force, const btVector3& gravity);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Makes a soft body of a cage, at the cage's position; it exists as long as the world. The force is the world's,
  /// whatever the options say, as another force might need another solver. Throws InputError if Bullet cannot make a
  /// body of the cage.
  btSoftBody& add(const Cage& cage, SoftBodyOptions options);

  /// Makes a soft body that moves by vibration modes, for Force::Reduced. It exists as long as the world.
  btSoftBody& add(const Cage& cage, const VibrationModes& modes, const ReducedBodyOptions& options);

  /// From now on, rigid bodies touch this mesh instead of the cage's nodes; for Force::Elastic only. Throws InputError
  /// if body and mesh do not fit.
  SurfaceContact& touchBySurface(btSoftBody& body, const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                 const SurfaceContactOptions& options);
  /// The same with samples closer together than obstacles here are thick.
  void touchBySurface(btSoftBody& body, const SoftBodyBinding& binding, const TriangleMesh& mesh);

  /// Soft bodies for which this was called touch each other at their visual surfaces, and, if requested, themselves;
  /// for Force::Elastic only. Throws InputError if body and shape do not fit.
  void touchEachOther(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool itself = false);
  /// Contacts of soft bodies in the last substep; empty if contact among soft bodies was not requested.
  std::vector<SoftContact> softContacts() const;

  /// slope  radians about z; mass  0: a fixed box, drawn as an obstacle
  btRigidBody& addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope = 0.0,
                      double mass = 0.0);
  /// A box that `moveTo` moves, and that is not drawn as an obstacle.
  btRigidBody& addMovingBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents);
  /// A capsule along z.
  /// halfLength  without its round ends
  void addPole(const Eigen::Vector3d& centre, double radius, double halfLength);
  void addSphere(const Eigen::Vector3d& centre, double radius);
  /// Draws the last obstacle added with another material: see scenes/materials.h.
  void paint(const std::string& material);
  /// Adds any other body, which is not drawn as an obstacle.
  /// mass  0: fixed
  btRigidBody& addRigid(std::unique_ptr<btCollisionShape> shape, const btTransform& where, double mass);
  /// Deletes a body. May be called between steps, or from an action.
  void remove(btRigidBody& body);

  /// From now on, steps are made by this; null: as they come.
  void setStepping(std::unique_ptr<Stepping> stepping) { stepping_ = std::move(stepping); }
  const Stepping* stepping() const { return stepping_.get(); }
  /// The world, if it is a deformable one; or null.
  btDeformableMultiBodyDynamicsWorld* deformableWorld() { return deformable_; }
  /// Makes one step of this many seconds; returns the number of Bullet's steps: 0 if no time passes.
  int step(double seconds);
  /// Iterations of the library's solver in the last step; 0 with other solvers.
  int iterations() const;
  const SolveTotals& solveTotals() const { return solveTotals_; }
  /// Times of all steps so far; skins are the caller's.
  const StageTimes& stageTimes() const { return stageTimes_; }
  /// Lends threads to the library's solver, if that is in use.
  void setThreads(ParallelFor* threads);
  /// Leaves out Bullet's normals of the nodes, which only drawing the cage's faces needs.
  void leaveOutNodeNormals();

  btDiscreteDynamicsWorld& bullet() { return *world_; }
  /// The report on the last reduced body added; null without one.
  const ReductionReport* reduction() const;
  /// The last body added, in the deformable world with a force of the library's.
  DeformableBody& deformable() { return *deformableBodies_.back(); }
  /// All such bodies, in the order in which they were added.
  const std::vector<std::unique_ptr<DeformableBody>>& deformables() const { return deformableBodies_; }
  /// A hash of the present nodes of all soft bodies, each position as three floats, seeded by `seed`: equal runs have
  /// equal hashes.
  std::uint64_t hashOfNodes(std::uint64_t seed) const;
  /// Everything that is fixed, world space.
  const TriangleMesh& obstacles() const { return obstacles_; }

 private:
  void makeClassic();
  void makeDeformable();
  void addCorotated(btSoftBody& body, const SoftBodyOptions& options);
  void countSolve(const DeformableSolver& solver);

  Force force_;
  std::unique_ptr<btCollisionConfiguration> configuration_;
  std::unique_ptr<btDispatcher> dispatcher_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::unique_ptr<btDeformableBodySolver> bodySolver_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  btDeformableMultiBodyDynamicsWorld* deformable_ = nullptr;  ///< the same world, if it is a deformable one
  btSoftBodyWorldInfo* info_ = nullptr;

  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigid_;
  TriangleMesh obstacles_;
  std::vector<std::unique_ptr<btDeformableLagrangianForce>> forces_;
  std::vector<std::unique_ptr<btSoftBody>> bodies_;
  std::vector<std::unique_ptr<DeformableBody>> deformableBodies_;
  std::vector<std::unique_ptr<ReducedBody>> reducedBodies_;
  std::vector<std::unique_ptr<SurfaceContact>> contacts_;
  std::unique_ptr<SoftContacts> softContacts_;
  SolveTotals solveTotals_;
  StageTimes stageTimes_;
  std::unique_ptr<Stepping> stepping_;
};

/// The stiffness that the library gives a body of this cage by default with Bullet's forces, under earth's gravity.
double defaultStiffness(const Cage& cage, const SoftBodyOptions& options);

/// Root mean square of the speeds of all these bodies' nodes.
double nodeSpeed(const std::vector<btSoftBody*>& bodies);

/// Moves a box made by `addMovingBox` to a new position, in the next step.
/// turn  radians about z
void moveTo(btRigidBody& body, const Eigen::Vector3d& centre, double turn = 0.0);

/// Moves a node without inverse mass to the position that it shall have at the end of a substep. Bullet moves it by its
/// velocity, which no force changes: so it arrives there, and its neighbours feel its motion.
void movePinnedNode(btSoftBody::Node& node, const Eigen::Vector3d& target, double seconds);

}  // namespace tetskin::scenes
