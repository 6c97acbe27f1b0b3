// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For tests of normals: meshes with known normals, and skins that carry them.
#pragma once

#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <gtest/gtest.h>
#include <tetskin/core/mesh_skin.h>

#include <cmath>

namespace tetskin::test {

inline constexpr double kDegrees = 180.0 / 3.14159265358979323846;
inline const Eigen::Vector3d kCentre = Eigen::Vector3d::Constant(0.5);

inline Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d c;
  c << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return c;
}

inline double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A sphere with exact normals, and with tangents along its circles of latitude.
inline TriangleMesh authoredSphere(int rings, double radius) {
  TriangleMesh mesh = sphere(rings, radius, kCentre);
  for (const Eigen::Vector3d& p : mesh.positions) {
    const Eigen::Vector3d n = (p - kCentre).normalized();
    mesh.normals.push_back(n.cast<float>());
    const Eigen::Vector3d t = std::abs(n.y()) > 0.999 ? Eigen::Vector3d::UnitX() : n.cross(Eigen::Vector3d::UnitY());
    mesh.tangents.emplace_back(static_cast<float>(t.normalized().x()), static_cast<float>(t.normalized().y()),
                               static_cast<float>(t.normalized().z()), -1.0f);
  }
  return mesh;
}

/// A unit cube whose faces share no vertices; if `authored`, each corner has its face's normal.
inline TriangleMesh box(bool authored) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int first = static_cast<int>(mesh.vertexCount());
      for (int c = 0; c < 4; ++c) {
        Eigen::Vector3d p;
        p[axis] = side;
        p[(axis + 1) % 3] = c == 1 || c == 2;
        p[(axis + 2) % 3] = c >= 2;
        mesh.positions.push_back(p);
        if (authored) mesh.normals.push_back((2.0f * static_cast<float>(side) - 1.0f) * Eigen::Vector3f::Unit(axis));
      }
      const int second = side == 1 ? 1 : 3, last = side == 1 ? 3 : 1;
      mesh.triangles.push_back({first, first + second, first + 2});
      mesh.triangles.push_back({first, first + 2, first + last});
    }
  }
  return mesh;
}

/// A skin with normals, which moves with its cage.
template <class Scalar>
class Carried {
 public:
  Carried(const Cage& cage, const TriangleMesh& mesh, Normals normals,
          Interpolation interpolation = Interpolation::Quadratic, double hardEdgeDegrees = kHardEdgeDegrees) {
    SkinOptions options;
    options.normals = normals;
    options.interpolation = interpolation;
    options.hardEdgeDegrees = hardEdgeDegrees;
    const Result<EmbedReport> bound = skin.bind(cage, mesh, options);
    EXPECT_TRUE(bound.ok()) << bound.status().message;
    fit = bound.value();
  }
  void move(const std::vector<Eigen::Vector3d>& positions) {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
    for (const Eigen::Vector3d& p : positions) nodes.push_back(p.cast<Scalar>());
    ASSERT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
  }
  Eigen::Vector3d normal(std::size_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(skin.normals()[v]).template cast<double>();
  }
  Eigen::Vector3d tangent(std::size_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(skin.tangents()[v]).template cast<double>();
  }

  MeshSkin<Scalar> skin;
  EmbedReport fit;
};

}  // namespace tetskin::test
