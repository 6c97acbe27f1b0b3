// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "../bullet/deformable_test.h"

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/src/soft/contact_body.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/triangle_bvh.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tetskin::test {

/// A ball in a cage 1 long, made of cubes of edge 0.2.
struct Ball {
  static constexpr double kRadius = 0.42;

  TetMesh cage = latticeCage(5, 5, 5, 0.2);
  TriangleMesh mesh = sphere(24, kRadius, Eigen::Vector3d(0.5, 0.5, 0.5));
  std::shared_ptr<const ContactShape> shape = makeShape({});

  std::shared_ptr<const ContactShape> makeShape(const ContactShapeOptions& options) const {
    Result<std::shared_ptr<const ContactShape>> made = ContactShape::create(cage, mesh, options);
    EXPECT_TRUE(made.ok()) << made.status().message;
    return made.value();
  }
  TetMesh at(const Eigen::Vector3d& offset) const { return shifted(cage, offset); }
};

/// Shared, because it takes a while to create.
inline const Ball& ball() {
  static const Ball made;
  return made;
}

/// Balls, which may be squeezed, and which no world steps.
class StillBalls : public testing::Test {
 protected:
  std::unique_ptr<contact_detail::ContactBody> include(const Eigen::Vector3d& offset, double squeeze = 1.0,
                                                       std::shared_ptr<const ContactShape> shape = ball().shape) {
    bodies_.push_back(createSoftBody(ball().at(offset), info_).value());
    btSoftBody& body = *bodies_.back();
    for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_x.setX(body.m_nodes[n].m_x.x() * squeeze);
    auto solved =
        std::make_unique<contact_detail::ContactBody>(body, std::move(shape), false, static_cast<int>(bodies_.size()));
    solved->read();
    return solved;
  }

  btSoftBodyWorldInfo info_;
  std::vector<std::unique_ptr<btSoftBody>> bodies_;
};

/// A plate of 1 x 0.12 x 1, in a cage of one layer of cubes.
struct Plate {
  static constexpr double kHalfThickness = 0.06;
  TetMesh cage = latticeCage(5, 1, 5, 0.2);
  TriangleMesh mesh;
  std::shared_ptr<const ContactShape> shape;

  Plate() {
    const Eigen::Vector3d low(0.03, 0.1 - kHalfThickness, 0.03), high(0.97, 0.1 + kHalfThickness, 0.97);
    for (int c = 0; c < 8; ++c) {
      mesh.positions.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(), c & 4 ? high.z() : low.z());
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    Result<std::shared_ptr<const ContactShape>> made = ContactShape::create(cage, mesh);
    EXPECT_TRUE(made.ok()) << made.status().message;
    shape = made.value();
  }
};

inline const Plate& plate() {
  static const Plate made;
  return made;
}

inline std::unique_ptr<TetskinWorld> worldWith(const btVector3& gravity) {
  auto world = std::make_unique<TetskinWorld>();
  world->deformable().setGravity(gravity);
  world->deformable().getWorldInfo().m_gravity = gravity;
  return world;
}

inline std::unique_ptr<SoftContacts> contactsIn(EmptyWorld& world, const SoftContactOptions& options = {}) {
  Result<std::unique_ptr<SoftContacts>> made = SoftContacts::add(world.deformable(), options);
  EXPECT_TRUE(made.ok()) << made.status().message;
  return std::move(made).value();
}

inline std::unique_ptr<DeformableBody> addBall(EmptyWorld& world, const Eigen::Vector3d& at, double mass = 1.0) {
  SoftBodyOptions options;
  options.mass = mass;
  options.youngsModulus = 2000.0;
  options.margin = 0.002;
  return added(world, ball().at(at), options);
}

/// Positions and velocities of all nodes of these bodies.
inline std::vector<btScalar> motionOf(const std::vector<std::unique_ptr<DeformableBody>>& bodies) {
  std::vector<btScalar> all;
  for (const auto& body : bodies) {
    for (int n = 0; n < body->body().m_nodes.size(); ++n) {
      const btSoftBody::Node& node = body->body().m_nodes[n];
      for (int axis = 0; axis < 3; ++axis) all.insert(all.end(), {node.m_x[axis], node.m_v[axis]});
    }
  }
  return all;
}

/// The largest speed of any node of these bodies, in units per second.
inline double fastestNode(const std::vector<std::unique_ptr<DeformableBody>>& bodies) {
  double fastest = 0;
  for (const auto& body : bodies) fastest = std::max(fastest, fastestOf(body->body()));
  return fastest;
}

/// How deep the deepest vertex of one body lies inside another, found by testing all vertices, all tets and all
/// triangles. At rest, both bodies are `mesh` in `cage`.
inline double deepest(const btSoftBody& body, const TetMesh& cage, const TriangleMesh& mesh, const btSoftBody& other,
                      const TetMesh& otherCage, const TriangleMesh& otherMesh) {
  const TriangleBvh surface(otherMesh);
  const WindingTree solid(otherMesh);
  const std::vector<VertexBinding> bindings = embed(cage, viewOf(mesh.positions)).value().bindings();
  double depth = 0.0;
  for (const VertexBinding& b : bindings) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) p += static_cast<double>(b.weights[k]) * toEigen(body.m_nodes[cage.tets[b.tet][k]].m_x);
    for (const Tet& tet : otherCage.tets) {
      TetCorners corners;
      for (int k = 0; k < 4; ++k) corners[k] = toEigen(other.m_nodes[tet[k]].m_x);
      if (isFlat(corners)) continue;
      const Eigen::Vector4d w = BarycentricMap(corners)(p);
      if (w.minCoeff() < 0.0) continue;
      Eigen::Vector3d rest = Eigen::Vector3d::Zero();
      for (int k = 0; k < 4; ++k) rest += w[k] * otherCage.nodes[tet[k]];
      if (solid.windingNumber(rest) < kInside) continue;
      depth = std::max(depth, std::sqrt(surface.nearest(rest).squaredDistance));
    }
  }
  return depth;
}

}  // namespace tetskin::test
