// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body whose surface lies well within its cage, and the things that it falls on.
#pragma once

#include "solver/deformable_test.h"
#include "support/points_within.h"
#include "support/rigids.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/contact/surface_contact.h>

#include <memory>
#include <random>
#include <vector>

namespace tetskin::test {

/// The largest side of the cage's bounding box.
constexpr double kBodySize = 1.0;

/// A ball around the origin, cut about as finely along its rings as across them.
inline TriangleMesh ballMesh(int rings, double radius) {
  return sphere(rings, radius, Eigen::Vector3d::Zero(), 2 * rings);
}

/// The six sides of a box, two triangles each.
inline TriangleMesh boxMesh(const Eigen::Vector3d& half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.positions.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                k & 4 ? half.z() : -half.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// The unit cube around the origin, as 6 x 4^3 tets: between it and the surface in it there is a fifth of its size.
inline TetMesh looseCage() {
  TetMesh cage = latticeCage(4, 4, 4, kBodySize / 4);
  for (Eigen::Vector3d& p : cage.nodes) p -= Eigen::Vector3d::Constant(kBodySize / 2);
  return cage;
}

/// A free multibody without joints or damping, whose base is a flat box.
struct FlatMultibody {
  FlatMultibody(EmptyWorld& in, btScalar mass, const btVector3& at)
      : world(in), body(0, mass, inertiaOf(box, mass), false, false) {
    body.setLinearDamping(0);
    body.setAngularDamping(0);
    body.setBaseWorldTransform(placeAt(at));
    body.finalizeMultiDof();
    link.setCollisionShape(&box);
    link.setWorldTransform(placeAt(at));
    link.setInterpolationWorldTransform(link.getWorldTransform());
    body.setBaseCollider(&link);
    world.deformable().addMultiBody(&body);
    world.deformable().addCollisionObject(&link);
  }
  ~FlatMultibody() {
    world.deformable().removeCollisionObject(&link);
    world.deformable().removeMultiBody(&body);
  }
  FlatMultibody(const FlatMultibody&) = delete;
  FlatMultibody& operator=(const FlatMultibody&) = delete;

  EmptyWorld& world;
  btBoxShape box{btVector3(1, btScalar(0.2), 1)};
  btMultiBody body;
  btMultiBodyLinkCollider link{&body, -1};

 private:
  static btVector3 inertiaOf(const btBoxShape& box, btScalar mass) {
    btVector3 inertia;
    box.calculateLocalInertia(mass, inertia);
    return inertia;
  }
};

/// A body with surface contact in a world.
struct TouchingBody {
  TouchingBody(EmptyWorld& world, TriangleMesh surface, const btVector3& at, const SurfaceContactOptions& options = {},
               const SoftBodyOptions& material = {})
      : mesh(std::move(surface)) {
    TetMesh cage = looseCage();
    binding = SoftBodyBinding::create(cage, mesh).value();
    for (Eigen::Vector3d& p : cage.nodes) p += toEigen(at);
    body = added(world, cage, material);
    Result<std::unique_ptr<SurfaceContact>> made =
        SurfaceContact::add(world.deformable(), body->body(), *binding, mesh, options);
    EXPECT_TRUE(made.ok()) << made.status().message;
    contact = std::move(made).value();
    EXPECT_TRUE(skin.bind(body->body(), binding).ok());
  }

  /// The surface in world space.
  std::vector<Eigen::Vector3d> surface() {
    skin.markMoved();
    EXPECT_EQ(skin.update(), StatusCode::Ok);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t v = 0; v < skin.positions().size(); ++v) {
      const btScalar* p = skin.positions()[v];
      points.emplace_back(p[0], p[1], p[2]);
    }
    return points;
  }
  /// The least distance of the surface's vertices, where `distance` gives the distance of a point.
  template <class Distance>
  double gap(const Distance& distance) {
    double minimum = HUGE_VAL;
    for (const Eigen::Vector3d& p : surface()) minimum = std::min(minimum, static_cast<double>(distance(p)));
    return minimum;
  }
  double height() {
    return gap([](const Eigen::Vector3d& p) { return p.y(); });
  }

  TriangleMesh mesh;
  std::shared_ptr<const SoftBodyBinding> binding;
  std::unique_ptr<DeformableBody> body;
  std::unique_ptr<SurfaceContact> contact;
  SoftBodySkin skin;
};

/// A rigid body of full friction in a world as long as this object lives.
class Obstacle {
 public:
  Obstacle(EmptyWorld& world, std::unique_ptr<btCollisionShape> shape, const btTransform& at, btScalar mass = 0)
      : rigid_(world, std::move(shape), mass, at) {
    rigid_->setFriction(1);
  }
  btRigidBody& body() { return *rigid_; }
  const btCollisionShape& shape() const { return *rigid_.shape; }

 private:
  Rigid rigid_;
};

}  // namespace tetskin::test
