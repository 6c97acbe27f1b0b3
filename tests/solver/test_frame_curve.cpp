// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/base/frame_curve.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr btScalar kFrame = btScalar(1) / 60;

/// The velocity at a fraction of a frame, by a difference.
btVector3 velocityAt(const FrameCurve& curve, btScalar fraction, btScalar duration) {
  constexpr btScalar kPart = btScalar(1) / 1024;
  const btScalar low = std::max(fraction - kPart, btScalar(0)), high = std::min(fraction + kPart, btScalar(1));
  return (curve.at(high) - curve.at(low)) / ((high - low) * duration);
}

TEST(FrameCurve, IsThePathOfAConstantAccelerationInFramesOfAnyLength) {
  const btVector3 velocity(btScalar(0.5), 1, 0), acceleration(0, btScalar(-9.81), 3);
  const auto place = [&](btScalar t) { return velocity * t + acceleration * (t * t / 2); };
  FrameMotion motion;
  btScalar t = 0;
  for (int frame = 0; frame < 12; ++frame) {
    const btScalar duration = kFrame * (1 + btScalar(0.3) * std::sin(static_cast<btScalar>(frame)));
    const FrameCurve curve = motion.next(place(t + duration) - place(t), duration);
    for (int k = 0; k <= 8 && frame >= 4; ++k) {
      const btScalar fraction = static_cast<btScalar>(k) / 8;
      EXPECT_LT((curve.at(fraction) - (place(t + fraction * duration) - place(t))).length(), 2e-6) << frame;
    }
    t += duration;
  }
}

TEST(FrameCurve, OfASwingHasNoJumpsOfVelocityAndIsNearTheSwing) {
  constexpr btScalar kRate = 30;  // half a radian per frame
  const auto place = [&](btScalar t) { return btVector3(std::sin(kRate * t), std::cos(kRate * t), 0); };
  FrameMotion motion;
  btVector3 last(0, 0, 0);
  btScalar straight = 0, curved = 0, jump = 0, chordsJump = 0;
  FrameCurve before;
  for (int frame = 0; frame < 60; ++frame) {
    const btScalar t = kFrame * static_cast<btScalar>(frame);
    const FrameCurve curve = motion.next(place(t + kFrame) - place(t), kFrame);
    for (int k = 0; k <= 16 && frame > 3; ++k) {
      const btScalar fraction = static_cast<btScalar>(k) / 16;
      const btVector3 way = place(t + fraction * kFrame) - place(t);
      straight = std::max(straight, (fraction * curve.way - way).length());
      curved = std::max(curved, (curve.at(fraction) - way).length());
    }
    if (frame > 4) {
      jump = std::max(jump, (velocityAt(curve, 0, kFrame) - last).length());
      chordsJump = std::max(chordsJump, (curve.way - before.way).length() / kFrame);
    }
    last = velocityAt(curve, 1, kFrame);
    before = curve;
  }
  EXPECT_LT(jump, 0.03 * chordsJump);  // differences over a thousandth of a frame
  EXPECT_LT(curved, 0.12 * straight);
}

TEST(FrameCurve, OfABodyThatStandsBeginsAtRestAndArrives) {
  FrameMotion motion;
  const btVector3 way(btScalar(0.1), 0, 0);
  const FrameCurve curve = motion.next(way, kFrame);
  EXPECT_LT(velocityAt(curve, 0, kFrame).length(), 0.01 * way.length() / kFrame);
  for (int k = 0; k < 16; ++k) {
    EXPECT_LE(curve.at(static_cast<btScalar>(k) / 16).x(), curve.at(static_cast<btScalar>(k + 1) / 16).x());
  }
  EXPECT_EQ(curve.at(1), way);
  EXPECT_EQ(curve.at(0), btVector3(0, 0, 0));
}

TEST(FrameCurve, OfABodyThatStopsAtOnceDoesNotGoFurther) {
  FrameMotion motion;
  const btVector3 way(btScalar(0.1), 0, 0), none(0, 0, 0);
  for (int frame = 0; frame < 5; ++frame) motion.next(way, kFrame);
  for (int frame = 0; frame < 3; ++frame) {
    const FrameCurve curve = motion.next(none, kFrame);
    for (int k = 0; k <= 16; ++k) EXPECT_EQ(curve.at(static_cast<btScalar>(k) / 16), none) << frame << " " << k;
  }
}

TEST(FrameCurve, OfABodyThatTurnsBackStaysNearItsPlaces) {
  FrameMotion motion;
  const btVector3 way(btScalar(0.1), 0, 0);
  for (int frame = 0; frame < 5; ++frame) motion.next(way, kFrame);
  const FrameCurve curve = motion.next(-way, kFrame);
  for (int k = 0; k <= 16; ++k) {
    const btScalar x = curve.at(static_cast<btScalar>(k) / 16).x() / way.x();
    EXPECT_LE(x, 0.1);
    EXPECT_GE(x, -1.0001);
  }
}

/// An even motion, in frames that Bullet divides into two or three steps of a length that does not fit.
TEST(FrameCurve, OfStepsThatDoNotFitIntoFramesHasNoLargerJumpsThanStraightPaths) {
  constexpr btScalar kStep = btScalar(1) / 140;
  FrameMotion motion;
  btScalar left = 0, last = 0, lastStraight = 0, jump = 0, straightJump = 0;
  for (int frame = 0; frame < 100; ++frame) {
    left += kFrame;
    const auto steps = static_cast<int>(left / kStep);
    const btScalar duration = static_cast<btScalar>(steps) * kStep;
    left -= duration;
    const FrameCurve curve = motion.next(btVector3(kFrame, 0, 0), duration);
    for (int k = 0; k < steps; ++k) {
      const auto share = [&](int count) { return static_cast<btScalar>(count) / static_cast<btScalar>(steps); };
      const btScalar velocity = (curve.at(share(k + 1)) - curve.at(share(k))).x() / kStep;
      const btScalar straight = kFrame / duration;
      if (frame > 5) {
        jump = std::max(jump, std::abs(velocity - last));
        straightJump = std::max(straightJump, std::abs(straight - lastStraight));
      }
      last = velocity;
      lastStraight = straight;
    }
  }
  EXPECT_LT(jump, 1.02 * straightJump);
}

TEST(FrameCurve, OfNoisyPlacesExpectsNothing) {
  FrameMotion motion;
  for (int frame = 0; frame < 40; ++frame) {
    const btScalar sign = frame % 2 ? btScalar(1) : btScalar(-1);
    const btVector3 way(sign * btScalar(0.1), 0, 0);
    motion.next(way, kFrame);
    EXPECT_LT((motion.velocity - way / kFrame).length(), 1e-4);
  }
}

}  // namespace
}  // namespace tetskin::test
