// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btAabbUtil2.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/solver/src/base/contact_filter.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/search/kinematic_paths.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

/// Results for shapes near the body take some 100 bytes per tet and shape. They are kept within this many bytes, but
/// for at least the number of shapes below. If there are more, the first ones are kept: each is asked for once per
/// step, so a least recently used rule would drop each one just before its turn.
constexpr std::size_t kMaxMemoryBytes = std::size_t(32) << 20;
constexpr std::size_t kMinRemembered = 64;
/// For nodes, relative to the body's size: the distance around them within which a search finds clearances, and the
/// depth up to which a node behind a mesh's surface still belongs to it. For surfaces see SurfaceContact.
constexpr btScalar kNodesSlack = btScalar(0.005), kMeshThickness = btScalar(0.03);
/// A shape that has not been near for this many steps is forgotten.
constexpr unsigned kForgottenAfter = 64;

std::size_t maxRemembered(const ContactPatches& patches) {
  const std::size_t bytes = patches.clusters.size() * (sizeof(Ball) + sizeof(btScalar)) +
                            patches.patches.size() * sizeof(btScalar) + patches.nodes.size() * sizeof(btVector3);
  return std::max(kMinRemembered, kMaxMemoryBytes / std::max(bytes, std::size_t(1)));
}

/// The number of a child shape among all shapes of an object, however deep compounds are nested. Results are stored
/// under it, so it is the same in each step. It is a hash: two children collide as rarely as two random 64-bit numbers.
std::uint64_t numberOfChild(std::uint64_t compound, int child) {
  return compound * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(child) + 1;
}

/// Collects the items of the leaves.
struct LeafGatherer : btDbvt::ICollide {
  // Not marked as an override: for MSVC, Bullet's functions are templates, and this one of its classes is not virtual.
  // NOLINTNEXTLINE(modernize-use-override,cppcoreguidelines-explicit-virtual-functions)
  void Process(const btDbvtNode* leaf) { items.push_back(leaf->dataAsInt); }
  std::vector<int> items;
};

/// The transform of an object at the end of the step. Bullet does not update its predicted transform if the object does
/// not move by itself, or sleeps.
btTransform predictedOf(const btCollisionObject& object) {
  const bool moves = object.isActive() && !object.isStaticOrKinematicObject();
  return moves ? object.getInterpolationWorldTransform() : object.getWorldTransform();
}

/// How far a turning shape may leave the box around both ends of its path: at most the height of its farthest point's
/// arc.
btScalar beyondBox(const btCollisionShape& shape, const ShapePath& path) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btScalar turned = turnBetween(path.now.getBasis(), path.predicted.getBasis());
  return turned > 0 ? turned * turned * (low.length() + high.length()) : btScalar(0);
}

/// The path of one shape of the object: a child of a compound has a transform within it.
/// paths  null outside of steps
ShapePath pathOf(const btCollisionObjectWrapper& rigid, const KinematicPaths* paths) {
  const btCollisionObject& object = *rigid.getCollisionObject();
  const btTransform position = object.getWorldTransform().inverse() * rigid.getWorldTransform();
  const bool starts = paths && paths->knowsStart(object);
  return {starts ? paths->startOf(object) * position : rigid.getWorldTransform(), predictedOf(object) * position};
}

}  // namespace

BodyContacts::BodyContacts(const btDispatcher* dispatcher, BodyWithTrees& body, PointCollider search,
                           btScalar thickness)
    : dispatcher_(dispatcher),
      body_(body),
      channel_(BodyChannel::of(body)),
      lifetime_(body.lifetime()),
      search_(std::move(search)),
      thickness_(thickness),
      maxRemembered_(maxRemembered(search_.patches())) {}

