// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Held nodes that are led by their m_x, as a hand, a hook or an animated skeleton leads them.
#include "deformable_test.h"

#include <functional>
#include <string>
#include <vector>

namespace tetskin::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 240;

TetMesh bar(double height) {
  TetMesh cage = latticeCage(10, 2, 2, 0.2);  // 2 long, along x
  for (Eigen::Vector3d& p : cage.nodes) p.y() += height;
  return cage;
}

/// A bar that is held at its first end, without gravity.
struct LedBar {
  LedBar() {
    world.deformable().setGravity(btVector3(0, 0, 0));
    SoftBodyOptions options;
    options.pinned = pinnedIn(Box3(Eigen::Vector3d(-0.01, -9, -9), Eigen::Vector3d(0.01, 9, 9)));
    options.youngsModulus = 2e4;
    body = added(world, bar(5), options);
    body->body().setActivationState(DISABLE_DEACTIVATION);
  }
  btSoftBody& soft() { return body->body(); }
  void forHeld(const std::function<void(btSoftBody::Node&)>& visit) {
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      if (soft().m_nodes[n].m_im == 0) visit(soft().m_nodes[n]);
    }
  }
  void place(btScalar offset) {
    forHeld([&](btSoftBody::Node& node) { node.m_x.setX(offset); });
  }
  void steps(int count) { world.deformable().stepSimulation(count * kStep, count, kStep); }
  double length() {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      least = std::min<double>(least, soft().m_nodes[n].m_x.x());
      most = std::max<double>(most, soft().m_nodes[n].m_x.x());
    }
    return most - least;
  }
  double fastest() {
    double most = 0;
    for (int n = 0; n < soft().m_nodes.size(); ++n) most = std::max<double>(most, soft().m_nodes[n].m_v.length());
    return most;
  }
  std::vector<btVector3> positions() {
    std::vector<btVector3> all;
    for (int n = 0; n < soft().m_nodes.size(); ++n) all.push_back(soft().m_nodes[n].m_x);
    return all;
  }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> body;
};

double farthest(const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max<double>(most, (a[k] - b[k]).length());
  return most;
}

/// So that it begins gently: the way after so many seconds, up to this speed.
btScalar wayAfter(btScalar seconds, btScalar speed) {
  constexpr btScalar kRise = btScalar(0.5);
  return seconds < kRise ? speed * seconds * seconds / (2 * kRise) : speed * (seconds - kRise / 2);
}

TEST(DrivenNodes, ByPositionMoveTheBodyAsByVelocity) {
  LedBar byPosition, byVelocity;
  for (int k = 1; k <= 240; ++k) {
    byPosition.place(wayAfter(k * kStep, 5));
    const btScalar speed = (wayAfter(k * kStep, 5) - wayAfter((k - 1) * kStep, 5)) / kStep;
    byVelocity.forHeld([&](btSoftBody::Node& node) { node.m_v = btVector3(speed, 0, 0); });
    byPosition.steps(1);
    byVelocity.steps(1);
  }
  EXPECT_LT(farthest(byPosition.positions(), byVelocity.positions()), 1e-3);
  EXPECT_NEAR(byPosition.length(), 2.0, 0.02);
  byPosition.forHeld([](const btSoftBody::Node& node) { EXPECT_NEAR(node.m_v.x(), 5, 0.01); });
}

TEST(DrivenNodes, ThatAreMovedOnceAFrameHaveTheFramesVelocityInAllItsSteps) {
  LedBar bar;
  for (int f = 1; f <= 60; ++f) {
    bar.place(wayAfter(4 * f * kStep, 5));
    bar.steps(4);
  }
  EXPECT_NEAR(bar.length(), 2.0, 0.02);
  bar.forHeld([](const btSoftBody::Node& node) { EXPECT_NEAR(node.m_v.x(), 5, 0.05); });
  double slowest = HUGE_VAL, fastest = 0;
  for (int k = 0; k < 12; ++k) {
    if (k % 4 == 0) bar.place(wayAfter((244 + k) * kStep, 5));
    bar.steps(1);
    bar.forHeld([&](const btSoftBody::Node& node) {
      slowest = std::min<double>(slowest, node.m_v.x());
      fastest = std::max<double>(fastest, node.m_v.x());
    });
  }
  EXPECT_NEAR(slowest, 5, 0.05);
  EXPECT_NEAR(fastest, 5, 0.05);
}

TEST(DrivenNodes, AreWhereTheyWerePutAfterAnyNumberOfSteps) {
  LedBar absolute, relative;
  const int counts[] = {4, 3, 5, 1, 4, 2, 7, 4};
  btScalar time = 0;
  for (int f = 0; f < 80; ++f) {
    const int count = counts[f % 8];
    const btScalar before = wayAfter(time, 3);
    time += count * kStep;
    absolute.place(wayAfter(time, 3));
    relative.forHeld([&](btSoftBody::Node& node) { node.m_x += btVector3(wayAfter(time, 3) - before, 0, 0); });
    absolute.steps(count);
    relative.steps(count);
    absolute.forHeld([&](const btSoftBody::Node& node) { ASSERT_EQ(node.m_x.x(), wayAfter(time, 3)); });
    relative.forHeld([&](const btSoftBody::Node& node) { ASSERT_NEAR(node.m_x.x(), wayAfter(time, 3), 1e-4); });
  }
  EXPECT_NEAR(absolute.length(), 2.0, 0.03);
}

