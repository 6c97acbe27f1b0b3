// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <functional>
#include <vector>

#include "scenes/table.h"

namespace tetskin::report {

/// How a render mesh is carried by a cage.
enum class SurfaceKind { Linear, Quadratic };
/// "linear", "quadratic".
const char* nameOf(SurfaceKind kind);
Interpolation interpolationOf(SurfaceKind kind);

/// Node positions by frame; the first frame is at rest.
using Trajectory = std::vector<std::vector<Eigen::Vector3f>>;

/// The cost of a surface. Times are processor times of one thread; medians over the frames.
struct SurfaceCost {
  double attachMs = 0.0;  ///< once
  double updateUs = 0.0;  ///< per frame
  std::size_t bytes = 0;  ///< 0 where the C library does not report it
};

/// Costs indexed by SurfaceKind.
using SurfaceCosts = std::array<SurfaceCost, 2>;

struct Simulation {
  Trajectory trajectory;
  double milliseconds = 0.0;  ///< of Bullet's step, per frame, without any surface
  std::size_t bytes = 0;      ///< of the body in its world
  SurfaceCosts surfaces;
  int modes = 0;                 ///< of a reduced body
  double projectionError = 0.0;  ///< largest projection error of these modes
  TriangleMesh obstacles;        ///< of the scene, in its world
  bool finite = true;            ///< finite and not exploded; the trajectory ends before the first frame that is not
};

/// Called after every frame.
using FrameDone = std::function<void()>;

/// Runs a scene with a cage.
/// kinds  the mesh is carried in these ways, to measure the cost of each; if empty, the mesh is not used
/// Throws InputError if cage or mesh cannot be used
Simulation simulate(const scenes::SceneEntry& entry, const Cage& cage, const scenes::SceneOptions& options,
                    const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds, const FrameDone& done);

/// The cost of surfaces on a body that is in no world.
SurfaceCosts surfaceCosts(const Cage& cage, const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds);

}  // namespace tetskin::report
