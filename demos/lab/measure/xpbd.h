// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <vector>

namespace tetskin::measure {

/// The body that XPBD simulates. All compliances are inverse stiffnesses; 0 is rigid.
struct XpbdBody {
  struct Edge {
    int a, b;
    double compliance;  ///< metres per newton
  };
  struct Volume {
    std::array<int, 4> nodes;
    double compliance;  ///< cubic metres per pascal
  };

  std::vector<Eigen::Vector3d> nodes;  ///< at rest
  std::vector<double> inverseMasses;   ///< per node; 0: pinned
  std::vector<Edge> edges;
  std::vector<Volume> volumes;  ///< positive tets
  double damping = 0.0;         ///< seconds, for compliant constraints: damping force over rate of elastic force
  double gravity = 9.81;        ///< downwards
  bool floor = false;           ///< at y = 0
};

/// The solver that the tutorials write by hand, for comparison with Bullet's worlds: constraints on edge lengths and
/// tet volumes, each solved once per substep, in turn; a floor, and nothing else. Plain C++, one thread, float.
///
/// This work is based on:
///   Miles Macklin et al., "XPBD: Position-Based Simulation of Compliant Constrained Dynamics", MIG 2016 (damping)
///   Miles Macklin et al., "Small Steps in Physics Simulation", SCA 2019, doi 10.1145/3309486.3340247
///   Matthias Müller, "Simple and unbreakable simulation of soft bodies", Ten Minute Physics 10, 2022
class Xpbd {
 public:
  explicit Xpbd(const XpbdBody& body);

  void step(float seconds, int substeps);
  /// Present positions, world space.
  std::vector<Eigen::Vector3f> nodes() const;

 private:
  struct Point {
    float x, y, z, inverseMass;
  };
  struct Edge {
    int a, b;
    float length, compliance;
  };
  struct Volume {
    std::array<int, 4> nodes;
    float volume, compliance;
  };

  void predict(float dt);
  void solveEdges(float dt);
  void solveVolumes(float dt);
  float damping(float compliance, float dt) const { return compliance > 0.0f ? damping_ / dt : 0.0f; }

  float damping_, gravity_;
  bool floor_;
  std::vector<Point> points_, before_, velocities_;
  std::vector<Edge> edges_;
  std::vector<Volume> volumes_;
};

}  // namespace tetskin::measure
