// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the side of a body's surface through which a sample has entered. The sample is pushed back
// through that side, even from beyond the middle of a thin part, where another side is nearer.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/contact/src/soft/distance_grid.h>

#include <cassert>
#include <cstddef>
#include <vector>

namespace tetskin::contact_detail {

/// The plane of the surface that a sample is in front of, or has entered through, in the rest space of the body it is
/// in.
struct ContactSide {
  int sample = 0;
  btVector3 point{0, 0, 0};   ///< a point of the surface
  btVector3 normal{0, 1, 0};  ///< of unit length, outwards
};

/// The sides of the samples of one body in another. Where that body folds, a sample may be in several places of it,
/// each with its own side.
class ContactSides {
 public:
  void beginStep();
  /// The sample's side from the last step that is nearest to a point, and nearer than `within`; or null. Samples must
  /// be asked for in ascending order.
  const ContactSide* find(int sample, const btVector3& rest, btScalar within);
  void keep(const ContactSide& side) {
    assert(now_.empty() || now_.back().sample <= side.sample);
    now_.push_back(side);
  }
  void clear();
  void serialize(bullet_detail::WorldStream& stream);

 private:
  std::vector<ContactSide> before_, now_;
  std::size_t next_ = 0;
};

/// The position of a sample relative to the surface: the plane out of which it is pushed.
struct SideDistance {
  btScalar distance = 0;  ///< below 0 inside
  ContactSide side;
};

/// True if the side depends on the sample's motion: it is already deep when it is first seen.
bool asksForMotion(const DistanceGrid& grid, const GridDistance& nearest, const ContactSide* before);

/// Finds the side of a sample. Returns false if the surface cannot be determined there.
/// grid    of the body that the sample is in
/// rest    position of the sample in that body's rest space; `nearest` is the grid's result there
/// motion  the sample's motion in a step, in that rest space; used if `asksForMotion` is true
/// before  the sample's side in the last step, or null
bool findSide(const DistanceGrid& grid, const btVector3& rest, const GridDistance& nearest, const btVector3& motion,
              const ContactSide* before, SideDistance& result);

}  // namespace tetskin::contact_detail
