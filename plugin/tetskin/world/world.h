// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A DeformableWorld and everything in it, with one owner: soft bodies with their surfaces, rigid bodies, joints.
#pragma once

#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/replay/recorder.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetskin {

/// Options of a World.
struct WorldOptions : DeformableWorldOptions {
  bool recordForces = false;  ///< see `World::forces`
};

/// Options of a soft body of a World.
struct WorldBodyOptions {
  /// Material and settings of the body. `pinned` selects by position in the world.
  SoftBodyOptions material;
  BindingOptions binding;               ///< how the surface follows the cage
  std::vector<int> pinned;              ///< nodes to pin, by index, in addition to those that `material.pinned` selects
  bool visible = true;                  ///< whether steps update the surface, see `SoftBodySkin::setVisible`
  bool surfaceContact = true;           ///< rigid bodies touch the surface (SurfaceContact), not the cage's nodes
  bool softContact = false;             ///< touches other bodies that have this, at their surfaces (SoftContacts)
  bool selfContact = false;             ///< the same, and self-contact
  std::optional<double> contactMargin;  ///< `SurfaceContactOptions::margin`, world length
  std::optional<double> sampleSpacing;  ///< `SurfaceContactOptions::sampleSpacing`, rest units
};

/// A world that owns the objects in it:
///
///     tetskin::World world;
///     auto body = world.addBody(cage, mesh).value();
///     while (world.step(1.0 / 60).ok()) draw(body->positions, mesh->triangles);
///
/// Bodies, joints and springs are held by shared pointers, which may be released in any order. Removing an object also
/// removes everything attached to it. A removed object stays readable as long as somebody holds it, but takes part in
/// nothing. Change objects through the world, or through Bullet's and tetskin's own objects, which are accessible; do
/// not add or delete those that the world owns. `bullet()` is Bullet's whole world, for everything else.
class TETSKIN_WORLD_API World {
 public:
  /// A rigid body. Its shape may be shared with others.
  struct RigidBody {
    std::shared_ptr<btCollisionShape> shape;       ///< never null
    std::unique_ptr<btDefaultMotionState> motion;  ///< where Bullet reads and writes its pose
    std::unique_ptr<btRigidBody> body;             ///< never null
    bool removed = false;                          ///< it has left the world for good
  };

  /// A joint between two rigid bodies, or of one to space.
  struct Joint {
    std::shared_ptr<RigidBody> first;          ///< never null
    std::shared_ptr<RigidBody> second;         ///< null for space
    std::unique_ptr<btTypedConstraint> joint;  ///< null once it has been removed
  };

  /// A soft body, and its surface if it was added with a mesh.
  struct Body {
    std::shared_ptr<const Cage> cage;          ///< as it was given, in the rest space of the mesh
    std::shared_ptr<const TriangleMesh> mesh;  ///< null if the body has no surface
    /// Shared by all bodies of one cage, mesh and options; null likewise.
    std::shared_ptr<const SoftBodyBinding> binding;
    EmbedReport fit;                          ///< of the mesh in the cage, at rest
    std::unique_ptr<DeformableBody> body;     ///< never null
    SoftBodySkin skin;                        ///< updated by `step`; its targets are the arrays below
    std::unique_ptr<SurfaceContact> contact;  ///< null without `surfaceContact`
    /// vertexCount x 3, world space, after the last step, in the binding's `VertexOrder`; the memory stays as long as
    /// the body.
    std::vector<float> positions;
    std::vector<float> normals;  ///< likewise, unit length; empty for Normals::None
    bool softContact = false;    ///< it is among the world's SoftContacts
    bool removed = false;        ///< it has left the world for good

   private:
    friend class World;
    std::unique_ptr<SurfaceTree> tree_;  ///< made on first use
  };

  /// A spring or a weld between a surface and something else. Both are null once it has been released.
  struct Touch {
    std::shared_ptr<Body> body;             ///< whose surface it is attached to
    std::shared_ptr<RigidBody> rigid;       ///< the body that it is fixed to; null: space
    std::unique_ptr<SurfaceSpring> spring;  ///< null for a weld
    std::unique_ptr<SurfaceWeld> weld;      ///< null for a spring
  };

  /// Where a ray has hit a surface.
  struct RayHit {
    std::shared_ptr<Body> body;  ///< null if it hits none
    SurfaceHit hit;              ///< where it hits the body's surface
  };

