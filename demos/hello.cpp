// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The smallest whole program: a bar of 192 tets, held at one end, carries a surface of 20,000 vertices. No files.
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletCollisionCommon.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/deformable_solver.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <cmath>
#include <cstdio>

/// A coarse bar: 8 x 2 x 2 cubes of edge 0.25, six tets each. Yours may come from a file, or from tetskin::buildCage.
tetskin::TetMesh makeBar() {
  tetskin::TetMesh bar;
  const auto node = [](int x, int y, int z) { return x + 9 * (y + 3 * z); };
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 9; ++x) bar.nodes.emplace_back(0.25 * x, 0.25 * y, 0.25 * z);
    }
  }
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int cube = 0; cube < 8 * 2 * 2; ++cube) {
    for (const auto& order : orders) {  // from one corner of the cube to the opposite one, along three edges
      int p[3] = {cube % 8, cube / 8 % 2, cube / 16};
      tetskin::Tet tet{node(p[0], p[1], p[2])};
      for (int k = 0; k < 3; ++k) {
        ++p[order[k]];
        tet[k + 1] = node(p[0], p[1], p[2]);
      }
      bar.tets.push_back(tet);
    }
  }
  (void)tetskin::repairTetMesh(bar);  // every other tet came out inside out
  return bar;
}

/// A fine surface inside the bar: 200 rings of 100 vertices. Yours may come from tetskin::loadMesh.
tetskin::TriangleMesh makeTube() {
  tetskin::TriangleMesh tube;
  for (int ring = 0; ring < 200; ++ring) {
    const double x = 2.0 * ring / 199, radius = 0.2 + 0.03 * std::sin(40 * x);
    for (int k = 0; k < 100; ++k) {
      const double angle = 6.2831853 * k / 100;
      tube.positions.emplace_back(x, 0.25 + radius * std::cos(angle), 0.25 + radius * std::sin(angle));
    }
  }
  return tube;
}

int main() {
  btSoftBodyRigidBodyCollisionConfiguration configuration;  // Bullet's usual five objects
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  tetskin::DeformableSolver bodySolver;  // instead of a btDeformableBodySolver
  btDeformableMultiBodyConstraintSolver solver;
  solver.setDeformableSolver(&bodySolver);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration, &bodySolver);
  world.setGravity(btVector3(0, -9.81f, 0));
  const tetskin::TetMesh cage = makeBar();
  const tetskin::TriangleMesh surface = makeTube();
  tetskin::SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& rest) { return rest.x() < 0.01; };
  auto body = tetskin::DeformableBody::add(world, cage, options);
  if (!body.ok()) return std::fprintf(stderr, "%s\n", body.status().message.c_str()), 1;

  tetskin::SoftBodySkin skin;
  const auto fit = skin.bind(body.value()->body(), cage, surface);  // once, at rest
  if (!fit.ok()) return std::fprintf(stderr, "%s\n", fit.status().message.c_str()), 1;
  std::printf("%s\n", fit.value().describe().c_str());

  const btScalar dt = btScalar(1) / 60;
  for (int frame = 0; frame <= 60; ++frame) {
    if (frame % 10 == 0) std::printf("frame %2d: lowest point at y = %.3f\n", frame, skin.bounds().min().y());
    if (world.stepSimulation(dt, 4, dt / 4) == 0) continue;
    if (skin.update() == tetskin::UpdateStatus::NonFinite) return 1;  // after each step; then draw skin.positions()
  }
  return 0;
}
