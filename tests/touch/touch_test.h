// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "../bullet/deformable_test.h"
#include "support/rigids.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <memory>
#include <ostream>
#include <string>

namespace tetskin::test {

/// A cage of 5 x 4 x 5 cubes, 1 x 0.8 x 1 in size, with a ball in it or around it.
struct TouchModel {
  TetMesh cage = latticeCage(5, 4, 5, 0.2);
  TriangleMesh mesh;

  /// radius  above 0.4, the ball sticks out of the cage
  explicit TouchModel(double radius = 0.38, double height = 0.0) : mesh(sphere(24, radius, {0.5, 0.4, 0.5})) {
    for (auto* points : {&cage.nodes, &mesh.positions}) {
      for (Eigen::Vector3d& p : *points) p.y() += height;
    }
  }
  std::shared_ptr<const SoftBodyBinding> bind(const BindingOptions& options = {}) const {
    return SoftBodyBinding::create(cage, mesh, options).value();
  }
};

inline std::unique_ptr<TetskinWorld> deformableWorld(double gravity = 0.0) {
  auto world = std::make_unique<TetskinWorld>();
  const btVector3 down(0, -static_cast<btScalar>(gravity), 0);
  world->deformable().setGravity(down);
  world->deformable().getWorldInfo().m_gravity = down;
  return world;
}

/// A body of a model in a world of this kind, with a skin and a tree.
struct TouchedBody {
  explicit TouchedBody(EmptyWorld& world, const TouchModel& item = TouchModel(), const SoftBodyOptions& options = {},
                       const BindingOptions& how = {})
      : model(item),
        owner(added(world, item.cage, options)),
        binding(item.bind(how)),
        tree(SurfaceTree::create(binding, item.mesh).value()) {
    EXPECT_TRUE(skin.bind(owner->body(), binding).ok());
    body().setActivationState(DISABLE_DEACTIVATION);
  }
  btSoftBody& body() { return owner->body(); }
  SurfacePoint vertex(int v) {
    Result<SurfacePoint> made = tree.pointAtVertex(body(), v);
    EXPECT_TRUE(made.ok()) << made.status().message;
    return made.value();
  }
  /// The lowest or highest vertex along an axis, at rest.
  int furthest(const Eigen::Vector3d& along) const {
    int best = 0;
    for (std::size_t v = 0; v < model.mesh.vertexCount(); ++v) {
      if (model.mesh.positions[v].dot(along) > model.mesh.positions[static_cast<std::size_t>(best)].dot(along)) {
        best = static_cast<int>(v);
      }
    }
    return best;
  }

  TouchModel model;
  std::unique_ptr<DeformableBody> owner;
  std::shared_ptr<const SoftBodyBinding> binding;
  SurfaceTree tree;
  SoftBodySkin skin;
};

/// The momentum of all nodes, angular momentum about the origin. Pinned nodes have none.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();

  explicit Momentum(const btSoftBody& body) {
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      const btSoftBody::Node& node = body.m_nodes[n];
      if (node.m_im == 0) continue;
      const Eigen::Vector3d value = toEigen(node.m_v) / static_cast<double>(node.m_im);
      linear += value;
      angular += toEigen(node.m_x).cross(value);
    }
  }
};

/// Displaces all nodes, so that no tet has its rest shape.
inline void deform(btSoftBody& body, double amount = 0.05) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const Eigen::Vector3d x = toEigen(body.m_nodes[n].m_x);
    const Eigen::Vector3d moved =
        x + amount * Eigen::Vector3d(std::sin(5 * x.y() + 1), std::sin(4 * x.z()), std::cos(6 * x.x() + x.y()));
    body.m_nodes[n].m_x = body.m_nodes[n].m_q = toBullet(moved);
  }
}

/// Makes one of Bullet's steps.
inline void substep(EmptyWorld& world, double dt = 1.0 / 240) {
  world.deformable().stepSimulation(static_cast<btScalar>(dt), 1, static_cast<btScalar>(dt));
}

/// A box in a world as long as this object lives.
struct RigidBox : Rigid {
  RigidBox(EmptyWorld& in, double mass, const btVector3& at, const btVector3& half = btVector3(0.1, 0.1, 0.1))
      : Rigid(in, std::make_unique<btBoxShape>(half), static_cast<btScalar>(mass), at) {}
};

inline bool isFinite(const btSoftBody& body) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (!toEigen(body.m_nodes[n].m_x).allFinite() || body.m_nodes[n].m_x.length() > 100) return false;
  }
  return true;
}

}  // namespace tetskin::test
