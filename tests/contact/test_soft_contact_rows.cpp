// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/soft_contact_rows.h>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace bullet_detail;
using namespace contact_detail;

/// Balls in a world, whose contacts are found without a step. The tets of two differ, so that their weights do.
class SoftRows : public testing::Test {
 protected:
  void add(const Eigen::Vector3d& at, double size = 1.0) {
    TetMesh cage = ball().at(at);
    for (Eigen::Vector3d& p : cage.nodes) p = at + size * (p - at);
    bodies.push_back(createSoftBody(cage, world->deformable().getWorldInfo()).value());
    world->deformable().addSoftBody(bodies.back().get());
    rows.include(*bodies.back(), ball().shape, false);
  }
  void addTwo(double apart = 0.77) {
    add(Eigen::Vector3d::Zero());
    add(Eigen::Vector3d(apart, 0, 0));
  }
  const PointContacts& contacts() { return *rows.contacts(btScalar(1.0 / 240), nullptr); }
  void sleep(int body) { bodies[body]->forceActivationState(ISLAND_SLEEPING); }
  void TearDown() override {
    for (const auto& body : bodies) world->deformable().removeSoftBody(body.get());
  }

  std::unique_ptr<TetskinWorld> world = worldWith(btVector3(0, 0, 0));
  std::vector<std::unique_ptr<btSoftBody>> bodies;
  SoftContactRows rows{SoftContactOptions{}};
};

/// Of both bodies.
void expectOnePoint(const PointContact& contact) {
  const btVector3 point = contact.at.position(*contact.body);
  const btVector3 ofObject = contact.onObject.position(*btSoftBody::upcast(contact.object));
  EXPECT_LT((point - contact.position).length(), 1e-5);
  EXPECT_LT((ofObject - contact.position).length(), 1e-5);
}

TEST_F(SoftRows, EachContactIsOnePointOfBothBodiesAsDeepAsItIsInTheOtherBall) {
  addTwo();
  bodies[0]->m_cfg.kDF = btScalar(0.2);
  bodies[1]->m_cfg.kDF = btScalar(0.8);
  btVector3 normals(0, 0, 0);
  std::size_t of[2] = {0, 0};
  for (const PointContact& contact : contacts()) {
    const int other = contact.body == bodies[0].get() ? 1 : 0;
    ASSERT_EQ(contact.object, bodies[other].get());
    ++of[other];
    expectOnePoint(contact);
    const btVector3 out = contact.position - btVector3(btScalar(0.5 + 0.77 * other), btScalar(0.5), btScalar(0.5));
    EXPECT_NEAR(contact.distance, out.length() - Ball::kRadius, 0.005);
    EXPECT_GT(contact.normal.dot(out.normalized()), 0.95);
    EXPECT_NEAR(contact.friction, 0.4, 1e-6);
  }
  EXPECT_GT(of[0], 5U);
  EXPECT_GT(of[1], 5U);
}

TEST_F(SoftRows, ContactsWithASleepingBodyAreThoseOfTheBodyThatIsAwake) {
  addTwo();
  bodies[0]->setActivationState(WANTS_DEACTIVATION);
  bodies[0]->setDeactivationTime(1);
  const PointContacts awake = contacts();
  sleep(1);
  const PointContacts& now = contacts();
  ASSERT_EQ(now.size(), awake.size());
  EXPECT_FALSE(bodies[1]->isActive());
  int count = 0;
  for (std::size_t k = 0; k < now.size(); ++k) {
    const bool turns = awake[k].body == bodies[1].get();
    EXPECT_EQ(now[k].body, bodies[0].get());
    EXPECT_EQ(now[k].object, bodies[1].get());
    EXPECT_EQ(now[k].normal, turns ? -awake[k].normal : awake[k].normal);
    EXPECT_EQ(now[k].position, awake[k].position);
    EXPECT_EQ(now[k].at.nodes[0], turns ? awake[k].onObject.nodes[0] : awake[k].at.nodes[0]);
    EXPECT_EQ(now[k].point == awake[k].point, !turns);
    expectOnePoint(now[k]);
    count += turns ? 1 : 0;
  }
  EXPECT_GT(count, 5);
}

