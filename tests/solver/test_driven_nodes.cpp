// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pinned nodes that are moved by their m_x, as a hand, a hook or an animated skeleton moves them.
#include "deformable_test.h"

namespace tetskin::test {
namespace {

constexpr btScalar kDrivenStep = btScalar(1) / 240;

TetMesh bar(double height) {
  return lifted(latticeCage(10, 2, 2, 0.2), height);  // 2 long, along x
}

/// A bar that is pinned at its first end, without gravity.
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
  void forPinned(const std::function<void(btSoftBody::Node&)>& visit) {
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      if (soft().m_nodes[n].m_im == 0) visit(soft().m_nodes[n]);
    }
  }
  void place(btScalar offset) {
    forPinned([&](btSoftBody::Node& node) { node.m_x.setX(offset); });
  }
  void steps(int count) { world.deformable().stepSimulation(count * kDrivenStep, count, kDrivenStep); }
  double length() {
    double minimum = HUGE_VAL, maximum = -HUGE_VAL;
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      minimum = std::min<double>(minimum, soft().m_nodes[n].m_x.x());
      maximum = std::max<double>(maximum, soft().m_nodes[n].m_x.x());
    }
    return maximum - minimum;
  }
  double fastest() { return fastestOf(soft()); }
  std::vector<btVector3> positions() { return nodesOf(soft()); }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> body;
};

double farthest(const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
  double maximum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) maximum = std::max<double>(maximum, (a[k] - b[k]).length());
  return maximum;
}

/// The distance covered after this many seconds by a motion that starts gently and rises to this speed.
btScalar directionAfter(btScalar seconds, btScalar speed) {
  constexpr btScalar kRise = btScalar(0.5);
  return seconds < kRise ? speed * seconds * seconds / (2 * kRise) : speed * (seconds - kRise / 2);
}

TEST(DrivenNodes, AreLedBySetPinnedPositionAsByTheirPositions) {
  LedBar byPosition, byCall;
  for (int frame = 1; frame <= 30; ++frame) {
    const btScalar offset = btScalar(0.02) * frame;
    byPosition.place(offset);
    for (int n = 0; n < byCall.soft().m_nodes.size(); ++n) {
      if (!byCall.body->isPinned(n)) continue;
      btVector3 target = byCall.soft().m_nodes[n].m_x;
      target.setX(offset);
      ASSERT_TRUE(byCall.body->setPinnedPosition(n, target).ok());
    }
    byPosition.steps(4);
    byCall.steps(4);
  }
  EXPECT_EQ(byCall.positions(), byPosition.positions());
  EXPECT_NEAR(byCall.soft().m_nodes[0].m_v.x(), 0.02 * 60, 1e-3) << "the velocity of the motion";
}

TEST(DrivenNodes, ByPositionMoveTheBodyAsByVelocity) {
  LedBar byPosition, byVelocity;
  for (int k = 1; k <= 240; ++k) {
    byPosition.place(directionAfter(k * kDrivenStep, 5));
    const btScalar speed =
        (directionAfter(k * kDrivenStep, 5) - directionAfter((k - 1) * kDrivenStep, 5)) / kDrivenStep;
    byVelocity.forPinned([&](btSoftBody::Node& node) { node.m_v = btVector3(speed, 0, 0); });
    byPosition.steps(1);
    byVelocity.steps(1);
  }
  EXPECT_LT(farthest(byPosition.positions(), byVelocity.positions()), 1e-3);
  EXPECT_NEAR(byPosition.length(), 2.0, 0.02);
  byPosition.forPinned([](const btSoftBody::Node& node) { EXPECT_NEAR(node.m_v.x(), 5, 0.01); });
}

TEST(DrivenNodes, ThatAreMovedOnceAFrameHaveTheFramesVelocityInAllItsSteps) {
  LedBar bar;
  for (int f = 1; f <= 60; ++f) {
    bar.place(directionAfter(4 * f * kDrivenStep, 5));
    bar.steps(4);
  }
  EXPECT_NEAR(bar.length(), 2.0, 0.02);
  bar.forPinned([](const btSoftBody::Node& node) { EXPECT_NEAR(node.m_v.x(), 5, 0.05); });
  double slowest = HUGE_VAL, fastest = 0;
  for (int k = 0; k < 12; ++k) {
    if (k % 4 == 0) bar.place(directionAfter((244 + k) * kDrivenStep, 5));
    bar.steps(1);
    bar.forPinned([&](const btSoftBody::Node& node) {
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
    const btScalar before = directionAfter(time, 3);
    time += count * kDrivenStep;
    absolute.place(directionAfter(time, 3));
    relative.forPinned([&](btSoftBody::Node& node) { node.m_x += btVector3(directionAfter(time, 3) - before, 0, 0); });
    absolute.steps(count);
    relative.steps(count);
    absolute.forPinned([&](const btSoftBody::Node& node) { ASSERT_EQ(node.m_x.x(), directionAfter(time, 3)); });
    relative.forPinned([&](const btSoftBody::Node& node) { ASSERT_NEAR(node.m_x.x(), directionAfter(time, 3), 1e-4); });
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
  bar.forPinned([](const btSoftBody::Node& node) {
    EXPECT_EQ(node.m_x.x(), btScalar(0.05) * 30);
    EXPECT_TRUE(node.m_v.isZero());
  });
}

TEST(DrivenNodes, GoByTheirVelocityWhereTheApplicationSetsThatToo) {
  LedBar both, velocity;
  for (int k = 1; k <= 120; ++k) {
    both.forPinned([&](btSoftBody::Node& node) {
      node.m_x.setX(btScalar(k - 1) * 2 * kDrivenStep);  // its current position, except for rounding
      node.m_v = btVector3(2, 0, 0);
    });
    velocity.forPinned([&](btSoftBody::Node& node) { node.m_v = btVector3(2, 0, 0); });
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
    bar.forPinned([](const btSoftBody::Node& node) { EXPECT_TRUE(node.m_v.isZero()); });
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
    bar.place(directionAfter(4 * f * kDrivenStep, 2));
    bar.steps(4);
  }
  for (int n = 0; n < bar.soft().m_nodes.size(); ++n) {
    if (bar.body->isPinned(n)) {
      ASSERT_TRUE(bar.body->setPinned(n, false).ok());
    }
  }
  bar.steps(60);
  double sum = 0;
  for (int n = 0; n < bar.soft().m_nodes.size(); ++n) sum += bar.soft().m_nodes[n].m_v.x();
  EXPECT_NEAR(sum / bar.soft().m_nodes.size(), 2, 0.05);
}

TEST(DrivenNodes, HoldABodyThatIsSwungLikeAHook) {
  // The bar turns around the z axis once per second, pinned at one end: the free end follows, bent back by its inertia
  // alone.
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
