// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "world_model.h"

#include <tetskin/replay/snapshot.h>
#include <algorithm>
#include <cmath>

namespace tetskin::facade {
namespace {

void checkNodes(const std::vector<int>& nodes, std::size_t count) {
  for (const int node : nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      fail(StatusCode::IndexOutOfRange, "nodes: there is no node " + std::to_string(node));
  }
}

template <class State>
void forget(std::vector<std::shared_ptr<State>>& all, const State& state) {
  all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& one) { return one.get() == &state; }), all.end());
}

bool same(const BindingOptions& a, const BindingOptions& b) {
  return a.interpolation == b.interpolation && a.normals == b.normals && a.outside == b.outside &&
         a.maxDistance == b.maxDistance;
}

btHingeConstraint* hingeOf(const JointState& state) {
  if (state.joint->getConstraintType() != HINGE_CONSTRAINT_TYPE) return nullptr;
  return static_cast<btHingeConstraint*>(state.joint.get());
}

/// The next step says if it is not finite.
void showTeleported(BodyState& body) {
  if (!body.binding) return;
  body.skin.markTeleported();
  (void)body.skin.update();
}

/// Also of a body without a surface to be seen, which no skin looks at. One that is asleep has been looked at.
bool isFinite(const BodyState& body) {
  const btSoftBody& soft = body.body->body();
  const auto nodes = nodePositions(soft);
  return !soft.isActive() || firstUnusable(nodes) == nodes.size();
}

}  // namespace

btVector3 toBullet(const Vec3& vector, const char* name) {
  finite(vector, name);
  return {static_cast<btScalar>(vector[0]), static_cast<btScalar>(vector[1]), static_cast<btScalar>(vector[2])};
}

btTransform toBullet(const Vec3& position, const Quaternion& rotation) {
  const btQuaternion q(static_cast<btScalar>(rotation[0]), static_cast<btScalar>(rotation[1]),
                       static_cast<btScalar>(rotation[2]), static_cast<btScalar>(rotation[3]));
  if (!(q.length2() > 1e-12f && q.length2() < 1e12f))
    fail(StatusCode::InvalidOption, "rotation: must be a quaternion x, y, z, w other than 0");
  return btTransform(q.normalized(), toBullet(position, "position"));
}

World::World(const Vec3& gravity, std::unique_ptr<ParallelFor> threads, bool deterministic, bool recordForces)
    : threads_(std::move(threads)) {
  DeformableWorldOptions options;
  options.gravity = toBullet(gravity, "gravity");
  options.threads = threads_.get();
  options.deterministic = deterministic;
  world_ = std::make_unique<DeformableWorld>(options);
  if (recordForces) record_ = take(ForceRecord::add(*world_));
}

World::~World() {
  while (!touches_.empty()) remove(*touches_.back());
  while (!joints_.empty()) remove(*joints_.back());
  while (!bodies_.empty()) remove(*bodies_.back());
  soft_.reset();
  record_.reset();
  while (!rigids_.empty()) remove(*rigids_.back());
}

void World::checkStep(double dt, int substeps) {
  if (dt != 0.0 && !(dt >= 1e-6 && dt <= 10.0))
    throw std::invalid_argument("dt: must be 0, or from 1e-6 to 10 seconds");
  if (substeps < 1 || substeps > 10000) throw std::invalid_argument("substeps: must be from 1 to 10000");
}

/// The longest step that is within `dt` as often as it should be: Bullet divides, and rounds down.
btScalar World::substepOf(double dt, int substeps) {
  const auto whole = static_cast<btScalar>(dt);
  btScalar step = whole / static_cast<btScalar>(substeps);
  while (static_cast<int>(whole / step) < substeps) step = std::nextafter(step, btScalar(0));
  return step;
}

World::Alone::Alone(World& world) : world_(world) {
  if (world.stepping_) {
    fail(StatusCode::InvalidOption, "the world is within a step: it cannot be stepped or restored by what it calls");
  }
  world.stepping_ = true;
}

