// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

#include "scenes/placement.h"
#include "stress/stress_case.h"

namespace tetskin::stress {

/// The geometry of a case, all in rest space, near the origin.
struct StressModel {
  tetskin::Cage cage;      ///< the cage that the skin is bound to, whatever is wrong with it
  tetskin::Cage bodyCage;  ///< the same nodes, without flat tets: the cage from which the body is made
  TriangleMesh mesh;
  double size = scenes::kSize;                       ///< largest side of the cage
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< position of the body in the world
};

StressModel makeModel(Cage cage, Surface surface);

}  // namespace tetskin::stress