TEST(DrivenNodes, StopWhenTheyAreMovedNoMore) {
  LedBar bar;
  for (int f = 1; f <= 30; ++f) {
    bar.place(btScalar(0.05) * f);
    bar.steps(4);
  }
  bar.steps(2);
  bar.forHeld([](const btSoftBody::Node& node) {
    EXPECT_EQ(node.m_x.x(), btScalar(0.05) * 30);
    EXPECT_TRUE(node.m_v.isZero());
  });
}

TEST(DrivenNodes, GoByTheirVelocityWhereTheApplicationSetsThatToo) {
  LedBar both, velocity;
  for (int k = 1; k <= 120; ++k) {
    both.forHeld([&](btSoftBody::Node& node) {
      node.m_x.setX(btScalar(k - 1) * 2 * kStep);  // where it is anyway, but for rounding
      node.m_v = btVector3(2, 0, 0);
    });
    velocity.forHeld([&](btSoftBody::Node& node) { node.m_v = btVector3(2, 0, 0); });
    both.steps(1);
    velocity.steps(1);
  }
  EXPECT_LT(farthest(both.positions(), velocity.positions()), 1e-3);
}

TEST(DrivenNodes, GetNoVelocityFromATeleport) {
  for (const bool led : {false, true}) {
    LedBar bar;
    for (int f = 1; led && f <= 30; ++f) {
      bar.place(btScalar(0.05) * f);
      bar.steps(4);
    }
    const double before = bar.fastest();
    bar.soft().translate(btVector3(100, 0, 0));
    bar.soft().rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.5)));
    bar.steps(1);
    EXPECT_LT(bar.fastest(), before + 0.05);
    bar.steps(240);
    bar.forHeld([](const btSoftBody::Node& node) { EXPECT_TRUE(node.m_v.isZero()); });
  }
}

TEST(DrivenNodes, GetNoVelocityFromAStateThatIsPutIn) {
  LedBar bar;
  bar.steps(4);
  const auto saved = bar.positions();
  for (int f = 1; f <= 30; ++f) {
    bar.place(btScalar(0.05) * f);
    bar.steps(4);
  }
  for (int n = 0; n < bar.soft().m_nodes.size(); ++n) {
    btSoftBody::Node& node = bar.soft().m_nodes[n];
    node.m_x = saved[static_cast<std::size_t>(n)];
    if (node.m_im > 0) node.m_v = btVector3(0, 0, 0);
  }
  bar.steps(8);
  EXPECT_LT(farthest(bar.positions(), saved), 1e-3);
  EXPECT_LT(bar.fastest(), 0.05);
}

TEST(DrivenNodes, KeepTheirVelocityWhenTheyAreLetGo) {
  LedBar bar;
  for (int f = 1; f <= 60; ++f) {
    bar.place(wayAfter(4 * f * kStep, 2));
    bar.steps(4);
  }
  for (int n = 0; n < bar.soft().m_nodes.size(); ++n) {
    if (bar.body->isPinned(n)) {
      ASSERT_TRUE(bar.body->unpin(n).ok());
    }
  }
  bar.steps(60);
  double sum = 0;
  for (int n = 0; n < bar.soft().m_nodes.size(); ++n) sum += bar.soft().m_nodes[n].m_v.x();
  EXPECT_NEAR(sum / bar.soft().m_nodes.size(), 2, 0.05);
}

TEST(DrivenNodes, HoldABodyThatIsSwungLikeAHook) {
  // Around the z axis, a turn a second, held at one end: the free end follows, bent back by its inertia alone.
  LedBar bar;
  const auto rest = bar.positions();
  const btVector3 hub(0, btScalar(5.2), btScalar(0.2));
  const auto turned = [&](std::size_t n, btScalar angle) {
    return hub + btMatrix3x3(btQuaternion(btVector3(0, 0, 1), angle)) * (rest[n] - hub);
  };
  btScalar angle = 0, rate = 0;
  for (int f = 1; f <= 240; ++f) {
    rate = btMin(rate + btScalar(0.05), SIMD_2_PI);
    angle += rate / 60;
    for (int n = 0; n < bar.soft().m_nodes.size(); ++n) {
      if (bar.soft().m_nodes[n].m_im == 0) bar.soft().m_nodes[n].m_x = turned(static_cast<std::size_t>(n), angle);
    }
    bar.steps(4);
  }
  double lag = 0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    lag = std::max<double>(lag, (bar.soft().m_nodes[static_cast<int>(n)].m_x - turned(n, angle)).length());
  }
  EXPECT_LT(lag, 0.25);
}

}  // namespace
}  // namespace tetskin::test
