// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "stress/stress_case.h"

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

namespace tetskin::stress {

/// Largest side of the bar's cage: Bullet has absolute constants, as in the other scenes.
constexpr double kSize = 2.0;

/// What a case needs of geometry, all in rest space, near the origin.
struct StressModel {
  TetMesh cage;      ///< that the skin is bound to, whatever is wrong with it
  TetMesh bodyCage;  ///< the same nodes, without flat tets: that the body is made of
  TriangleMesh mesh;
  double size = kSize;                               ///< largest side of the cage
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< where in the world the body is put
};

StressModel makeModel(Cage cage, Surface surface);

}  // namespace tetskin::stress
