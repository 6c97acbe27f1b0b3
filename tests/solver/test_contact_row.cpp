// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/rows/contact_row.h>

#include <utility>

namespace tetskin {

using namespace bullet_detail;

namespace {

using State = ContactRow::State;

constexpr double kRounding = 1e-4;  // for impulses of some units, in float

/// Random numbers from -1 to 1.
class Random {
 public:
  btScalar operator()() { return static_cast<btScalar>(generator_()) / btScalar(2147483648.0) - 1; }
  btVector3 vector() {
    const btScalar x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  std::mt19937 generator_{7};
};

/// A row with stiffness 10, tangent stiffness 3 and a friction bound of 0.8, unless a test changes them.
ContactRow slanted() {
  ContactRow row;
  row.normal = btVector3(1, 2, -2) / 3;
  row.friction = btScalar(0.4);
  row.normalBound = 2;
  row.stiffness = 10;
  row.tangentStiffness = 3;
  row.gapVelocity = btScalar(0.1);
  row.offsetVelocity = btVector3(2, -1, 0) * btScalar(0.02);  // along the surface
  return row;
}

btVector3 alongOf(const ContactRow& row, const btVector3& v) {
  return v - row.normal.dot(v) * row.normal;
}

double quadratic(const btMatrix3x3& m, const btVector3& v) {
  return static_cast<double>(v.dot(m * v));
}

/// The negative derivative of the impulse, by central differences.
btMatrix3x3 fallOf(const ContactRow& row, const btVector3& u, btScalar step) {
  btMatrix3x3 fall;
  for (int k = 0; k < 3; ++k) {
    btVector3 to(0, 0, 0);
    to[k] = step;
    State state;
    const btVector3 change = impulseAt(row, u - to, false, state) - impulseAt(row, u + to, false, state);
    for (int i = 0; i < 3; ++i) fall[i][k] = change[i] / (2 * step);
  }
  return fall;
}

double farthest(const btMatrix3x3& a, const btMatrix3x3& b) {
  double maximum = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) maximum = std::max(maximum, std::abs(static_cast<double>(a[i][j] - b[i][j])));
  }
  return maximum;
}

TEST(ContactRow, PushesInProportionToWhatIsBelowItsGapAndNeverPulls) {
  const ContactRow row = slanted();
  Random random;
  int apart = 0;
  for (int k = 0; k < 200; ++k) {
    const btVector3 u = random.vector();
    State state;
    const btVector3 impulse = impulseAt(row, u, false, state);
    const double wanted = -10.0 * static_cast<double>(row.normal.dot(u) + row.gapVelocity);
    EXPECT_NEAR(row.normal.dot(impulse), std::max(wanted, 0.0), kRounding);
    if (state == State::Apart) {
      ++apart;
      EXPECT_LE(wanted, kRounding);
      EXPECT_TRUE(impulse.isZero());
      EXPECT_LT(farthest(tangentAt(row, u, state, 1), btMatrix3x3::getIdentity() * btScalar(0)), 1e-12);
    }
  }
  EXPECT_GT(apart, 50);
  EXPECT_LT(apart, 150);
}

TEST(ContactRow, GivesNoMoreThanItsBoundsAndNoneAlongTheSurfaceThere) {
  ContactRow row = slanted();
  row.lowest = -1;
  row.highest = 2;
  for (const auto& [speed, expected] : {std::pair{btScalar(5), btScalar(-1)}, {btScalar(-5), btScalar(2)}}) {
    State state;
    const btVector3 impulse = impulseAt(row, speed * row.normal, false, state);
    EXPECT_LT((impulse - expected * row.normal).length(), kRounding);
    EXPECT_EQ(state, State::Apart) << "more speed does not change it";
  }
  State state;
  const btVector3 impulse = impulseAt(row, btScalar(-0.2) * row.normal, false, state);
  EXPECT_NEAR(row.normal.dot(impulse), 1.0, kRounding);
  EXPECT_NE(state, State::Apart);
}

TEST(ContactRow, RubsAgainstSlipAndOffsetNoMoreThanFrictionTimesTheNormalImpulseOfBefore) {
  const ContactRow row = slanted();
  Random random;
  int sticking = 0, sliding = 0;
  for (int k = 0; k < 300; ++k) {
    const btVector3 u = alongOf(row, random.vector()) - btScalar(0.3) * row.normal;
    const btVector3 slip = alongOf(row, u) + row.offsetVelocity;
    State state;
    const btVector3 along = alongOf(row, impulseAt(row, u, false, state));
    if (3 * slip.length() < btScalar(0.8)) {
      ++sticking;
      EXPECT_EQ(state, State::Sticks);
      EXPECT_LT((along + 3 * slip).length(), kRounding);
    } else {
      ++sliding;
      EXPECT_EQ(state, State::Slides);
      EXPECT_NEAR(along.length(), 0.8, kRounding);
      EXPECT_NEAR(along.dot(slip), -0.8 * static_cast<double>(slip.length()), kRounding) << "against it";
    }
    const btVector3 stuck = alongOf(row, impulseAt(row, u, true, state));
    EXPECT_EQ(state, State::Sticks) << "if it is taken to";
    EXPECT_LT((stuck + 3 * slip).length(), kRounding);
  }
  EXPECT_GT(sticking, 20);
  EXPECT_GT(sliding, 100);
}

TEST(ContactRow, WithoutFrictionSlidesFreely) {
  for (const bool never : {true, false}) {
    ContactRow row = slanted();
    (never ? row.friction : row.normalBound) = 0;
    const btVector3 u(btScalar(0.5), btScalar(-0.7), 0);
    State state;
    const btVector3 impulse = impulseAt(row, u, false, state);
    EXPECT_EQ(state, State::Slides);
    EXPECT_GT(impulse.length(), 1);
    EXPECT_LT(alongOf(row, impulse).length(), kRounding);
    for (const btScalar kept : {btScalar(0), btScalar(1)}) {
      EXPECT_LT((tangentAt(row, u, state, kept) * alongOf(row, u)).length(), kRounding);
    }
  }
}

TEST(ContactRow, ThatIsJoinedPullsInAllDirections) {
  ContactRow row = slanted();
  row.joined = true;
  Random random;
  for (int k = 0; k < 20; ++k) {
    const btVector3 u = random.vector();
    State state;
    EXPECT_LT((impulseAt(row, u, false, state) + 10 * (u + row.offsetVelocity)).length(), kRounding);
    EXPECT_EQ(state, State::Sticks);
    EXPECT_LT(farthest(tangentAt(row, u, state, 1), btMatrix3x3::getIdentity() * 10), 1e-6);
    EXPECT_LT(farthest(fallOf(row, u, btScalar(0.1)), btMatrix3x3::getIdentity() * 10), 10 * kRounding);
  }
}

TEST(ContactRow, FallsByItsTangentWhereItSticks) {
  const ContactRow row = slanted();
  Random random;
  for (int k = 0; k < 50; ++k) {
    const btVector3 u = btScalar(0.1) * alongOf(row, random.vector()) - btScalar(0.3) * row.normal;
    State state;
    impulseAt(row, u, false, state);
    ASSERT_EQ(state, State::Sticks);
    // The impulse is linear there, so large differences are as accurate as small ones.
    EXPECT_LT(farthest(tangentAt(row, u, state, 1), fallOf(row, u, btScalar(0.02))), 0.01);
  }
}

TEST(ContactRow, FallsByItsTangentWhereItSlidesAndNothingOfThatIsKept) {
  const ContactRow row = slanted();
  Random random;
  for (int k = 0; k < 50; ++k) {
    btVector3 u = alongOf(row, random.vector());
    if (u.length() < btScalar(0.5)) u *= btScalar(0.5) / u.length();
    u -= btScalar(0.3) * row.normal;
    State state;
    impulseAt(row, u, false, state);
    ASSERT_EQ(state, State::Slides);
    EXPECT_LT(farthest(tangentAt(row, u, state, 0), fallOf(row, u, btScalar(0.02))), 0.01);
  }
}

/// The omitted term would be a resistance that falls with speed; with all of it kept, friction is resisted as if it
/// were proportional to the slip.
TEST(ContactRow, KeepsOfSlidingWhatMakesItAResistance) {
  const ContactRow row = slanted();
  Random random;
  for (int k = 0; k < 50; ++k) {
    const btVector3 u = alongOf(row, random.vector()) * 3 - btScalar(0.3) * row.normal;
    const btVector3 slip = alongOf(row, u) + row.offsetVelocity;
    State state;
    const btVector3 along = alongOf(row, impulseAt(row, u, false, state));
    if (state != State::Slides) continue;
    const btMatrix3x3 derivative = tangentAt(row, u, state, 0), some = tangentAt(row, u, state, btScalar(0.1)),
                      all = tangentAt(row, u, state, 1);
    EXPECT_LT((all * slip + along).length(), kRounding);
    EXPECT_LT((derivative * slip).length(), kRounding) << "it does not grow with the slip";
    EXPECT_NEAR(quadratic(some, slip), 0.1 * quadratic(all, slip), kRounding * (1.0 + quadratic(all, slip)));
    for (int j = 0; j < 20; ++j) {
      const btVector3 v = random.vector();
      for (const btMatrix3x3& tangent : {derivative, some, all}) {
        EXPECT_GE(quadratic(tangent, v), -kRounding) << "no negative eigenvalue";
        EXPECT_LT(farthest(tangent, tangent.transpose()), 1e-6);
      }
      EXPECT_GE(quadratic(some - derivative, v), -kRounding);
      EXPECT_GE(quadratic(all - some, v), -kRounding) << "a majorant";
    }
  }
}

}  // namespace
}  // namespace tetskin
