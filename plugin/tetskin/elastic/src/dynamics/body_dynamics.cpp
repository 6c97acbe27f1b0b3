// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/body_dynamics.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// A matrix whose tets have turned by no more, in radians, in the mean and at most, still serves: forces are those of
/// the tets as they are.
constexpr double kMeanTurn = 0.015, kMostTurn = 0.3;

}  // namespace

template <class S>
BodyDynamics<S>::BodyDynamics(RestTets rest, std::size_t nodes)
    : matrix_(nodes, rest.tets, CorotatedTets<S>::noTet(rest.count())), held_(nodes) {
  if (rest.count() > 0) tets_.emplace(std::move(rest), matrix_.pattern().slotOf, matrix_.slotCount());
  for (AlignedVector<S>* v : {&points_, &velocities_, &relative_, &forces_}) v->assign(4 * matrix_.slotCount(), S(0));
  for (AlignedVector<S>* v : {&rightSide_, &image_}) v->assign(matrix_.wideSize(), S(0));
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
  if (other || (tets_ && (tets_->meanTurn() > kMeanTurn || tets_->mostTurn() > kMostTurn))) {
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
  assert(!anyHeld());
  using Vector = Eigen::Vector3d;
  S* solution = matrix_.solution();
  const auto solutionAt = [&](std::size_t wide) {
    return Vector(solution[wide], solution[wide + kGroup], solution[wide + 2 * kGroup]);
  };
  const auto pointAt = [&](std::size_t slot) {
    return Vector(points_[4 * slot], points_[4 * slot + 1], points_[4 * slot + 2]);
  };
  double mass = 0.0;
  Vector momentum = Vector::Zero(), centre = Vector::Zero();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const auto m = static_cast<double>(matrix_.massAt(slot));
    mass += m;
    momentum += m * solutionAt(wide);
    centre += m * pointAt(slot);
  });
  const Vector push = momentum / mass;
  centre /= mass;
  Vector spin = Vector::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const auto m = static_cast<double>(matrix_.massAt(slot));
    const Vector arm = pointAt(slot) - centre;
    spin += m * arm.cross(solutionAt(wide));
    inertia += m * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  });
  const Vector rate = inertia.ldlt().solve(spin);
  if (!push.allFinite() || !rate.allFinite()) return;
  bySlots(matrix_.slotCount(), [&](std::size_t slot, std::size_t wide) {
    const Vector rigid = push + rate.cross(pointAt(slot) - centre);
    for (std::size_t k = 0; k < 3; ++k) solution[wide + k * kGroup] -= static_cast<S>(rigid[static_cast<int>(k)]);
  });
}

#define TETSKIN_INSTANTIATE(Scalar) template class BodyDynamics<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
