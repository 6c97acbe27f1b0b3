// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/measuring_world.h"

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <utility>

#include "measure/extremes.h"
#include "scenes/input_error.h"

namespace tetskin::measure {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Cage moved(Cage cage, const Isometry3d& to) {
  for (Vector3d& node : cage.mesh.nodes) node = to * node;
  return cage;
}

SoftBodyOptions materialOf(const BodyModel& model, const BodyOptions& options, const Isometry3d& at) {
  SoftBodyOptions soft;
  soft.mass = options.mass;
  soft.friction = options.friction;
  soft.stiffnessDamping = options.damping;
  soft.solverTolerance = options.tolerance;
  soft.maxIterations = 1000;  // no figure may come from a solve that was stopped early
  const double density = options.mass / model.volume;
  soft.youngsModulus =
      options.youngsModulus > 0.0 ? options.youngsModulus : options.stiffness * density * scenes::kEarth * model.size;
  if (options.pinned) {
    soft.pinned = [pinned = options.pinned, toRest = at.inverse()](const Vector3d& p) { return pinned(toRest * p); };
  }
  return soft;
}

}  // namespace

btTransform at(const Vector3d& centre) {
  return btTransform(btQuaternion::getIdentity(), toBullet(centre));
}

SoftObject::SoftObject(DeformableBody& deformable, ModelPtr model, const SoftBodyOptions& material)
    : deformable_(deformable),
      model_(std::move(model)),
      stiffnessScale_(withCageDefaults(model_->cage, material).stiffnessScale) {
  scenes::require(skin_.bind(soft(), model_->binding));
}

void SoftObject::push(const Vector3d& velocity, const Vector3d& spin) {
  const Vector3d centroid = motion().centroid;
  for (int n = 0; n < soft().m_nodes.size(); ++n) {
    btSoftBody::Node& node = soft().m_nodes[n];
    node.m_v += toBullet(velocity + spin.cross(toEigen(node.m_x) - centroid));
    node.m_vn = node.m_v;
  }
}

void SoftObject::setElasticLaw(const ElasticLaw& law) {
  scenes::require(deformable_.setElasticLaw(law));
  law_ = law;
}

double SoftObject::elasticEnergy() const {
  return measure::elasticEnergy(*model_, soft(), {deformable_.youngsModulus(), deformable_.poissonRatio()}, law_,
                                stiffnessScale_);
}

std::optional<Vector3d> SoftObject::contactImpulse() const {
  if (!contact_) return std::nullopt;
  Vector3d sum = Vector3d::Zero();
  for (const SurfaceContactPoint& point : contact_->contacts()) sum += toEigen(point.impulse);
  return sum;
}

const std::vector<Vector3d>& SoftObject::surface() {
  skin_.markMoved();
  surface_.assign(skin_.positions().size(), Vector3d::Constant(std::nan("")));
  if (skin_.update() != StatusCode::Ok) return surface_;
  for (std::size_t v = 0; v < surface_.size(); ++v) {
    surface_[v] = Eigen::Map<const Eigen::Matrix<btScalar, 3, 1>>(skin_.positions()[v]).cast<double>();
  }
  return surface_;
}

double SoftObject::gap(const Distance& distance) {
  double minimum = HUGE_VAL;
  for (const Vector3d& p : surface()) lower(minimum, distance(p));
  return minimum;
}

double SoftObject::floorGap() {
  return gap([](const Vector3d& p) { return p.y(); });
}

MeasuringWorld::MeasuringWorld(Run& run, const Vector3d& gravity)
    : run_(run),
      world_(run.kind == Kind::Bullet ? scenes::Force::LinearElasticity : scenes::Force::Elastic, toBullet(gravity)),
      gravity_(gravity) {}

MeasuringWorld::~MeasuringWorld() {
  for (const auto& constraint : constraints_) bullet().removeConstraint(constraint.get());
  for (const auto& collider : colliders_) bullet().removeCollisionObject(collider.get());
  for (const auto& body : multiBodies_) bullet().removeMultiBody(body.get());
  for (const auto& ghost : ghosts_) bullet().removeCollisionObject(ghost.get());
}