World::MotorImpulses::MotorImpulses(World& world, btScalar substep) : world_(world) {
  world.torques_.clear();
  for (const auto& state : world.joints_) {
    btHingeConstraint* hinge = hingeOf(*state);
    if (!hinge) continue;
    const btScalar torque = hinge->getMaxMotorImpulse();
    world.torques_.emplace_back(hinge, torque);
    hinge->setMaxMotorImpulse(torque * substep);
  }
}
World::MotorImpulses::~MotorImpulses() {
  for (const auto& [hinge, torque] : world_.torques_) hinge->setMaxMotorImpulse(torque);
}

bool World::step(Replay& replay) {
  const Alone alone(*this);
  if (!replay.step()) return false;
  // A file has the impulses of steps.
  for (const auto& state : joints_) {
    if (btHingeConstraint* hinge = hingeOf(*state))
      hinge->setMaxMotorImpulse(hinge->getMaxMotorImpulse() / replay.report().secondsPerStep);
  }
  updateSkins();
  return true;
}

void World::updateSkins() {
  skins_.clear();
  for (const auto& body : bodies_) {
    if (body->binding) skins_.push_back(&body->skin);
  }
  statuses_.resize(skins_.size());
  SoftBodySkin::updateAll(skins_.data(), skins_.size(), statuses_.data(), 1, threads_.get());
  for (const StatusCode code : statuses_) {
    if (code == StatusCode::TopologyChanged) check(code, "World.step");
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (isFinite(*bodies_[b])) continue;
    fail(StatusCode::NonFinite, "body " + std::to_string(b) +
                                    " has nodes that are not finite: the simulation is unstable. Restore a snapshot, "
                                    "or remove the body");
  }
}

std::vector<char> World::save() const {
  std::vector<char> bytes(take(saveSnapshot(*world_, nullptr, 0)));
  (void)take(saveSnapshot(*world_, bytes.data(), bytes.size()));
  return bytes;
}

void World::restore(const void* snapshot, std::size_t size) {
  const Alone alone(*this);
  check(restoreSnapshot(*world_, snapshot, size));
  updateTeleported();
}

std::unique_ptr<Replay> World::replay(const std::string& path) {
  const Alone alone(*this);
  std::unique_ptr<Replay> replay = take(Replay::open(*world_, path));
  updateTeleported();
  return replay;
}

void World::updateTeleported() {
  for (const auto& body : bodies_) {
    if (body->binding) body->skin.markTeleported();
  }
  updateSkins();
}

namespace {

void checkFriction(double friction) {
  if (!(friction >= 0.0 && friction < 1e6)) throw std::invalid_argument("friction: must be 0 or more, and finite");
}

}  // namespace

std::shared_ptr<RigidState> World::addRigid(const ShapeModel& shape, double mass, const btTransform& pose,
                                            double friction, bool kinematic) {
  if (!(mass >= 0.0 && mass < Limits::kMaxCoordinate))
    throw std::invalid_argument("mass: must be 0 or more, and finite");
  checkFriction(friction);
  if (shape.concave && mass > 0.0)
    throw std::invalid_argument("mass: a plane or a mesh does not move by itself; its mass is 0");
  if (kinematic && mass > 0.0) throw std::invalid_argument("mass: that of a kinematic body is 0");
  auto rigid = std::make_shared<RigidState>();
  rigid->shape = shape;
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape.shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  rigid->motion = std::make_unique<btDefaultMotionState>(pose);
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), rigid->motion.get(), shape.shape.get(),
                                                inertia);
  info.m_friction = static_cast<btScalar>(friction);
  rigid->body = std::make_unique<btRigidBody>(info);
  if (kinematic) {
    rigid->body->setCollisionFlags(rigid->body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid->body->setActivationState(DISABLE_DEACTIVATION);
  }
  rigids_.push_back(rigid);
  try {
    world_->addRigidBody(rigid->body.get());
  } catch (...) {  // as if nothing had been added
    world_->removeRigidBody(rigid->body.get());
    rigids_.pop_back();
    throw;
  }
  return rigid;
}

