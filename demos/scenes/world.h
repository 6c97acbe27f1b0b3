// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The one place in which the demos make Bullet's worlds and put bodies into them.
#pragma once

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstdint>
#include <memory>
#include <vector>

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
/// Of gravity, in lengths a second, squared.
constexpr double kEarth = 9.81;

/// The library's defaults for a body of 1 kg, which all figures of the demos are of.
inline SoftBodyOptions oneKilogram() {
  SoftBodyOptions options;
  options.mass = 1.0;
  return options;
}

/// What holds soft bodies together, and with it the world that they need.
enum class Force {
  MassSpring,        ///< Bullet's classic world
  LinearElasticity,  ///< the deformable world, as all that follow
  NeoHookean,
  BulletCorotated,  ///< Bullet's own, which the library does not offer: it has no damping, and no implicit form
  Elastic,          ///< the library's, in its solver
  Reduced,          ///< no force: vibrations of fine tets, in Bullet's reduced solver
};

/// What of a soft body meets rigid ones.
enum class Contact { Surface, Cage };

/// What the library's solver has done in the steps so far.
struct SolveTotals {
  int steps = 0;  ///< 0: another solver is in use, or there was no step
  long iterations = 0;
  long passes = 0;      ///< of contacts
  int unconverged = 0;  ///< steps in which contact did not converge, of any body

  double iterationsPerStep() const { return static_cast<double>(iterations) / steps; }
  double passesPerStep() const { return static_cast<double>(passes) / steps; }
};

/// A world of the kind that a force needs, with everything it takes to make one, and its bodies, all owned here.
class World {
 public:
  World(Force force, const btVector3& gravity);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Makes a soft body of a cage, where it is; it stays as long as the world. The force is the world's, whatever the
  /// options say: another solver would be chosen here. Throws InputError if Bullet cannot make a body of the cage.
  btSoftBody& add(const Cage& cage, SoftBodyOptions options);

  /// The same of vibrations, for Force::Reduced.
  btSoftBody& add(const Cage& cage, const VibrationModes& modes, const ReducedBodyOptions& options);

  /// Rigid bodies meet this mesh in the body from now on, not the cage's nodes; of Force::Elastic. Throws InputError if
  /// they do not fit.
  void touchBySurface(btSoftBody& body, const SoftBodyBinding& binding, const TriangleMesh& mesh);

  /// Soft bodies for which this was called meet each other at their visual surfaces, and perhaps themselves; of
  /// Force::Elastic. Throws InputError if body and shape do not fit.
  void touchEachOther(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool itself = false);
  /// Of the last substep; none where nothing was to touch.
  std::vector<SoftContact> softContacts() const;

  /// slope  radians about z; mass  0: fixed, and an obstacle to draw
  btRigidBody& addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope = 0.0,
                      double mass = 0.0);
  /// A box that is moved by `moveTo`, and not drawn as an obstacle.
  btRigidBody& addMovingBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents);
  /// Along z, half as long as it says beyond its round ends.
  void addPole(const Eigen::Vector3d& centre, double radius, double halfLength);
  void addSphere(const Eigen::Vector3d& centre, double radius);
  /// Draws the obstacle added last with another material: see scenes/materials.h.
  void paint(const std::string& material);
  /// Anything else, which is not drawn as an obstacle. mass  0: fixed
  btRigidBody& addRigid(std::unique_ptr<btCollisionShape> shape, const btTransform& where, double mass);
  /// Deletes it. Between steps, or from an action.
  void remove(btRigidBody& body);

  /// Makes one step of so many seconds; returns the number of Bullet's steps: 0 if no time passes.
  int step(double seconds);
  /// Of the library's solver in the last step; 0 of others.
  int iterations() const;
  const SolveTotals& solveTotals() const { return solveTotals_; }
  /// Lends threads to the library's solver, if it is in use.
  void setThreads(ParallelFor* threads);

  btDiscreteDynamicsWorld& bullet() { return *world_; }
  /// Of the reduced body added last; null without one.
  const ReductionReport* reduction() const;
  /// Of the body added last, in the deformable world by a force of the library's.
  double youngsModulus() const;
  /// All soft bodies' nodes as they are now, each position as three floats, hashed behind `seed`: equal runs have equal
  /// hashes.
  std::uint64_t hashOfNodes(std::uint64_t seed) const;
  /// All that is fixed, world space.
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
  btDeformableMultiBodyDynamicsWorld* deformable_ = nullptr;  ///< the same, if it is one
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
};

/// The stiffness that the library gives a body of this cage by default with Bullet's forces, under the earth's gravity.
double defaultStiffness(const Cage& cage, const SoftBodyOptions& options);

/// Sends a box made by `addMovingBox` elsewhere, in the next step.
/// turn  radians about z
void moveTo(btRigidBody& body, const Eigen::Vector3d& centre, double turn = 0.0);

/// Sends a node without inverse mass to where it shall be at the end of a substep. Bullet moves it by its velocity, and
/// changes that by no force: so it arrives, and its neighbours feel it move.
void moveHeldNode(btSoftBody::Node& node, const Eigen::Vector3d& target, double seconds);

}  // namespace tetskin::scenes