btDeformableMultiBodyDynamicsWorld& MeasuringWorld::bullet() {
  return static_cast<btDeformableMultiBodyDynamicsWorld&>(world_.bullet());
}

SoftObject& MeasuringWorld::addSoft(ModelPtr model, const SoftBodyOptions& material, const Isometry3d& at) {
  world_.add(moved(model->cage, at), material);
  soft_.push_back(std::make_unique<SoftObject>(world_.deformable(), std::move(model), material));
  return *soft_.back();
}

SoftObject& MeasuringWorld::addSoft(ModelPtr model, const SoftBodyOptions& material) {
  return addSoft(std::move(model), material, Isometry3d::Identity());
}

SoftObject& MeasuringWorld::addSoft(ModelPtr model, const BodyOptions& options, const Isometry3d& at) {
  SoftObject& body = addSoft(model, materialOf(*model, options, at), at);
  if (!options.sleeps) body.soft().setActivationState(DISABLE_DEACTIVATION);
  if (!isBySurface(options)) return body;
  SurfaceContactOptions contact;
  contact.margin = kMargin * model->size;
  if (options.sampleSpacing > 0.0) contact.sampleSpacing = options.sampleSpacing;
  body.contact_ = &world_.touchBySurface(body.soft(), *model->binding, model->mesh, contact);
  return body;
}

SoftObject& MeasuringWorld::addSoft(ModelPtr model, const BodyOptions& options, const Vector3d& centre) {
  Isometry3d at = Isometry3d::Identity();
  at.translation() = centre;
  return addSoft(std::move(model), options, at);
}

SoftObject& MeasuringWorld::addSoftOn(double height, const ModelPtr& model, const BodyOptions& options, double x,
                                      double z) {
  // The default of `SoftBodyOptions::margin`.
  constexpr double kNodeMargin = 0.02;
  const bool bySurface = isBySurface(options);
  const Box3 box = boundingBox(bySurface ? model->mesh.positions : model->cage.mesh.nodes);
  const double margin = bySurface ? kMargin * model->size : kNodeMargin * box.sizes().maxCoeff();
  return addSoft(model, options, Vector3d(x, height + margin - box.min().y(), z));
}

void MeasuringWorld::touchBySurface(SoftObject& body) {
  if (run_.kind == Kind::Surface) world_.touchBySurface(body.soft(), *body.model().binding, body.model().mesh);
}

void MeasuringWorld::touchOthers(SoftObject& body, const ContactShapeOptions& options) {
  std::shared_ptr<const ContactShape>& shape = shapesOfModels_[&body.model()];
  if (!shape) {
    auto made = ContactShape::create(body.model().cage, body.model().mesh, options);
    scenes::require(made.status());
    shape = std::move(made).value();
  }
  world_.touchEachOther(body.soft(), shape);
}

double MeasuringWorld::deepest() const {
  double deepest = 0.0;
  for (const SoftContact& contact : softContacts()) lower(deepest, static_cast<double>(contact.distance));
  return deepest;
}

btRigidBody& MeasuringWorld::addRigid(std::unique_ptr<btCollisionShape> shape, const btTransform& at, double mass) {
  btRigidBody& body = world_.addRigid(std::move(shape), at, mass);
  if (mass > 0.0) {
    body.setActivationState(DISABLE_DEACTIVATION);
    rigid_.push_back(&body);
  }
  return body;
}

btRigidBody& MeasuringWorld::addBox(const Vector3d& centre, const Vector3d& halfExtents, double mass) {
  return addRigid(std::make_unique<btBoxShape>(toBullet(halfExtents)), at(centre), mass);
}

btRigidBody& MeasuringWorld::addSphere(const Vector3d& centre, double radius, double mass) {
  return addRigid(std::make_unique<btSphereShape>(static_cast<btScalar>(radius)), at(centre), mass);
}

btRigidBody& MeasuringWorld::addFloor() {
  return addBox({0, -1, 0}, {20, 1, 20});
}

