// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/solver/src/base/opened_member.h>
#include <tetskin/solver/src/base/required_solver.h>

namespace tetskin::bullet_detail {

using SolverOfWorld = Hidden<btDeformableMultiBodyDynamicsWorld, btDeformableBodySolver*>;
template struct Opened<SolverOfWorld, &btDeformableMultiBodyDynamicsWorld::m_deformableBodySolver>;

DeformableSolver* deformableSolver(btSoftBodySolver* solver) {
  return asOwn<DeformableSolver>(OwnObject::Kind::DeformableSolver, solver);
}

DeformableSolver* deformableSolverOf(const btSoftBody& body) {
  // A body that has left its world may refer to a solver that has been destroyed.
  if (!body.getBroadphaseHandle()) return nullptr;
  return deformableSolver(const_cast<btSoftBody&>(body).getSoftBodySolver());
}

btDeformableBodySolver& solverOf(btDeformableMultiBodyDynamicsWorld& world) {
  return *(world.*memberOf(SolverOfWorld()));
}

DeformableSolver* deformableSolverOf(btDeformableMultiBodyDynamicsWorld& world) {
  return deformableSolver(&solverOf(world));
}

Status refusal(const std::string& subject, const std::vector<std::string>& changes) {
  if (changes.empty()) return {};
  std::string message = "for " + subject;
  for (std::size_t k = 0; k < changes.size(); ++k) message += (k == 0 ? " " : "; and ") + changes[k];
  return {StatusCode::InvalidOption, message};
}

}  // namespace tetskin::bullet_detail
