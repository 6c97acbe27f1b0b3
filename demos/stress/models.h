// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/triangle_mesh.h>

#include "scenes/placement.h"
#include "stress/stress_case.h"

namespace tetskin::stress {

/// What a case needs of geometry, all in rest space, near the origin.
struct StressModel {
  tetskin::Cage cage;      ///< that the skin is bound to, whatever is wrong with it
  tetskin::Cage bodyCage;  ///< the same nodes, without flat tets: that the body is made of
  TriangleMesh mesh;
  double size = scenes::kSize;                       ///< largest side of the cage
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< where in the world the body is put
};

StressModel makeModel(Cage cage, Surface surface);

}  // namespace tetskin::stress
