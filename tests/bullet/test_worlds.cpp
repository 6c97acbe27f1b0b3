// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The skin in each of Bullet's worlds: after stepSimulation it equals the weights applied to the nodes.
#include "support/odd_meshes.h"
#include "worlds.h"

#include <tetskin/bullet/soft_body_skin.h>

namespace tetskin {
namespace {

using MakeWorld = std::function<std::unique_ptr<test::TestWorld>(const TetMesh&)>;

struct NamedWorld {
  const char* name;
  MakeWorld make;
};
void PrintTo(const NamedWorld& world, std::ostream* out) {  // not byte by byte: some of it is addresses
  *out << world.name;
}

template <class World>
std::unique_ptr<test::TestWorld> makeWorld(const TetMesh& cage) {
  return std::make_unique<World>(cage);
}

class Worlds : public testing::TestWithParam<NamedWorld> {
 protected:
  Worlds() : cage(test::latticeCage(4, 4, 4, 0.25)), mesh(test::sphere(24, 0.52, Eigen::Vector3d::Constant(0.5))) {
    for (Eigen::Vector3d& p : cage.nodes) p.y() += 0.3;  // above the floor
    for (Eigen::Vector3d& p : mesh.positions) p.y() += 0.3;
    world = GetParam().make(cage);
    const Result<EmbedReport> report = skin.bind(world->body(), cage, mesh);
    EXPECT_TRUE(report.ok()) << report.status().message;
    EXPECT_GT(report.value().outside, 0u);
  }

  /// Compares the skin with the weights applied to the nodes in double precision.
  void expectSkinFollowsNodes() const {
    const auto bindings = skin.binding()->embedding().bindings();
    const PointView<const btScalar> positions = skin.positions();
    for (std::size_t v = 0; v < bindings.size(); ++v) {
      Eigen::Vector3d expected = Eigen::Vector3d::Zero();
      for (int k = 0; k < 4; ++k) {
        expected += bindings[v].weights[k] * toEigen(world->body().m_nodes[cage.tets[bindings[v].tet][k]].m_x);
      }
      const Eigen::Vector3d actual(positions[v][0], positions[v][1], positions[v][2]);
      ASSERT_LT((actual - expected).norm(), 1e-5) << "vertex " << v;
    }
  }

  std::vector<Eigen::Vector3d> surface() const {
    std::vector<Eigen::Vector3d> copy;
    for (std::size_t v = 0; v < skin.positions().size(); ++v) {
      const btScalar* p = skin.positions()[v];
      copy.emplace_back(p[0], p[1], p[2]);
    }
    return copy;
  }

  TetMesh cage;
  TriangleMesh mesh;
  std::unique_ptr<test::TestWorld> world;
  SoftBodySkin skin;
};

constexpr btScalar kStep = btScalar(1) / 240;

TEST_P(Worlds, SkinFollowsTheNodesAfterTenSubsteps) {
  for (int step = 0; step < 12; ++step) {
    // The time is a little more than ten steps, so that rounding does not reduce it to nine.
    ASSERT_EQ(world->world->stepSimulation(btScalar(10.01) * kStep, 10, kStep), 10);
    ASSERT_EQ(skin.update(), StatusCode::Ok);
    expectSkinFollowsNodes();
  }
  EXPECT_LT(skin.bounds().min().y(), 0.25);
}

TEST_P(Worlds, FramesBetweenStepsGoFromEachStepToTheNext) {
  SoftBodySkin between;
  ASSERT_TRUE(between.bind(world->body(), skin.binding()).ok());
  between.recordStep();
  for (int step = 0; step < 20; ++step) {
    const auto before = surface();
    ASSERT_GT(world->world->stepSimulation(4 * kStep, 4, kStep), 0);
    ASSERT_EQ(skin.update(), StatusCode::Ok);
    between.recordStep();
    const auto after = surface();
    for (const double alpha : {0.125, 0.375, 0.625, 0.875}) {
      ASSERT_EQ(between.update(static_cast<btScalar>(alpha)), StatusCode::Ok);
      for (std::size_t v = 0; v < after.size(); ++v) {
        const btScalar* p = between.positions()[v];
        ASSERT_LT((Eigen::Vector3d(p[0], p[1], p[2]) - before[v] - alpha * (after[v] - before[v])).norm(), 1e-5);
      }
    }
  }
  EXPECT_LT(skin.bounds().min().y(), 0.25);
}

INSTANTIATE_TEST_SUITE_P(All, Worlds,
                         testing::Values(NamedWorld{"SoftRigid", makeWorld<test::RigidWorld>},
                                         NamedWorld{"SoftMultiBody", makeWorld<test::MultiBodyWorld>},
                                         NamedWorld{"Deformable", makeWorld<test::DeformableWorld>},
                                         NamedWorld{"Reduced", makeWorld<test::ReducedWorld>}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace tetskin
