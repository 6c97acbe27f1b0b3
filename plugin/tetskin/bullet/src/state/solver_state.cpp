// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_forces.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/state/world_state.h>
#include <tetskin/bullet/src/step/step.h>

#include <cstdint>
#include <memory>
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

/// Tells classes apart: the application's by the type that they have for Bullet, the library's by what they write.
std::int64_t kindOf(btDeformableLagrangianForce* force) {
  if (inactiveForce(force)) return -1;
  return gravityOf(force) ? -2 : static_cast<std::int64_t>(force->getForceType());
}

}  // namespace

void checkForces(WorldStream& stream, DeformableSolver& solver) {
  const std::vector<btDeformableLagrangianForce*> forces = forcesOf(solver);
  const char* const kOthers = "other soft bodies, contacts of soft bodies, springs, welds or loads were there";
  stream.same(forces.size(), kOthers);
  for (btDeformableLagrangianForce* force : forces) {
    stream.same(kindOf(force), kOthers);
    stream.same(force->m_softBodies.size(), kOthers);
    if (InactiveForce* own = inactiveForce(force)) own->checkState(stream);
    if (stream.failed()) return;
  }
  const btAlignedObjectArray<btSoftBody*>& bodies = stream.world().getSoftBodyArray();
  stream.same(bodies.size(), "another number of soft bodies was there");
  for (int b = 0; b < bodies.size() && !stream.failed(); ++b) {
    stream.same(bodies[b]->m_nodes.size(), "a soft body had another number of nodes");
    stream.same(bodies[b]->m_deformableAnchors.size(), "a soft body had another number of anchors");
    if (bodies[b]->m_reducedModel) stream.refuse("a reduced body");
    const BodyWithTrees* own = bodyWithTrees(*bodies[b]);
    const bool atSurface = own && own->surfaceContacts().lock();
    stream.same(atSurface, "a soft body had contact at its surface, or had none");
  }
}

void visitForces(WorldStream& stream, DeformableSolver& solver) {
  for (btDeformableLagrangianForce* force : forcesOf(solver)) {
    if (BodyGravity* gravity = gravityOf(force)) gravity->visitState(stream);
    if (InactiveForce* own = inactiveForce(force)) own->visitState(stream);
  }
}

/// A record that is there now but was not there then begins anew; one that was there then is left out.
void visitRecord(WorldStream& stream, const std::weak_ptr<RecordedForces>& inSolver) {
  const std::shared_ptr<RecordedForces> recorded = inSolver.lock();
  bool wasThere = recorded != nullptr;
  stream(wasThere);
  if (wasThere) {
    RecordedForces unused(stream.world());
    (recorded ? *recorded : unused).visitState(stream);
  } else if (recorded) {
    recorded->clear();
  }
}

void visitSolver(WorldStream& stream, DeformableSolver& solver) {
  DeformableSolver::Impl& impl = *solver.impl_;
  impl.visitFlags(stream);
  impl.bodies.visitState(stream);
  impl.driven.visitState(stream);
  impl.sleepers.visitState(stream);
  impl.stillness.visitState(stream);
  impl.rigids.paths().visitState(stream);
  visitRecord(stream, impl.recorded);
}

void visitSolverSettings(WorldStream& stream, DeformableSolver& solver) {
  DeformableSolver::Impl& impl = *solver.impl_;
  stream(impl.deterministic);
  stream(impl.nodeNormals);
  stream(impl.always);
}

}  // namespace tetskin::bullet_detail

namespace tetskin {

void DeformableSolver::Impl::visitFlags(WorldStream& stream) {
  stream(solver.m_dt);
  stream(solver.m_useProjection);
  stream(solver.m_lineSearch);
  stream(solver.m_implicit);
}

}  // namespace tetskin
