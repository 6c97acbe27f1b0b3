// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world and all that is in it, with one owner. Other languages hold handles: a share of the world and of a thing in
// it, so that the order in which they let go does not matter. What has been removed keeps its memory while a handle or
// a view of it lives, and refuses to be used.
#pragma once

#include "models.h"

#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/replay/recorder.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tetskin::facade {

btVector3 toBullet(const Vec3& vector, const char* name);
btTransform toBullet(const Vec3& position, const Quaternion& rotation);

/// A collision shape, with what it refers to. Shared by bodies.
struct ShapeModel {
  std::shared_ptr<btCollisionShape> shape;
  bool concave = false;
};

struct RigidState {
  ShapeModel shape;
  std::unique_ptr<btDefaultMotionState> motion;
  std::unique_ptr<btRigidBody> body;
  bool removed = false;
};

/// A joint between rigid bodies; null: removed. The motor of a hinge is limited by a torque, which is where Bullet has
/// an impulse: between steps, so that snapshots have it.
struct JointState {
  std::shared_ptr<RigidState> first, second;
  std::unique_ptr<btTypedConstraint> joint;
};

struct BodyState {
  CageModel cage;
  MeshModel mesh;                                  ///< null: the body has no surface
  std::shared_ptr<const SoftBodyBinding> binding;  ///< null likewise
  std::unique_ptr<DeformableBody> body;
  SoftBodySkin skin;
  std::unique_ptr<SurfaceContact> contact;
  std::unique_ptr<SurfaceTree> tree;  ///< made when it is first asked for
  std::vector<float> positions, normals;
  bool softContact = false;
  bool removed = false;
};

/// A spring or weld between a surface and something else; both null: released.
struct TouchState {
  std::shared_ptr<BodyState> body;
  std::shared_ptr<RigidState> rigid;
  std::unique_ptr<SurfaceSpring> spring;
  std::unique_ptr<SurfaceWeld> weld;
};

/// Where a ray has met a surface.
struct RayHit {
  std::shared_ptr<BodyState> body;  ///< null: nowhere
  SurfaceHit hit;
};

struct BodyOptions {
  SoftBodyOptions material;
  BindingOptions binding;
  std::vector<int> pinned;
  bool visible = true, surfaceContact = true, softContact = false, selfContact = false;
  std::optional<double> contactMargin, sampleSpacing;
};

class World : public std::enable_shared_from_this<World> {
 public:
  /// threads  that work on a step; null: the calling one
  World(const Vec3& gravity, std::unique_ptr<ParallelFor> threads, bool deterministic, bool recordForces);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  DeformableWorld& bullet() { return *world_; }
  std::recursive_mutex& mutex() { return mutex_; }
  std::atomic<unsigned> lockedIn{0};  ///< for who locks: the process, see Locked of the Python package

  /// Steps, and updates all surfaces. Returns the number of substeps that were made; none, if dt is 0. Throws after the
  /// step if a body is not finite, or has other nodes than its surface knows; before it for anything else.
  /// stepped  how the world is stepped: by itself, or by a recorder
  template <class Stepped>
  int step(double dt, int substeps, Stepped&& stepped) {
    checkStep(dt, substeps);
    if (dt == 0.0) return 0;
    const Alone alone(*this);
    const btScalar substep = substepOf(dt, substeps);
    int made = 0;
    {
      const MotorImpulses impulses(*this, substep);
      made = stepped(btScalar(dt), substeps, substep);
    }
    updateSkins();
    return made;
  }
  /// Makes the next step of a run, and updates all surfaces. Returns false if there is no further step.
  bool step(Replay& replay);
  std::vector<char> save() const;
  void restore(const void* snapshot, std::size_t size);
  /// Opens a run, in the state in which recording began.
  std::unique_ptr<Replay> replay(const std::string& path);

  std::shared_ptr<RigidState> addRigid(const ShapeModel& shape, double mass, const btTransform& pose, double friction,
                                       bool kinematic);
  void remove(RigidState& rigid);
  /// Put a body somewhere: a kinematic one by its motion state, which gives it the velocity of the motion.
  void setPosition(RigidState& rigid, const Vec3& position);
  void setRotation(RigidState& rigid, const Quaternion& rotation);
  std::shared_ptr<JointState> addJoint(std::shared_ptr<RigidState> first, std::shared_ptr<RigidState> second,
                                       std::unique_ptr<btTypedConstraint> joint, bool collide);
  void remove(JointState& joint);
  std::shared_ptr<BodyState> addBody(const CageModel& cage, const MeshModel& mesh, const Eigen::Affine3d& placement,
                                     const BodyOptions& options);
  void remove(BodyState& body);
  /// Puts a body elsewhere in its motion, or into the state in which it was added, with its surface.
  void teleport(BodyState& body, const btTransform& motion);
  void reset(BodyState& body);
  /// What was at this point is at the world's origin then, and all else as far from it as it was.
  void shiftOrigin(const btVector3& origin);
  std::shared_ptr<TouchState> addTouch(TouchState&& touch);
  void remove(TouchState& touch);

