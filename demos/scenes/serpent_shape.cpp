// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/serpent_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scenes/angles.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kHeadLength = 0.54;
constexpr double kTailCap = 0.02;                        ///< length over which the tip of the tail is rounded off
constexpr double kSnoutCap = 0.085;                      ///< length over which the snout is rounded off
constexpr double kBackHeight = 1.0, kBellyDepth = 0.86;  ///< of the body, over half its width: the belly is flat
constexpr double kScaleHeight = 0.17;                    ///< relative to the body's radius
constexpr double kHeadScaleHeight = 0.03;                ///< the same for the head, whose scales are small
constexpr double kNeckEnd = -0.2;     ///< share of the head's length at which the head's relief begins
constexpr double kSmoothStep = 2e-4;  ///< step in t and theta for the smooth surface's normal

/// A spiral whose inner end rises into an S-shaped neck; the tail flicks outwards.
std::vector<Vector3d> spineControls() {
  constexpr double kInnermost = 0.36, kPitch = 0.43;     ///< distance from the centre; its increase in one turn
  constexpr double kThinFrom = 0.75, kTightening = 0.2;  ///< turns beyond which the tail, which is thin, lies closer
  constexpr double kFirstAngle = -315.0, kLastAngle = 180.0, kStep = 22.5;
  std::vector<Vector3d> controls = {
      {-0.56, 0.20, 0.96}, {-0.45, 0.09, 1.06}, {-0.24, 0.06, 1.04}, {0.03, 0.07, 0.94}, {0.30, 0.10, 0.87}};
  for (double angle = kFirstAngle; angle <= kLastAngle; angle += kStep) {
    const double turns = (kLastAngle - angle) / 360.0, thin = std::max(turns - kThinFrom, 0.0);
    const double distance = kInnermost + kPitch * turns - kTightening * thin * thin;
    // Gentle humps, so that the coil does not look like a rope on the floor.
    const double height = 0.17 + 0.035 * std::sin(2.0 * angle * kDegree + 0.6);
    controls.emplace_back(distance * std::sin(angle * kDegree), height, distance * std::cos(angle * kDegree));
  }
  const std::vector<Vector3d> neck = {{-0.16, 0.23, -0.32}, {-0.26, 0.35, -0.26}, {-0.31, 0.51, -0.21},
                                      {-0.28, 0.69, -0.19}, {-0.19, 0.86, -0.11}, {-0.09, 0.94, 0.03},
                                      {-0.02, 0.93, 0.22},  {0.03, 0.87, 0.36},   {0.07, 0.81, 0.50}};
  controls.insert(controls.end(), neck.begin(), neck.end());
  return controls;
}

/// Half the width of the body as a function of t.
double bodyRadius(double t) {
  static const Profile profile = {{0.0, 0.012},  {0.08, 0.034}, {0.22, 0.08},  {0.40, 0.128}, {0.56, 0.155},
                                  {0.70, 0.150}, {0.80, 0.124}, {0.88, 0.100}, {0.93, 0.09},  {1.0, 0.09}};
  return profile(t);
}

/// The head as a function of h, its share of the head's length: wide cheeks, a high brow, a long snout.
double headWidth(double h) {
  static const Profile profile = {{0.0, 0.092},  {0.22, 0.147}, {0.36, 0.152}, {0.55, 0.106},
                                  {0.78, 0.081}, {0.90, 0.085}, {1.0, 0.078}};
  return profile(h);
}
double headAbove(double h) {
  static const Profile profile = {{0.0, 0.092},  {0.25, 0.121}, {0.40, 0.120}, {0.56, 0.076},
                                  {0.78, 0.057}, {0.90, 0.064}, {1.0, 0.057}};
  return profile(h);
}
double headBelow(double h) {
  static const Profile profile = {{0.0, 0.081}, {0.25, 0.106}, {0.45, 0.083}, {0.75, 0.060}, {1.0, 0.051}};
  return profile(h);
}

/// A quarter circle: 1 from `cap` inwards, 0 at the end.
double roundEnd(double distance, double cap) {
  const double x = std::clamp(1.0 - distance / cap, 0.0, 1.0);
  return std::sqrt(1.0 - x * x);
}

double bell(double x) {
  return std::exp(-0.5 * x * x);
}

/// A bump, mirrored on both sides of the head.
struct HeadBump {
  double h, theta;         ///< where: share of the head's length; degrees
  double length, breadth;  ///< standard deviations: share of the head's length; degrees
  double height;           ///< in units of length; negative is a pit
};
constexpr HeadBump kHeadBumps[] = {
    {0.46, 138.0, 0.085, 11.0, 0.038},   // brow
    {0.30, 142.0, 0.080, 14.0, 0.016},   // root of the brow
    {0.51, 112.0, 0.045, 12.0, -0.016},  // eye socket
    {0.20, 75.0, 0.080, 22.0, 0.024},    // jaw muscle
    {0.87, 140.0, 0.040, 16.0, 0.014},   // nostril
    {0.915, 128.0, 0.016, 9.0, -0.016},  // hole of the nostril
    {0.70, 118.0, 0.150, 10.0, 0.007},   // ridge from brow to nostril
    {0.62, 66.0, 0.200, 9.0, 0.008},     // lower lip
};

constexpr double kMouthCorner = 0.30;    ///< share of the head's length where the mouth begins
constexpr double kMouthHalfGap = 0.012;  ///< standard deviation of the groove, in units of length
constexpr double kMouthDepth = 0.040;

