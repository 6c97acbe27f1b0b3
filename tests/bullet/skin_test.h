// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "support/odd_meshes.h"

#include <gtest/gtest.h>
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <cmath>
#include <memory>
#include <vector>

namespace tetskin::test {

/// Tolerance for positions of a body about 1 in size.
constexpr double kRounding = 2e-6;

/// A skin's positions, 3 numbers per vertex.
using Surface = std::vector<btScalar>;
inline Surface surfaceOf(const SoftBodySkin& skin) {
  Surface all;
  for (std::size_t v = 0; v < skin.positions().size(); ++v) {
    all.insert(all.end(), skin.positions()[v], skin.positions()[v] + 3);
  }
  return all;
}

/// A body made from a lattice cage, at rest and in no world, and a sphere that sticks out of it.
class SkinTest : public testing::Test {
 protected:
  SkinTest() : body(createSoftBody(cage, info).value()) {}

  void bend() {
    for (int n = 0; n < body->m_nodes.size(); ++n) {
      const Eigen::Vector3d p = cage.nodes[n];
      body->m_nodes[n].m_x =
          toBullet(p + 0.2 * Eigen::Vector3d(std::sin(4 * p.y()), p.x() * p.z(), std::cos(3 * p.x())));
    }
  }

  static Eigen::Vector3d at(const SoftBodySkin& body, std::size_t v) {
    const btScalar* p = body.positions()[v];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  TriangleMesh mesh = test::sphere(30, 0.53, Eigen::Vector3d::Constant(0.5));
  btSoftBodyWorldInfo info;
  std::unique_ptr<btSoftBody> body;
  SoftBodySkin skin;
};

}  // namespace tetskin::test
