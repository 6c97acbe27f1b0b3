// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/world.h"

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableCorotatedForce.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/reduced/reduced_body.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/obstacle_mesh.h"
#include "scenes/timer.h"

namespace tetskin::scenes {
namespace {

/// Spacing of contact samples, over the mesh's size: finer than obstacles here are thick.
constexpr double kSampleSpacing = 0.04;

ForceModel modelOf(Force force) {
  switch (force) {
    case Force::MassSpring:
      return ForceModel::MassSpring;
    case Force::LinearElasticity:
      return ForceModel::LinearElasticity;
    case Force::NeoHookean:
    case Force::BulletCorotated:
      return ForceModel::NeoHookean;
    case Force::Elastic:
    case Force::Reduced:
      break;
  }
  return ForceModel::Corotated;
}

/// radians about z
btTransform turned(const Eigen::Vector3d& centre, double turn) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(turn)), toBullet(centre));
}

}  // namespace

World::World(Force force, const btVector3& gravity)
    : force_(force),
      configuration_(std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>()),
      dispatcher_(std::make_unique<btCollisionDispatcher>(configuration_.get())),
      broadphase_(std::make_unique<btDbvtBroadphase>()) {
  force == Force::MassSpring ? makeClassic() : makeDeformable();
  world_->setGravity(gravity);
  info_->m_gravity = gravity;
  info_->m_sparsesdf.Initialize();
}

void World::makeClassic() {
  solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
  auto world = std::make_unique<btSoftRigidDynamicsWorld>(dispatcher_.get(), broadphase_.get(), solver_.get(),
                                                          configuration_.get());
  info_ = &world->getWorldInfo();
  world_ = std::move(world);
}

void World::makeDeformable() {
  if (force_ == Force::Elastic) {
    bodySolver_ = std::make_unique<DeformableSolver>();
  } else if (force_ == Force::Reduced) {
    bodySolver_ = std::make_unique<btReducedDeformableBodySolver>();
  } else {
    bodySolver_ = std::make_unique<btDeformableBodySolver>();
  }
  auto solver = std::make_unique<btDeformableMultiBodyConstraintSolver>();
  solver->setDeformableSolver(bodySolver_.get());
  auto world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(dispatcher_.get(), broadphase_.get(), solver.get(),
                                                                    configuration_.get(), bodySolver_.get());
  deformable_ = world.get();
  info_ = &world->getWorldInfo();
  solver_ = std::move(solver);
  world_ = std::move(world);
}

World::~World() {
  stepping_.reset();
  softContacts_.reset();
  contacts_.clear();
  deformableBodies_.clear();
  reducedBodies_.clear();
  for (const auto& body : bodies_) world_->removeCollisionObject(body.get());
  for (const auto& body : rigid_) world_->removeCollisionObject(body.get());
  world_.reset();
}

SurfaceContact& World::touchBySurface(btSoftBody& body, const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                      const SurfaceContactOptions& options) {
  if (!deformable_) throw InputError("contact at the surface needs the deformable world");
  auto made = SurfaceContact::add(*deformable_, body, binding, mesh, options);
  require(made.status());
  contacts_.push_back(std::move(made).value());
  return *contacts_.back();
}

void World::touchBySurface(btSoftBody& body, const SoftBodyBinding& binding, const TriangleMesh& mesh) {
  SurfaceContactOptions options;
  options.sampleSpacing = kSampleSpacing * boundingBox(mesh.positions).sizes().maxCoeff();
  touchBySurface(body, binding, mesh, options);
}

void World::touchEachOther(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool itself) {
  if (!deformable_) throw InputError("contact between soft bodies at their surfaces needs the deformable world");
  if (!softContacts_) {
    auto made = SoftContacts::add(*deformable_);
    require(made.status());
    softContacts_ = std::move(made).value();
  }
  require(softContacts_->add(body, std::move(shape), itself));
}

std::vector<SoftContact> World::softContacts() const {
  return softContacts_ ? softContacts_->contacts() : std::vector<SoftContact>{};
}

btSoftBody& World::add(const Cage& cage, SoftBodyOptions options) {
  options.forceModel = modelOf(force_);
  if (deformable_ && force_ != Force::BulletCorotated) {
    auto made = DeformableBody::add(*deformable_, cage, options);
    require(made.status());
    deformableBodies_.push_back(std::move(made).value());
    return deformableBodies_.back()->body();
  }
  auto made = createSoftBody(cage, *info_, options);
  require(made.status());
  bodies_.emplace_back(std::move(made).value());
  btSoftBody& body = *bodies_.back();
  if (deformable_) {
    addCorotated(body, options);
  } else {
    static_cast<btSoftRigidDynamicsWorld&>(*world_).addSoftBody(&body);
  }
  return body;
}

btSoftBody& World::add(const Cage& cage, const VibrationModes& modes, const ReducedBodyOptions& options) {
  auto made = ReducedBody::add(*deformable_, modes, cage, options);
  require(made.status());
  reducedBodies_.push_back(std::move(made).value());
  return reducedBodies_.back()->body();
}

