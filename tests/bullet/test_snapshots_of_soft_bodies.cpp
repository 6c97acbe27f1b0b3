// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <functional>

#include "deformable_test.h"
#include "support/bars.h"
#include "support/replays.h"

namespace tetskin::test {
namespace {

/// A world, and what an application does in each of its frames.
class Scene : public ReplayedScene {
 public:
  btDeformableMultiBodyDynamicsWorld& world() override { return worldOf.deformable(); }
  void frame(int number) override {
    if (before) before(number);
    step(worldOf, 1);
  }
  btSoftBody& soft(std::size_t k = 0) { return bodies[k]->body(); }

  TetskinWorld worldOf;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::function<void(int)> before;
};

constexpr double kFarUp = 50.0;

/// A bar along x.
/// pinned  at its lower end of x
std::unique_ptr<Scene> withBar(double height, bool pinned, const SoftBodyOptions& options = {}) {
  auto scene = std::make_unique<Scene>();
  TetMesh bar = makeBox({8, 2, 2}, {2.0, 0.5, 0.5});
  for (Eigen::Vector3d& p : bar.nodes) p.y() += height;
  scene->bodies.push_back(added(scene->worldOf, bar, options));
  for (int n = 0; pinned && n < scene->soft().m_nodes.size(); ++n) {
    if (scene->soft().m_nodes[n].m_x.x() > 0) continue;
    EXPECT_TRUE(scene->bodies[0]->setPinned(n, true).ok());
  }
  return scene;
}

void spin(btSoftBody& body, btScalar rate) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v = node.m_vn = rate * btVector3(1, 2, 3).cross(node.m_x - btVector3(1, btScalar(kFarUp), 0));
  }
}

TEST(SnapshotsOfSoftBodies, OfAFreeBodyThatSpins) {
  const auto make = [] {
    auto scene = withBar(kFarUp, false);
    spin(scene->soft(), 3);
    return scene;
  };
  expectReplays(make, 40, {0, 3, 11, 25});
}

TEST(SnapshotsOfSoftBodies, OfAHeldBarThatSwings) {
  expectReplays([] { return withBar(kFarUp, true); }, 60, {0, 7, 30});
}

TEST(SnapshotsOfSoftBodies, OfAStiffBarThatSwings) {
  SoftBodyOptions stiff;
  stiff.relativeStiffness = 20000.0;
  stiff.solverTolerance = 1e-4;
  expectReplays([&] { return withBar(kFarUp, true, stiff); }, 60, {0, 7, 30});
}

}  // namespace
}  // namespace tetskin::test