void MeasuringWorld::addTrigger(double halfExtent) {
  btRigidBody& trigger = addBox(Vector3d::Zero(), Vector3d::Constant(halfExtent));
  trigger.setCollisionFlags(trigger.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
}

void MeasuringWorld::addGhost(double halfExtent) {
  shapes_.push_back(std::make_unique<btBoxShape>(toBullet(Vector3d::Constant(halfExtent))));
  ghosts_.push_back(std::make_unique<btGhostObject>());
  btGhostObject& ghost = *ghosts_.back();
  ghost.setCollisionShape(shapes_.back().get());
  ghost.setWorldTransform(btTransform::getIdentity());
  ghost.setInterpolationWorldTransform(btTransform::getIdentity());
  ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  bullet().addCollisionObject(&ghost);
}

btRigidBody& MeasuringWorld::makeKinematic(btRigidBody& body) {
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
  return body;
}

void MeasuringWorld::addConstraint(std::unique_ptr<btTypedConstraint> constraint) {
  bullet().addConstraint(constraint.get(), true);
  constraints_.push_back(std::move(constraint));
}

btMultiBody& MeasuringWorld::addMultiBody(std::unique_ptr<btMultiBody> body, int link,
                                          std::unique_ptr<btCollisionShape> shape) {
  bullet().addMultiBody(body.get());
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  body->forwardKinematics(turns, origins);
  auto collider = std::make_unique<btMultiBodyLinkCollider>(body.get(), link);
  collider->setCollisionShape(shape.get());
  collider->setFriction(1);
  const btTransform where = link < 0 ? body->getBaseWorldTransform() : body->getLink(link).m_cachedWorldTransform;
  collider->setWorldTransform(where);
  collider->setInterpolationWorldTransform(where);
  (link < 0 ? body->setBaseCollider(collider.get()) : void(body->getLink(link).m_collider = collider.get()));
  bullet().addCollisionObject(collider.get());
  colliders_.push_back(std::move(collider));
  shapes_.push_back(std::move(shape));
  multiBodies_.push_back(std::move(body));
  return *multiBodies_.back();
}

void MeasuringWorld::setGravity(const Vector3d& gravity) {
  gravity_ = gravity;
  bullet().setGravity(toBullet(gravity));
}

void MeasuringWorld::step(double seconds) {
  world_.step(seconds);
  ++run_.steps;
  run_.iterations += world_.iterations();
}

void MeasuringWorld::simulate(double seconds, const std::function<void()>& after, double step) {
  const auto steps = std::lround(seconds / step);
  for (long k = 0; k < steps; ++k) {
    this->step(step);
    if (after) after();
  }
}

Momentum MeasuringWorld::momentum() const {
  Momentum sum;
  for (const auto& body : soft_) addMomentum(sum, body->soft());
  for (const btRigidBody* body : rigid_) addMomentum(sum, *body);
  for (const auto& body : multiBodies_) addMomentum(sum, *body);
  return sum;
}

double MeasuringWorld::energy() const {
  double energy = 0.0;
  for (const auto& body : soft_) {
    const RigidMotion motion = body->motion();
    energy += body->energy() - motion.mass * gravity_.dot(motion.centroid);
  }
  for (const btRigidBody* body : rigid_) {
    const double mass = 1.0 / static_cast<double>(body->getInvMass());
    energy += kineticEnergy(*body) - mass * gravity_.dot(toEigen(body->getCenterOfMassPosition()));
  }
  for (const auto& body : multiBodies_) energy += kineticEnergy(*body);
  return energy;
}

void reportConserved(Run& run, MeasuringWorld& world, double seconds, const std::function<void()>& after) {
  const Momentum before = world.momentum();
  const double start = world.energy();
  double maximum = 0.0;
  world.simulate(seconds, [&] {
    raise(maximum, world.energy());
    if (after) after();
  });
  const Momentum end = world.momentum();
  run.report("linear momentum lost", (end.linear - before.linear).norm() / before.linearScale);
  run.report("angular momentum lost", (end.angular - before.angular).norm() / before.angularScale);
  if (run.kind != Kind::Bullet) run.report("energy over its start", maximum / start);
}

}  // namespace tetskin::measure
