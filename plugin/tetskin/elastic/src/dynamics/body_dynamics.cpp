// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/body_dynamics.h>
#include <tetskin/elastic/src/dynamics/part_motion.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// A matrix whose tets have turned by no more, in radians, in the mean and at most, still serves: forces are those of
/// the tets as they are.
constexpr double kMeanTurn = 0.015, kMostTurn = 0.3;
/// Of steps of so many seconds and more; in proportion of shorter ones, so that they converge.
constexpr double kFullTurnStep = 1.0 / 240.0;

}  // namespace

template <class S>
BodyDynamics<S>::BodyDynamics(RestTets rest, std::size_t nodes)
    : matrix_(nodes, rest.tets, CorotatedTets<S>::noTet(rest.count())), held_(nodes) {
  findParts(rest.tets);
  if (rest.count() > 0) tets_.emplace(std::move(rest), matrix_.pattern().slotOf, matrix_.slotCount());
  for (AlignedVector<S>* v : {&points_, &velocities_, &relative_, &forces_}) v->assign(4 * matrix_.slotCount(), S(0));
  for (AlignedVector<S>* v : {&rightSide_, &image_}) v->assign(matrix_.wideSize(), S(0));
}

/// Slots without node, which have no mass, belong to the first.
template <class S>
void BodyDynamics<S>::findParts(const std::vector<Tet>& tets) {
  DisjointSets sets(nodeCount());
  for (const Tet& tet : tets) {
    for (std::size_t k = 1; k < 4; ++k) sets.unite(tet[0], tet[k]);
  }
  partOf_.assign(matrix_.slotCount(), 0);
  std::vector<std::uint32_t> numbers(nodeCount(), 0);  // from 1
  for (std::size_t n = 0; n < nodeCount(); ++n) {
    std::uint32_t& number = numbers[static_cast<std::size_t>(sets.find(static_cast<int>(n)))];
    if (number == 0) number = ++parts_;
    partOf_[matrix_.slotOf(n)] = number - 1;
  }
}

template <class S>
void BodyDynamics<S>::setMaterial(const std::vector<LameOfTet>& lame) {
  assert(tets_ && lame.size() == tets_->count());
  for (std::size_t t = 0; t < lame.size(); ++t) tets_->setMaterial(t, lame[t]);
  changed_ = true;
}

template <class S>
void BodyDynamics<S>::setMass(std::size_t node, S mass) {
  const S before = matrix_.mass(node);
  if (before == mass) return;
  matrix_.setMass(node, mass);
  changed_ = true;
  held_ += mass == S(0);
  held_ -= before == S(0);
}

template <class S>
double BodyDynamics<S>::alphaFor(double seconds) const {
  return tets_ ? seconds * (damping_ + seconds) : 0.0;
}

template <class S>
void BodyDynamics<S>::prepareForces(ParallelFor* threads) {
  if (tets_) tets_->forces(points_.data(), forces_.data(), threads);
}

template <class S>
void BodyDynamics<S>::prepare(double seconds, ParallelFor* threads) {
  assert(seconds > 0.0);
  const double alpha = alphaFor(seconds);
  const bool other = changed_ || alpha != alpha_;
  prepareForces(threads);
  const double share = std::min(1.0, seconds / kFullTurnStep);
  if (other || (tets_ && (tets_->meanTurn() > share * kMeanTurn || tets_->mostTurn() > share * kMostTurn))) {
    matrix_.assemble(tets_ ? tets_->cornersForMatrix(static_cast<S>(alpha), threads) : nullptr, threads);
    alpha_ = alpha;
    changed_ = false;
  }
}

/// Calls visit(slot, first scalar in wide vectors) for all slots.
template <class Visit>
void bySlots(std::size_t slots, Visit&& visit) {
  for (std::size_t chunk = 0; chunk < slots / kGroup; ++chunk) {
    for (std::size_t lane = 0; lane < kGroup; ++lane) visit(kGroup * chunk + lane, kernels::kWideVector * chunk + lane);
  }
}

