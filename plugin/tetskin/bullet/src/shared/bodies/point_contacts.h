// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: the contacts that a search passes to DeformableSolver.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <LinearMath/btVector3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin {

/// The corners of a triangle may be in three different tets.
constexpr std::size_t kMaxPointNodes = 12;

/// A point that nodes of a soft body carry, and the object outside of which it must stay. World space.
struct PointContact {
  std::uint32_t point = 0;                         ///< number of the point, the same in each step
  const btCollisionObject* object = nullptr;       ///< rigid body, link or any other collision object
  std::uint32_t nodeCount = 0;                     ///< number of entries in use of the next two
  std::array<int, kMaxPointNodes> nodes{};         ///< nodes of the body
  std::array<btScalar, kMaxPointNodes> weights{};  ///< sum 1; some may be below 0
  btVector3 position;                              ///< when the step begins
  btVector3 normal;                                ///< away from the object, of unit length
  btScalar distance = 0;  ///< along the normal, when the step begins, minus the distance to be kept
  btScalar friction = 0;  ///< coefficient of the pair
  /// The impulse of the object on the soft body in the step: force times seconds. Written by the solver.
  btVector3 impulse{0, 0, 0};
};

/// All contacts of a body in one step.
using PointContacts = std::vector<PointContact>;

}  // namespace tetskin
