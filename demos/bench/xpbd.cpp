// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/xpbd.h"

#include <algorithm>
#include <cmath>

namespace tetskin::bench {
namespace {

constexpr float kEdgeCompliance = 2e-4f,
                kVolumeCompliance = 0.0f;  ///< metres per newton; gives a body that wobbles but keeps its volume
constexpr float kGravity = 9.81f;

struct Vector {
  float x, y, z;
};

template <class P>
Vector minus(const P& a, const P& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class P>
void add(P& p, const Vector& v, float factor) {
  p.x += v.x * factor;
  p.y += v.y * factor;
  p.z += v.z * factor;
}

}  // namespace

Xpbd::Xpbd(const TetMesh& cage) {
  for (const Eigen::Vector3d& p : cage.nodes) {
    const Eigen::Vector3f q = p.cast<float>();
    points_.push_back({q.x(), q.y(), q.z(), 0.0f});
  }
  before_ = velocities_ = std::vector<Point>(points_.size(), Point{0, 0, 0, 0});
  std::vector<float> masses(points_.size(), 0.0f);
  float total = 0.0f;
  for (const Tet& t : cage.tets) {
    const auto& [a, b, c, d] = t;
    const float volume =
        dot(cross(minus(points_[b], points_[a]), minus(points_[c], points_[a])), minus(points_[d], points_[a])) / 6.0f;
    volumes_.push_back({t, volume});
    for (const int n : t) masses[static_cast<std::size_t>(n)] += volume / 4.0f;
    total += volume;
  }
  for (std::size_t n = 0; n < masses.size(); ++n) points_[n].inverseMass = masses[n] > 0.0f ? total / masses[n] : 0.0f;
  for (const auto& [a, b] : uniqueEdges(cage)) {
    const Vector edge = minus(points_[a], points_[b]);
    edges_.push_back({a, b, std::sqrt(dot(edge, edge))});
  }
}

void Xpbd::predict(float dt) {
  for (std::size_t n = 0; n < points_.size(); ++n) {
    Point &p = points_[n], &v = velocities_[n];
    before_[n] = p;
    v.y -= kGravity * dt;
    add(p, {v.x, v.y, v.z}, dt);
    if (p.y < 0.0f) p = {before_[n].x, 0.0f, before_[n].z, p.inverseMass};
  }
}

void Xpbd::solveEdges(float dt) {
  const float alpha = kEdgeCompliance / (dt * dt);
  for (const Edge& edge : edges_) {
    Point &a = points_[edge.a], &b = points_[edge.b];
    const Vector d = minus(a, b);
    const float length = std::sqrt(dot(d, d));
    if (length == 0.0f) continue;
    const float s = -(length - edge.length) / ((a.inverseMass + b.inverseMass + alpha) * length);
    add(a, d, s * a.inverseMass);
    add(b, d, -s * b.inverseMass);
  }
}

void Xpbd::solveVolumes(float dt) {
  static constexpr int kFaces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  const float alpha = kVolumeCompliance / (dt * dt);
  for (const Volume& tet : volumes_) {
    Vector gradients[4];
    float weight = alpha;
    for (int k = 0; k < 4; ++k) {
      const Point &p0 = points_[tet.nodes[kFaces[k][0]]], &p1 = points_[tet.nodes[kFaces[k][1]]];
      const Point& p2 = points_[tet.nodes[kFaces[k][2]]];
      gradients[k] = cross(minus(p1, p0), minus(p2, p0));
      weight += points_[tet.nodes[k]].inverseMass * dot(gradients[k], gradients[k]) / 36.0f;
    }
    if (weight == 0.0f) continue;
    const Vector edge = minus(points_[tet.nodes[3]], points_[tet.nodes[0]]);
    const float volume = dot(gradients[3], edge) / 6.0f;
    const float s = -(volume - tet.volume) / weight / 6.0f;
    for (int k = 0; k < 4; ++k) add(points_[tet.nodes[k]], gradients[k], s * points_[tet.nodes[k]].inverseMass);
  }
}

void Xpbd::step(float seconds, int substeps) {
  const float dt = seconds / static_cast<float>(substeps);
  for (int k = 0; k < substeps; ++k) {
    predict(dt);
    solveEdges(dt);
    solveVolumes(dt);
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const Vector moved = minus(points_[n], before_[n]);
      velocities_[n] = {moved.x / dt, moved.y / dt, moved.z / dt, 0.0f};
    }
  }
}

std::array<float, 2> Xpbd::heights() const {
  const auto byHeight = [](const Point& a, const Point& b) { return a.y < b.y; };
  const auto [low, high] = std::minmax_element(points_.begin(), points_.end(), byHeight);
  return {low->y, high->y};
}

}  // namespace tetskin::bench
