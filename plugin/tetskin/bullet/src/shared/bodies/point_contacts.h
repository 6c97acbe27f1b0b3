// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: what a search for contacts hands to DeformableSolver.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <LinearMath/btVector3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetskin {

/// The corners of a triangle may each be in a tet of its own.
constexpr std::size_t kMaxPointNodes = 12;

/// A point that nodes of a soft body carry, and the object that it is to stay outside of. World space.
struct PointContact {
  std::uint32_t point = 0;                         ///< its number, the same in each step
  const btCollisionObject* object = nullptr;       ///< rigid body, link, or whatever else Bullet moves or not
  std::uint32_t nodeCount = 0;                     ///<
  std::array<int, kMaxPointNodes> nodes{};         ///< of the body
  std::array<btScalar, kMaxPointNodes> weights{};  ///< sum 1; some may be below 0
  btVector3 position;                              ///< when the step begins
  btVector3 normal;                                ///< away from the object, of unit length
  btScalar distance = 0;                           ///< along the normal, when the step begins, less what is to be kept
  btScalar friction = 0;                           ///< of the pair
  /// Of the object on the soft body in the step: force times seconds. Written by the solver.
  btVector3 impulse{0, 0, 0};
};

/// All of a body in one step.
using PointContacts = std::vector<PointContact>;

}  // namespace tetskin
