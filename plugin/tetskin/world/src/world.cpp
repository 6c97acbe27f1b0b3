// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/exported/contact_options.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/world/world.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace tetskin {
namespace {

/// Undoes a half-made change, unless it is told of success: also if memory runs out.
template <class Undo>
struct Unless {
  Undo undo;
  bool done = false;
  ~Unless() {
    if (!done) undo();
  }
};
template <class Undo>
Unless(Undo) -> Unless<Undo>;

Status invalid(const char* message) {
  return {StatusCode::InvalidOption, message};
}

SurfaceContactOptions contactOptions(const WorldBodyOptions& options) {
  SurfaceContactOptions contact;
  contact.margin = options.contactMargin;
  contact.sampleSpacing = options.sampleSpacing;
  return contact;
}

template <class Thing>
void forget(std::vector<std::shared_ptr<Thing>>& all, const Thing& thing) {
  all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& one) { return one.get() == &thing; }), all.end());
}

bool same(const BindingOptions& a, const BindingOptions& b) {
  const auto all = [](const BindingOptions& of) {
    const auto& [interpolation, normals, outside, maxDistance, order, hardEdgeDegrees] = of;
    return std::tie(interpolation, normals, outside, maxDistance, order, hardEdgeDegrees);
  };
  return all(a) == all(b);
}

btHingeConstraint* hingeOf(const World::Joint& joint) {
  if (joint.joint->getConstraintType() != HINGE_CONSTRAINT_TYPE) return nullptr;
  return static_cast<btHingeConstraint*>(joint.joint.get());
}

/// The next step says if it is not finite.
void showTeleported(World::Body& body) {
  if (!body.binding) return;
  body.skin.markTeleported();
  (void)body.skin.update();
}

/// Also for a body without a visible surface, which no skin checks. A sleeping one has been checked.
bool isFinite(const World::Body& body) {
  const btSoftBody& soft = body.body->body();
  const auto nodes = nodePositions(soft);
  return !soft.isActive() || firstUnusable(nodes) == nodes.size();
}

Status removed() {
  return {StatusCode::BodyDeleted, "the body has been removed from its world"};
}

}  // namespace

World::World(const WorldOptions& options)
    : world_(std::make_unique<DeformableWorld>(options)), threads_(options.threads) {
  if (options.recordForces) record_ = ForceRecord::add(*world_).value();
}

World::~World() {
  while (!touches_.empty()) remove(*touches_.back());
  while (!joints_.empty()) remove(*joints_.back());
  while (!bodies_.empty()) remove(*bodies_.back());
  soft_.reset();
  record_.reset();
  while (!rigids_.empty()) remove(*rigids_.back());
}

Status World::checkStep(double dt, int substeps) const {
  if (dt != 0.0 && !(dt >= 1e-6 && dt <= 10.0)) return invalid("dt: must be 0, or from 1e-6 to 10 seconds");
  if (substeps < 1 || substeps > 10000) return invalid("substeps: must be from 1 to 10000");
  if (!stepping_) return {};
  return invalid("the world is within a step: it cannot be stepped or restored by what it calls");
}

/// The longest step that fits into `dt` as often as it should: Bullet divides, and rounds down.
btScalar World::substepOf(double dt, int substeps) {
  const auto whole = static_cast<btScalar>(dt);
  btScalar step = whole / static_cast<btScalar>(substeps);
  while (static_cast<int>(whole / step) < substeps) step = std::nextafter(step, btScalar(0));
  return step;
}

World::Within::Within(World& world, btScalar substep) : world_(world) {
  world.torques_.clear();
  world.torques_.reserve(world.joints_.size());  // from here on, nothing fails
  for (const auto& joint : world.joints_) {
    btHingeConstraint* hinge = hingeOf(*joint);
    if (!hinge || substep == 0) continue;
    const btScalar torque = hinge->getMaxMotorImpulse();
    world.torques_.emplace_back(hinge, torque);
    hinge->setMaxMotorImpulse(torque * substep);
  }
  world.stepping_ = true;
}
World::Within::~Within() {
  for (const auto& [hinge, torque] : world_.torques_) hinge->setMaxMotorImpulse(torque);
  world_.stepping_ = false;
}