  /// An empty world.
  explicit World(const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  DeformableWorld& bullet() { return *world_; }              ///< Bullet's world
  const DeformableWorld& bullet() const { return *world_; }  ///< Bullet's world

  /// Advances by `dt` seconds in this number of equal substeps, and updates all visible surfaces. Motors of hinges
  /// added by `addJoint` are limited by torques, mass length^2 / s^2; Bullet itself uses impulses.
  /// dt        1e-6 to 10 seconds, or 0, which does nothing
  /// substeps  1 to 10000
  /// Returns   the number of substeps made
  /// Errors    InvalidOption: out of range, or called from within a step, and nothing has changed. After the step:
  ///           NonFinite, the simulation is unstable: restore a snapshot, or remove the body; TopologyChanged, the
  ///           application has changed a body's nodes or tets
  Result<int> step(double dt, int substeps = 4) {
    return step(dt, substeps, [this](btScalar whole, int count, btScalar substep) {
      return world_->stepSimulation(whole, count, substep);
    });
  }
  /// The same with another call instead of `stepSimulation`, with its arguments and result: for instance
  /// `Recorder::step`.
  template <class Stepped>
  Result<int> step(double dt, int substeps, Stepped&& stepped) {
    Status status = checkStep(dt, substeps);
    if (!status.ok()) return status;
    if (dt == 0.0) return 0;
    const btScalar substep = substepOf(dt, substeps);
    int made = 0;
    {
      const Within within(*this, substep);
      made = stepped(static_cast<btScalar>(dt), substeps, substep);
    }
    status = updateSkins();
    if (!status.ok()) return status;
    return made;
  }
  /// Makes the next step of a recorded run, and updates all visible surfaces.
  /// Returns  false without a step: at its end, or after an error, see `Replay::status`; restore a snapshot then
  /// Errors   those of `step`
  Result<bool> step(Replay& replay);
  /// Whether a step is being made. Within it, `step`, `restore` and `replay` are refused with InvalidOption.
  bool inStep() const { return stepping_; }

  /// The state, see `saveSnapshot`.
  Result<std::vector<char>> save() const;
  /// Goes back to a saved state, see `restoreSnapshot`, and updates all visible surfaces.
  Status restore(const void* snapshot, std::size_t size);
  /// Opens a recorded run, see `Replay::open`, in the state at the start of the recording.
  /// path  UTF-8
  Result<std::unique_ptr<Replay>> replay(const std::string& path);

  /// Adds a soft body.
  /// cage       in the rest space of the mesh; kept; not null
  /// mesh       kept; null: no surface, and contact at the cage's nodes
  /// placement  of the rest space in the world: a rotation and a translation; not checked
  /// Cost       `DeformableBody::add`, and `SoftBodyBinding::create` for the first body of its cage, mesh and binding's
  ///            options; soft and self contact `ContactShape::create` likewise: a second for 20,000 triangles
  /// Errors     those of the calls named; Unbound: contact at the surface of a body without one; IndexOutOfRange:
  ///            `pinned`. On an error nothing is changed
  Result<std::shared_ptr<Body>> addBody(std::shared_ptr<const Cage> cage, std::shared_ptr<const TriangleMesh> mesh,
                                        const WorldBodyOptions& options = {},
                                        const Eigen::Affine3d& placement = Eigen::Affine3d::Identity());
  /// Adds a rigid body.
  /// shape      kept; not null
  /// mass       0: fixed
  /// kinematic  moved by `setPose`; mass 0
  /// Errors     InvalidOption: a mass or friction that is negative or not finite, a mass for a plane, a mesh or a
  ///            kinematic body. On an error nothing is changed
  Result<std::shared_ptr<RigidBody>> addRigidBody(std::shared_ptr<btCollisionShape> shape, double mass,
                                                  const btTransform& pose, double friction = 0.5,
                                                  bool kinematic = false);
  /// Adds a joint made for these bodies, which are in this world, and wakes them.
  /// first, joint  not null;  second  null for space
  /// collide  the two bodies still touch each other
  std::shared_ptr<Joint> addJoint(std::shared_ptr<RigidBody> first, std::shared_ptr<RigidBody> second,
                                  std::unique_ptr<btTypedConstraint> joint, bool collide = false);
  /// Keeps a spring or weld, with the objects that it is attached to.
  std::shared_ptr<Touch> add(Touch&& touch);

  /// Removes a rigid body, with its joints, springs and welds. Nothing happens to one that has been removed.
  void remove(RigidBody& rigid);
  void remove(Joint& joint);  ///< removes a joint, likewise; what it joined wakes
  /// Removes a soft body, with its contacts, springs and welds, likewise.
  void remove(Body& body);
  void remove(Touch& touch);  ///< releases a spring or a weld, likewise

  /// Places a rigid body: a kinematic one in the next step, which gives it the velocity of the motion. Does nothing if
  /// it has been removed.
  void setPose(RigidBody& rigid, const btTransform& pose);
  /// Like `DeformableBody::teleport`, with the surface.
  Status teleport(Body& body, const btTransform& motion);
  /// Like `DeformableBody::reset`, with the surface.
  Status reset(Body& body);
  /// Like tetskin::shiftOrigin, with all surfaces.
  Status shiftOrigin(const btVector3& origin);

  /// The tree of a body's surface, for points and rays; made by the first call, see `SurfaceTree::create`; it
  /// lives as long as the body. Errors:
  /// Unbound, the body has no surface; BodyDeleted, it has been removed.
  Result<const SurfaceTree*> treeOf(Body& body);
  /// The first intersection of a segment with the body's surface. Errors: those of `treeOf` and of
  /// `SurfaceTree::raycast`, except NoHit.
  Result<RayHit> raycast(const std::shared_ptr<Body>& body, const btVector3& from, const btVector3& to);
  /// The first intersection of a segment with any surface. Errors: those of a single body, of the first that has one.
  Result<RayHit> raycast(const btVector3& from, const btVector3& to);

  ForceRecord* forces() { return record_.get(); }       ///< of the last step; null without `recordForces`
  SoftContacts* softContacts() { return soft_.get(); }  ///< null until a body has soft or self contact
  const std::vector<std::shared_ptr<Body>>& bodies() const { return bodies_; }            ///< in the order of adding
  const std::vector<std::shared_ptr<RigidBody>>& rigidBodies() const { return rigids_; }  ///< in the order of adding

 private:
  /// Data that bodies of one cage and mesh share.
  struct Shared {
    std::weak_ptr<const Cage> cage;
    std::weak_ptr<const TriangleMesh> mesh;
    BindingOptions options;
    std::weak_ptr<const SoftBodyBinding> binding;
    EmbedReport fit;
    std::weak_ptr<const ContactShape> shape;
  };

  /// While it lives, the world is within a step, and limits the motors of hinges in Bullet's way: by an impulse.
  /// substep  seconds; 0: motors are unchanged
  class TETSKIN_WORLD_API Within {
   public:
    explicit Within(World& world, btScalar substep = 0);
    ~Within();
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

   private:
    World& world_;
  };

  Status checkStep(double dt, int substeps) const;
  static btScalar substepOf(double dt, int substeps);
  Status updateSkins();
  Status updateTeleported();
  Shared& sharedOf(const Body& body, const BindingOptions& options);
  /// What the surface needs of its model, in the body and, for contact with others, as the result.
  Result<std::shared_ptr<const ContactShape>> prepareSurface(Body& body, const WorldBodyOptions& options);
  Status bindSurface(Body& body, const WorldBodyOptions& options, std::shared_ptr<const ContactShape> shape);
  /// Removes those for which a condition holds, in order. Allocates nothing, so it works when memory is short.
  template <class Thing, class Condition>
  void removeEach(std::vector<std::shared_ptr<Thing>>& all, Condition&& condition) {
    for (std::size_t i = 0; i < all.size();) condition(*all[i]) ? remove(*std::shared_ptr<Thing>(all[i])) : void(++i);
  }

  std::unique_ptr<DeformableWorld> world_;
  ParallelFor* threads_ = nullptr;
  std::unique_ptr<ForceRecord> record_;
  std::unique_ptr<SoftContacts> soft_;
  std::vector<std::unique_ptr<Shared>> shared_;
  std::vector<std::shared_ptr<RigidBody>> rigids_;
  std::vector<std::shared_ptr<Joint>> joints_;
  std::vector<std::shared_ptr<Body>> bodies_;
  std::vector<std::shared_ptr<Touch>> touches_;
  std::vector<SoftBodySkin*> skins_;
  std::vector<StatusCode> statuses_;
  std::vector<std::pair<btHingeConstraint*, btScalar>> torques_;  ///< of motors, within a step
  bool stepping_ = false;
};

}  // namespace tetskin
