// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world in which motion and contact are measured, with everything that moves in it.
#pragma once

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/solver/deformable_body.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "measure/body_model.h"
#include "measure/motion.h"
#include "measure/run.h"
#include "scenes/world.h"

class btGhostObject;
class btMultiBody;
class btMultiBodyLinkCollider;
class btTypedConstraint;

namespace tetskin::measure {

constexpr double kStep = 1.0 / 240;
/// The distance kept between a surface and a touched object, divided by the body's size: the exact gap at rest.
constexpr double kMargin = 0.002;

/// The transform of an object that is moved, not turned.
btTransform at(const Eigen::Vector3d& centre);

/// The distance of a point in world space from an obstacle.
using Distance = std::function<double(const Eigen::Vector3d&)>;

struct BodyOptions {
  double stiffness = 50.0;     ///< Young's modulus over density x gravity x size
  double friction = 0.5;       ///< combined with that of any obstacle of the scene
  double youngsModulus = 0.0;  ///< Pa; above 0: used instead of `stiffness`
  double mass = 1.0;           ///< kg
  double damping = 0.02;       ///< seconds
  double tolerance = 5e-3;     ///< tolerance of the library's solver
  bool byNodes = false;        ///< the cage's nodes touch rigid bodies, whatever the kind of the run
  bool sleeps = false;         ///< it may fall asleep
  double sampleSpacing = 0.0;  ///< of contact at the surface; 0: the default
  std::function<bool(const Eigen::Vector3d&)> pinned =
      {};  ///< chooses pinned nodes by rest position, in the model's space
};

/// A soft body in a MeasuringWorld, which owns it.
class SoftObject {
 public:
  /// material  from which the body was made
  SoftObject(DeformableBody& deformable, ModelPtr model, const SoftBodyOptions& material);

  DeformableBody& deformable() { return deformable_; }
  btSoftBody& soft() { return deformable_.body(); }
  const btSoftBody& soft() const { return deformable_.body(); }
  const BodyModel& model() const { return *model_; }
  const std::vector<double>& stiffnessScale() const { return stiffnessScale_; }  ///< tetCount; empty: 1

  void setElasticLaw(const ElasticLaw& law);
  /// Adds to the velocities of all nodes.
  void push(const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin = Eigen::Vector3d::Zero());

  RigidMotion motion() const { return rigidMotionOf(soft()); }
  double fastest() const { return fastestNode(soft()); }
  double kineticEnergy() const { return measure::kineticEnergy(soft()); }
  double elasticEnergy() const;
  double energy() const { return kineticEnergy() + elasticEnergy(); }
  /// The sum of the impulses of all contacts in the last step; 0 if nodes touch rigid bodies, as Bullet does not report
  /// these.
  std::optional<Eigen::Vector3d> contactImpulse() const;
  /// The mesh's vertices at present, world space.
  const std::vector<Eigen::Vector3d>& surface();
  /// The least distance of the mesh's vertices from an obstacle, metres.
  double gap(const Distance& distance);
  /// The least distance of the mesh's vertices from the floor's plane, y = 0.
  double floorGap();

 private:
  friend class MeasuringWorld;

  DeformableBody& deformable_;
  const SurfaceContact* contact_ = nullptr;  ///< null if the body's nodes touch rigid bodies
  ModelPtr model_;
  std::vector<double> stiffnessScale_;
  ElasticLaw law_;
  SoftBodySkin skin_;
  std::vector<Eigen::Vector3d> surface_;
};

class MeasuringWorld {
 public:
  explicit MeasuringWorld(Run& run, const Eigen::Vector3d& gravity = Eigen::Vector3d(0, -scenes::kEarth, 0));
  ~MeasuringWorld();
  MeasuringWorld(const MeasuringWorld&) = delete;
  MeasuringWorld& operator=(const MeasuringWorld&) = delete;

  SoftObject& addSoft(ModelPtr model, const BodyOptions& options, const Eigen::Isometry3d& at);
  SoftObject& addSoft(ModelPtr model, const BodyOptions& options, const Eigen::Vector3d& centre);
  /// Adds a soft body of any other material at its model's position; its nodes touch rigid bodies.
  SoftObject& addSoft(ModelPtr model, const SoftBodyOptions& material);
  /// From now on rigid bodies touch the body's surface, if the run's kind is that.
  void touchBySurface(SoftObject& body);
  /// Adds a soft body whose lowest point just touches a horizontal plane.
  SoftObject& addSoftOn(double height, const ModelPtr& model, const BodyOptions& options, double x = 0.0,
                        double z = 0.0);

  /// A soft body touches all others for which this was called, at their visual surfaces.
  /// shape  counts for the first body of a model, as a model has one shape
  void touchOthers(SoftObject& body, const ContactShapeOptions& shape = {});
  /// Contacts between these bodies in the last step.
  std::vector<SoftContact> softContacts() const { return world_.softContacts(); }
  /// The least of these contacts' distances, metres, at most 0: below 0 it is the penetration depth.
  double deepest() const;

  // Rigid bodies never fall asleep; their friction is 1, so that the soft body's friction is what counts. mass  0:
  // fixed
  btRigidBody& addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double mass = 0.0);
  btRigidBody& addSphere(const Eigen::Vector3d& centre, double radius, double mass = 0.0);
  btRigidBody& addRigid(std::unique_ptr<btCollisionShape> shape, const btTransform& at, double mass = 0.0);
  /// A large box with its upper side at y = 0.
  btRigidBody& addFloor();
  /// A box about the origin that takes part in contact detection and exerts no force: by its flags, or as a ghost.
  void addTrigger(double halfExtent);
  void addGhost(double halfExtent);
  /// Makes a body kinematic: the scene moves it by setting its world transform before each step.
  static btRigidBody& makeKinematic(btRigidBody& body);
  void addConstraint(std::unique_ptr<btTypedConstraint> constraint);
  /// Adds a multibody that is complete.
  /// link  the link that collides; -1: the base
  btMultiBody& addMultiBody(std::unique_ptr<btMultiBody> body, int link, std::unique_ptr<btCollisionShape> shape);

  const scenes::World& world() const { return world_; }
  btDeformableMultiBodyDynamicsWorld& bullet();
  void setGravity(const Eigen::Vector3d& gravity);
  void step(double seconds = kStep);
  /// Makes steps of equal length.
  /// after  called after each step
  void simulate(double seconds, const std::function<void()>& after = {}, double step = kStep);

  /// The momentum of everything that can move.
  Momentum momentum() const;
  /// Kinetic, elastic, and potential energy above y = 0; of multibodies, only the kinetic energy of their bases.
  double energy() const;

 private:
  SoftObject& addSoft(ModelPtr model, const SoftBodyOptions& material, const Eigen::Isometry3d& at);

  bool isBySurface(const BodyOptions& options) const { return run_.kind == Kind::Surface && !options.byNodes; }

  Run& run_;
  scenes::World world_;
  Eigen::Vector3d gravity_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btGhostObject>> ghosts_;
  std::vector<std::unique_ptr<btMultiBody>> multiBodies_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::vector<btRigidBody*> rigid_;
  std::vector<std::unique_ptr<SoftObject>> soft_;
  std::map<const BodyModel*, std::shared_ptr<const ContactShape>> shapesOfModels_;
};

/// Simulates. Reports how much momentum is lost, and the largest energy over its start, which Bullet's material would
/// need other formulas for.
/// after  called after each step
void reportConserved(Run& run, MeasuringWorld& world, double seconds, const std::function<void()>& after = {});

}  // namespace tetskin::measure
