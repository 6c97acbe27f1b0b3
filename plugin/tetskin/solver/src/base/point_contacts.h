// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: the contacts that a search passes to DeformableSolver.
#pragma once

#include <LinearMath/btVector3.h>
#include <tetskin/solver/src/base/carried_point.h>

#include <cstdint>
#include <vector>

namespace tetskin::bullet_detail {

/// A point of a soft body, and the object outside of which it must stay. World space.
struct PointContact {
  btSoftBody* body = nullptr;                 ///< the body of the point
  std::uint32_t point = 0;                    ///< number of the point, the same in each step
  std::uint32_t sample = 0;                   ///< tells apart the places that share this number
  CarriedPoint at;                            ///< the point
  const btCollisionObject* object = nullptr;  ///< rigid body, link or any other collision object; or a soft body
  CarriedPoint onObject;                      ///< the point in the object, if that is a soft body; otherwise unused
  btVector3 position;                         ///< at the beginning of the step
  btVector3 normal;                           ///< away from the object, of unit length
  btScalar distance = 0;   ///< along the normal, at the beginning of the step, minus the distance to be kept
  btScalar predicted = 0;  ///< the distance that the step would reach without contact; for rigid objects only
  btScalar friction = 0;   ///< coefficient of the pair
  /// The impulse of the object on the soft body in the step: force times seconds. The solver writes it.
  btVector3 impulse{0, 0, 0};
};

/// All contacts of a body in one step.
using PointContacts = std::vector<PointContact>;

}  // namespace tetskin::bullet_detail