/// The groove of the mouth, which lies where the surface crosses a level: so it goes around the snout with constant
/// width.
double mouthRelief(double h, double level) {
  static const Profile mouthLevel = {{kMouthCorner, 0.002}, {0.45, -0.018}, {0.7, -0.010}, {0.88, -0.004}, {1.0, 0.0}};
  return -kMouthDepth * smoothStep(kMouthCorner, kMouthCorner + 0.2, h) * bell((level - mouthLevel(h)) / kMouthHalfGap);
}

/// Height of a section's outline above the spine.
double levelOf(const Section& section, double theta) {
  const double c = std::cos(theta);
  return -c * (c < 0.0 ? section.above : section.below);
}

}  // namespace

Vector3d Section::point(double theta) const {
  return frame.origin + halfWidth * std::sin(theta) * frame.side + levelOf(*this, theta) * frame.up;
}

SerpentShape::SerpentShape() : spine_(spineControls()), headStart_(1.0 - kHeadLength / spine_.length()) {
  constexpr int kSamples = 512;
  Eigen::AlignedBox3d box;
  for (int k = 0; k <= kSamples; ++k) {
    const double t = static_cast<double>(k) / kSamples;
    box.extend(spine_.frame(t).origin + Vector3d::Constant(radius(t)));
    box.extend(spine_.frame(t).origin - Vector3d::Constant(radius(t)));
  }
  spine_.translate({-box.center().x(), -box.min().y(), -box.center().z()});
}

double SerpentShape::radius(double t) const {
  return section(t).halfWidth;
}

Section SerpentShape::section(double t) const {
  const double r = bodyRadius(t);
  const double h = (t - headStart_) / (1.0 - headStart_);
  const double head = smoothStep(-0.15, 0.15, h);
  const double ends = roundEnd(t * spine_.length(), kTailCap) * roundEnd((1.0 - t) * spine_.length(), kSnoutCap);
  const auto blend = [&](double body, double skull) { return ends * ((1.0 - head) * body + head * skull); };
  return {spine_.frame(t), blend(r, headWidth(h)), blend(kBackHeight * r, headAbove(h)),
          blend(kBellyDepth * r, headBelow(h))};
}

SurfacePoint SerpentShape::surface(double t, double theta) const {
  const double before = std::max(t - kSmoothStep, 0.0), after = std::min(t + kSmoothStep, 1.0);
  const Section here = section(t);
  if (here.halfWidth <= 0.0) {  // a pole, where all angles meet
    const Vector3d outwards = (t < 0.5 ? -1.0 : 1.0) * here.frame.tangent;
    return {here.frame.origin, outwards, -here.frame.up};
  }
  const Vector3d along = section(after).point(theta) - section(before).point(theta);
  const Vector3d around = here.point(theta + kSmoothStep) - here.point(theta - kSmoothStep);
  return {here.point(theta), around.cross(along).normalized(), -along.normalized()};
}

double SerpentShape::headRelief(double t, double theta) const {
  const double h = (t - headStart_) / (1.0 - headStart_);
  if (h < kNeckEnd) return 0.0;
  const double degrees = std::min(theta, 2.0 * kPi - theta) / kDegree;
  double bumps = 0.0;
  for (const HeadBump& b : kHeadBumps) {
    bumps += b.height * bell((h - b.h) / b.length) * bell((degrees - b.theta) / b.breadth);
  }
  // At the tip all angles meet, so a bump there would be a crease.
  const double fade = smoothStep(kNeckEnd, 0.1, h) * (1.0 - smoothStep(0.93, 1.0, h));
  return fade * bumps + mouthRelief(h, levelOf(section(t), theta));
}

double SerpentShape::scaleHeight(double t) const {
  const double head = smoothStep(-0.3, 0.3, (t - headStart_) / (1.0 - headStart_));
  return radius(t) * (kScaleHeight + head * (kHeadScaleHeight - kScaleHeight));
}

double SerpentShape::spikeLength(double t) const {
  static const Profile share = {{0.0, 1.6}, {0.25, 1.4}, {0.6, 1.1}, {0.85, 1.3}, {1.0, 0.8}};
  return share(t) * bodyRadius(t);
}

double scalePattern(double row, double column, int columns) {
  constexpr double kLength = 1.9;                 ///< of a scale, in rows: scales overlap
  constexpr double kTip = 0.55;                   ///< share of the length that is rounded
  constexpr double kDome = 0.75, kSlope = 0.75;   ///< shares of the height lost from centre to side, from tip to root
  constexpr double kBelly = 0.10, kFlank = 0.15;  ///< where plates end and scales begin, in turns from the belly
  double height = 0.0;
  for (double tip = std::floor(row) - 1.0; tip <= row; tip += 1.0) {
    const double x = (row - tip) / kLength;
    if (x > 1.0) continue;
    const double stagger = std::fmod(std::abs(tip), 2.0) == 0.0 ? 0.0 : 0.5;
    const double y = std::abs(column + stagger - std::round(column + stagger));
    const double outline = 0.53 * std::sin(0.5 * kPi * std::min(x / kTip, 1.0));
    const double edge = 1.0 - smoothStep(0.8, 1.0, outline > 0.0 ? y / outline : 1.0);
    height = std::max(height, edge * (1.0 - kSlope * x) * (1.0 - kDome * std::pow(2.0 * y, 1.5)));
  }
  const double plate = row - std::floor(row);
  const double plateHeight = 0.45 * smoothStep(0.0, 0.25, plate) * (1.0 - 0.8 * plate);
  const double turn = column / columns;
  const double scales = smoothStep(kBelly, kFlank, std::min(turn, 1.0 - turn));
  return (1.0 - scales) * plateHeight + scales * height;
}

}  // namespace tetskin::scenes
