// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: contacts among soft bodies, which DeformableSolver asks for in each step. What is in the
// world's list of forces, and is one of these, is asked.
#pragma once

#include <tetskin/bullet/src/shared/bodies/point_contacts.h>

class btSoftBody;

namespace tetskin {

/// A point of one soft body that is to stay outside of another, or of another part of its own. `object` is that body.
struct SoftPointContact : PointContact {
  btSoftBody* body = nullptr;               ///< awake
  std::array<int, 4> objectNodes{};         ///< of the tet that the point is in
  std::array<btScalar, 4> objectWeights{};  ///< sum 1
};

class ContactSource {
 public:
  virtual ~ContactSource() = default;

  /// Positions are those that the step begins with, velocities those that bodies would end it with alone. The contacts
  /// live until the next call; the solver writes their impulses.
  virtual std::vector<SoftPointContact>& find(btScalar seconds) = 0;
};

}  // namespace tetskin
