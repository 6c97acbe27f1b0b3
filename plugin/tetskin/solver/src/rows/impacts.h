// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: impacts that are going on, and what is given back when they are over.
//
// A point that meets an obstacle is stopped within a step, inelastically. In a fine mesh and small steps, each of these
// stops takes little, and an elastic body gives back nearly all of its energy. In a step of a game they take a third of
// that of a soft ball, and all of that of a stiff one. What they take is known: by row and step, L is
//   -impulse * (velocity of approach before + after) / 2
// When an impact is over, the pair gets a part of L back, as two rigid bodies, at the mean place and along the mean
// direction of the pushes. With E the energy of the approach, and E' of that with which they part, the part is
//   (k^(1/4) E' + k L) / E
// E' / E is what the pair gives back without: vibrations, friction and damping keep their share of L, too. k is the
// share that the material's damping leaves in an impact, estimated, for what the steps do not resolve (L near E), where
// the part is 0.9 at most. The fast vibrations that stops make are damped more than the whole, hence the root. Undamped
// balls and cubes rise in 4 substeps as in 64, to within a fifth of the height (`tetskin_measure --only bounce`).
//
// Restitution, of what is not elastic, is Bullet's: the product e of both objects' `getRestitution()`. The pair parts
// with no less than e^2 E, as far as their vibrations have not taken it.
#pragma once

#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/rows/impact_side.h>

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tetskin::bullet_detail {

/// The change of velocity in a step from which on contacts count as an impact: twice what a body at rest takes.
/// gravity, size  of the body
btScalar leastImpact(const btVector3& gravity, btScalar size, btScalar seconds);

/// A component of a soft body, and what it meets: any object, of a soft body a component.
struct ImpactPair {
  const btCollisionObject* body = nullptr;
  const btCollisionObject* object = nullptr;
  std::uint64_t component = 0, otherComponent = 0;

  bool operator==(const ImpactPair& other) const {
    return body == other.body && object == other.object && component == other.component &&
           otherComponent == other.otherComponent;
  }
};

struct Impact {
  ImpactPair pair;
  std::array<SideMotion, 2> before;  ///< of both, when it began
  btVector3 fallen{0, 0, 0};         ///< velocity that gravity has added in its first step, of one side alone
  btVector3 push{0, 0, 0};           ///< sum of the normal impulses on the first one
  btVector3 arm{0, 0, 0};            ///< sum of their places beside its centre, by impulse
  btScalar weight = 0;               ///< sum of the impulses' sizes
  double lost = 0.0;                 ///< L, in joules
  double vibrations = 0.0;           ///< energy of both bodies' deformation and vibration when it began, in joules
  int quiet = 0;                     ///< steps since it was last felt
};

/// What an impact gives back: the pair parts faster by `speed`. It acts from the beginning of the next step on, so that
/// what else touches the two resists it.
struct DueImpulse {
  ImpactPair pair;
  btVector3 at{0, 0, 0}, along{0, 0, 0};  ///< place and direction of the impulse on the first one, world space
  btScalar speed = 0;
  /// The relative velocity with which they came: they part with no more energy than that, including their vibrations.
  btVector3 came{0, 0, 0};
  double vibrations = 0.0;  ///< what they had of these when they came, in joules
};

/// An impulse that a step has begun with, on the first one of the pair; the other one gets the opposite.
struct GivenImpulse {
  ImpactPair pair;
  btVector3 at{0, 0, 0}, impulse{0, 0, 0};
};

/// Sums of the normal impulses of a step's contacts.
struct PushSums {
  std::vector<btVector3> ofPairs;  ///< by impact, on the first one of its pair
  /// By component of a soft body, from everything.
  std::map<std::pair<const btCollisionObject*, std::uint64_t>, btVector3> ofComponents;

  btVector3& on(const btCollisionObject* body, std::uint64_t component) {
    return ofComponents.try_emplace({body, component}, btVector3(0, 0, 0)).first->second;
  }
  btVector3 of(const btCollisionObject* body, std::uint64_t component) const {
    const auto found = ofComponents.find({body, component});
    return found == ofComponents.end() ? btVector3(0, 0, 0) : found->second;
  }
};

class Impacts {
 public:
  /// At the beginning of a step, when velocities are known: gives back what is due.
  void giveBack(SolverBodies& bodies, RigidUnknowns& rigids);
  /// Before a step's solve, when its rows are known: finds those that begin.
  void begin(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds);
  /// When velocities are solved: adds what the step has taken, and finds what is due where an impact is over.
  void finish(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds);
  /// Those of this step.
  const std::vector<GivenImpulse>& given() const { return given_; }
  /// Whether some impact of the body goes on.
  bool includes(const btSoftBody& body) const;

  void forget(const btCollisionObject& gone);
  void shift(const btVector3& by);
  void serialize(WorldStream& stream);

 private:
  Impact* find(const ImpactPair& pair);
  /// Adds the step's pushes, and what they have taken, to the impacts.
  PushSums addPushes(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids);

  std::vector<Impact> list_;  ///< in the order in which they began
  std::vector<DueImpulse> due_;
  std::vector<GivenImpulse> given_;
};

}  // namespace tetskin::bullet_detail