Result<bool> World::step(Replay& replay) {
  Status status = checkStep(0, 1);
  if (!status.ok()) return status;
  {
    const Within within(*this);
    if (!replay.step()) return false;
  }
  // A file contains impulses per step.
  for (const auto& joint : joints_) {
    if (btHingeConstraint* hinge = hingeOf(*joint))
      hinge->setMaxMotorImpulse(hinge->getMaxMotorImpulse() / replay.report().secondsPerStep);
  }
  status = updateSkins();
  if (!status.ok()) return status;
  return true;
}

Status World::updateSkins() {
  skins_.clear();
  for (const auto& body : bodies_) {
    if (body->binding) skins_.push_back(&body->skin);
  }
  statuses_.resize(skins_.size());
  SoftBodySkin::updateAll(skins_.data(), skins_.size(), statuses_.data(), 1, threads_);
  for (const StatusCode code : statuses_) {
    if (code == StatusCode::TopologyChanged) return {code, std::string("World.step: ") + toString(code)};
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (isFinite(*bodies_[b])) continue;
    return {StatusCode::NonFinite,
            "body " + std::to_string(b) +
                " has nodes that are not finite: the simulation is unstable. Restore a snapshot, or remove the body"};
  }
  return {};
}

Result<std::vector<char>> World::save() const {
  const Result<std::size_t> size = saveSnapshot(*world_, nullptr, 0);
  if (!size.ok()) return size.status();
  std::vector<char> bytes(size.value());
  const Result<std::size_t> saved = saveSnapshot(*world_, bytes.data(), bytes.size());
  if (!saved.ok()) return saved.status();
  return bytes;
}

Status World::restore(const void* snapshot, std::size_t size) {
  Status status = checkStep(0, 1);
  if (!status.ok()) return status;
  const Within within(*this);
  status = restoreSnapshot(*world_, snapshot, size);
  return status.ok() ? updateTeleported() : status;
}

Result<std::unique_ptr<Replay>> World::replay(const std::string& path) {
  Status status = checkStep(0, 1);
  if (!status.ok()) return status;
  const Within within(*this);
  Result<std::unique_ptr<Replay>> replay = Replay::open(*world_, path);
  if (!replay.ok()) return replay;
  status = updateTeleported();
  if (!status.ok()) return status;
  return replay;
}

Status World::updateTeleported() {
  for (const auto& body : bodies_) {
    if (body->binding) body->skin.markTeleported();
  }
  return updateSkins();
}

Result<std::shared_ptr<World::RigidBody>> World::addRigidBody(std::shared_ptr<btCollisionShape> shape, double mass,
                                                              const btTransform& pose, double friction,
                                                              bool kinematic) {
  assert(shape);
  if (!(mass >= 0.0 && mass < Limits::kMaxCoordinate)) return invalid("mass: must be 0 or more, and finite");
  if (!(friction >= 0.0 && friction < 1e6)) return invalid("friction: must be 0 or more, and finite");
  if (shape->isConcave() && mass > 0.0)
    return invalid("mass: a plane or a mesh does not move by itself; its mass is 0");
  if (kinematic && mass > 0.0) return invalid("mass: that of a kinematic body is 0");
  auto rigid = std::make_shared<RigidBody>();
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  rigid->motion = std::make_unique<btDefaultMotionState>(pose);
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), rigid->motion.get(), shape.get(), inertia);
  info.m_friction = static_cast<btScalar>(friction);
  rigid->shape = std::move(shape);
  rigid->body = std::make_unique<btRigidBody>(info);
  if (kinematic) {
    rigid->body->setCollisionFlags(rigid->body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid->body->setActivationState(DISABLE_DEACTIVATION);
  }
  rigids_.push_back(rigid);
  Unless added{[&] {
    world_->removeRigidBody(rigid->body.get());
    rigids_.pop_back();
  }};
  world_->addRigidBody(rigid->body.get());
  added.done = true;
  return rigid;
}

void World::setPose(RigidBody& rigid, const btTransform& pose) {
  if (rigid.removed) return;
  btRigidBody& body = *rigid.body;
  rigid.motion->setWorldTransform(pose);
  if (body.isKinematicObject()) return;
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
  world_->updateSingleAabb(&body);
  body.activate(true);
}

void World::remove(RigidBody& rigid) {
  if (rigid.removed) return;
  rigid.removed = true;
  removeEach(touches_, [&](const Touch& touch) { return touch.rigid.get() == &rigid; });
  removeEach(joints_, [&](const Joint& joint) { return joint.first.get() == &rigid || joint.second.get() == &rigid; });
  world_->removeRigidBody(rigid.body.get());
  forget(rigids_, rigid);
}

