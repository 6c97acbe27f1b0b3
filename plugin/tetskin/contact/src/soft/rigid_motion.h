// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: the rigid motion of a part of a body, against which two bodies are measured. It changes no
// distance: two points approach each other by at most the sum of their deviations from it.
#pragma once

#include <LinearMath/btMatrix3x3.h>

#include <cassert>
#include <vector>

namespace tetskin::contact_detail {

class RigidMotion {
 public:
  /// A translation.
  explicit RigidMotion(const btVector3& shift) : from_(0, 0, 0), to_(shift) {}
  /// The best fit, up to terms of second order in the angle.
  /// nodes     not empty
  /// from, to  btVector3(std::size_t node): positions before and after
  template <class From, class To>
  RigidMotion(const std::vector<int>& nodes, const From& from, const To& to);

  btVector3 operator()(const btVector3& p) const { return turns_ ? to_ + rotation_ * (p - from_) : to_ + (p - from_); }

 private:
  void turn(const btVector3& moment, const btMatrix3x3& inertia);

  btVector3 from_, to_;  ///< the centre before and after
  btMatrix3x3 rotation_ = btMatrix3x3::getIdentity();
  bool turns_ = false;
};

template <class From, class To>
RigidMotion::RigidMotion(const std::vector<int>& nodes, const From& from, const To& to) : from_(0, 0, 0), to_(0, 0, 0) {
  assert(!nodes.empty());
  for (const int n : nodes) {
    from_ += from(static_cast<std::size_t>(n));
    to_ += to(static_cast<std::size_t>(n));
  }
  const btScalar share = 1 / static_cast<btScalar>(nodes.size());
  from_ *= share;
  to_ *= share;
  btVector3 moment(0, 0, 0), squares(0, 0, 0), products(0, 0, 0);
  for (const int n : nodes) {
    const btVector3 r = from(static_cast<std::size_t>(n)) - from_, s = to(static_cast<std::size_t>(n)) - to_;
    moment += r.cross(s);
    squares += r * r;
    products += btVector3(r.y() * r.z(), r.z() * r.x(), r.x() * r.y());
  }
  turn(moment,
       btMatrix3x3(squares.y() + squares.z(), -products.z(), -products.y(), -products.z(), squares.z() + squares.x(),
                   -products.x(), -products.y(), -products.x(), squares.x() + squares.y()));
}

}  // namespace tetskin::contact_detail
