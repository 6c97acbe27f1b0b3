// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/contact/src/soft/contact_normal.h>

namespace tetskin::test {
namespace {

using namespace contact_detail;

const btVector3 kUp(0, 1, 0);

/// A touch whose nearest surface faces upwards, at this distance in cubes of 1.
Touch touchAt(btScalar distance) {
  Touch touch;
  touch.normal = kUp;
  touch.distance = distance;
  return touch;
}

/// The surface of a sample whose normal has this cosine to upwards.
SampleSurface surfaceWith(btScalar cosine) {
  SampleSurface surface;
  surface.normal = {btSqrt(1 - cosine * cosine), cosine, 0};
  return surface;
}

PairDirection pairOf(const btVector3& apart = {0, 0, 0}, btScalar deep = 0) {
  return {apart, deep, 1};
}

bool touches(SampleSurface sample, btScalar distance, const PairDirection& pair = pairOf()) {
  Touch touch = touchAt(distance);
  return chooseNormal(pair, sample, touch);
}

TEST(ContactNormal, SurfacesTouchThatFaceEachOtherAndOnFacesOnlyIfTheyDoSoSquarely) {
  SampleSurface edge = surfaceWith(btScalar(-0.4));
  EXPECT_TRUE(touches(edge, 0));
  edge.onFace = true;
  EXPECT_FALSE(touches(edge, 0));
  EXPECT_FALSE(touches(surfaceWith(btScalar(-0.2)), 0)) << "it slides along";
}

TEST(ContactNormal, WhatHasTouchedStaysAContactForLonger) {
  SampleSurface slanted = surfaceWith(btScalar(-0.2));
  slanted.touched = true;
  EXPECT_TRUE(touches(slanted, 0));
}

TEST(ContactNormal, WhatPiercesOrHasPiercedTouchesUnlessItsNormalAgrees) {
  Touch deep = touchAt(btScalar(-0.3));
  EXPECT_TRUE(chooseNormal(pairOf(), surfaceWith(btScalar(0.2)), deep));
  EXPECT_TRUE(deep.pierces);
  EXPECT_FALSE(touches(surfaceWith(btScalar(0.4)), btScalar(-0.3)));
  SampleSurface before = surfaceWith(btScalar(0.2));
  EXPECT_FALSE(touches(before, 0));
  before.pierced = true;
  EXPECT_TRUE(touches(before, 0));
}

TEST(ContactNormal, WhereItsOwnNormalIsUnknownASampleTouches) {
  EXPECT_TRUE(touches(SampleSurface{}, 0));
}

TEST(ContactNormal, DeepSamplesOfBodiesThatOverlapLeaveInOneDirectionAndOthersDoNotHoldThemBack) {
  const btVector3 down(0, -1, 0), aside(1, 0, 0);
  Touch deep = touchAt(-3);
  EXPECT_FALSE(chooseNormal(pairOf(aside, 2), surfaceWith(-1), deep)) << "its surface slides along that way";
  EXPECT_EQ(deep.normal, aside);
  EXPECT_FALSE(deep.pierces) << "where bodies overlap, nothing counts as piercing";
  EXPECT_FALSE(touches(surfaceWith(-1), -1, pairOf(down, 2))) << "it is pushed the other way";
  EXPECT_TRUE(touches(surfaceWith(-1), -1, pairOf(kUp, 2)));
  Touch coinciding = touchAt(0);
  (void)chooseNormal(pairOf(aside, 2), surfaceWith(1), coinciding);
  EXPECT_EQ(coinciding.distance, -4) << "surfaces that agree are those of bodies that coincide";
}

}  // namespace
}  // namespace tetskin::test
