// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/exported/solver_state.h>
#include <tetskin/solver/src/forces/elastic_force.h>
#include <tetskin/solver/src/search/padded_trees.h>
#include <tetskin/solver/src/step/step.h>
#include <tetskin/solver/src/step/watched_detection.h>

#include <cstdint>
#include <memory>
#include <unordered_set>
#include <vector>

namespace tetskin::bullet_detail {
namespace {

std::vector<btDeformableLagrangianForce*> forcesOf(DeformableSolver& solver) {
  std::vector<btDeformableLagrangianForce*> forces;
  const ForceList& list = *solver.getLagrangianForceArray();
  for (int k = 0; k < list.size(); ++k) {
    if (!isPlaceholder(list[k])) forces.push_back(list[k]);
  }
  return forces;
}

BodyGravity* gravityOf(btDeformableLagrangianForce* force) {
  return asOwn<BodyGravity>(OwnObject::Kind::BodyGravity, force);
}

/// Tells classes apart: the application's by Bullet's type number, the library's by what they write.
std::int64_t kindOf(btDeformableLagrangianForce* force) {
  if (inactiveForce(force)) return -1;
  return gravityOf(force) ? -2 : static_cast<std::int64_t>(force->getForceType());
}

/// The order of a tree's leaves, by their indices in the body's list of nodes or faces.
template <class Item>
void addLeaves(Hash& hash, const btDbvtNode* node, const btAlignedObjectArray<Item>& items) {
  if (!node) return;
  hash.add(node->isleaf() ? static_cast<std::uint64_t>(static_cast<const Item*>(node->data) - &items[0])
                          : ~std::uint64_t{0});
  for (int k = 0; k < 2 && node->isinternal(); ++k) addLeaves(hash, node->childs[k], items);
}

/// Bullet's own search finds contacts in the order of these trees. Steps keep the form of the trees; moving a body by
/// hand changes that of the nodes, and appending to a body that of both.
std::int64_t treesOf(const btSoftBody& body) {
  Hash hash;
  addLeaves(hash, body.m_ndbvt.m_root, body.m_nodes);
  const BodyWithTrees* own = bodyWithTrees(body);
  if (!own || !own->hasNoFaceTree()) addLeaves(hash, body.m_fdbvt.m_root, body.m_faces);
  return static_cast<std::int64_t>(hash.value());
}

void checkAnchors(WorldStream& stream, const btSoftBody& body) {
  const char* const kOthers = "a soft body had other anchors";
  const auto& anchors = body.m_deformableAnchors;
  stream.same(anchors.size(), kOthers);
  for (int k = 0; k < anchors.size() && !stream.failed(); ++k) {
    stream.same(static_cast<std::int64_t>(anchors[k].m_node - &body.m_nodes[0]), kOthers);
    stream.sameObject(anchors[k].m_cti.m_colObj, kOthers);
    for (int axis = 0; axis < 3; ++axis) stream.same(anchors[k].m_local[axis], kOthers);
  }
}

}  // namespace

WorldParts& WorldParts::get() {
  static auto* const parts = new WorldParts;  // never destroyed: worlds may be static
  return *parts;
}

btDefaultCollisionConstructionInfo WorldParts::small() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize = 16;
  return info;
}

bool isWatched(const btBroadphaseInterface& broadphase) {
  static bool detects = false;
  static const btBroadphaseInterface* const watched = new WatchedBroadphase(detects);
  return isOfSameClass(broadphase, *watched);
}

bool isWatched(const btDispatcher& dispatcher) {
  static bool detects = false;
  static auto* const configuration = new btDefaultCollisionConfiguration;
  static const btDispatcher* const watched = new WatchedDispatcher(*configuration, detects);
  return isOfSameClass(dispatcher, *watched);
}

bool drawsRecords(const btActionInterface& action) {
  static const btActionInterface* const drawing = new RecordDrawing;
  return isOfSameClass(action, *drawing);
}

