// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The distances are Inigo Quilez's, https://iquilezles.org/articles/distfunctions
#include "scenes/hoop_and_star.h"

#include <algorithm>
#include <cmath>

#include "scenes/angles.h"
#include "scenes/hand.h"
#include "scenes/stuffed_solid.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kHoopRadius = 0.9, kHalfBand = 0.25, kFootThickness = 0.18,
                 kTopThickness = 0.06;  // the last two: half thicknesses
constexpr double kBall = 0.26, kLeg = 0.32, kRoot = 0.18, kTip = 0.07, kArm = 1.15, kSpread = 70.0 * kDegree;
constexpr double kMaxStarSpacing = 0.1;

/// The distance from a band whose section is a rectangle with rounded edges, roughly where it gets thinner.
double hoopDistance(const Vector3d& p) {
  const double around = std::hypot(p.x(), p.y());
  const double up = around > 0.0 ? 0.5 * (1.0 + p.y() / around) : 0.5;  // 0 at the foot, 1 at the top
  const double half = kFootThickness + (kTopThickness - kFootThickness) * up, rounding = 0.5 * half;
  const Eigen::Vector2d q(std::abs(around - kHoopRadius) - half + rounding, std::abs(p.z()) - kHalfBand + rounding);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
}

/// The distance from a ball at the origin, another one on an arm of this direction, and the cone between them.
double armDistance(const Vector3d& p, const Vector3d& direction, double root, double tip) {
  const double slope = (root - tip) / kArm, rise = std::sqrt(1.0 - slope * slope);
  const double along = p.dot(direction), across = (p - along * direction).norm(), k = rise * along - slope * across;
  if (k < 0.0) return p.norm() - root;
  if (k > rise * kArm) return std::hypot(across, along - kArm) - tip;
  return across * rise + along * slope - root;
}

double starDistance(const Vector3d& p) {
  double nearest = std::min(p.norm() - kBall, armDistance(p, -Vector3d::UnitY(), kBall, kLeg));
  for (const double angle : {kSpread, -kSpread})
    nearest = std::min(nearest, armDistance(p, {std::sin(angle), std::cos(angle), 0.0}, kRoot, kTip));
  return nearest;
}

TriangleMesh starMesh(const Box3& box, double (*distance)(const Vector3d&), std::size_t triangles, const char* name) {
  const ImplicitSolid solid{box, distance, [](const Vector3d& p) { return p; }};
  TriangleMesh mesh = surfaceOf(solid, std::clamp(triangles, kMinHoopTriangles, kMaxHandTriangles), kMaxStarSpacing);
  mesh.groups.push_back({name, name, 0, mesh.triangleCount()});
  return mesh;
}

}  // namespace

TriangleMesh makeHoop(std::size_t triangles) {
  return starMesh({Vector3d(-1.1, -1.1, -0.3), Vector3d(1.1, 1.1, 0.3)}, hoopDistance, triangles, "hoop");
}

TriangleMesh makeStar(std::size_t triangles) {
  return starMesh({Vector3d(-1.3, -1.5, -0.35), Vector3d(1.3, 0.6, 0.35)}, starDistance, triangles, "star");
}

}  // namespace tetskin::scenes
