// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The distances are Inigo Quilez's, https://iquilezles.org/articles/distfunctions and .../smin
#include "scenes/hand.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/angles.h"
#include "scenes/stuffed_solid.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kPitch = 0.25;  ///< from one finger to the next
constexpr double kRootRadius = 0.1, kTipRadius = 0.085;
constexpr double kRootY = 0.7;  ///< where the fingers begin, inside the palm
constexpr double kPalmTop = 0.8, kPalmRounding = 0.08;
constexpr double kJoint = 0.06;  ///< length over which a finger blends into the palm
constexpr double kPlaneY = kPalmTop + 0.15;
constexpr double kHandLean = 50.0 * kDegree;  ///< from upright: gravity bends the fingers
constexpr std::array<double, 5> kTipY = {1.4, 1.7, 1.8, 1.72, 1.5};

/// Across the hand, the lattice is this much sparser than on average along the middles of the fingers, and as much
/// denser between them: in the lattice's own space the gaps are half as wide as the fingers, and a coarse lattice can
/// separate these.
constexpr double kCrowding = 0.6;
/// The spacing of the coarsest lattice that separates the fingers: a little less than a gap in its space.
constexpr double kMaxSpacing = 0.085;

double squared(double x) {
  return x * x;
}

double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// The distance from a box with rounded edges.
double palmDistance(const Vector3d& p) {
  const Vector3d half(0.6, 0.5 * kPalmTop, 0.11), centre(0.0, 0.5 * kPalmTop, 0.0);
  const Vector3d q = (p - centre).cwiseAbs() - half + Vector3d::Constant(kPalmRounding);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - kPalmRounding;
}

/// The distance from two balls on a line along y and the cone between them.
double fingerDistance(const Vector3d& p, double x, double tipY) {
  const double far = tipY - kRootY, slope = (kRootRadius - kTipRadius) / far;
  const double across = length(p.x() - x, p.z()), along = p.y() - kRootY;
  const double rise = std::sqrt(1.0 - squared(slope)), k = rise * along - slope * across;
  if (k < 0.0) return length(across, along) - kRootRadius;
  if (k > rise * far) return length(across, along - far) - kTipRadius;
  return across * rise + along * slope - kRootRadius;
}

double smoothMinimum(double a, double b) {
  const double overlap = std::max(kJoint - std::abs(a - b), 0.0);
  return std::min(a, b) - squared(overlap) / (4.0 * kJoint);
}

double uprightDistance(const Vector3d& p) {
  const double palm = palmDistance(p);
  double nearest = palm;
  for (std::size_t finger = 0; finger < kTipY.size(); ++finger) {
    const double x = kPitch * (static_cast<double>(finger) - 2.0);
    // Each finger is blended with the palm only: nothing joins the fingers.
    nearest = std::min(nearest, smoothMinimum(palm, fingerDistance(p, x, kTipY[finger])));
  }
  return nearest;
}

Eigen::AngleAxisd leaning() {
  return {kHandLean, Vector3d::UnitX()};
}

Vector3d fromLattice(const Vector3d& p) {
  const double turn = 2.0 * kPi / kPitch;
  return {p.x() + kCrowding / turn * std::sin(turn * p.x()), p.y(), p.z()};
}

ImplicitSolid uprightHand() {
  ImplicitSolid hand;
  hand.box = Box3(Vector3d(-0.65, 0.0, -0.12), Vector3d(0.65, 1.9, 0.12));
  hand.value = [](const Vector3d& p) { return uprightDistance(fromLattice(p)); };
  hand.position = [](const Vector3d& p) -> Vector3d { return leaning() * fromLattice(p); };
  return hand;
}

}  // namespace

TriangleMesh makeHand(std::size_t triangles) {
  TriangleMesh mesh =
      surfaceOf(uprightHand(), std::clamp(triangles, kMinHandTriangles, kMaxHandTriangles), kMaxSpacing);
  mesh.groups.push_back({"hand", "hand", 0, mesh.triangleCount()});
  return mesh;
}

TetMesh makeHandTets(std::size_t tets) {
  TetMesh mesh = tetsOf(uprightHand(), std::max(tets, kMinHandTets), kMaxSpacing);
  matchVolume(mesh, handDistance);
  return mesh;
}

Eigen::Hyperplane<double, 3> handPlane() {
  return {leaning() * Vector3d::UnitY(), leaning() * Vector3d(0.0, kPlaneY, 0.0)};
}

double handDistance(const Vector3d& p) {
  return uprightDistance(leaning().inverse() * p);
}

}  // namespace tetskin::scenes
