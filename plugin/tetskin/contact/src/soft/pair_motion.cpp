// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_motion.h>
#include <tetskin/contact/src/soft/rigid_motion.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin::contact_detail {
namespace {

/// The nodes of a body in a box. If there are none: all, since large tets may reach into the box.
void listNodesIn(const ContactBox& box, const ContactBody& body, std::vector<int>& nodes) {
  nodes.clear();
  for (std::size_t n = 0; n < body.positions.size(); ++n) {
    const btVector3& p = body.positions[n];
    const bool in = p.x() >= box.low[0] && p.y() >= box.low[1] && p.z() >= box.low[2] && p.x() <= box.high[0] &&
                    p.y() <= box.high[1] && p.z() <= box.high[2];
    if (in) nodes.push_back(static_cast<int>(n));
  }
  if (!nodes.empty()) return;
  nodes.resize(body.positions.size());
  std::iota(nodes.begin(), nodes.end(), 0);
}

}  // namespace

bool PairMotion::isStill(const ContactBody& first, const ContactBody& second, btScalar dt, btScalar maximum) {
  assert(dt > 0 && !(maximum < 0) && first.reads > 0 && second.reads > 0);
  const bool follows = first.reads == reads_[0] + 1 && second.reads == reads_[1] + 1;
  if (first.reads == reads_[0] && second.reads == reads_[1]) return false;
  reads_[0] = first.reads;
  reads_[1] = second.reads;
  for (std::vector<int>& nodes : near_) nodes.clear();
  coming_ = 0;
  searched_ = searched_ && follows;
  if (!searched_) return false;
  const btScalar motion = sinceBefore(first, second);
  path_ += motion;
  // A pair that moves this fast is also searched in the next step.
  if (motion > maximum) return false;
  coming_ = inNextStep(first, second, dt);
  return path_ + std::max(coming_ - searchedComing_, btScalar(0)) <= maximum;
}

void PairMotion::markSearched() {
  searched_ = true;
  path_ = 0;
  searchedComing_ = coming_;
}

btScalar PairMotion::sinceBefore(const ContactBody& first, const ContactBody& second) {
  const btScalar all = first.data().largestSpread * first.moved + second.moved;
  if (all <= kStillCubes * second.data().grid.spacing()) return all;
  const auto before = [](const ContactBody& body, std::size_t n) { return body.before[n]; };
  const auto now = [](const ContactBody& body, std::size_t n) { return body.positions[n]; };
  return measure(first, second, before, now);
}

/// Samples already touch what they will reach in the coming step, up to `kReachCubes`.
btScalar PairMotion::inNextStep(const ContactBody& first, const ContactBody& second, btScalar dt) {
  const btScalar cube = second.data().grid.spacing();
  const btScalar all = dt * (first.data().largestSpread * first.fastest + second.fastest);
  if (all <= kStillCubes * cube) return all;
  const auto now = [](const ContactBody& body, std::size_t n) { return body.positions[n]; };
  const auto next = [dt](const ContactBody& body, std::size_t n) {
    return body.positions[n] + dt * body.velocities[n];
  };
  return std::min(measure(first, second, now, next), (kReachCubes - kNearCubes) * cube);
}

/// The deviation of the nodes near the other body from a rigid motion of the second body.
template <class From, class To>
btScalar PairMotion::measure(const ContactBody& first, const ContactBody& second, const From& from, const To& to) {
  if (near_[0].empty()) listNear(first, second);
  const auto fromSecond = [&](std::size_t n) { return from(second, n); };
  const auto toSecond = [&](std::size_t n) { return to(second, n); };
  const RigidMotion motion(near_[1], fromSecond, toSecond);
  const auto largest = [&](const ContactBody& body, const std::vector<int>& nodes) {
    btScalar square = 0;
    for (const int node : nodes) {
      const auto n = static_cast<std::size_t>(node);
      square = std::max(square, (to(body, n) - motion(from(body, n))).length2());
    }
    return btSqrt(square);
  };
  return first.data().largestSpread * largest(first, near_[0]) + largest(second, near_[1]);
}

/// Tets near the other body may have nodes outside of the box.
void PairMotion::listNear(const ContactBody& first, const ContactBody& second) {
  const btScalar beside = std::max(first.data().edge, second.data().edge);
  listNodesIn(second.box.grownBy(beside), first, near_[0]);
  listNodesIn(first.box.grownBy(beside), second, near_[1]);
}

void PairMotion::serialize(StateStream& stream) {
  stream.plain(reads_, 2);
  stream(searched_, path_, searchedComing_);
}

}  // namespace tetskin::contact_detail