/// Sleeping objects are searched at once: a contact wakes them, before Bullet decides what moves.
void BodyContacts::collide(const btCollisionObjectWrapper& rigid) {
  assert(bodyLives());
  const btCollisionObject& object = *rigid.getCollisionObject();
  if (!body_.isActive() || !collidesWithRigid(body_, object)) return;
  if (!dispatcher_ && (body_.m_cfg.collisions & btSoftBody::fCollision::SDF_RDN) == 0) return;
  const std::shared_ptr<const KinematicPaths> paths =
      channel_.speculation() > 0 ? channel_.kinematicPaths().lock() : nullptr;
  const Met met{&object, rigid.getCollisionShape(), pathOf(rigid, paths.get())};
  if (!channel_.searchWaits() || !(object.isActive() || object.isStaticOrKinematicObject())) return search(met);
  waiting_.push_back(met);
}

void BodyContacts::searchWaiting() {
  for (const Met& met : waiting_) search(met);
  waiting_.clear();
}

void BodyContacts::search(const Met& met) {
  KnownObject& known = known_[met.object];
  ++known.step;
  collideShape(*met.shape, 0, met.path, *met.object);
  if (known.step % kForgottenAfter == 0) forgetUnused(known);
}

/// The nodes do not move between the searches of a step. Outside of steps, an application may move them at any time.
void BodyContacts::readNodes() {
  const bool inStep = channel_.speculation() > 0;
  if (inStep && nodesRead_ == channel_.predictions()) return;
  nodesRead_ = channel_.predictions();
  nodes_.resize(static_cast<std::size_t>(body_.m_nodes.size()));
  for (int n = 0; n < body_.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body_.m_nodes[n];
    nodes_[static_cast<std::size_t>(n)] = {node.m_x, node.m_x + body_.m_sst.sdt * node.m_v};
  }
  // Known clearances are distances beyond the margin.
  const btScalar margin = body_.margin();
  for (auto known = known_.begin(); known != known_.end() && margin != margin_; ++known) {
    for (auto& [number, shape] : known->second.shapes) shape.memory = {};
  }
  margin_ = margin;
  search_.begin(nodes_, margin, channel_.speculation());
}

/// A box around the shape at both ends of its path.
WorldBox BodyContacts::boxAround(const btCollisionShape& shape, const ShapePath& path) const {
  WorldBox box;
  for (const btTransform* at : {&path.now, &path.predicted}) {
    btVector3 low, high;
    shape.getAabb(*at, low, high);
    box.extend(low.m_floats, high.m_floats);
  }
  return box;
}

/// Tests against the box that Bullet keeps for the body.
bool BodyContacts::isNear(const WorldBox& box) const {
  const btBroadphaseProxy* body = body_.getBroadphaseHandle();
  if (!body) return true;
  WorldBox bodys;
  bodys.extend(body->m_aabbMin.m_floats, body->m_aabbMax.m_floats);
  return box.collides(bodys);
}

void BodyContacts::collideShape(const btCollisionShape& shape, std::uint64_t number, const ShapePath& path,
                                const btCollisionObject& object) {
  const WorldBox box = boxAround(shape, path);
  if (!isNear(box)) return;
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (const int c : childrenNear(compound, path)) {
      const btTransform& local = compound.getChildTransform(c);
      collideShape(*compound.getChildShape(c), numberOfChild(number, c), {path.now * local, path.predicted * local},
                   object);
    }
    return;
  }
  KnownShape& known = knownShape(shape, number, object);
  ShapeProbe* probe = probeOf(shape, known);
  if (!probe) return;
  readNodes();
  // Points count as touching a mesh up to some depth behind it, and a turning shape leaves the box on its way.
  const WorldBox around = box.grownBy((shape.isConcave() ? thickness_ : btScalar(0)) + beyondBox(shape, path));
  bool touches = false;
  for (const PointContact& touch : search_.find(*probe, path, memoryOf(known), &around)) {
    if (passesOver(touch.at)) continue;
    PointContact& contact = channel_.pointContacts().emplace_back(touch);
    contact.body = &body_;
    contact.object = &object;
    contact.friction = body_.m_cfg.kDF * object.getFriction();
    touches = true;
  }
  if (touches && !object.isActive()) const_cast<btCollisionObject&>(object).activate();
}

/// Anchored nodes are held in place, and pinned ones do not move.
bool BodyContacts::passesOver(const CarriedPoint& point) const {
  if (point.count > 1) return false;
  const btSoftBody::Node& node = body_.m_nodes[point.nodes[0]];
  return node.m_battach != 0 || !(node.m_im > 0);
}

