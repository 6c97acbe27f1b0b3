// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The smallest whole program: a tube of 20,000 vertices, pinned at one end, sags in a cage of 300 tets. No files.
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <cmath>
#include <cstdio>

/// A fine surface: 200 rings of 100 vertices, along x. Yours may come from tetskin::loadMesh.
tetskin::TriangleMesh makeTube() {
  tetskin::TriangleMesh tube;
  for (int ring = 0; ring < 200; ++ring) {
    const double x = 2.0 * ring / 199, radius = 0.2 + 0.03 * std::sin(40 * x);
    for (int k = 0; k < 100; ++k) {
      const double angle = 6.2831853 * k / 100;
      tube.positions.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
      if (ring == 0) continue;
      const int a = 100 * ring + k, b = 100 * ring + (k + 1) % 100;  // this ring, and the one before
      tube.triangles.push_back({a - 100, b - 100, b});
      tube.triangles.push_back({a - 100, b, a});
    }
  }
  return tube;
}

int main() {
  const tetskin::TriangleMesh surface = makeTube();
  tetskin::CageOptions cageOptions;
  cageOptions.targetTets = 300;
  const auto cage = tetskin::createCage(surface, cageOptions);
  if (!cage.ok()) return std::fprintf(stderr, "%s\n", cage.status().message.c_str()), 1;

  tetskin::DeformableWorld world;  // Bullet's deformable world, with its solver and all else that it needs
  tetskin::SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& rest) { return rest.x() < 0.1; };
  auto body = tetskin::DeformableBody::add(world, cage.value(), options);
  if (!body.ok()) return std::fprintf(stderr, "%s\n", body.status().message.c_str()), 1;

  tetskin::SoftBodySkin skin;
  const auto fit = skin.bind(body.value()->body(), cage.value(), surface);  // once, at rest
  if (!fit.ok()) return std::fprintf(stderr, "%s\n", fit.status().message.c_str()), 1;
  std::printf("%s\n", fit.value().describe().c_str());

  const btScalar dt = btScalar(1) / 60;
  for (int frame = 0; frame <= 60; ++frame) {
    if (frame % 10 == 0) std::printf("frame %2d: lowest point at y = %.3f\n", frame, skin.bounds().min().y());
    if (world.stepSimulation(dt, 4, dt / 4) == 0) continue;
    if (skin.update() == tetskin::StatusCode::NonFinite) return 1;  // after each step; then draw skin.positions()
  }
  return 0;
}