  const SurfaceTree& treeOf(BodyState& body);
  /// The first intersection of a segment with a body's surface, or with those of all; null: none.
  RayHit raycast(const std::shared_ptr<BodyState>& body, const btVector3& from, const btVector3& to);
  RayHit raycast(const btVector3& from, const btVector3& to);
  ImpulseResult radialImpulse(BodyState& body, const RadialImpulse& impulse);
  ForceRecord& forces();
  SoftContacts* softContacts() { return soft_.get(); }
  const std::vector<std::shared_ptr<BodyState>>& bodies() const { return bodies_; }
  const std::vector<std::shared_ptr<RigidState>>& rigids() const { return rigids_; }

 private:
  /// What bodies of one cage and mesh share.
  struct Shared {
    std::weak_ptr<const Cage> cage;
    std::weak_ptr<const TriangleMesh> mesh;
    BindingOptions options;
    std::weak_ptr<const SoftBodyBinding> binding;
    std::weak_ptr<const ContactShape> shape;
  };

  /// Throws if the world is within a step or a restore of it, whose calls of the application it comes from.
  class Alone {
   public:
    explicit Alone(World& world);
    ~Alone() { world_.stepping_ = false; }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;

   private:
    World& world_;
  };
  /// Limits the motors of hinges within a step, as Bullet does it: by an impulse.
  class MotorImpulses {
   public:
    MotorImpulses(World& world, btScalar substep);
    ~MotorImpulses();
    MotorImpulses(const MotorImpulses&) = delete;
    MotorImpulses& operator=(const MotorImpulses&) = delete;

   private:
    World& world_;
  };

  void updateSkins();
  void updateTeleported();
  void place(RigidState& rigid, const btTransform& pose);
  static void checkStep(double dt, int substeps);
  static btScalar substepOf(double dt, int substeps);
  Shared& sharedOf(const CageModel& cage, const MeshModel& mesh, const BindingOptions& options);
  void bindSurface(BodyState& body, const BodyOptions& options);
  /// Removes those that a condition holds for, in their order. Needs no memory: what is to be freed can be.
  template <class State, class Condition>
  void removeEach(std::vector<std::shared_ptr<State>>& all, Condition&& condition) {
    for (std::size_t i = 0; i < all.size();) condition(*all[i]) ? remove(*std::shared_ptr<State>(all[i])) : void(++i);
  }

  std::recursive_mutex mutex_;
  std::unique_ptr<ParallelFor> threads_;
  std::unique_ptr<DeformableWorld> world_;
  std::unique_ptr<ForceRecord> record_;
  std::unique_ptr<SoftContacts> soft_;
  std::vector<std::unique_ptr<Shared>> shared_;
  std::vector<std::shared_ptr<RigidState>> rigids_;
  std::vector<std::shared_ptr<JointState>> joints_;
  std::vector<std::shared_ptr<BodyState>> bodies_;
  std::vector<std::shared_ptr<TouchState>> touches_;
  std::vector<SoftBodySkin*> skins_;
  std::vector<StatusCode> statuses_;
  std::vector<std::pair<btHingeConstraint*, btScalar>> torques_;  ///< of motors, within a step
  bool stepping_ = false;
};

/// Throw if the thing has been removed from its world.
btRigidBody& alive(const RigidState& rigid);
DeformableBody& alive(const BodyState& body);
void checkSurface(const BodyState& body);
/// The surface of a body that has one; throws otherwise.
SoftBodySkin& surfaceOf(BodyState& body);

/// By node. Throw, and change nothing, for another count, a number that is not finite, a node that is not there.
/// velocities, positions  three numbers for each; velocities of pinned nodes stay
void setVelocities(BodyState& body, const double* velocities, std::size_t numbers);
void setPinned(BodyState& body, const std::vector<int>& nodes, bool pinned);
void setPinnedPositions(BodyState& body, const std::vector<int>& nodes, const double* positions, std::size_t numbers);
std::vector<unsigned char> pinnedOf(const BodyState& body);
void setFriction(BodyState& body, double friction);
void setFriction(RigidState& rigid, double friction);

}  // namespace tetskin::facade
