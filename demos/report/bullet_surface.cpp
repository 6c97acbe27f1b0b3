// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/bullet_surface.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tetskin/bullet/soft_body.h>

#include "scenes/input_error.h"
#include "scenes/system.h"
#include "scenes/timer.h"

namespace tetskin::report {

BulletSurface::BulletSurface(const Cage& cage, const TriangleMesh& mesh) {
  auto body = createSoftBody(cage, worldInfo_);
  scenes::require(body.status());
  body_ = std::unique_ptr<btSoftBody>(std::move(body).value());
  const std::size_t before = scenes::heapBytes();
  body_->m_renderNodes.reserve(static_cast<int>(mesh.vertexCount()));
  for (const Eigen::Vector3d& p : mesh.positions) {
    btSoftBody::RenderNode node;
    node.m_x = toBullet(p);
    body_->m_renderNodes.push_back(node);
  }
  const scenes::CpuTimer timer;
  btSoftBodyHelpers::interpolateBarycentricWeights(body_.get());
  attachMs_ = timer.milliseconds();
  bytes_ = scenes::heapBytes() - before;
}

Eigen::Vector3d BulletSurface::position(std::size_t vertex) const {
  return toEigen(body_->m_renderNodes[static_cast<int>(vertex)].m_x);
}

}  // namespace tetskin::report
