// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the scenes of the report are, without saying with which cage.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <functional>
#include <optional>
#include <string>

#include "scenes/twist.h"

namespace tetskin::report {

enum class SceneKind {
  Sag,    ///< held at its lower end, under gravity
  Twist,  ///< held at its lower and its upper end, which is turned, without gravity
  Drop,   ///< falls on a box
  Exact,  ///< a control without Bullet: the cage's nodes follow a smooth map
};

/// "sag", "twist", "drop", "exact".
std::string nameOf(SceneKind kind);

/// Largest side of a mesh in Bullet's world, which has absolute constants. All lengths of the report are of this space.
constexpr double kSize = 2.0;
constexpr double kFrameRate = 60.0;

/// The mesh scaled to kSize, centred at the origin.
TriangleMesh placed(TriangleMesh mesh);

/// One body, one scene. It depends on the mesh alone, so that it is the same for every cage.
struct SceneSetup {
  SceneKind kind = SceneKind::Sag;
  int frames = 60;       ///< simulated after frame 0, at rest
  double gravity = 0.0;  ///< downwards
  /// Nodes that Bullet does not move, by their rest position; empty: none.
  std::function<bool(const Eigen::Vector3d&)> held;
  std::optional<scenes::Twist> twist;  ///< takes the held nodes along, see `turnAt`
  double floorY = 0.0;                 ///< upper side of the box
  bool floor = false;

  /// The twist of a frame, which may be a fraction.
  double turnAt(double frame) const;
};

/// mesh  as `placed`; frames: 0 for the scene's own number
SceneSetup setupOf(SceneKind kind, const TriangleMesh& mesh, int frames = 0);

}  // namespace tetskin::report
