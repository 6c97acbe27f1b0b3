// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/two_plates.h"

#include "temp_folder.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

TEST(CageInBullet, BulletReadsTheSameNodesAndTets) {
  const TempFolder folder;
  for (const double joinedUntil : {-1.0, 1.0}) {
    Cage cage = platesOfCopies(joinedUntil).cage;
    for (Eigen::Vector3d& p : cage.mesh.nodes) p = 0.1 * p + Eigen::Vector3d(1.0 / 3.0, 0, -7);
    const Status saved = saveCage(cage, folder.path("c.vtk"));
    ASSERT_TRUE(saved.ok()) << saved.message;
    btSoftBodyWorldInfo info;
    testing::internal::CaptureStdout();  // Bullet's reader prints
    const std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreateFromVtkFile(info, folder.path("c.vtk").c_str()));
    testing::internal::GetCapturedStdout();
    ASSERT_TRUE(body);
    ASSERT_EQ(body->m_nodes.size(), static_cast<int>(cage.mesh.nodeCount()));
    ASSERT_EQ(body->m_tetras.size(), static_cast<int>(cage.mesh.tetCount()));
    for (int n = 0; n < body->m_nodes.size(); ++n) {
      const Eigen::Vector3d& p = cage.mesh.nodes[static_cast<std::size_t>(n)];
      EXPECT_EQ(body->m_nodes[n].m_x, btVector3(btScalar(p.x()), btScalar(p.y()), btScalar(p.z()))) << n;
    }
    for (int t = 0; t < body->m_tetras.size(); ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(body->m_tetras[t].m_n[k] - &body->m_nodes[0], cage.mesh.tets[static_cast<std::size_t>(t)][k]) << t;
      }
    }
  }
}

}  // namespace
}  // namespace tetskin::test
