// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/xpbd.h"

#include <cmath>

namespace tetskin::measure {
namespace {

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

Xpbd::Xpbd(const XpbdBody& body)
    : damping_(static_cast<float>(body.damping)), gravity_(static_cast<float>(body.gravity)), floor_(body.floor) {
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    const Eigen::Vector3f p = body.nodes[n].cast<float>();
    points_.push_back({p.x(), p.y(), p.z(), static_cast<float>(body.inverseMasses[n])});
  }
  before_ = points_;
  velocities_ = std::vector<Point>(points_.size(), Point{0, 0, 0, 0});
  for (const XpbdBody::Edge& e : body.edges) {
    const Vector edge = minus(points_[e.a], points_[e.b]);
    edges_.push_back({e.a, e.b, std::sqrt(dot(edge, edge)), static_cast<float>(e.compliance)});
  }
  for (const XpbdBody::Volume& tet : body.volumes) {
    const auto& [a, b, c, d] = tet.nodes;
    const float volume =
        dot(cross(minus(points_[b], points_[a]), minus(points_[c], points_[a])), minus(points_[d], points_[a])) / 6.0f;
    volumes_.push_back({tet.nodes, volume, static_cast<float>(tet.compliance)});
  }
}

void Xpbd::predict(float dt) {
  for (std::size_t n = 0; n < points_.size(); ++n) {
    Point &p = points_[n], &v = velocities_[n];
    before_[n] = p;
    if (p.inverseMass == 0.0f) continue;
    v.y -= gravity_ * dt;
    add(p, {v.x, v.y, v.z}, dt);
    if (floor_ && p.y < 0.0f) p = {before_[n].x, 0.0f, before_[n].z, p.inverseMass};
  }
}

void Xpbd::solveEdges(float dt) {
  for (const Edge& edge : edges_) {
    Point &a = points_[edge.a], &b = points_[edge.b];
    const Vector d = minus(a, b);
    const float length = std::sqrt(dot(d, d));
    if (length == 0.0f) continue;
    const float damp = damping(edge.compliance, dt);
    const float weight = (1.0f + damp) * (a.inverseMass + b.inverseMass) + edge.compliance / (dt * dt);
    if (weight == 0.0f) continue;
    float wrong = length - edge.length;
    if (damp > 0.0f) wrong += damp * dot(d, minus(d, minus(before_[edge.a], before_[edge.b]))) / length;
    const float s = -wrong / (weight * length);
    add(a, d, s * a.inverseMass);
    add(b, d, -s * b.inverseMass);
  }
}

void Xpbd::solveVolumes(float dt) {
  static constexpr int kFaces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  for (const Volume& tet : volumes_) {
    Vector gradients[4];  // times 6
    float weight = 0.0f, moved = 0.0f;
    const float damp = damping(tet.compliance, dt);
    for (int k = 0; k < 4; ++k) {
      const Point &p0 = points_[tet.nodes[kFaces[k][0]]], &p1 = points_[tet.nodes[kFaces[k][1]]];
      const Point& p2 = points_[tet.nodes[kFaces[k][2]]];
      gradients[k] = cross(minus(p1, p0), minus(p2, p0));
      weight += points_[tet.nodes[k]].inverseMass * dot(gradients[k], gradients[k]) / 36.0f;
      if (damp > 0.0f) moved += dot(gradients[k], minus(points_[tet.nodes[k]], before_[tet.nodes[k]])) / 6.0f;
    }
    weight = (1.0f + damp) * weight + tet.compliance / (dt * dt);
    if (weight == 0.0f) continue;
    const Vector edge = minus(points_[tet.nodes[3]], points_[tet.nodes[0]]);
    const float volume = dot(gradients[3], edge) / 6.0f;
    const float s = -(volume - tet.volume + damp * moved) / weight / 6.0f;
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

std::vector<Eigen::Vector3f> Xpbd::nodes() const {
  std::vector<Eigen::Vector3f> positions;
  for (const Point& p : points_) positions.emplace_back(p.x, p.y, p.z);
  return positions;
}

}  // namespace tetskin::measure