std::shared_ptr<World::Joint> World::addJoint(std::shared_ptr<RigidBody> first, std::shared_ptr<RigidBody> second,
                                              std::unique_ptr<btTypedConstraint> joint, bool collide) {
  assert(first && joint && !first->removed && !(second && second->removed));
  auto added = std::make_shared<Joint>(Joint{std::move(first), std::move(second), std::move(joint)});
  joints_.push_back(added);
  world_->addConstraint(added->joint.get(), !collide);
  added->first->body->activate(true);
  if (added->second) added->second->body->activate(true);
  return added;
}

void World::remove(Joint& joint) {
  if (!joint.joint) return;
  world_->removeConstraint(joint.joint.get());
  joint.first->body->activate(true);
  if (joint.second) joint.second->body->activate(true);
  const auto isOfIt = [&](const auto& motor) { return motor.first == joint.joint.get(); };  // within a step
  torques_.erase(std::remove_if(torques_.begin(), torques_.end(), isOfIt), torques_.end());
  joint.joint.reset();
  forget(joints_, joint);
}

World::Shared& World::sharedOf(const Body& body, const BindingOptions& options) {
  shared_.erase(std::remove_if(shared_.begin(), shared_.end(), [](const auto& one) { return one->binding.expired(); }),
                shared_.end());
  for (const auto& one : shared_) {
    if (one->cage.lock() == body.cage && one->mesh.lock() == body.mesh && same(one->options, options)) return *one;
  }
  shared_.push_back(std::make_unique<Shared>(Shared{body.cage, body.mesh, options, {}, {}, {}}));
  return *shared_.back();
}

Result<std::shared_ptr<const ContactShape>> World::prepareSurface(Body& body, const WorldBodyOptions& options) {
  Shared& shared = sharedOf(body, options.binding);
  body.binding = shared.binding.lock();
  if (!body.binding) {
    auto binding = SoftBodyBinding::create(*body.cage, *body.mesh, options.binding, &shared.fit);
    if (!binding.ok()) return binding.status();
    shared.binding = body.binding = std::move(binding).value();
  }
  body.fit = shared.fit;
  if (options.surfaceContact) {
    if (Status status = checkContactOptions(contactOptions(options), *body.mesh); !status.ok()) return status;
  }
  std::shared_ptr<const ContactShape> shape = shared.shape.lock();
  if (!shape && (options.softContact || options.selfContact)) {
    auto made = ContactShape::create(*body.cage, *body.mesh);
    if (!made.ok()) return made.status();
    shared.shape = shape = std::move(made).value();
  }
  return shape;
}

Status World::bindSurface(Body& body, const WorldBodyOptions& options, std::shared_ptr<const ContactShape> shape) {
  const std::size_t count = body.mesh->vertexCount();
  InstanceOptions instance;
  body.positions.resize(3 * count);
  instance.target = PointView<float>(body.positions.data(), count);
  if (options.binding.normals != Normals::None) {
    body.normals.resize(3 * count);
    instance.normalTarget = PointView<float>(body.normals.data(), count);
  }
  Status bound = body.skin.bind(body.body->body(), body.binding, instance);
  if (!bound.ok()) return bound;
  if (options.surfaceContact) {
    auto contact = SurfaceContact::add(*world_, body.body->body(), *body.binding, *body.mesh, contactOptions(options));
    if (!contact.ok()) return contact.status();
    body.contact = std::move(contact).value();
  }
  if (!options.softContact && !options.selfContact) return {};
  if (!soft_) soft_ = SoftContacts::add(*world_).value();
  Status added = soft_->add(body.body->body(), std::move(shape), options.selfContact);
  body.softContact = added.ok();
  return added;
}

