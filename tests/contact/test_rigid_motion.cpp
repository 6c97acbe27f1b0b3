// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <LinearMath/btQuaternion.h>
#include <tetskin/contact/src/soft/rigid_motion.h>

#include <numeric>

namespace tetskin::test {
namespace {

using contact_detail::RigidMotion;

struct Points {
  explicit Points(std::size_t count) : nodes(count) {
    std::iota(nodes.begin(), nodes.end(), 0);
    std::mt19937 random(5);
    std::uniform_real_distribution<btScalar> coordinate(-1, 1);
    for (std::size_t n = 0; n < count; ++n) {
      before.emplace_back(3 * coordinate(random) + 7, coordinate(random), coordinate(random));
    }
  }
  RigidMotion fit(const std::vector<btVector3>& after) const {
    return {nodes, [&](std::size_t n) { return before[n]; }, [&](std::size_t n) { return after[n]; }};
  }
  std::vector<btVector3> turned(btScalar angle) const {
    std::vector<btVector3> after;
    const btQuaternion turn(btVector3(1, 2, -1).normalized(), angle);
    for (const btVector3& p : before) after.push_back(quatRotate(turn, p) + btVector3(1, 0, 2));
    return after;
  }
  static double largest(const RigidMotion& motion, const std::vector<btVector3>& from,
                        const std::vector<btVector3>& to) {
    double largest = 0.0;
    for (std::size_t n = 0; n < from.size(); ++n) {
      largest = std::max(largest, static_cast<double>((to[n] - motion(from[n])).length()));
    }
    return largest;
  }

  std::vector<int> nodes;
  std::vector<btVector3> before;
};

TEST(RigidMotion, FitsATurnUpToTermsOfSecondOrder) {
  const Points points(50);
  for (const btScalar angle : {btScalar(0.01), btScalar(0.1)}) {
    const std::vector<btVector3> after = points.turned(angle);
    const double error = Points::largest(points.fit(after), points.before, after);
    EXPECT_LT(error, 3.0 * static_cast<double>(angle * angle) + 2e-5) << angle;
    EXPECT_GT(Points::largest(RigidMotion(after[0] - points.before[0]), points.before, after), 10.0 * error) << angle;
  }
}

/// Bounds of distances rest on this, whatever the points do.
TEST(RigidMotion, ChangesNoDistance) {
  const Points points(50);
  std::vector<btVector3> after = points.turned(btScalar(0.7));
  for (std::size_t n = 0; n < after.size(); ++n) after[n] *= btScalar(1 + 0.02 * static_cast<double>(n % 7));
  const RigidMotion motion = points.fit(after);
  for (std::size_t a = 0; a < 50; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto wanted = static_cast<double>((points.before[a] - points.before[b]).length());
      const auto found = static_cast<double>((motion(points.before[a]) - motion(points.before[b])).length());
      EXPECT_NEAR(found, wanted, 1e-5);
    }
  }
}

TEST(RigidMotion, TranslatesWhereNoTurnIsKnown) {
  const Points one(1);
  const RigidMotion motion = one.fit({one.before[0] + btVector3(1, 2, 3)});
  EXPECT_NEAR(static_cast<double>((motion(btVector3(0, 0, 0)) - btVector3(1, 2, 3)).length()), 0.0, 1e-5);
}

}  // namespace
}  // namespace tetskin::test
