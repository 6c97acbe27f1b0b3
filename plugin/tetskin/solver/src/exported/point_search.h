// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For other libraries: contact of a body's surface points with rigid objects, in place of contact at its nodes.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/solver/src/base/contact_patches.h>

#include <memory>

namespace tetskin::bullet_detail {

class BodyContacts;

/// Distances of a search, world lengths.
struct SearchDistances {
  btScalar margin = 0;       ///< kept between the points and rigid objects
  btScalar slack = 0;        ///< range beyond the margin within which clearances are computed and kept
  btScalar thickness = 0;    ///< depth up to which a point behind a mesh's surface still belongs to it
  btScalar beyondNodes = 0;  ///< how far points may be outside of the nodes' box
};

/// Finds the contacts of these points from the next step on, as long as it exists. It, the body and the world may be
/// destroyed in any order.
class TETSKIN_SOLVER_API PointSearch {
 public:
  /// world  with a btCollisionDispatcher
  PointSearch(btDeformableMultiBodyDynamicsWorld& world, BodyWithTrees& body, ContactPatches patches,
              const SearchDistances& distances);
  ~PointSearch();
  PointSearch(const PointSearch&) = delete;
  PointSearch& operator=(const PointSearch&) = delete;

  /// True if there is one for the body.
  static bool exists(const btSoftBody& body);
  /// All contacts of the body in the last step; null if the body has been destroyed.
  const PointContacts* contacts() const;
  const ContactPatches& patches() const;

 private:
  std::shared_ptr<BodyContacts> contacts_;
  btScalar marginBefore_;
};

}  // namespace tetskin::bullet_detail
