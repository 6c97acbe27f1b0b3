// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: by which side of a body's surface a sample has come, so that it goes back that way even
// from beyond the middle of a thin part, where the nearest surface is another one.
#pragma once

#include <tetskin/contact/src/soft/distance_grid.h>

#include <cstddef>
#include <vector>

namespace tetskin::contact_detail {

/// The plane of the surface that a sample is in front of, or has come through: rest space of the body that it is in.
struct ContactSide {
  int sample = 0;
  btVector3 point{0, 0, 0};   ///< of the surface
  btVector3 normal{0, 1, 0};  ///< of unit length, outwards
};

/// Of the samples of one body in another. Where that folds, a sample may be in several parts of it, each with a side.
class ContactSides {
 public:
  void beginStep();
  /// Of the step before: the sample's side nearest to a point, but none as far as `within`; or null. Samples are asked
  /// for in ascending order.
  const ContactSide* find(int sample, const btVector3& rest, btScalar within);
  void keep(const ContactSide& side) { now_.push_back(side); }
  void clear();

 private:
  std::vector<ContactSide> before_, now_;
  std::size_t next_ = 0;
};

/// How a sample is to the surface: the plane that it is pushed out by.
struct SideDistance {
  btScalar distance = 0;  ///< below 0 inside
  ContactSide side;
};

/// grid    of the body that the sample is in
/// rest    where the sample is in that one's rest space; `nearest` is what the grid tells there
/// motion  by which it has come there in a step, likewise
/// before  its side in the step before, or null
/// False if the surface cannot be told there.
bool findSide(const DistanceGrid& grid, const btVector3& rest, const GridDistance& nearest, const btVector3& motion,
              const ContactSide* before, SideDistance& result);

}  // namespace tetskin::contact_detail
