// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: in which direction a sample at a surface is pushed, and whether it is a contact at all.
#pragma once

#include <tetskin/contact/src/soft/node_touches.h>

namespace tetskin::contact_detail {

/// A pair of bodies, as the choice of a normal asks for it.
struct PairDirection {
  btVector3 apart{0, 0, 0};  ///< direction in which the first is to leave the second, where it is deep in it; or 0
  btScalar deep = 0;         ///< depth from which on it applies; world space
  btScalar cube = 0;         ///< of the second body's grid, in rest units
};

/// The surface of the first body at one of its samples.
struct SampleSurface {
  btVector3 normal{0, 0, 0};  ///< of unit length, world space; 0: it is not known
  bool onFace = false;        ///< not on an edge or a corner
  bool touched = false;       ///< it has touched in the last steps
  bool pierced = false;       ///< it pierced in the last step: see Touch
};

/// True if the normals of two surfaces are so near to each other that the surfaces do not face each other.
bool agree(const btVector3& first, const btVector3& second);

/// Determines the direction in which the contact pushes, and whether the sample pierces; returns false if it is no
/// contact.
/// touch  with the nearest direction and distance; both are replaced by those that apply
bool chooseNormal(const PairDirection& pair, const SampleSurface& sample, Touch& touch);

}  // namespace tetskin::contact_detail