TEST_F(SoftRows, ABodyThatMovesWakesTheOneThatItMeets) {
  addTwo();
  sleep(1);
  EXPECT_FALSE(contacts().empty());
  EXPECT_TRUE(bodies[1]->isActive());
}

TEST_F(SoftRows, ContactsBetweenSleepingBodiesAreKeptUntilOneWakes) {
  addTwo();
  const std::size_t count = contacts().size();
  sleep(0);
  sleep(1);
  for (int step = 0; step < 3; ++step) {
    EXPECT_TRUE(contacts().empty());
    EXPECT_EQ(rows.sleepingContacts().size(), count);
  }
  const PointContacts before = rows.sleepingContacts();
  const btVector3 by(8, 0, -4);
  rows.shift(by);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_LT((rows.sleepingContacts()[k].position - before[k].position - by).length(), 1e-5);
  }
  rows.shift(-by);
  bodies[0]->activate(true);
  EXPECT_EQ(contacts().size(), count);
  EXPECT_TRUE(rows.sleepingContacts().empty());
}

TEST_F(SoftRows, ABodyWhollyWithinAnotherMeetsAllOthersButNotThatOne) {
  add(Eigen::Vector3d::Zero());
  add(Eigen::Vector3d(0.4, 0.4, 0.4), 0.2);
  EXPECT_TRUE(contacts().empty());
  EXPECT_TRUE(rows.isWithin(*rows.find(*bodies[1])));
  EXPECT_FALSE(rows.isWithin(*rows.find(*bodies[0])));
  bodies[1]->translate(btVector3(btScalar(0.4), 0, 0));
  EXPECT_FALSE(contacts().empty());
  EXPECT_FALSE(rows.isWithin(*rows.find(*bodies[1])));
}

TEST_F(SoftRows, NothingIsLeftOfABodyThatGoes) {
  addTwo();
  add(Eigen::Vector3d(0.4, 0.7, 0));
  const auto areOf = [&](const btSoftBody& body) {
    const auto& all = rows.lastContacts();
    return std::any_of(all.begin(), all.end(), [&](const auto& c) { return c.body == &body || c.object == &body; });
  };
  contacts();
  rows.exclude(*bodies[0]);
  EXPECT_FALSE(areOf(*bodies[0]));
  EXPECT_TRUE(areOf(*bodies[1]));
  EXPECT_EQ(rows.find(*bodies[0]), nullptr);
  EXPECT_FALSE(rows.isGone(*bodies[0]));
  rows.removeSoftBody(bodies[1].get());
  world->deformable().removeSoftBody(bodies[1].get());
  EXPECT_TRUE(rows.isGone(*bodies[1]));
  EXPECT_TRUE(contacts().empty());
}

/// The elastic forces of a light node may throw a separating point back within the step.
TEST_F(SoftRows, KeepWhatLeavesUnlessItIsFartherThanItGoesInAStep) {
  addTwo(2 * Ball::kRadius + 0.006);  // more than a tenth of a cell of the grid
  const auto contactsAt = [&](btScalar speed) {
    bodies[1]->setVelocity(btVector3(speed, 0, 0));
    return contacts().size();
  };
  EXPECT_GT(contactsAt(-2), 0U);
  EXPECT_GT(contactsAt(2), 0U);
  EXPECT_EQ(contactsAt(btScalar(0.3)), 0U);
  EXPECT_EQ(contactsAt(btScalar(-0.3)), 0U);
}

TEST_F(SoftRows, EndWithinTwoStepsOfABodyThatIsPushedAway) {
  addTwo(2 * Ball::kRadius - 0.002);
  for (int step = 0; step < 3; ++step) EXPECT_FALSE(contacts().empty());
  const btVector3 away(3, 0, 0);
  bodies[1]->setVelocity(away);
  EXPECT_FALSE(contacts().empty()) << "it may be thrown back in this step";
  for (int step = 0; step < 2; ++step) {
    bodies[1]->translate(away / 240);
    contacts();
  }
  EXPECT_TRUE(rows.lastContacts().empty());
}

}  // namespace
}  // namespace tetskin::test