namespace {

/// Where it is, or where it will be in the next step.
btTransform poseOf(const RigidState& rigid) {
  btTransform pose = alive(rigid).getWorldTransform();
  rigid.motion->getWorldTransform(pose);
  return pose;
}

}  // namespace

void World::setPosition(RigidState& rigid, const Vec3& position) {
  btTransform pose = poseOf(rigid);
  pose.setOrigin(toBullet(position, "position"));
  place(rigid, pose);
}

void World::setRotation(RigidState& rigid, const Quaternion& rotation) {
  btTransform pose = poseOf(rigid);
  pose.setRotation(toBullet(Vec3{}, rotation).getRotation());
  place(rigid, pose);
}

void World::place(RigidState& rigid, const btTransform& pose) {
  btRigidBody& body = alive(rigid);
  rigid.motion->setWorldTransform(pose);
  if (body.isKinematicObject()) return;
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
  world_->updateSingleAabb(&body);
  body.activate(true);
}

void World::remove(RigidState& rigid) {
  if (rigid.removed) return;
  rigid.removed = true;
  removeEach(touches_, [&](const TouchState& touch) { return touch.rigid.get() == &rigid; });
  removeEach(joints_,
             [&](const JointState& joint) { return joint.first.get() == &rigid || joint.second.get() == &rigid; });
  world_->removeRigidBody(rigid.body.get());
  forget(rigids_, rigid);
}

std::shared_ptr<JointState> World::addJoint(std::shared_ptr<RigidState> first, std::shared_ptr<RigidState> second,
                                            std::unique_ptr<btTypedConstraint> joint, bool collide) {
  auto state = std::make_shared<JointState>();
  state->first = std::move(first);
  state->second = std::move(second);
  state->joint = std::move(joint);
  joints_.push_back(state);
  world_->addConstraint(state->joint.get(), !collide);
  state->first->body->activate(true);
  return state;
}

void World::remove(JointState& joint) {
  if (!joint.joint) return;
  world_->removeConstraint(joint.joint.get());
  joint.first->body->activate(true);
  if (joint.second) joint.second->body->activate(true);
  joint.joint.reset();
  forget(joints_, joint);
}

World::Shared& World::sharedOf(const CageModel& cage, const MeshModel& mesh, const BindingOptions& options) {
  shared_.erase(std::remove_if(shared_.begin(), shared_.end(), [](const auto& one) { return one->binding.expired(); }),
                shared_.end());
  for (const auto& one : shared_) {
    if (one->cage.lock() == cage.cage && one->mesh.lock() == mesh.mesh && same(one->options, options)) return *one;
  }
  shared_.push_back(std::make_unique<Shared>(Shared{cage.cage, mesh.mesh, options, {}, {}}));
  return *shared_.back();
}

void World::bindSurface(BodyState& body, const BodyOptions& options) {
  Shared& shared = sharedOf(body.cage, body.mesh, options.binding);
  body.binding = shared.binding.lock();
  if (!body.binding) {
    body.binding = take(SoftBodyBinding::create(*body.cage.cage, *body.mesh.mesh, options.binding));
    shared.binding = body.binding;
  }
  const std::size_t count = body.mesh.mesh->vertexCount();
  InstanceOptions instance;
  body.positions.resize(3 * count);
  instance.target = PointView<float>(body.positions.data(), count);
  if (options.binding.normals != Normals::None) {
    body.normals.resize(3 * count);
    instance.normalTarget = PointView<float>(body.normals.data(), count);
  }
  check(body.skin.bind(body.body->body(), body.binding, instance));
  if (options.surfaceContact) {
    SurfaceContactOptions contact;
    contact.margin = options.contactMargin;
    contact.sampleSpacing = options.sampleSpacing;
    body.contact = take(SurfaceContact::add(*world_, body.body->body(), *body.binding, *body.mesh.mesh, contact));
  }
  if (!options.softContact && !options.selfContact) return;
  std::shared_ptr<const ContactShape> shape = shared.shape.lock();
  if (!shape) {
    shape = take(ContactShape::create(*body.cage.cage, *body.mesh.mesh));
    shared.shape = shape;
  }
  if (!soft_) soft_ = take(SoftContacts::add(*world_));
  check(soft_->add(body.body->body(), shape, options.selfContact));
  body.softContact = true;
}