template <class S>
void BodyDynamics<S>::start(double seconds, ParallelFor* threads) {
  std::fill_n(matrix_.solution(), matrix_.wideSize(), S(0));
  if (!tets_) {
    std::fill(rightSide_.begin(), rightSide_.end(), S(0));
  } else {
    // Of velocities beside that of the whole body, which are small: the stiffness has no part of that, but for
    // rounding. Slots without node have no velocity, and none is read.
    std::array<double, 3> sum{};
    for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(velocities_[4 * slot + k]);
    }
    const auto count = static_cast<double>(nodeCount());
    const S mean[3] = {static_cast<S>(sum[0] / count), static_cast<S>(sum[1] / count), static_cast<S>(sum[2] / count)};
    for (std::size_t slot = 0; slot < matrix_.slotCount(); ++slot) {
      for (std::size_t k = 0; k < 3; ++k) relative_[4 * slot + k] = velocities_[4 * slot + k] - mean[k];
    }
    matrix_.multiply(relative_.data(), image_.data(), threads);
    const auto dt = static_cast<S>(seconds);
    bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
      const S mass = matrix_.massAt(slot);
      for (std::size_t k = 0; k < 3; ++k) {
        rightSide_[wide + k * kGroup] =
            dt * forces_[4 * slot + k] - image_[wide + k * kGroup] + mass * relative_[4 * slot + k];
      }
    });
  }
  std::copy(rightSide_.begin(), rightSide_.end(), matrix_.residual());
}

template <class S>
void BodyDynamics<S>::rightSide(std::size_t node, S out[3]) const {
  for (std::size_t k = 0; k < 3; ++k) out[k] = rightSide_[matrix_.wideOf(node) + k * kGroup];
}

template <class S>
const S* BodyDynamics<S>::times(const S* points, ParallelFor* threads) {
  matrix_.multiply(points, image_.data(), threads);
  return image_.data();
}

template <class S>
void BodyDynamics<S>::startAgain(ParallelFor* threads) {
  const S* solution = matrix_.solution();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    for (std::size_t k = 0; k < 3; ++k) relative_[4 * slot + k] = solution[wide + k * kGroup];
  });
  matrix_.multiply(relative_.data(), image_.data(), threads);
  S* residual = matrix_.residual();
  for (std::size_t k = 0; k < rightSide_.size(); ++k) residual[k] = rightSide_[k] - image_[k];
}

template <class S>
double BodyDynamics<S>::energy(ParallelFor* threads) {
  return tets_ ? tets_->energy(points_.data(), threads) : 0.0;
}

template <class S>
void BodyDynamics<S>::removeMomentum() {
  using Vector = Eigen::Vector3d;
  S* solution = matrix_.solution();
  const auto solutionAt = [&](std::size_t wide) {
    return Vector(solution[wide], solution[wide + kGroup], solution[wide + 2 * kGroup]);
  };
  const auto pointAt = [&](std::size_t slot) {
    return Vector(points_[4 * slot], points_[4 * slot + 1], points_[4 * slot + 2]);
  };
  std::vector<PartMotion> parts(parts_);
  if (held_ > 0) {
    for (std::size_t n = 0; n < nodeCount(); ++n) {
      const std::size_t slot = matrix_.slotOf(n);
      if (matrix_.massAt(slot) == S(0)) parts[partOf_[slot]].pivot.add(pointAt(slot));
    }
  }
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    PartMotion& part = parts[partOf_[slot]];
    const auto m = static_cast<double>(matrix_.massAt(slot));
    part.mass += m;
    part.push += m * solutionAt(wide);
    part.about += m * pointAt(slot);
  });
  for (PartMotion& part : parts) part.finishPush();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    PartMotion& part = parts[partOf_[slot]];
    const auto m = static_cast<double>(matrix_.massAt(slot));
    const Vector arm = pointAt(slot) - part.about;
    part.rate += m * arm.cross(solutionAt(wide));
    part.inertia += m * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  });
  for (PartMotion& part : parts) part.finishRate();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    if (matrix_.massAt(slot) == S(0)) return;
    const PartMotion& part = parts[partOf_[slot]];
    const Vector rigid = part.push + part.rate.cross(pointAt(slot) - part.about);
    for (std::size_t k = 0; k < 3; ++k) solution[wide + k * kGroup] -= static_cast<S>(rigid[static_cast<int>(k)]);
  });
}

#define TETSKIN_INSTANTIATE(Scalar) template class BodyDynamics<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
