// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: which of a node's samples at a surface become contacts.
#pragma once

#include <tetskin/contact/src/soft/contact_body.h>

#include <vector>

namespace tetskin::contact_detail {

/// A sample of one body at the surface of another, or below it.
struct Touch {
  int sample = 0, run = 0;
  int tet = -1;              ///< of the other body
  btScalar weights[4] = {};  ///< in that tet
  btVector3 point{0, 0, 0};  ///< of the sample, world space
  btVector3 normal{0, 1, 0};
  btScalar distance = 0;  ///< world space; below 0: the depth
  bool pierces = false;   ///< deeper than a sample of a sliding surface can be, in this step or before
  int next = -1;          ///< next touch of the same node
  // The surface as a plane, when the touch was found; rest space of the other body.
  btVector3 restFound{0, 0, 0};  ///< position of the sample
  btVector3 restNormal{0, 1, 0};
  btScalar restDistance = 0;
};

/// A sample that has touched the other body in one of the last steps.
struct TouchedSample {
  int sample = 0;
  int age = 0;  ///< steps in which its node has touched with other samples since then
};

/// Finds the contacts of one pair of bodies in a step: for each node of the first body, the deepest of the samples in
/// which it has the largest weight, and the deepest of those that are pushed in another direction; beside each, others
/// that have touched in the last steps.
class NodeTouches {
 public:
  /// body     the samples', which must stay as it is until `remember`
  /// cube     of the other body's grid, in rest units
  /// touched  samples that have touched in the steps before, ascending; taken away
  /// touches  is cleared, and filled by `keep`
  void begin(const ContactBody& body, btScalar cube, std::vector<TouchedSample>& touched, std::vector<Touch>& touches);
  /// Number of steps, of those in which its node has touched, since the sample has touched; below 0: it has not.
  int ageOf(int sample) const;
  /// Keeps a sample's touch if it becomes a contact.
  void keep(const Touch& touch);
  /// Ends what `begin` has begun.
  /// touched  becomes the samples by which nodes have touched, in this step or before, ascending
  void remember(std::vector<TouchedSample>& touched);

 private:
  void keepBeside(const Touch& touch, int node);
  void replace(int index, const Touch& by);
  void add(const Touch& touch, int node);
  Touch& at(int index) { return (*touches_)[static_cast<std::size_t>(index)]; }
  btScalar rankOf(const Touch& touch) const;

  const ContactBody* body_ = nullptr;  ///< null: nothing has begun
  btScalar cube_ = 0;
  std::vector<TouchedSample> touched_;
  std::vector<Touch>* touches_ = nullptr;
  std::vector<int> touchOfNode_;  ///< the head of each node's list in `touches_`
  std::vector<int> sameWay_;      ///< in `touches_`: those of a node in one direction, the deepest first
};

}  // namespace tetskin::contact_detail