std::shared_ptr<BodyState> World::addBody(const CageModel& cage, const MeshModel& mesh,
                                          const Eigen::Affine3d& placement, const BodyOptions& options) {
  if (!mesh.mesh && (options.softContact || options.selfContact))
    fail(StatusCode::Unbound, "a body without a mesh has no surface to be in contact with others");
  checkNodes(options.pinned, cage.cage->mesh.nodeCount());
  auto body = std::make_shared<BodyState>();
  body->cage = cage;
  body->mesh = mesh;
  Cage placed = *cage.cage;
  // From one array into another: in place, Emscripten 3.1.6 turns the last of an odd number while it is still read.
  const std::vector<Eigen::Vector3d>& rest = cage.cage->mesh.nodes;
  std::transform(rest.begin(), rest.end(), placed.mesh.nodes.begin(),
                 [&](const Eigen::Vector3d& node) -> Eigen::Vector3d { return placement * node; });
  body->body = take(DeformableBody::add(*world_, placed, options.material));
  try {
    if (mesh.mesh) bindSurface(*body, options);
    setPinned(*body, options.pinned, true);
    if (mesh.mesh && !options.visible) body->skin.setVisible(false);
    bodies_.push_back(body);
  } catch (...) {  // as if nothing had been added
    if (soft_ && body->softContact) soft_->remove(body->body->body());
    throw;
  }
  return body;
}

void World::remove(BodyState& body) {
  if (body.removed) return;
  body.removed = true;
  removeEach(touches_, [&](const TouchState& touch) { return touch.body.get() == &body; });
  if (soft_ && body.softContact) soft_->remove(body.body->body());
  body.contact.reset();
  // The body itself is kept as long as a view of its nodes may be.
  world_->removeSoftBody(&body.body->body());
  forget(bodies_, body);
}

void World::teleport(BodyState& body, const btTransform& motion) {
  check(alive(body).teleport(motion));
  showTeleported(body);
}

void World::reset(BodyState& body) {
  check(alive(body).reset());
  showTeleported(body);
}

void World::shiftOrigin(const btVector3& origin) {
  check(tetskin::shiftOrigin(*world_, origin));
  for (const auto& body : bodies_) showTeleported(*body);
}

std::shared_ptr<TouchState> World::addTouch(TouchState&& touch) {
  touches_.push_back(std::make_shared<TouchState>(std::move(touch)));
  return touches_.back();
}

void World::remove(TouchState& touch) {
  touch.spring.reset();
  touch.weld.reset();
  forget(touches_, touch);
}

const SurfaceTree& World::treeOf(BodyState& body) {
  if (!body.tree) body.tree = std::make_unique<SurfaceTree>(take(SurfaceTree::create(body.binding, *body.mesh.mesh)));
  return *body.tree;
}

RayHit World::raycast(const std::shared_ptr<BodyState>& body, const btVector3& from, const btVector3& to) {
  (void)alive(*body);
  checkSurface(*body);
  const SurfaceHit hit = treeOf(*body).raycast(body->skin, from, to);
  if (hit) return {body, hit};
  if (hit.status != StatusCode::NoHit) check(hit.status, "raycast");
  return {};
}

RayHit World::raycast(const btVector3& from, const btVector3& to) {
  RayHit nearest;
  for (const auto& body : bodies_) {
    if (!body->binding) continue;
    RayHit found = raycast(body, from, to);
    if (found.body && (!nearest.body || found.hit.distance < nearest.hit.distance)) nearest = std::move(found);
  }
  return nearest;
}

