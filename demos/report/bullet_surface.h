// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include <memory>
#include <vector>

namespace tetskin::report {

/// Bullet's own embedding of a render mesh: render nodes, bound by testing all pairs of vertices and tets, in a body
/// that is in no world.
class BulletSurface {
 public:
  /// Throws InputError if Bullet cannot make a body of the cage.
  BulletSurface(const Cage& cage, const TriangleMesh& mesh);

  /// nodes  positions, nodeCount x 3
  template <class Points>
  void update(const Points& nodes) {
    for (int n = 0; n < body_->m_nodes.size(); ++n) {
      const auto& p = nodes[static_cast<std::size_t>(n)];
      body_->m_nodes[n].m_x =
          btVector3(static_cast<btScalar>(p[0]), static_cast<btScalar>(p[1]), static_cast<btScalar>(p[2]));
    }
    interpolate();
  }
  /// What Bullet does in every substep.
  void interpolate() { body_->interpolateRenderMesh(); }

  Eigen::Vector3d position(std::size_t vertex) const;
  double attachMs() const { return attachMs_; }
  std::size_t bytes() const { return bytes_; }

 private:
  btSoftBodyWorldInfo worldInfo_;
  std::unique_ptr<btSoftBody> body_;
  double attachMs_ = 0.0;
  std::size_t bytes_ = 0;
};

}  // namespace tetskin::report
