// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <array>

namespace tetskin::test {

/// A box that starts at the origin, made of cubes of five tets each; every other cube is mirrored. Along a side with an
/// even number of cubes, it is the same in both directions.
inline TetMesh makeBox(const std::array<int, 3>& cubes, const Eigen::Vector3d& size) {
  TetMesh box;
  const auto node = [&](int x, int y, int z) { return x + (cubes[0] + 1) * (y + (cubes[1] + 1) * z); };
  for (int z = 0; z <= cubes[2]; ++z) {
    for (int y = 0; y <= cubes[1]; ++y) {
      for (int x = 0; x <= cubes[0]; ++x) {
        box.nodes.emplace_back(size.x() * x / cubes[0], size.y() * y / cubes[1], size.z() * z / cubes[2]);
      }
    }
  }
  constexpr int kEven[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};
  for (int z = 0; z < cubes[2]; ++z) {
    for (int y = 0; y < cubes[1]; ++y) {
      for (int x = 0; x < cubes[0]; ++x) {
        const int mirror = (x + y + z) % 2;  // mirrors the corners along x
        for (const auto& corners : kEven) {
          Tet tet;
          for (int k = 0; k < 4; ++k) {
            const int c = corners[k] ^ mirror;
            tet[k] = node(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          }
          box.tets.push_back(tet);
        }
      }
    }
  }
  (void)repairTetMesh(box);
  return box;
}

}  // namespace tetskin::test
