// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <vector>

namespace tetskin::bench {

/// What the tutorial writes by hand, measured beside Bullet's worlds: constraints on edge lengths and tet volumes, a
/// floor at y = 0, and nothing else. Plain C++, one thread, float.
///
/// This work is based on:
///   Miles Macklin et al., "Small Steps in Physics Simulation", SCA 2019, doi 10.1145/3309486.3340247
///   Matthias Müller, "Simple and unbreakable simulation of soft bodies", Ten Minute Physics 10, 2022
class Xpbd {
 public:
  /// cage  all tets positive; the body has a mass of 1 kg
  explicit Xpbd(const TetMesh& cage);

  void step(float seconds, int substeps);
  /// Heights of the lowest and the highest node, world space.
  std::array<float, 2> heights() const;

 private:
  struct Point {
    float x, y, z, inverseMass;
  };
  struct Edge {
    int a, b;
    float length;
  };
  struct Volume {
    std::array<int, 4> nodes;
    float volume;
  };

  void predict(float dt);
  void solveEdges(float dt);
  void solveVolumes(float dt);

  std::vector<Point> points_, before_, velocities_;
  std::vector<Edge> edges_;
  std::vector<Volume> volumes_;
};

}  // namespace tetskin::bench
