// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/cross_matrix.h>
#include <tetskin/elastic/src/dynamics/group_motions.h>
#include <tetskin/elastic/src/modes/aggregates.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Most groups: factorising six motions for each takes about as long as a hundred iterations of a body of this size.
constexpr std::size_t kMaxGroups = 64;
/// Number of nodes per group, for a body with few nodes.
constexpr std::size_t kNodesOfGroup = 12;
/// Stiffness added to a group's, relative to it: nodes on a line do not resist rotations about it.
constexpr double kShift = 1e-14;

/// By node: the nodes with which it shares a tet, some of them several times.
Lists<> neighboursOf(const RestTets& rest, std::size_t nodes) {
  return packLists(nodes, [&](auto&& add) {
    const auto connect = [&](const auto& ofTet) {
      for (const int a : ofTet) {
        for (const int b : ofTet) {
          if (a != b) add(static_cast<std::size_t>(a), static_cast<std::uint32_t>(b));
        }
      }
    };
    for (const Tet& tet : rest.tets) connect(tet);
    for (const RestQuadraticTet& tet : rest.quadratic) connect(tet.nodes);
  });
}

}  // namespace

GroupMotions::GroupMotions(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots)
    : groupOf_(slots, -1), moves_(slots, 0), arms_(slots) {
  const std::size_t nodes = slotOf.size();
  const std::size_t most = std::clamp<std::size_t>(nodes / kNodesOfGroup, 1, kMaxGroups);
  const Aggregates groups = aggregate(neighboursOf(rest, nodes), static_cast<int>(most));
  count_ = groups.count;
  for (std::size_t n = 0; n < nodes; ++n) groupOf_[slotOf[n]] = groups.indices[n];
}

void GroupMotions::findArms(const std::vector<double>& masses, const std::vector<double>& points) {
  std::vector<Eigen::Vector3d> centres(static_cast<std::size_t>(count_), Eigen::Vector3d::Zero());
  std::vector<double> counts(centres.size(), 0.0);
  const auto forEachMoving = [&](auto&& visit) {
    for (std::size_t slot = 0; slot < moves_.size(); ++slot) {
      if (moves_[slot]) visit(slot, static_cast<std::size_t>(groupOf_[slot]));
    }
  };
  for (std::size_t slot = 0; slot < moves_.size(); ++slot) moves_[slot] = groupOf_[slot] >= 0 && masses[slot] > 0.0;
  forEachMoving([&](std::size_t slot, std::size_t group) {
    centres[group] += Eigen::Map<const Eigen::Vector3d>(&points[3 * slot]);
    counts[group] += 1.0;
  });
  double radius = 0.0;
  forEachMoving([&](std::size_t slot, std::size_t group) {
    arms_[slot] = Eigen::Map<const Eigen::Vector3d>(&points[3 * slot]) - centres[group] / counts[group];
    radius = std::max(radius, arms_[slot].norm());
  });
  if (!(radius > 0.0)) return;
  for (Eigen::Vector3d& arm : arms_) arm /= radius;
}

GroupMotions::Motions GroupMotions::motionsAt(std::size_t slot) const {
  const Eigen::Vector3d& arm = arms_[slot];
  Motions motions;
  motions.leftCols<3>().setIdentity();
  motions.rightCols<3>() = -crossMatrix(arm);
  return motions;
}

bool GroupMotions::assemble(const TetStiffness& stiffness, const std::vector<double>& masses,
                            const std::vector<double>& points) {
  assert(masses.size() == groupOf_.size() && points.size() == 3 * groupOf_.size());
  findArms(masses, points);
  const Eigen::Index size = kMotions * count_;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t slot = 0; slot < groupOf_.size(); ++slot) {
    if (!moves_[slot]) continue;
    const Motions own = motionsAt(slot);
    const Eigen::Index at = kMotions * groupOf_[slot];
    sums.block<kMotions, kMotions>(at, at) += masses[slot] * own.transpose().lazyProduct(own);
  }
  stiffness.forPoints([&](const StiffnessPoint& at) { addStiffness(stiffness, at, sums); });
  for (Eigen::Index k = 0; k < size; k += kMotions) {
    auto own = sums.block<kMotions, kMotions>(k, k);
    const double shift = kShift * own.trace();
    own.diagonal().array() += shift > 0.0 ? shift : 1.0;
  }
  matrix_ = sums.sparseView();
  factors_.compute(matrix_);
  return factors_.info() == Eigen::Success && factors_.vectorD().minCoeff() > 0.0;
}

/// A point's contribution: E_gh += B_g^T D B_h, where B are the gradients of a group's motions, and D their stress.
void GroupMotions::addStiffness(const TetStiffness& stiffness, const StiffnessPoint& at, Eigen::MatrixXd& sums) const {
  struct Part {
    int group;
    Eigen::Matrix<double, 9, kMotions> gradients, stresses;
  };
  std::vector<Part> parts;
  for (std::size_t n = 0; n < at.nodes; ++n) {
    const std::size_t slot = at.slots[n];
    if (!moves_[slot]) continue;
    auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.group == groupOf_[slot]; });
    if (part == parts.end()) {
      part = parts.insert(parts.end(), Part{groupOf_[slot], {}, {}});
      part->gradients.setZero();
    }
    const Motions motions = motionsAt(slot);
    for (Eigen::Index k = 0; k < kMotions; ++k) {
      Eigen::Map<Eigen::Matrix3d>(part->gradients.col(k).data()) += motions.col(k) * at.vectors[n].transpose();
    }
  }
  for (Part& part : parts) {
    for (Eigen::Index k = 0; k < kMotions; ++k) {
      const Eigen::Map<const Eigen::Matrix3d> gradient(part.gradients.col(k).data());
      Eigen::Map<Eigen::Matrix3d>(part.stresses.col(k).data()) = stiffness.stress(gradient, at.layer);
    }
  }
  for (const Part& row : parts) {
    for (const Part& column : parts) {
      if (row.group < column.group) continue;
      sums.block<kMotions, kMotions>(kMotions * row.group, kMotions * column.group) +=
          row.gradients.transpose().lazyProduct(column.stresses);
    }
  }
}

void GroupMotions::addResponse(const std::vector<double>& impulses, std::vector<double>& velocities) const {
  assert(impulses.size() == 3 * moves_.size() && velocities.size() == impulses.size());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(kMotions * count_);
  for (std::size_t slot = 0; slot < moves_.size(); ++slot) {
    if (!moves_[slot]) continue;
    const Eigen::Map<const Eigen::Vector3d> impulse(&impulses[3 * slot]);
    sums.segment<3>(kMotions * groupOf_[slot]) += impulse;
    sums.segment<3>(kMotions * groupOf_[slot] + 3) += arms_[slot].cross(impulse);
  }
  const Eigen::VectorXd found = factors_.solve(sums);
  for (std::size_t slot = 0; slot < moves_.size(); ++slot) {
    if (!moves_[slot]) continue;
    const Eigen::Vector3d rate = found.segment<3>(kMotions * groupOf_[slot] + 3);
    Eigen::Map<Eigen::Vector3d>(&velocities[3 * slot]) +=
        found.segment<3>(kMotions * groupOf_[slot]) + rate.cross(arms_[slot]);
  }
}

}  // namespace tetskin::elastic_detail
