// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/replay/src/state/bullet_members.h>
#include <tetskin/replay/src/state/world_state.h>
#include <tetskin/solver/src/base/destroy_all.h>

#include <vector>

namespace tetskin::bullet_detail {
namespace {

using Node = btSoftBody::Node;

void serializeSettings(WorldStream& stream, btSoftBody& body) {
  btSoftBody::Config& c = body.m_cfg;
  serializeAll(stream, c.aeromodel, c.kVCF, c.kDP, c.kDG, c.kLF, c.kPR, c.kVC, c.kDF, c.kMT, c.kCHR, c.kKHR, c.kSHR,
               c.kAHR, c.kSRHR_CL, c.kSKHR_CL, c.kSSHR_CL, c.kSR_SPLT_CL, c.kSK_SPLT_CL, c.kSS_SPLT_CL, c.maxvolume,
               c.timescale, c.viterations, c.piterations, c.diterations, c.citerations, c.collisions, c.drag,
               c.m_maxStress);
  serializeAll(stream, body.m_dampingCoefficient, body.m_sleepingThreshold, body.m_repulsionStiffness,
               body.m_gravityFactor, body.m_useSelfCollision, body.m_softSoftCollision, body.m_windVelocity);
  const BodyWithTrees* own = bodyWithTrees(body);
  btScalar margin = own ? own->margin() : body.getCollisionShape()->getMargin();
  stream(margin);
  if (stream.restoring()) body.getCollisionShape()->setMargin(margin);
}

/// Results of the last step.
void serializeStep(WorldStream& stream, btSoftBody& body) {
  btSoftBody::SolverState& s = body.m_sst;
  serializeAll(stream, s.sdt, s.isdt, s.velmrg, s.radmrg, s.updmrg);
  serializeAll(stream, body.m_timeacc, body.m_bounds[0], body.m_bounds[1], body.m_maxSpeedSquared, body.m_bUpdateRtCst);
}

/// Objects in no world may have been destroyed; their pointers are only compared, and kept as they are.
void serializeIgnored(WorldStream& stream, btSoftBody& body) {
  auto& ignored = body.m_collisionDisabledObjects;
  std::vector<const btCollisionObject*> inWorld, others;
  for (int k = 0; k < ignored.size(); ++k) (stream.has(ignored[k]) ? inWorld : others).push_back(ignored[k]);
  stream.each(inWorld, [&](const btCollisionObject*& object) { stream.object(object); });
  if (!stream.restoring()) return;
  ignored.clear();
  for (const auto* list : {&inWorld, &others}) {
    for (const btCollisionObject* object : *list) ignored.push_back(object);
  }
}

/// True if a node has more state than its position and velocity: the application has moved or pushed it since the last
/// step, or it is anchored.
bool hasMore(const Node& node) {
  return node.m_q != node.m_x || node.m_vn != node.m_v || !node.m_f.isZero() || node.m_battach != 0;
}

void serializeMore(WorldStream& stream, Node& node) {
  serializeAll(stream, node.m_q, node.m_vn, node.m_f);
  int attached = node.m_battach;
  stream(attached);
  if (stream.restoring()) node.m_battach = attached != 0 ? -1 : 0;
}

void serializeNodes(WorldStream& stream, btSoftBody& body) {
  std::vector<int> more;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    Node& node = body.m_nodes[n];
    stream(node.m_x, node.m_v);
    if (stream.saving()) {
      if (hasMore(node)) more.push_back(n);
    } else {
      node.m_q = node.m_x;
      node.m_vn = node.m_v;
      node.m_f = node.m_splitv = btVector3(0, 0, 0);
      node.m_battach = node.m_constrained = 0;
    }
  }
  stream.array(more);
  for (const int n : more) {
    if (n < 0 || n >= body.m_nodes.size()) return stream.fail();
    serializeMore(stream, body.m_nodes[n]);
  }
}

/// Nodes may be pinned, or given other masses, at any time.
void serializeMasses(WorldStream& stream, btSoftBody& body) {
  for (int n = 0; n < body.m_nodes.size(); ++n) stream(body.m_nodes[n].m_im);
}

void serializeBody(WorldStream& stream, btSoftBody& body) {
  serializeSettings(stream, body);
  serializeStep(stream, body);
  serializeIgnored(stream, body);
  serializeNodes(stream, body);
  serializeMasses(stream, body);
  if (BodyWithTrees* own = bodyWithTrees(body)) own->serializeShift(stream);
  if (!stream.restoring()) return;
  destroyAll(body.m_nodeRigidContacts);
  destroyAll(body.m_faceRigidContacts);
  destroyAll(body.m_faceNodeContacts);
  destroyAll(body.m_faceNodeContactsCCD);
}

}  // namespace

void serializeSoftBodies(WorldStream& stream) {
  btAlignedObjectArray<btSoftBody*>& bodies = stream.world().getSoftBodyArray();
  for (int b = 0; b < bodies.size(); ++b) serializeBody(stream, *bodies[b]);
}

}  // namespace tetskin::bullet_detail
