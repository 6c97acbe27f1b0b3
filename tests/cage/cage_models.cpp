// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_models.h"

#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

void addQuad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

Eigen::Vector3d onSphere(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace

TriangleMesh unitSphere(int rings) {
  return sphere(rings, 1.0, Eigen::Vector3d::Zero());
}

TriangleMesh openSphereMesh(int rings, double openingRadians) {
  const int segments = 2 * rings;
  TriangleMesh mesh;
  mesh.positions.emplace_back(0.0, 0.0, 1.0);
  for (int r = 1; r <= rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      mesh.positions.push_back(onSphere(openingRadians * r / rings, 2.0 * kPi * s / segments));
    }
  }
  const auto at = [&](int r, int s) { return 1 + (r - 1) * segments + s % segments; };
  for (int s = 0; s < segments; ++s) mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) addQuad(mesh, at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1));
  }
  return mesh;
}

TriangleMesh torusMesh(int segments) {
  TriangleMesh mesh;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double u = 2.0 * kPi * i / segments, v = 2.0 * kPi * j / segments;
      const double r = 1.0 + 0.35 * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), 0.35 * std::sin(v));
    }
  }
  const auto at = [&](int i, int j) { return i % segments * segments + j % segments; };
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

TriangleMesh boxMesh(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(0.5 * size.x() * (i & 1 ? 1 : -1), 0.5 * size.y() * (i & 2 ? 1 : -1),
                                0.5 * size.z() * (i & 4 ? 1 : -1));
  }
  addQuad(mesh, 0, 2, 3, 1);
  addQuad(mesh, 4, 5, 7, 6);
  addQuad(mesh, 0, 1, 5, 4);
  addQuad(mesh, 2, 6, 7, 3);
  addQuad(mesh, 0, 4, 6, 2);
  addQuad(mesh, 1, 3, 7, 5);
  return mesh;
}

TriangleMesh sheetMesh(int n) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      mesh.positions.emplace_back(i / static_cast<double>(n), j / static_cast<double>(n), 0.0);
  }
  const auto at = [&](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

TriangleMesh figurineMesh(int rings) {
  TriangleMesh mesh = unitSphere(rings);
  for (Eigen::Vector3d& p : mesh.positions) {
    const double bumps = 0.25 * std::sin(3.0 * p.x() + 1.0) * std::sin(4.0 * p.y()) * std::cos(3.0 * p.z());
    const double ridges = 0.08 * std::sin(14.0 * p.x()) * std::sin(12.0 * p.y() + 1.0) * std::sin(13.0 * p.z());
    const double tail = 1.6 * std::exp(-40.0 * (p - Eigen::Vector3d(0.8, 0.6, 0.0)).squaredNorm());
    const double stem = 1.2 * std::exp(-60.0 * (p - Eigen::Vector3d(-0.6, 0.0, 0.8)).squaredNorm());
    p *= 0.7 + bumps + ridges + tail + stem;
  }
  return mesh;
}

TriangleMesh finnedSphereMesh() {
  return joined(unitSphere(16), transformed(boxMesh({1.0, 0.001, 0.4}), 1.0, {1.45, 0.0, 0.0}));
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  const auto offset = static_cast<int>(a.positions.size());
  mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return mesh;
}

TriangleMesh invertedMesh(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh shuffledOrientation(TriangleMesh mesh) {
  std::mt19937 random(1);
  for (auto& t : mesh.triangles) {
    if (random() & 1u) std::swap(t[1], t[2]);
  }
  return mesh;
}

TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<int>(soup.positions.size());
    for (const int v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh transformed(TriangleMesh mesh, double scale, const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& p : mesh.positions) p = scale * p + offset;
  return mesh;
}

}  // namespace tetskin::test
