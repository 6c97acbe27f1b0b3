// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_motion.h>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

constexpr btScalar kMotionStep = btScalar(0.004);

/// Two balls that overlap, and their motions.
class SoftMotion : public StillBalls {
 protected:
  void SetUp() override {
    first = include({0, 0, 0});
    second = include({0.6, 0.2, 0.1});
  }
  bool isStill(btScalar maximum) { return motion.isStill(*first, *second, kMotionStep, maximum); }
  /// In the step in which the touches are searched for.
  void search() {
    isStill(0);
    motion.markSearched();
  }
  void read() {
    for (ContactBody* body : {first.get(), second.get()}) body->read();
  }
  /// Moves each node of a body.
  void move(ContactBody& body, const std::function<btVector3(const btVector3&)>& to) {
    for (int n = 0; n < body.body->m_nodes.size(); ++n) body.body->m_nodes[n].m_x = to(body.body->m_nodes[n].m_x);
  }
  void setSpeed(btScalar speed) {
    for (int n = 0; n < bodies_[1]->m_nodes.size(); ++n) bodies_[1]->m_nodes[n].m_v = btVector3(speed, 0, 0);
  }

  std::unique_ptr<ContactBody> first, second;
  PairMotion motion;
};

/// Beyond any motion in these tests.
constexpr btScalar kAnyMotion = 100;

TEST_F(SoftMotion, IsNotStillBeforeASearch) {
  EXPECT_FALSE(isStill(kAnyMotion));
  read();
  EXPECT_FALSE(isStill(kAnyMotion));
  motion.markSearched();
  EXPECT_FALSE(isStill(kAnyMotion)) << "the same step again";
  read();
  EXPECT_TRUE(isStill(0));
  read();
  read();
  EXPECT_FALSE(isStill(kAnyMotion)) << "a step in which it was not asked for";
}

TEST_F(SoftMotion, IsStillUntilItsSumIsLarger) {
  const btScalar bound = btScalar(0.001), by = btScalar(0.4) * bound;
  for (const bool ofFirst : {false, true}) {
    // Samples outside of the tets that carry them go farther than nodes do.
    const btScalar spread = ofFirst ? first->data().largestSpread : btScalar(1);
    for (const int steps : {1, 2, 3}) {
      for (const bool larger : {false, true}) {
        read();
        search();
        const btScalar sum = by * static_cast<btScalar>(steps);
        for (int step = 1; step <= steps; ++step) {
          move(ofFirst ? *first : *second, [&](const btVector3& x) { return x + btVector3(0, by, 0); });
          read();
          const btScalar maximum =
              step < steps ? kAnyMotion : sum * (larger ? btScalar(1.01) * spread : btScalar(0.99));
          EXPECT_EQ(isStill(maximum), step < steps || larger) << step;
        }
      }
    }
  }
}

TEST_F(SoftMotion, CountsOneNodeNearTheOtherBody) {
  search();
  const btVector3 within(btScalar(0.8), btScalar(0.6), btScalar(0.5));  // where the two overlap
  btSoftBody::Node* nearest = &bodies_[0]->m_nodes[0];
  for (int n = 0; n < bodies_[0]->m_nodes.size(); ++n) {
    btSoftBody::Node& node = bodies_[0]->m_nodes[n];
    if ((node.m_x - within).length2() < (nearest->m_x - within).length2()) nearest = &node;
  }
  nearest->m_x += btVector3(0, btScalar(0.002), 0);
  read();
  EXPECT_FALSE(isStill(btScalar(0.0019)));
}

TEST_F(SoftMotion, LeavesOutWhatIsFarFromTheOtherBody) {
  search();
  btSoftBody::Node* farthest = &bodies_[0]->m_nodes[0];
  for (int n = 0; n < bodies_[0]->m_nodes.size(); ++n) {
    if (bodies_[0]->m_nodes[n].m_x.x() < farthest->m_x.x()) farthest = &bodies_[0]->m_nodes[n];
  }
  farthest->m_x += btVector3(0, btScalar(0.02), 0);
  read();
  EXPECT_TRUE(isStill(btScalar(1e-5)));
}

TEST_F(SoftMotion, IsRelative) {
  search();
  for (const auto& body : bodies_) body->translate(btVector3(btScalar(0.3), 0, 0));
  read();
  EXPECT_TRUE(isStill(btScalar(1e-4)));
  bodies_[1]->translate(btVector3(0, btScalar(0.01), 0));
  read();
  EXPECT_FALSE(isStill(btScalar(0.009)));
}

/// In the step to come, samples may then touch that could not touch in the one that was searched.
TEST_F(SoftMotion, CountsThatBodiesGetFaster) {
  const auto atSpeed = [&](btScalar speed) {
    setSpeed(speed);
    read();
  };
  const auto searchAt = [&](btScalar speed) {
    atSpeed(speed);
    search();
    atSpeed(speed);
    isStill(kAnyMotion);
    motion.markSearched();
  };
  searchAt(1);
  atSpeed(3);
  EXPECT_FALSE(isStill(btScalar(1.9) * kMotionStep));
  searchAt(1);
  atSpeed(3);
  EXPECT_TRUE(isStill(btScalar(2.1) * kMotionStep)) << "by as much";
  for (const btScalar slower : {btScalar(0.5), btScalar(-1)}) {
    searchAt(1);
    atSpeed(slower);
    EXPECT_TRUE(isStill(btScalar(1e-6))) << "what is slower reaches no more";
  }
}

}  // namespace
}  // namespace tetskin::test