/// The numbers of the children near the body, ascending. In the compound's space, the paths of all the body's points
/// lie in the box around the body's current and predicted boxes: children outside of it touch nothing.
std::vector<int> BodyContacts::childrenNear(const btCompoundShape& compound, const ShapePath& path) const {
  LeafGatherer children;
  const btDbvt* tree = compound.getDynamicAabbTree();
  const btBroadphaseProxy* body = body_.getBroadphaseHandle();
  if (!tree || !body) {
    children.items.resize(static_cast<std::size_t>(compound.getNumChildShapes()));
    std::iota(children.items.begin(), children.items.end(), 0);
    return std::move(children.items);
  }
  btVector3 low, high, laterLow, laterHigh;
  btTransformAabb(body->m_aabbMin, body->m_aabbMax, 0, path.now.inverse(), low, high);
  btTransformAabb(body->m_aabbMin, body->m_aabbMax, 0, path.predicted.inverse(), laterLow, laterHigh);
  low.setMin(laterLow);
  high.setMax(laterHigh);
  tree->collideTV(tree->m_root, btDbvtVolume::FromMM(low, high), children);
  std::sort(children.items.begin(), children.items.end());
  return std::move(children.items);
}

void BodyContacts::forget(const btCollisionObject& object) {
  waiting_.erase(
      std::remove_if(waiting_.begin(), waiting_.end(), [&](const Met& met) { return met.object == &object; }),
      waiting_.end());
  const auto found = known_.find(&object);
  if (found != known_.end()) {
    for (const auto& [number, shape] : found->second.shapes) remembered_ -= shape.isRemembered;
    known_.erase(found);
  }
  if (!bodyLives()) return;
  // Contacts of the last step are reported until the next one.
  for (PointContact& contact : channel_.pointContacts()) {
    if (contact.object == &object) contact.object = nullptr;
  }
}

void BodyContacts::forgetAll() {
  waiting_.clear();
  known_.clear();
  remembered_ = 0;
  nodesRead_ = 0;
  channel_.pointContacts().clear();
}

/// Clearances are dropped, and found again with the same result.
void BodyContacts::shift(const btVector3& by) {
  for (auto& [object, known] : known_) {
    for (auto& [number, shape] : known.shapes) {
      ShapeMemory fresh;
      fresh.touched.swap(shape.memory.touched);
      shape.memory = std::move(fresh);
    }
  }
  for (PointContact& contact : channel_.pointContacts()) contact.position += by;
}

void BodyContacts::forgetUnused(KnownObject& object) {
  for (auto shape = object.shapes.begin(); shape != object.shapes.end();) {
    const bool used = object.step - shape->second.lastStep < kForgottenAfter;
    if (!used) remembered_ -= shape->second.isRemembered;
    shape = used ? std::next(shape) : object.shapes.erase(shape);
  }
}

KnownShape& BodyContacts::knownShape(const btCollisionShape& shape, std::uint64_t number,
                                     const btCollisionObject& object) {
  KnownObject& all = known_[&object];
  KnownShape& known = all.shapes[number];
  const ShapeKey key = ShapeKey::of(shape);
  if (!known.key.shape) known.key.shape = &shape;
  if (known.key != key) {
    known.key = key;
    known.memory = {};
    known.hull = nullptr;
  }
  known.lastStep = all.step;
  return known;
}

ShapeMemory& BodyContacts::memoryOf(KnownShape& known) {
  if (!known.isRemembered && remembered_ < maxRemembered_) {
    known.isRemembered = true;
    ++remembered_;
  }
  return known.isRemembered ? known.memory : overflow_ = {};
}

ShapeProbe* BodyContacts::probeOf(const btCollisionShape& shape, KnownShape& known) {
  if (const std::optional<ExactShape> exact = ExactShape::exactShape(shape)) {
    exact_.take(*exact);
    return &exact_;
  }
  if (shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE) {
    const bool hasFaces = hull_.take(static_cast<const btConvexHullShape&>(shape));
    known.hull = hull_.faces();
    if (hasFaces) return &hull_;
  }
  if (shape.isConvex() && !shape.isConvex2d()) {
    convex_.take(static_cast<const btConvexShape&>(shape));
    return &convex_;
  }
  if (!shape.isConcave()) return nullptr;
  mesh_.take(static_cast<const btConcaveShape&>(shape), thickness_);
  return &mesh_;
}

