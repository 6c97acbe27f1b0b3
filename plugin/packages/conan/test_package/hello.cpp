// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Links every part of the package, and steps a body once.
#include <tetskin/cage/create_cage.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/tetskin.h>

#include <cstdio>

int main() {
  tetskin::TriangleMesh box;
  for (int corner = 0; corner < 8; ++corner) box.positions.emplace_back(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto cage = tetskin::createCage(box);
  if (!cage.ok()) return std::fprintf(stderr, "%s\n", cage.status().message.c_str()), 1;
  tetskin::DeformableWorld world;
  const auto body = tetskin::DeformableBody::add(world, cage.value());
  if (!body.ok()) return std::fprintf(stderr, "%s\n", body.status().message.c_str()), 1;
  world.stepSimulation(btScalar(1) / 60);
  std::printf("tetskin %s, a body of %d tets\n", TETSKIN_VERSION, body.value()->body().m_tetras.size());
  return 0;
}
