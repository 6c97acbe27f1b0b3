// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/contact_sides.h>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

TEST(ContactSides, OfASampleTheNearestOfTheStepBeforeIsFound) {
  std::mt19937 random(6);
  const auto point = [&] {
    return btVector3(btScalar(random() % 100), btScalar(random() % 100), btScalar(random() % 100)) / 100;
  };
  ContactSides sides;
  std::vector<ContactSide> before;
  for (int step = 0; step < 5; ++step) {
    sides.beginStep();
    for (int sample = 0; sample < 60; ++sample) {
      const btVector3 rest = point();
      const btScalar within = btScalar(0.1) * static_cast<btScalar>(random() % 10);
      const ContactSide* nearest = nullptr;
      for (const ContactSide& side : before) {
        const btScalar distance = (side.point - rest).length();
        const bool isNearer = distance < (nearest ? (nearest->point - rest).length() : within);
        if (side.sample == sample && isNearer) nearest = &side;
      }
      const ContactSide* found = sides.find(sample, rest, within);
      ASSERT_EQ(found != nullptr, nearest != nullptr);
      EXPECT_TRUE(!found || found->point == nearest->point);
    }
    before.clear();
    for (int k = 0; k < 100; ++k) before.push_back({k * 60 / 100, point(), btVector3(0, 1, 0)});
    for (const ContactSide& side : before) sides.keep(side);
  }
  sides.clear();
  sides.beginStep();
  EXPECT_EQ(sides.find(0, btVector3(0, 0, 0), 10), nullptr);
}

/// The distance from the plate, below 0 inside, by all of its planes: its edges are out of reach.
TEST(ContactSides, ASampleSeenFirstIsAtTheNearestSurface) {
  const DistanceGrid& grid = dataOf(*plate().shape).grid;
  for (const Eigen::Vector3d& p :
       randomPoints(500, Box3(Eigen::Vector3d(0.3, 0, 0.3), Eigen::Vector3d(0.7, 0.2, 0.7)), 3)) {
    const double height = std::abs(p.y() - 0.1) - Plate::kHalfThickness;
    if (std::abs(p.y() - 0.1) < static_cast<double>(grid.spacing())) continue;  // as near to both sides
    GridDistance nearest;
    ASSERT_TRUE(grid.at(toBullet(p), nearest));
    EXPECT_EQ(asksForMotion(grid, nearest, nullptr), nearest.distance <= -2 * grid.spacing());
    SideDistance found;
    ASSERT_TRUE(findSide(grid, toBullet(p), nearest, btVector3(0, 0, 0), nullptr, found));
    EXPECT_NEAR(found.distance, height, 1e-5);
    EXPECT_NEAR(found.side.normal.y(), p.y() > 0.1 ? 1 : -1, 1e-4);
    EXPECT_NEAR(found.side.point.y(), p.y() > 0.1 ? 0.16 : 0.04, 1e-5);
    EXPECT_FALSE(asksForMotion(grid, nearest, &found.side));
  }
}

TEST(ContactSides, ASampleBeyondTheMiddleGoesBackAsItCame) {
  const DistanceGrid& grid = dataOf(*plate().shape).grid;
  const btScalar top = btScalar(0.1 + Plate::kHalfThickness);
  ContactSides sides;
  for (btScalar depth = btScalar(-0.02); depth < btScalar(0.1); depth += btScalar(0.01)) {
    const btVector3 rest(btScalar(0.3) + 4 * depth, top - depth, btScalar(0.5));  // it slides meanwhile
    sides.beginStep();
    GridDistance nearest;
    ASSERT_TRUE(grid.at(rest, nearest));
    SideDistance found;
    ASSERT_TRUE(findSide(grid, rest, nearest, btVector3(0, 0, 0), sides.find(3, rest, 1), found)) << depth;
    EXPECT_NEAR(found.distance, -depth, 0.5 * grid.spacing()) << "the nearer side is below from 0.06 on";
    EXPECT_NEAR(found.side.point.x(), rest.x(), 0.01) << "it follows";
    EXPECT_GT(found.side.normal.y(), 0.9);
    found.side.sample = 3;
    sides.keep(found.side);
  }
}

TEST(ContactSides, ASampleSeenLateHasComeFromBehind) {
  const DistanceGrid& grid = dataOf(*plate().shape).grid;
  const btVector3 rest(btScalar(0.5), btScalar(0.075), btScalar(0.5)), motion(0, btScalar(-0.12), 0);
  GridDistance nearest;
  ASSERT_TRUE(grid.at(rest, nearest));
  SideDistance found;
  ASSERT_TRUE(findSide(grid, rest, nearest, motion, nullptr, found));
  EXPECT_GT(found.side.normal.y(), 0.9) << "though the nearest side is below";
  EXPECT_NEAR(found.distance, 0.075 - 0.16, 0.005);
  ASSERT_TRUE(findSide(grid, rest, nearest, -motion, nullptr, found));
  EXPECT_LT(found.side.normal.y(), -0.9);
}

TEST(ContactSides, ASampleThatGoesAroundAnEdgeIsFree) {
  const DistanceGrid& grid = dataOf(*plate().shape).grid;
  ContactSide top;
  top.point = btVector3(btScalar(0.5), btScalar(0.16), btScalar(0.5));
  const btVector3 rest(btScalar(0.5), btScalar(0.18), btScalar(0.5));
  GridDistance nearest;
  ASSERT_TRUE(grid.at(rest, nearest));
  SideDistance found;
  ASSERT_TRUE(findSide(grid, rest, nearest, btVector3(0, 0, 0), &top, found));
  EXPECT_GT(found.distance, 0);
}

}  // namespace
}  // namespace tetskin::test
