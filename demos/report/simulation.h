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

/// A render mesh on a cage, by one of three ways.
enum class SurfaceKind {
  Linear,
  Quadratic,
  Bullet,  ///< Bullet's own render nodes, which it updates in every substep
};
constexpr std::array<SurfaceKind, 3> kSurfaceKinds = {SurfaceKind::Linear, SurfaceKind::Quadratic, SurfaceKind::Bullet};
/// "linear", "quadratic", "bullet".
const char* nameOf(SurfaceKind kind);
/// Of our own kinds.
Interpolation interpolationOf(SurfaceKind kind);

/// Node positions by frame, of which the first is at rest.
using Trajectory = std::vector<std::vector<Eigen::Vector3f>>;

/// What a surface costs. Times are of the processor, in one thread; medians over the frames.
struct SurfaceCost {
  double attachMs = 0.0;  ///< once
  double updateUs = 0.0;  ///< a frame
  std::size_t bytes = 0;  ///< 0 where the C library does not tell
};

/// By SurfaceKind.
using SurfaceCosts = std::array<SurfaceCost, kSurfaceKinds.size()>;

struct Simulation {
  Trajectory trajectory;
  double milliseconds = 0.0;  ///< a frame of Bullet's step, without any surface
  std::size_t bytes = 0;      ///< of the body in its world
  SurfaceCosts surfaces;
  int modes = 0;                 ///< of a reduced body
  double projectionError = 0.0;  ///< of these, the largest
  TriangleMesh obstacles;        ///< of the scene, in its world
  bool finite = true;            ///< and not exploded; the trajectory ends before the first frame that is not
};

/// Told of every frame that is done.
using FrameDone = std::function<void()>;

/// Runs a scene with a cage.
/// kinds  the mesh is carried in these ways, to see what each costs; with none it is not looked at
/// Throws InputError if cage or mesh cannot be used
Simulation simulate(const scenes::SceneEntry& entry, const Cage& cage, const scenes::SceneOptions& options,
                    const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds, const FrameDone& done);

/// What surfaces cost on a body that is in no world.
SurfaceCosts surfaceCosts(const Cage& cage, const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds);

}  // namespace tetskin::report