/// Shapes are sorted by number, because the map's order may differ in another run.
void BodyContacts::serialize(WorldStream& stream) {
  if (stream.restoring()) {
    waiting_.clear();
    remembered_ = 0;
    nodesRead_ = 0;
  }
  stream(margin_);
  stream.byObject(known_, [&](const btCollisionObject&, KnownObject& object) {
    stream(object.step);
    std::vector<std::uint64_t> numbers;
    for (const auto& [number, shape] : object.shapes) numbers.push_back(number);
    std::sort(numbers.begin(), numbers.end());
    stream.array(numbers);
    for (const std::uint64_t number : numbers) serializeShape(stream, object.shapes[number]);
  });
}

void BodyContacts::serializeShape(WorldStream& stream, KnownShape& shape) {
  stream(shape.key.low);
  stream(shape.key.high);
  stream(shape.lastStep);
  stream(shape.isRemembered);
  stream.array(shape.memory.touched);
  serializeFollowed(stream, shape.memory);
  if (!stream.restoring()) return;
  remembered_ += shape.isRemembered;
  std::sort(shape.memory.touched.begin(), shape.memory.touched.end());
}

void BodyContacts::serializeFollowed(WorldStream& stream, ShapeMemory& memory) {
  const ContactPatches& all = search_.patches();
  std::vector<std::uint32_t> followed;
  for (std::size_t p = 0; p < memory.clear.size(); ++p) {
    if (memory.clear[p] < 0 && memory.followed[p] == memory.steps) followed.push_back(static_cast<std::uint32_t>(p));
  }
  stream.array(followed);
  if (stream.restoring()) {
    if (!followed.empty()) search_.prepare(memory);
    for (btScalar& clear : memory.clear) clear = std::max(clear, btScalar(0));
  }
  for (const std::uint32_t p : followed) {
    if (!(p < all.patches.size())) return stream.fail();
    stream(memory.clear[p]);
    memory.followed[p] = memory.steps;
    for (std::uint32_t n = 0; n < all.patches[p].nodeCount; ++n) stream(memory.carriers[all.patches[p].firstNode + n]);
  }
}

btScalar sizeOfNodes(const BodyWithTrees& body) {
  return static_cast<btScalar>(boundingBox(nodePositions(body)).sizes().maxCoeff());
}

std::shared_ptr<BodyContacts> makeNodeContacts(BodyWithTrees& body, btScalar size) {
  const auto count = static_cast<std::size_t>(body.m_nodes.size());
  std::vector<LoosePatch> patches(count);
  for (std::size_t n = 0; n < count; ++n) {
    LoosePatch& patch = patches[n];
    patch.nodes = {static_cast<int>(n)};
    patch.weights = {1};
    const bool isNew = body.createdAt().size() != count;
    patch.centroid = toEigen(isNew ? body.m_nodes[static_cast<int>(n)].m_x : body.createdAt()[n]);
  }
  return std::make_shared<BodyContacts>(nullptr, body, PointCollider(clustered(patches), kNodesSlack * size),
                                        kMeshThickness * size);
}

std::shared_ptr<BodyContacts> contactsOf(const btSoftBody& body, const btDispatcher& dispatcher, bool nodes) {
  const BodyChannel* channel = channelOf(body);
  if (!channel) return nullptr;
  std::shared_ptr<BodyContacts> atSurface = channel->surfaceContacts().lock();
  if (atSurface && atSurface->dispatcher() == &dispatcher) return atSurface;
  const btSoftBodySolver* solver = const_cast<btSoftBody&>(body).getSoftBodySolver();
  const bool isOurs = channel->nodesSolver() && channel->nodesSolver() == solver;
  return nodes && isOurs ? channel->nodeContacts() : nullptr;
}

}  // namespace tetskin::bullet_detail