void checkForces(WorldStream& stream, DeformableSolver& solver) {
  stream.same(solver.deterministic(), solver.deterministic() ? "it was not deterministic, and this one is"
                                                             : "it was deterministic, and this one is not");
  const std::vector<btDeformableLagrangianForce*> forces = forcesOf(solver);
  const char* const kOthers = "other soft bodies, contacts of soft bodies, springs or welds were there";
  std::unordered_set<const btSoftBody*> solvedHere;
  stream.same(forces.size(), kOthers);
  for (btDeformableLagrangianForce* force : forces) {
    stream.same(kindOf(force), kOthers);
    stream.same(force->m_softBodies.size(), kOthers);
    for (int b = 0; b < force->m_softBodies.size(); ++b) stream.sameObject(force->m_softBodies[b], kOthers);
    if (auto* elastic = dynamic_cast<ElasticForce*>(inactiveForce(force))) solvedHere.insert(elastic->body().body);
    if (InactiveForce* own = inactiveForce(force)) own->checkState(stream);
    if (stream.failed()) return;
  }
  const btAlignedObjectArray<btSoftBody*>& bodies = stream.world().getSoftBodyArray();
  stream.same(bodies.size(), "another number of soft bodies was there");
  for (int b = 0; b < bodies.size() && !stream.failed(); ++b) {
    stream.same(bodies[b]->m_nodes.size(), "a soft body had another number of nodes");
    checkAnchors(stream, *bodies[b]);
    if (bodies[b]->m_reducedModel) stream.refuse("a reduced body");
    if (bodies[b]->m_clusters.size() > 0) stream.refuse("a soft body with clusters");
    bool byBullet = solvedHere.count(bodies[b]) == 0 || collidesByBulletsTrees(*bodies[b]);
    stream(byBullet);
    if (byBullet) stream.same(treesOf(*bodies[b]), "a soft body whose contacts Bullet searches had other trees");
    const BodyChannel* channel = channelOf(*bodies[b]);
    const bool atSurface = channel && channel->surfaceContacts().lock();
    stream.same(atSurface, "a soft body had contact at its surface, or had none");
  }
}

void serializeForces(WorldStream& stream, DeformableSolver& solver) {
  for (btDeformableLagrangianForce* force : forcesOf(solver)) {
    if (BodyGravity* gravity = gravityOf(force)) gravity->serialize(stream);
    if (InactiveForce* own = inactiveForce(force)) own->serialize(stream);
  }
}

/// A record that exists now but did not then begins anew; one that existed only then is skipped.
void serializeRecord(WorldStream& stream, const std::weak_ptr<RecordedForces>& inSolver) {
  const std::shared_ptr<RecordedForces> recorded = inSolver.lock();
  bool wasThere = recorded != nullptr && stream.withRecords();
  stream(wasThere);
  if (wasThere) {
    RecordedForces unused(stream.world());
    (recorded ? *recorded : unused).serialize(stream);
  } else if (recorded) {
    recorded->clear();
  }
}

void serializeSolver(WorldStream& stream, DeformableSolver& solver) {
  auto& impl = Access<DeformableSolver>::impl(solver);
  if (stream.saving()) impl.forgetRemovedObjects(&stream.world());
  impl.serializeFlags(stream);
  impl.bodies.serialize(stream);
  impl.rows.serialize(stream);
  impl.impacts.serialize(stream);
  impl.driven.serialize(stream);
  impl.loads.serialize(stream);
  impl.sleepers.serialize(stream);
  impl.stillness.serialize(stream);
  impl.rigids.paths().serialize(stream);
  serializeRecord(stream, impl.recorded);
  if (stream.restoring()) impl.objects.note(&stream.world());
}

void serializeSolverSettings(WorldStream& stream, DeformableSolver& solver) {
  auto& impl = Access<DeformableSolver>::impl(solver);
  stream(impl.deterministic);
  stream(impl.nodeNormals);
  stream(impl.always);
}

}  // namespace tetskin::bullet_detail

namespace tetskin {

void DeformableSolver::Impl::serializeFlags(WorldStream& stream) {
  stream(solver.m_dt);
  stream(solver.m_useProjection);
  stream(solver.m_lineSearch);
  stream(solver.m_implicit);
  stream(impactParts);
  if (impactParts < 1) stream.fail();
}

}  // namespace tetskin
