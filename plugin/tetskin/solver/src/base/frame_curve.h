// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The path, between two places, of something that an application moves once per frame: a curve that starts with the
// velocity of the frame before, and ends with the velocity that the last three frames suggest. On straight paths,
// velocities would jump once per frame, within a single step: held objects would be torn off, or creep.
//
// A cubic in Hermite form; its end velocity is that of the cubic through the last four places. If a motion's third
// differences are not small (the application stops it at once, or its places are noisy), nothing is extrapolated.
#pragma once

#include <LinearMath/btVector3.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {

/// The path from the beginning of a frame, of positions in m or of rotation vectors in radians.
struct FrameCurve {
  btVector3 way{0, 0, 0};    ///< over the whole frame
  btVector3 early{0, 0, 0};  ///< extra path if it kept the velocity of the beginning
  btVector3 late{0, 0, 0};   ///< extra path if it had the velocity of the end throughout

  /// fraction  of the frame's time, 0 to 1
  btVector3 at(btScalar fraction) const {
    assert(fraction >= 0 && fraction <= 1);
    const btScalar left = 1 - fraction;
    return fraction * way + (fraction * left) * (left * early - fraction * late);
  }

  /// Turns it with its body.
  template <class Rotation>
  void rotate(const Rotation& by) {
    by.rotate(way, early, late);
  }

  template <class Stream>
  void serialize(Stream& stream) {
    stream(way, early, late);
  }
};

/// The motion in the frames before. All zero: at rest.
struct FrameMotion {
  btVector3 velocity{0, 0, 0};               ///< at the end of the last frame, per second
  btVector3 mean{0, 0, 0}, before{0, 0, 0};  ///< mean velocities of the last frame and of the one before
  btScalar seconds = 0, secondsBefore = 0;   ///< of these frames

  FrameCurve next(const btVector3& way, btScalar duration) {
    assert(duration > 0);
    const btVector3 now = way / duration;
    const bool smooth = isSmooth(now);
    FrameCurve curve;
    curve.way = way;
    curve.early = velocity * duration - way;
    // For a motion that is not smooth: no overshoot, as far as its places allow it (Fritsch and Carlson's bound).
    const btScalar most = 2 * way.length(), early = curve.early.length();
    if (!smooth && early > most) curve.early *= most / early;
    velocity = smooth ? endVelocity(now, duration) : now;
    curve.late = velocity * duration - way;
    before = mean;
    mean = now;
    secondsBefore = seconds;
    seconds = duration;
    return curve;
  }

  template <class Rotation>
  void rotate(const Rotation& by) {
    by.rotate(velocity, mean, before);
  }

  template <class Stream>
  void serialize(Stream& stream) {
    stream(velocity, mean, before, seconds, secondsBefore);
  }

 private:
  /// With frames of uneven length, the end velocity of the parabola through the last three places: when Bullet's steps
  /// do not fit into the application's frames, places do not match the steps' times, and a higher order would be noise.
  btVector3 endVelocity(const btVector3& now, btScalar duration) const {
    constexpr btScalar kEven = btScalar(0.01);
    const btVector3 second = (now - mean) / (duration + seconds);
    const btVector3 parabola = now + duration * second;
    const auto isEven = [&](btScalar other) { return std::abs(other - duration) <= kEven * duration; };
    if (!isEven(seconds) || !isEven(secondsBefore)) return parabola;
    return parabola + (now - 2 * mean + before) / 3;
  }
  bool isSmooth(const btVector3& now) const {
    constexpr btScalar kSmooth = btScalar(0.75);  // a swing of at least seven frames
    const btScalar fastest = std::max({now.length2(), mean.length2(), before.length2()});
    return (now - 2 * mean + before).length2() <= kSmooth * kSmooth * fastest;
  }
};

}  // namespace tetskin::bullet_detail
