// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gaps/gap_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tetskin::gaps {
namespace {

using namespace measure;
using Eigen::Vector3d;
using scenes::kSize;

/// The upper edges of two boxes at 45 degrees, 0.5 S apart.
Obstacle edges() {
  const double side = 0.2 * kSize, below = -side * std::sqrt(2.0);
  return obstacleOf(box({side, side, 2 * kSize}, 0.25 * EIGEN_PI),
                    {{-0.25 * kSize, below, 0}, {0.25 * kSize, below, 0}});
}

/// The middle of four spheres of radius 0.6 S.
Obstacle spheres() {
  const double radius = 0.6 * kSize, aside = 0.5 * kSize;
  return obstacleOf(
      ball(radius),
      {{-aside, -radius, -aside}, {-aside, -radius, aside}, {aside, -radius, -aside}, {aside, -radius, aside}});
}

/// Three balls of radius 0.075 S, 0.25 S from the middle.
Obstacle smallBalls() {
  const double radius = 0.075 * kSize;
  std::vector<Vector3d> centres;
  for (int k = 0; k < 3; ++k) {
    const double turn = 2.0 * EIGEN_PI * k / 3;
    centres.emplace_back(0.25 * kSize * std::cos(turn), -radius, 0.25 * kSize * std::sin(turn));
  }
  return obstacleOf(ball(radius), centres);
}

/// Two poles of radius 0.03 S, 0.5 S apart.
Obstacle poles() {
  const double radius = 0.03 * kSize;
  return obstacleOf(capsule(radius, 2 * kSize), {{-0.25 * kSize, -radius, 0}, {0.25 * kSize, -radius, 0}});
}

/// The hull of a slab 0.6 S wide whose sides slope at 45 degrees. Its distance is that of the farthest plane: exact
/// inside and above the faces.
Obstacle hull() {
  const double top = 0.3 * kSize, height = 0.2 * kSize;
  const auto add = [=](MeasuringWorld& world) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (int k = 0; k < 8; ++k) {
      const double y = k & 4 ? 0.0 : -height, side = k & 4 ? top : top + height;
      shape->addPoint(btVector3(static_cast<btScalar>(k & 1 ? side : -side), static_cast<btScalar>(y),
                                static_cast<btScalar>(k & 2 ? side : -side)));
    }
    world.addRigid(std::move(shape), btTransform::getIdentity());
  };
  return {add, [=](const Vector3d& p) {
            const double slope = (std::max(std::abs(p.x()), std::abs(p.z())) + p.y() - top) * std::sqrt(0.5);
            return std::max({p.y(), slope, -height - p.y()});
          }};
}

/// Gentle hills 0.04 S high, a grid of triangles. The distance is a function of the plane, by the triangle above or
/// below a point.
struct Hills {
  static constexpr int kCells = 12;  ///< to either side
  static constexpr double kCell = 0.125 * kSize, kDepth = 0.04 * kSize, kLength = 1.5 * kSize;

  static double height(int i, int j) {
    const double turn = 2.0 * EIGEN_PI * kCell / kLength;
    return 0.5 * kDepth * (std::cos(turn * i) * std::cos(turn * j) - 1.0);
  }
  static btVector3 corner(int i, int j) {
    return {static_cast<btScalar>(i * kCell), static_cast<btScalar>(height(i, j)), static_cast<btScalar>(j * kCell)};
  }
  /// The distance from the plane of the triangle at a position: there are two per cell, cut from (1, 0) to (0, 1).
  static double distance(const Vector3d& p) {
    const double x = p.x() / kCell, z = p.z() / kCell;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(z));
    const double u = x - i, v = z - j, first = height(i + 1, j), second = height(i, j + 1);
    const bool lower = u + v < 1.0;
    const double at = lower ? height(i, j) : height(i + 1, j + 1);
    const double alongX = lower ? first - at : at - second, alongZ = lower ? second - at : at - first;
    const double y = lower ? at + u * alongX + v * alongZ : at - (1.0 - u) * alongX - (1.0 - v) * alongZ;
    return (p.y() - y) / std::sqrt(1.0 + (alongX * alongX + alongZ * alongZ) / (kCell * kCell));
  }
};

void addHills(btTriangleMesh& mesh) {
  for (int i = -Hills::kCells; i < Hills::kCells; ++i) {
    for (int j = -Hills::kCells; j < Hills::kCells; ++j) {
      const btVector3 a = Hills::corner(i, j), b = Hills::corner(i + 1, j), c = Hills::corner(i, j + 1);
      mesh.addTriangle(a, c, b);
      mesh.addTriangle(b, c, Hills::corner(i + 1, j + 1));
    }
  }
}

}  // namespace

const std::vector<GapObstacle>& gapObstacles() {
  static const std::vector<GapObstacle> all = {
      {obstacleOf(box({5 * kSize, kSize, 5 * kSize}), {{0, -kSize, 0}}), "floor"},
      {edges(), "edge"},
      {spheres(), "sphere"},
      {poles(), "pole"},
      {hull(), "hull"},
      {{[](MeasuringWorld& world) {
          world.addRigid(std::make_unique<TriangleShape>(addHills), btTransform::getIdentity());
        },
        &Hills::distance},
       "mesh"},
      {smallBalls(), "ball", true}};
  return all;
}

}  // namespace tetskin::gaps
