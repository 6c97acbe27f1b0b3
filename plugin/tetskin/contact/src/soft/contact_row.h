// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: a contact of this step, between four nodes and four others.
#pragma once

#include <tetskin/contact/src/soft/pair_search.h>

#include <memory>
#include <utility>
#include <vector>

namespace tetskin::contact_detail {

using VectorArray = btAlignedObjectArray<btVector3>;
using BodyList = std::vector<std::unique_ptr<ContactBody>>;

/// The nodes of one side, and how much of the contact each has.
struct ContactNodes {
  ContactBody* of = nullptr;
  int nodes[4] = {};
  btScalar weights[4] = {};  ///< below 0 on the side that is pushed
  /// In Bullet's vectors; below 0 for nodes that nothing moves.
  int numbers[4] = {};

  /// nodeWeights  of the four nodes, by which the contact acts
  void take(ContactBody& body, const Tet& tet, const btScalar* nodeWeights, btScalar sign);
  /// Sum of weights squared over masses.
  btScalar inverseMass() const;
};

/// How a contact behaves along the surface.
enum class Sliding { No, Yes };

/// What a contact of the step before leaves: by which node of which bodies.
struct ContactMemory {
  int first = 0, second = 0;  ///< ContactBody::id
  int node = 0;
  btVector3 normal{0, 1, 0};
  btScalar impulse = 0;
  btVector3 friction{0, 0, 0};
  Sliding sliding = Sliding::No;
};

struct ContactRow {
  ContactNodes sides[2];
  int node = 0;  ///< of the first, that it counts for
  btVector3 point{0, 0, 0}, normal{0, 1, 0};
  btScalar distance = 0;
  btScalar inverseMass = 0;  ///< along any direction
  btScalar roughness = 0;    ///< Coulomb's coefficient
  btScalar target = 0;       ///< least relative velocity along the normal
  btScalar impulse = 0;      ///< along the normal, of the first body; 0: nothing touches
  btVector3 friction{0, 0, 0};
  Sliding sliding = Sliding::No;

  /// Relative velocity of what `velocityOf` tells of a side's nodes, by place in the side.
  template <class VelocityOf>
  btVector3 relative(VelocityOf&& velocityOf) const {
    btVector3 v(0, 0, 0);
    for (const ContactNodes& side : sides) {
      for (int k = 0; k < 4; ++k) v += side.weights[k] * velocityOf(side, k);
    }
    return v;
  }
  /// In Bullet's numbers.
  btVector3 relativeOf(const VectorArray& velocities) const;
  btVector3 relativeNow() const;
  void addTo(VectorArray& forces, const btVector3& impulseOnFirst) const;

  bool live() const { return impulse > 0; }
  /// What of a relative velocity the contact withstands in this step: all if it sticks.
  btVector3 held(const btVector3& relativeVelocity) const {
    return sliding == Sliding::No ? relativeVelocity : relativeVelocity.dot(normal) * normal;
  }
};

}  // namespace tetskin::contact_detail
