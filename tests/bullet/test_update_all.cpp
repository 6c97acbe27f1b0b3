// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <deque>
#include <limits>
#include <map>

namespace tetskin {
namespace {

/// Each body carries two skins: one updated by updateAll, and a twin updated by update.
class UpdateAll : public testing::Test {
 protected:
  void make(std::size_t count) {
    SkinOptions options;
    options.bounds = false;
    for (std::size_t i = 0; i < count; ++i) {
      bodies.emplace_back(createSoftBody(cage, info).value());
      for (std::deque<SoftBodySkin>* skins : {&together, &alone}) {
        skins->emplace_back();
        if (i % 11 == 7) continue;  // stays unbound
        if (i == 0) {
          ASSERT_TRUE(skins->back().bind(*bodies[i], cage, mesh, options).ok());
        } else {
          ASSERT_TRUE(skins->back().bind(*bodies[i], skins->front().binding(), instanceOf(options)).ok());
        }
      }
    }
    for (SoftBodySkin& skin : together) pointers.push_back(&skin);
  }

  void changeEverything() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i]->forceActivationState(i % 3 == 0 ? ACTIVE_TAG : ISLAND_SLEEPING);
      if (i % 4 != 1) bodies[i]->translate(btVector3(0, btScalar(i), 1));
      if (i % 5 == 2) bodies[i]->m_nodes[3].m_x.setX(std::numeric_limits<btScalar>::infinity());
      if (i % 7 == 5) bodies[i]->appendNode(btVector3(9, 9, 9), 1);
      for (std::deque<SoftBodySkin>* skins : {&together, &alone}) (*skins)[i].setVisible(i % 6 != 4);
    }
  }

  static bool samePositions(const SoftBodySkin& a, const SoftBodySkin& b) {
    if (a.positions().size() != b.positions().size()) return false;
    for (std::size_t v = 0; v < a.positions().size(); ++v) {
      if (!std::equal(a.positions()[v], a.positions()[v] + 3, b.positions()[v])) return false;
    }
    return true;
  }

  TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  TriangleMesh mesh = test::sphere(8, 0.5, Eigen::Vector3d::Constant(0.5));
  btSoftBodyWorldInfo info;
  std::deque<std::unique_ptr<btSoftBody>> bodies;
  std::deque<SoftBodySkin> together, alone;
  std::vector<SoftBodySkin*> pointers;
};

TEST_F(UpdateAll, DoesForEachWhatUpdateDoes) {
  make(1100);
  changeEverything();
  std::vector<StatusCode> statuses(pointers.size());
  std::size_t expected = 0;
  const std::size_t updated = SoftBodySkin::updateAll(pointers.data(), pointers.size(), statuses.data());
  std::map<StatusCode, std::size_t> seen;
  for (std::size_t i = 0; i < pointers.size(); ++i) {
    const StatusCode status = alone[i].update();
    ASSERT_EQ(toString(statuses[i]), std::string(toString(status))) << i;
    EXPECT_TRUE(samePositions(together[i], alone[i])) << i;
    EXPECT_EQ(together[i].firstNonFiniteNode(), alone[i].firstNonFiniteNode()) << i;
    expected += status == StatusCode::Ok;
    ++seen[status];
  }
  EXPECT_EQ(updated, expected);
  EXPECT_EQ(seen.size(), 6u);
  for (const auto& [status, count] : seen) EXPECT_GT(count, 10u) << toString(status);
}

/// Runs the tasks from the last to the first.
class Backwards : public ParallelFor {
 public:
  void run(std::size_t count, Task task) override {
    for (std::size_t k = count; k-- > 0;) task(k);
    tasks += count;
  }
  std::size_t tasks = 0;
};

TEST_F(UpdateAll, DividesTheSkinsAmongThreads) {
  make(600);
  changeEverything();
  Backwards threads;
  std::vector<StatusCode> statuses(pointers.size()), expected(pointers.size());
  const std::size_t updated = SoftBodySkin::updateAll(pointers.data(), pointers.size(), statuses.data(), 1, &threads);
  for (std::size_t i = 0; i < pointers.size(); ++i) {
    expected[i] = alone[i].update();
    EXPECT_TRUE(samePositions(together[i], alone[i])) << i;
  }
  EXPECT_EQ(statuses, expected);
  EXPECT_EQ(updated, static_cast<std::size_t>(std::count(expected.begin(), expected.end(), StatusCode::Ok)));
  EXPECT_GE(threads.tasks, updated);
}

TEST_F(UpdateAll, AllocatesNothingAndNeedsNoStatuses) {
  make(20);
  changeEverything();
  const std::size_t before = test::allocationCount();
  const std::size_t updated = SoftBodySkin::updateAll(pointers.data(), pointers.size());
  EXPECT_EQ(test::allocationCount(), before);
  EXPECT_GT(updated, 0u);
  EXPECT_EQ(SoftBodySkin::updateAll(nullptr, 0), 0u);
}

TEST_F(UpdateAll, NoticesATeleportOfAFlatBody) {
  bodies.emplace_back(createSoftBody(cage, info).value());
  for (int n = 0; n < bodies[0]->m_nodes.size(); ++n) bodies[0]->m_nodes[n].m_x.setY(0);
  together.emplace_back();
  ASSERT_TRUE(together[0].bind(*bodies[0], cage, mesh).ok());
  bodies[0]->forceActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(together[0].update(), StatusCode::Asleep);
  bodies[0]->translate(btVector3(0, 1, 0));
  EXPECT_EQ(together[0].update(), StatusCode::Ok);
}

}  // namespace
}  // namespace tetskin