ImpulseResult World::radialImpulse(BodyState& body, const RadialImpulse& impulse) {
  btSoftBody& soft = alive(body).body();
  checkSurface(body);
  const ImpulseResult result = treeOf(body).applyImpulse(soft, impulse);
  if (result.status != StatusCode::NoHit) check(result.status, "a radial impulse");
  return result;
}

ForceRecord& World::forces() {
  if (!record_) fail(StatusCode::NotAdded, "record_forces: the world was made with this false, and records no forces");
  return *record_;
}

btRigidBody& alive(const RigidState& rigid) {
  if (rigid.removed) fail(StatusCode::BodyDeleted, "the rigid body has been removed from its world");
  return *rigid.body;
}

DeformableBody& alive(const BodyState& body) {
  if (body.removed) fail(StatusCode::BodyDeleted, "the body has been removed from its world");
  return *body.body;
}

void checkSurface(const BodyState& body) {
  if (!body.binding) fail(StatusCode::Unbound, "the body has no surface: it was added without a mesh");
}

SoftBodySkin& surfaceOf(BodyState& body) {
  (void)alive(body);
  checkSurface(body);
  return body.skin;
}

namespace {

std::size_t nodeCount(const BodyState& body) {
  return body.cage.cage->mesh.nodeCount();
}

PointView<const double> pointsOf(const double* numbers, std::size_t count, std::size_t nodes, const char* name) {
  if (count != 3 * nodes)
    fail(StatusCode::SizeMismatch,
         std::string(name) + ": " + std::to_string(count) + " numbers for " + std::to_string(nodes) + " nodes");
  const PointView<const double> points(numbers, nodes);
  if (firstUnusable(points) != nodes)
    fail(StatusCode::NonFinite, std::string(name) + ": a number is not finite, or larger than 1e18");
  return points;
}

btVector3 vectorAt(const PointView<const double>& points, std::size_t i) {
  return {static_cast<btScalar>(points[i][0]), static_cast<btScalar>(points[i][1]),
          static_cast<btScalar>(points[i][2])};
}

}  // namespace

void setVelocities(BodyState& body, const double* velocities, std::size_t numbers) {
  btSoftBody& soft = alive(body).body();
  const PointView<const double> points = pointsOf(velocities, numbers, nodeCount(body), "velocities");
  for (std::size_t i = 0; i < points.size(); ++i) {
    btSoftBody::Node& node = soft.m_nodes[static_cast<int>(i)];
    if (node.m_im > 0) node.m_v = vectorAt(points, i);
  }
  soft.activate(true);
}

void setPinned(BodyState& body, const std::vector<int>& nodes, bool pinned) {
  DeformableBody& soft = alive(body);
  checkNodes(nodes, nodeCount(body));
  for (const int node : nodes) check(soft.setPinned(node, pinned));
}

void setPinnedPositions(BodyState& body, const std::vector<int>& nodes, const double* positions, std::size_t numbers) {
  DeformableBody& soft = alive(body);
  checkNodes(nodes, nodeCount(body));
  const PointView<const double> points = pointsOf(positions, numbers, nodes.size(), "positions");
  for (const int node : nodes) {
    if (!soft.isPinned(node)) fail(StatusCode::InvalidOption, "nodes: node " + std::to_string(node) + " is not pinned");
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) check(soft.setPinnedPosition(nodes[i], vectorAt(points, i)));
}

std::vector<unsigned char> pinnedOf(const BodyState& body) {
  const DeformableBody& soft = alive(body);
  std::vector<unsigned char> mask(nodeCount(body));
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = soft.isPinned(static_cast<int>(i));
  return mask;
}

void setFriction(BodyState& body, double friction) {
  btSoftBody& soft = alive(body).body();
  if (!(friction >= 0.0 && friction <= 1.0)) fail(StatusCode::InvalidOption, "friction: must be from 0 to 1");
  soft.m_cfg.kDF = static_cast<btScalar>(friction);
}

void setFriction(RigidState& rigid, double friction) {
  checkFriction(friction);
  alive(rigid).setFriction(static_cast<btScalar>(friction));
}

}  // namespace tetskin::facade