Result<std::shared_ptr<World::Body>> World::addBody(std::shared_ptr<const Cage> cage,
                                                    std::shared_ptr<const TriangleMesh> mesh,
                                                    const WorldBodyOptions& options, const Eigen::Affine3d& placement) {
  assert(cage);
  if (!mesh && (options.softContact || options.selfContact))
    return Status{StatusCode::Unbound, "a body without a mesh has no surface to be in contact with others"};
  for (const int node : options.pinned) {
    if (node < 0 || static_cast<std::size_t>(node) >= cage->mesh.nodeCount())
      return Status{StatusCode::IndexOutOfRange, "pinned: there is no node " + std::to_string(node)};
  }
  Cage placed = *cage;
  // Not in place: Emscripten 3.1.6 would overwrite the last of an odd number before it has been read.
  const std::vector<Eigen::Vector3d>& rest = cage->mesh.nodes;
  std::transform(rest.begin(), rest.end(), placed.mesh.nodes.begin(),
                 [&](const Eigen::Vector3d& node) -> Eigen::Vector3d { return placement * node; });
  auto body = std::make_shared<Body>();
  body->cage = std::move(cage);
  body->mesh = std::move(mesh);
  std::shared_ptr<const ContactShape> shape;
  if (body->mesh) {  // before the body is in the world: what fails then leaves traces in its snapshots
    auto prepared = prepareSurface(*body, options);
    if (!prepared.ok()) return prepared.status();
    shape = std::move(prepared).value();
  }
  auto made = DeformableBody::add(*world_, placed, options.material);
  if (!made.ok()) return made.status();
  body->body = std::move(made).value();
  Unless added{[&] {
    if (soft_ && body->softContact) soft_->remove(body->body->body());
  }};
  Status bound = body->mesh ? bindSurface(*body, options, std::move(shape)) : Status{};
  if (!bound.ok()) return bound;
  if (body->mesh) body->body->preparePressureSurface(body->mesh, body->binding->embedding());
  for (const int node : options.pinned) (void)body->body->setPinned(node);
  if (body->mesh && !options.visible) body->skin.setVisible(false);
  bodies_.push_back(body);
  added.done = true;
  return body;
}

void World::remove(Body& body) {
  if (body.removed) return;
  body.removed = true;
  removeEach(touches_, [&](const Touch& touch) { return touch.body.get() == &body; });
  if (soft_ && body.softContact) soft_->remove(body.body->body());
  body.contact.reset();
  // The body itself is kept as long as a view of its nodes may be.
  world_->removeSoftBody(&body.body->body());
  forget(bodies_, body);
}

Status World::teleport(Body& body, const btTransform& motion) {
  Status status = body.removed ? removed() : body.body->teleport(motion);
  if (status.ok()) showTeleported(body);
  return status;
}

Status World::reset(Body& body) {
  Status status = body.removed ? removed() : body.body->reset();
  if (status.ok()) showTeleported(body);
  return status;
}

Status World::shiftOrigin(const btVector3& origin) {
  Status status = tetskin::shiftOrigin(*world_, origin);
  if (!status.ok()) return status;
  for (const auto& body : bodies_) showTeleported(*body);
  return status;
}

std::shared_ptr<World::Touch> World::add(Touch&& touch) {
  touches_.push_back(std::make_shared<Touch>(std::move(touch)));
  return touches_.back();
}

void World::remove(Touch& touch) {
  touch.spring.reset();
  touch.weld.reset();
  forget(touches_, touch);
}

Result<const SurfaceTree*> World::treeOf(Body& body) {
  if (body.removed) return removed();
  if (!body.binding) return Status{StatusCode::Unbound, "the body has no surface: it was added without a mesh"};
  if (!body.tree_) {
    auto tree = SurfaceTree::create(body.binding, *body.mesh);
    if (!tree.ok()) return tree.status();
    body.tree_ = std::make_unique<SurfaceTree>(std::move(tree).value());
  }
  return body.tree_.get();
}

Result<World::RayHit> World::raycast(const std::shared_ptr<Body>& body, const btVector3& from, const btVector3& to) {
  assert(body);
  const Result<const SurfaceTree*> tree = treeOf(*body);
  if (!tree.ok()) return tree.status();
  const SurfaceHit hit = tree.value()->raycast(body->skin, from, to);
  if (hit) return RayHit{body, hit};
  if (hit.status == StatusCode::NoHit) return RayHit{};
  return Status{hit.status, std::string("raycast: ") + toString(hit.status)};
}

Result<World::RayHit> World::raycast(const btVector3& from, const btVector3& to) {
  RayHit nearest;
  for (const auto& body : bodies_) {
    if (!body->binding) continue;
    Result<RayHit> found = raycast(body, from, to);
    if (!found.ok()) return found;
    const RayHit& hit = found.value();
    if (hit.body && (!nearest.body || hit.hit.distance < nearest.hit.distance)) nearest = hit;
  }
  return nearest;
}

}  // namespace tetskin