void World::addCorotated(btSoftBody& body, const SoftBodyOptions& options) {
  const double shear = options.youngsModulus.value_or(0.0) / (2.0 * (1.0 + options.poissonRatio));
  auto elasticity = std::make_unique<btDeformableCorotatedForce>();
  elasticity->m_mu = static_cast<btScalar>(shear);
  elasticity->m_lambda = static_cast<btScalar>(2.0 * shear * options.poissonRatio / (1.0 - 2.0 * options.poissonRatio));
  deformable_->setImplicit(options.implicit.value_or(false));
  deformable_->setLineSearch(false);
  deformable_->setUseProjection(true);
  deformable_->addSoftBody(&body);
  forces_.push_back(std::make_unique<btDeformableGravityForce>(world_->getGravity()));
  deformable_->addForce(&body, forces_.back().get());
  forces_.push_back(std::move(elasticity));
  deformable_->addForce(&body, forces_.back().get());
}

void World::leaveOutNodeNormals() {
  if (force_ == Force::Elastic) static_cast<DeformableSolver&>(*bodySolver_).setNodeNormals(false);
}

void World::setThreads(ParallelFor* threads) {
  if (force_ == Force::Elastic) static_cast<DeformableSolver&>(*bodySolver_).setThreads(threads);
}

int World::iterations() const {
  return force_ == Force::Elastic ? static_cast<const DeformableSolver&>(*bodySolver_).iterations() : 0;
}

int World::step(double seconds) {
  const WallTimer timer;
  const int steps = stepping_ ? stepping_->step(seconds) : world_->stepSimulation(static_cast<btScalar>(seconds), 0);
  stageTimes_.simulation += timer.seconds();
  if (force_ == Force::Elastic && steps > 0) countSolve(static_cast<const DeformableSolver&>(*bodySolver_));
  return steps;
}

void World::countSolve(const DeformableSolver& solver) {
  ++solveTotals_.steps;
  solveTotals_.iterations += solver.iterations();
  solveTotals_.passes += solver.linearSolves();
  if (solver.unconvergedSystems() > 0) ++solveTotals_.unconverged;
  stageTimes_.solver = solver.stepTimes();
}

std::uint64_t World::hashOfNodes(std::uint64_t seed) const {
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btSoftBody* body = btSoftBody::upcast(objects[i]);
    for (int n = 0; body && n < body->m_nodes.size(); ++n) {
      const btVector3& x = body->m_nodes[n].m_x;
      const float position[3] = {static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())};
      seed = fnv1a(position, sizeof position, seed);
    }
  }
  return seed;
}

const ReductionReport* World::reduction() const {
  return reducedBodies_.empty() ? nullptr : &reducedBodies_.back()->report();
}

btRigidBody& World::addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope,
                           double mass) {
  if (mass == 0.0) appendBox(obstacles_, centre, halfExtents, slope);
  return addRigid(std::make_unique<btBoxShape>(toBullet(halfExtents)), turned(centre, slope), mass);
}

btRigidBody& World::addMovingBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents) {
  btRigidBody& body = addRigid(std::make_unique<btBoxShape>(toBullet(halfExtents)),
                               btTransform(btQuaternion::getIdentity(), toBullet(centre)), 0.0);
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
  return body;
}

void World::addPole(const Eigen::Vector3d& centre, double radius, double halfLength) {
  addRigid(std::make_unique<btCapsuleShapeZ>(static_cast<btScalar>(radius), static_cast<btScalar>(2.0 * halfLength)),
           btTransform(btQuaternion::getIdentity(), toBullet(centre)), 0.0);
  appendBox(obstacles_, centre, {radius, radius, halfLength}, 0.0);
  paint("pole");
}

void World::paint(const std::string& material) {
  assert(!obstacles_.groups.empty());
  obstacles_.groups.back().material = material;
}

void World::addSphere(const Eigen::Vector3d& centre, double radius) {
  addRigid(std::make_unique<btSphereShape>(static_cast<btScalar>(radius)),
           btTransform(btQuaternion::getIdentity(), toBullet(centre)), 0.0);
  appendSphere(obstacles_, centre, radius);
}

btRigidBody& World::addRigid(std::unique_ptr<btCollisionShape> shape, const btTransform& where, double mass) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  auto body = std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, shape.get(), inertia);
  body->setWorldTransform(where);
  // Bullet uses this one in its search for contacts of soft bodies, but does not set it itself.
  body->setInterpolationWorldTransform(where);
  body->setFriction(1);
  world_->addRigidBody(body.get());
  shapes_.push_back(std::move(shape));
  rigid_.push_back(std::move(body));
  return *rigid_.back();
}

void World::remove(btRigidBody& body) {
  world_->removeRigidBody(&body);
  const auto isIt = [&](const std::unique_ptr<btRigidBody>& one) { return one.get() == &body; };
  rigid_.erase(std::find_if(rigid_.begin(), rigid_.end(), isIt));
}

double defaultStiffness(const Cage& cage, const SoftBodyOptions& options) {
  World world(Force::NeoHookean, btVector3(0, static_cast<btScalar>(-kEarth), 0));
  world.add(cage, options);
  return world.deformable().youngsModulus();
}

double nodeSpeed(const std::vector<btSoftBody*>& bodies) {
  double squared = 0.0;
  int count = 0;
  for (const btSoftBody* body : bodies) {
    for (int n = 0; n < body->m_nodes.size(); ++n) squared += toEigen(body->m_nodes[n].m_v).squaredNorm();
    count += body->m_nodes.size();
  }
  return std::sqrt(squared / count);
}

void moveTo(btRigidBody& body, const Eigen::Vector3d& centre, double turn) {
  body.setWorldTransform(turned(centre, turn));
}

void movePinnedNode(btSoftBody::Node& node, const Eigen::Vector3d& target, double seconds) {
  node.m_v = (toBullet(target) - node.m_x) / static_cast<btScalar>(seconds);
}

}  // namespace tetskin::scenes
