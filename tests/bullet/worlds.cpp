// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "worlds.h"

namespace tetskin::test {
namespace {

std::unique_ptr<btReducedDeformableBody> makeReducedBody(const TetMesh& cage, btSoftBodyWorldInfo& worldInfo) {
  std::vector<btVector3> nodes;
  for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(toBullet(p));
  const int count = static_cast<int>(nodes.size());
  auto body = std::make_unique<btReducedDeformableBody>(&worldInfo, count, nodes.data(), nullptr);
  for (const Tet& t : cage.tets) body->appendTetra(t[0], t[1], t[2], t[3]);
  for (const auto& f : boundaryFaces(cage)) body->appendFace(f[0], f[1], f[2]);
  body->initializeDmInverse();

  const int modes = 2;
  body->setReducedModes(modes, count);
  body->m_modes.resize(modes);
  for (int m = 0; m < modes; ++m) body->m_modes[m].resize(3 * count, 0);
  const Eigen::Vector3d centre = boundingBox(cage.nodes).center();
  for (int n = 0; n < count; ++n) {
    const Eigen::Vector3d p = cage.nodes[n] - centre;
    body->m_modes[0][3 * n + 1] = static_cast<btScalar>(p.x() * p.x() - p.z() * p.z());
    body->m_modes[1][3 * n] = static_cast<btScalar>(p.y() * p.y());
  }
  body->m_eigenvalues.resize(modes, 0);
  body->m_Kr.resize(modes, 0);
  for (int m = 0; m < modes; ++m) body->m_eigenvalues[m] = body->m_Kr[m] = btScalar(2000 * (m + 1));

  btReducedDeformableBody::tDenseArray masses;
  for (const double mass : lumpedMasses(cage, 1.0)) masses.push_back(static_cast<btScalar>(mass));
  body->setMassProps(masses);
  body->setInertiaProps();
  body->internalInitialization();
  body->getCollisionShape()->setMargin(btScalar(0.02));
  body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
  body->m_cfg.kKHR = 1;
  body->m_cfg.kCHR = 1;
  return body;
}

}  // namespace

ReducedWorld::ReducedWorld(const TetMesh& cage)
    : DeformableWorldBase(std::make_unique<btReducedDeformableBodySolver>()) {
  static_cast<btReducedDeformableBodySolver*>(softSolver.get())->setGravity(btVector3(0, -10, 0));
  body_ = makeReducedBody(cage, soft->getWorldInfo());
  soft->addSoftBody(body_.get());
  soft->addForce(body_.get(), &gravity);
}

}  // namespace tetskin::test
