// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "drag/props.h"

#include <cmath>
#include <utility>
#include <vector>

namespace tetskin::scenes {
namespace {

constexpr int kAround = 32;

/// Revolves a polyline of (radius, height) about the y axis; the outside is on its left.
TriangleMesh turned(const std::vector<std::pair<double, double>>& line) {
  TriangleMesh mesh;
  for (const auto& [radius, height] : line) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * EIGEN_PI * k / kAround;
      mesh.positions.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    }
  }
  for (int row = 0; row + 1 < static_cast<int>(line.size()); ++row) {
    for (int k = 0; k < kAround; ++k) {
      const int a = row * kAround + k, b = row * kAround + (k + 1) % kAround;
      mesh.triangles.push_back({a, a + kAround, b});
      mesh.triangles.push_back({b, a + kAround, b + kAround});
    }
  }
  return mesh;
}

/// Makes the whole mesh one group, with this name and a material of the same name.
TriangleMesh named(const char* name, TriangleMesh mesh) {
  mesh.groups = {{name, name, 0, mesh.triangleCount()}};
  return mesh;
}

}  // namespace

TriangleMesh makeHat(double radius) {
  const double r = radius;
  return named("hat",
               turned({{0, 0}, {1.7 * r, 0}, {1.7 * r, 0.1 * r}, {r, 0.15 * r}, {0.85 * r, 1.5 * r}, {0, 1.5 * r}}));
}

TriangleMesh makePointer(double radius) {
  return named("pointer", turned({{0, -radius}, {radius, 0}, {0, radius}}));
}

TriangleMesh makeRing(double radius, double thickness) {
  constexpr int kAcross = 12;
  TriangleMesh mesh;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const double u = 2 * EIGEN_PI * i / kAround, v = 2 * EIGEN_PI * j / kAcross;
      const double reach = radius + thickness * std::cos(v);
      mesh.positions.emplace_back(reach * std::cos(u), reach * std::sin(u), thickness * std::sin(v));
      const int a = i * kAcross + j, b = i * kAcross + (j + 1) % kAcross;
      const int c = (i + 1) % kAround * kAcross + j, d = (i + 1) % kAround * kAcross + (j + 1) % kAcross;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return named("ring", std::move(mesh));
}

}  // namespace tetskin::scenes
