// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/candidate_validity.h>
#include <tetskin/contact/src/soft/rigid_motion.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace tetskin::contact_detail {
namespace {

/// The slack is the relative motion of this many steps, bounded as given in cubes of the grid.
constexpr btScalar kSlackSteps = 6, kSlackCubes = btScalar(0.7), kMaxSlackCubes = 3;
/// In cubes of the grid: more than the error of thin tets' planes in single precision.
constexpr btScalar kRoundingCubes = btScalar(1e-3);

/// A lower bound of the distance between two boxes; below 0 if they overlap.
btScalar gapBetween(const ContactBox& a, const ContactBox& b) {
  btScalar gap = a.low[0] - b.high[0];
  for (int k = 0; k < 3; ++k) gap = std::max({gap, a.low[k] - b.high[k], b.low[k] - a.high[k]});
  return gap;
}

/// By node: the smallest gap between a box of the tree that contains one of its tets and another box; at least `slack`.
/// tetOf  int(int item): the tet of an item of the tree
template <class TetOf>
void findClearances(const ContactBody& body, const SearchTree& tree, const std::vector<ContactBox>& boxes,
                    const ContactBox& other, btScalar slack, const TetOf& tetOf, std::vector<btScalar>& clearances) {
  clearances.assign(body.positions.size(), std::numeric_limits<btScalar>::infinity());
  const std::vector<Bvh::Node>& nodes = tree.tree.nodes();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!nodes[k].isLeaf()) continue;
    const btScalar room = std::max(slack, gapBetween(boxes[k], other));
    for (int item = nodes[k].first; item < nodes[k].last; ++item) {
      for (const int n : body.data().tets[static_cast<std::size_t>(tetOf(tree.tree.item(item)))]) {
        btScalar& least = clearances[static_cast<std::size_t>(n)];
        least = std::min(least, room);
      }
    }
  }
}

}  // namespace

void CandidateValidity::begin(const ContactBody& first, const ContactBody& second) {
  const btScalar cube = second.data().grid.spacing();
  const btScalar growth = age_ > 0 ? drift_ / static_cast<btScalar>(age_) : 0;
  slack_ = std::min(std::max(kSlackCubes * cube, kSlackSteps * growth), kMaxSlackCubes * cube);
  moved_ = drift_ = 0;
  age_ = 0;
  setRounding(first, second);
  began_[0] = first.positions;
  began_[1] = second.positions;
  near_.clear();
  const SearchTree &runs = first.data().runTree, &tets = second.data().tetTree;
  if (runs.tree.empty() || tets.tree.empty()) return;
  findClearances(
      first, runs, first.runTreeBoxes, second.tetTreeBoxes[0], slack_,
      [&](int run) { return first.data().runs[static_cast<std::size_t>(run)].tet; }, rooms_[0]);
  findClearances(
      second, tets, second.tetTreeBoxes, first.runTreeBoxes[0], slack_, [](int tet) { return tet; }, rooms_[1]);
  for (std::size_t n = 0; n < rooms_[1].size(); ++n) {
    if (!(rooms_[1][n] > slack_)) near_.push_back(static_cast<int>(n));
  }
}

bool CandidateValidity::lasts(const ContactBody& first, const ContactBody& second) {
  assert(began_[0].size() == first.positions.size() && began_[1].size() == second.positions.size());
  ++age_;
  const btScalar spread = first.data().largestSpread;
  setRounding(first, second);
  moved_ += accountable(spread * first.moved + kInsideSpread * second.moved, second);
  if (moved_ + rounding_ <= slack_) return true;
  if (rooms_[0].empty() || rooms_[1].empty()) return true;
  const RigidMotion motion = near_.empty() ? RigidMotion(second.positions[0] - began_[1][0])
                                           : RigidMotion(
                                                 near_, [&](std::size_t n) { return began_[1][n]; },
                                                 [&](std::size_t n) { return second.positions[n]; });
  const Deviation own = deviate(0, first, motion), other = deviate(1, second, motion);
  drift_ = spread * own.near + kInsideSpread * other.near;
  // The used part of the slack: the rest is left for later steps.
  moved_ = std::max(
      {drift_, usedUp(0, spread, kInsideSpread * other.anywhere), usedUp(1, kInsideSpread, spread * own.near)});
  return moved_ + rounding_ <= slack_;
}

void CandidateValidity::setRounding(const ContactBody& first, const ContactBody& second) {
  rounding_ = kRoundingCubes * second.data().grid.spacing() + roundingOf(first, second);
}

CandidateValidity::Deviation CandidateValidity::deviate(int k, const ContactBody& body, const RigidMotion& motion) {
  Deviation largest;
  deviations_[k].resize(body.positions.size());
  for (std::size_t n = 0; n < body.positions.size(); ++n) {
    const btScalar deviation = (body.positions[n] - motion(began_[k][n])).length();
    deviations_[k][n] = deviation;
    if (!(rooms_[k][n] < std::numeric_limits<btScalar>::infinity())) continue;
    largest.anywhere = std::max(largest.anywhere, deviation);
    if (!(rooms_[k][n] > slack_)) largest.near = std::max(largest.near, deviation);
  }
  return largest;
}

/// The part of the slack used by nodes that were far from the other body.
/// other  the other body's deviation
btScalar CandidateValidity::usedUp(int k, btScalar spread, btScalar other) const {
  btScalar used = 0;
  for (std::size_t n = 0; n < rooms_[k].size(); ++n) {
    if (!(rooms_[k][n] > slack_)) continue;
    used = std::max(used, spread * deviations_[k][n] + other - (rooms_[k][n] - slack_));
  }
  return used;
}

}  // namespace tetskin::contact_detail
