// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The initial values of contact rows between soft bodies in a step, made by hand.
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/rows/fixed_nodes.h>

#include <initializer_list>

#include "deformable_test.h"

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr btScalar kStepSeconds = btScalar(1) / 240;
const btVector3 kUp(0, 1, 0);

/// Two bodies, one above the other, whose contacts a test gives.
class WarmRows : public testing::Test {
 protected:
  void SetUp() override {
    btAlignedObjectArray<btSoftBody*> all, awake;
    for (const auto& body : {upper_.get(), lower_.get()}) all.push_back(&body->body());
    bodies_.collect(all, false, awake);
    bodies_.assign(*world_.bodySolver().getLagrangianForceArray());
    for (SolvedBody& solved : bodies_.bodies()) readNodes(*solved.body, *solved.dynamics);
  }
  PointContact contact(std::uint32_t point, std::uint32_t sample, const btVector3& normal = kUp) {
    PointContact made;
    made.body = &upper_->body();
    made.point = point;
    made.sample = sample;
    made.at.add(static_cast<int>(sample), 1);  // another place in the body
    made.object = &lower_->body();
    made.onObject.add(0, 1);
    made.position = made.at.position(upper_->body());
    made.normal = normal;
    made.friction = 1;
    return made;
  }
  /// Begins a step with these contacts.
  void begin(std::initializer_list<PointContact> contacts) {
    contacts_ = contacts;
    rows_.collect(bodies_, rigids_, kStepSeconds);
    rows_.add(contacts_, bodies_, kStepSeconds);
    ASSERT_EQ(rows_.rows().size(), contacts_.size());
  }
  /// Ends the step: each row has stuck, with this slip and impulse.
  void end(std::initializer_list<std::pair<btVector3, btScalar>> found) {
    auto row = rows_.rows().begin();
    for (const auto& [slip, impulse] : found) {
      row->state = ContactRow::State::Sticks;
      row->slip = slip;
      row->impulse = impulse * row->normal;
      ++row;
    }
    rows_.finish(bodies_, kStepSeconds);
  }
  void expectRecalled(std::size_t row, const btVector3& offset, btScalar bound) {
    const ContactRow& at = rows_.rows()[row];
    EXPECT_LT((at.offsetVelocity - offset).length(), 1e-4);
    EXPECT_NEAR(at.normalBound, bound, 1e-5);
    EXPECT_EQ(at.stuck, bound > 0);
  }

  TetskinWorld world_;
  std::unique_ptr<DeformableBody> upper_ = added(world_, smallCageAbove(1.0)),
                                  lower_ = added(world_, smallCageAbove(0));
  SolverBodies bodies_;
  RigidUnknowns rigids_;
  ContactRows rows_;
  PointContacts contacts_;
};

const btVector3 kOneSlip(btScalar(0.2), 0, 0), kOtherSlip(0, 0, btScalar(-0.3));

TEST_F(WarmRows, BeginWithNothing) {
  begin({contact(7, 3)});
  expectRecalled(0, btVector3(0, 0, 0), 0);
}

/// In any order, in this step and in the previous one.
TEST_F(WarmRows, OfTwoSamplesOfAPointRecallEachItsOwn) {
  begin({contact(7, 3), contact(7, 9)});
  end({{kOneSlip, 1}, {kOtherSlip, 2}});
  begin({contact(7, 9), contact(7, 3)});
  expectRecalled(0, kOtherSlip, 2);
  expectRecalled(1, kOneSlip, 1);
  end({{btVector3(0, 0, 0), 2}, {btVector3(0, 0, 0), 1}});
  begin({contact(7, 3), contact(7, 9)});
  expectRecalled(0, kOneSlip, 1);
  expectRecalled(1, kOtherSlip, 2);
}

TEST_F(WarmRows, OfASampleThatIsNewRecallWhatItsPointHasDone) {
  begin({contact(7, 3), contact(8, 4)});
  end({{kOneSlip, 1}, {kOtherSlip, 2}});
  begin({contact(7, 5), contact(9, 5)});
  expectRecalled(0, kOneSlip, 1);
  expectRecalled(1, btVector3(0, 0, 0), 0);
}

/// Bullet finds contacts where a kinematic body is at the end of the step: the gap at its beginning is larger by the
/// way that the body comes nearer.
TEST_F(WarmRows, OfBulletsContactsBeginAsFarAwayAsTheStepDoes) {
  btBoxShape shape(btVector3(1, 1, 1));
  btRigidBody lift(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
  const btVector3 rate(0, btScalar(0.6), 0);
  lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  lift.setActivationState(DISABLE_DEACTIVATION);
  lift.setLinearVelocity(rate);
  btSoftBody& body = upper_->body();
  btSoftBody::DeformableNodeRigidContact found;
  found.m_node = &body.m_nodes[0];
  found.m_cti.m_colObj = &lift;
  found.m_cti.m_normal = kUp;
  found.m_cti.m_offset = btScalar(0.01);
  found.m_c3 = 1;
  body.m_nodeRigidContacts.push_back(found);
  rows_.collect(bodies_, rigids_, kStepSeconds);
  ASSERT_EQ(rows_.rows().size(), 1U);
  EXPECT_NEAR(rows_.rows()[0].gapVelocity * kStepSeconds, 0.01 + 0.6 * kStepSeconds, 1e-5);
  EXPECT_NEAR(rows_.rows()[0].relative.y(), -0.6, 1e-5);
  body.m_nodeRigidContacts.clear();
}

TEST_F(WarmRows, OfANodeBeginWithTheDirectionsInWhichBulletFixesIt) {
  btAlignedObjectArray<btSoftBody*> all;
  all.push_back(&upper_->body());
  btDeformableContactProjection projection(all);
  const SolvedBody& body = *bodies_.find(&upper_->body());
  const btVector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto fix = [&](int node, std::initializer_list<btVector3> directions) {
    btAlignedObjectArray<btVector3> list;
    for (const btVector3& direction : directions) list.push_back(direction);
    projection.m_projectionsDict.insert(btHashInt(body.first + node), list);
  };
  fix(0, {x});
  fix(1, {x, y});
  fix(2, {x, x});
  fix(3, {x, y, z});
  listFixedNodes(projection, bodies_);
  ASSERT_EQ(body.acted.fixed.size(), 4U);
  EXPECT_EQ(body.acted.fixed[0].kind, FixedNode::AlongDirection);
  EXPECT_EQ(body.acted.fixed[1].kind, FixedNode::AllButDirection);
  EXPECT_NEAR(std::abs(body.acted.fixed[1].direction.z()), 1, 1e-6);
  EXPECT_EQ(body.acted.fixed[2].kind, FixedNode::AlongDirection);
  EXPECT_EQ(body.acted.fixed[3].kind, FixedNode::Fixed);
}

/// A fold is pushed several ways.
TEST_F(WarmRows, OfOneSampleInTwoDirectionsRecallThatOfTheirs) {
  const btVector3 aside(1, 0, 0), slipAside(0, btScalar(0.1), 0);
  begin({contact(7, 3), contact(7, 3, aside)});
  end({{kOtherSlip, 1}, {slipAside, 2}});
  begin({contact(7, 3, aside), contact(7, 3), contact(7, 3, -kUp)});
  expectRecalled(0, slipAside, 2);
  expectRecalled(1, kOtherSlip, 1);
  expectRecalled(2, btVector3(0, 0, 0), 0);
}

}  // namespace
}  // namespace tetskin::test
