// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBody.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <tetskin/touch/src/points/body_kind.h>

namespace tetskin::touch_detail {

bool isReduced(const btSoftBody& body) {
  return dynamic_cast<const btReducedDeformableBody*>(&body) != nullptr;
}

btDeformableBodySolver* deformableSolverOf(const btSoftBody& body) {
  // Only bodies in a world have one that is sure to be there.
  if (!body.getBroadphaseHandle()) return nullptr;
  auto* solver = dynamic_cast<btDeformableBodySolver*>(const_cast<btSoftBody&>(body).getSoftBodySolver());
  return solver && !solver->isReducedSolver() ? solver : nullptr;
}

}  // namespace tetskin::touch_detail
