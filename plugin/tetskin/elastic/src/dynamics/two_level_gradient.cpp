// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/two_level_gradient.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::elastic_detail {
namespace {

template <class S>
void fromWide(const S* wide, std::vector<double>& out) {
  for (std::size_t slot = 0; slot < out.size() / 3; ++slot) {
    const S* from = wide + BlockMatrix<S>::wideOfSlot(slot);
    for (std::size_t k = 0; k < 3; ++k) out[3 * slot + k] = static_cast<double>(from[k * kernels::kGroup]);
  }
}

template <class S>
void toWide(const std::vector<double>& from, S* wide) {
  for (std::size_t slot = 0; slot < from.size() / 3; ++slot) {
    S* to = wide + BlockMatrix<S>::wideOfSlot(slot);
    for (std::size_t k = 0; k < 3; ++k) to[k * kernels::kGroup] = static_cast<S>(from[3 * slot + k]);
  }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// a += factor b
void add(double factor, const std::vector<double>& b, std::vector<double>& a) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += factor * b[k];
}

}  // namespace

template <class S>
TwoLevelGradient<S>::TwoLevelGradient(const RestTets& rest, const BlockMatrix<S>& matrix)
    : stiffness_(rest, matrix.pattern().slotOf),
      groups_(rest, matrix.pattern().slotOf, matrix.slotCount()),
      masses_(matrix.slotCount()) {
  for (Vector* v : {&right_, &solution_, &residual_, &image_, &step_, &direction_}) v->resize(3 * matrix.slotCount());
  for (AlignedVector<S>* v : {&impulses_, &velocities_}) v->assign(matrix.wideSize(), S(0));
}

/// Pinned nodes get no impulses.
template <class S>
void TwoLevelGradient<S>::multiply(const Vector& velocities, Vector& impulses) const {
  for (std::size_t k = 0; k < impulses.size(); ++k) impulses[k] = masses_[k / 3] * velocities[k];
  stiffness_.addProduct(velocities, impulses);
  const auto forOuter = [&](auto&& call) {
    for (std::size_t k = 0; k < outer_.size(); ++k) call(outer_[k], 3 * outerSlots_[k / 3] + k % 3);
  };
  double factor = 0.0;
  forOuter([&](double u, std::size_t at) { factor += u * velocities[at]; });
  forOuter([&](double u, std::size_t at) { impulses[at] += factor * u; });
  for (std::size_t k = 0; k < impulses.size(); ++k) {
    if (!(masses_[k / 3] > 0.0)) impulses[k] = 0.0;
  }
}

/// Computes the step from the residual by sweeps.
template <class S>
double TwoLevelGradient<S>::precondition(BlockMatrix<S>& matrix, ParallelFor* threads) {
  toWide(residual_, impulses_.data());
  const double squared = matrix.precondition(impulses_.data(), velocities_.data(), threads);
  fromWide(velocities_.data(), step_);
  return squared;
}

template <class S>
int TwoLevelGradient<S>::solve(BlockMatrix<S>& matrix, const MatrixSource<S>& source, const S* rightSide,
                               const std::vector<double>& points, double target, int maximum, ParallelFor* threads) {
  assert(rightSide && points.size() == solution_.size() && target > 0.0);
  for (std::size_t slot = 0; slot < masses_.size(); ++slot) masses_[slot] = static_cast<double>(matrix.massAt(slot));
  outerSlots_ = matrix.outerSlots();
  outer_.assign(matrix.outer().begin(), matrix.outer().end());
  stiffness_.take(source);
  matrix.clear();
  fromWide(rightSide, right_);
  fromWide(matrix.solution(), solution_);
  findResidual();
  int iterations = 0;
  if (groups_.assemble(stiffness_, masses_, points)) {
    groups_.addResponse(residual_, solution_);
    findResidual();
    std::fill(direction_.begin(), direction_.end(), 0.0);
    double before = 0.0;
    while (iterations < maximum && precondition(matrix, threads) > target && advance(before)) ++iterations;
  }
  toWide(solution_, matrix.solution());
  toWide(residual_, matrix.residual());
  return iterations;
}

template <class S>
void TwoLevelGradient<S>::findResidual() {
  multiply(solution_, residual_);
  for (std::size_t k = 0; k < right_.size(); ++k) residual_[k] = masses_[k / 3] > 0.0 ? right_[k] - residual_[k] : 0.0;
}

/// One iteration, after `precondition`. Returns false, and does nothing, if the operator is not positive.
/// before  the squared norm of the residual in the last iteration; 0: there was none
template <class S>
bool TwoLevelGradient<S>::advance(double& before) {
  multiply(step_, image_);
  for (std::size_t k = 0; k < image_.size(); ++k) image_[k] = residual_[k] - image_[k];
  groups_.addResponse(image_, step_);
  const double rho = dot(residual_, step_), kept = before > 0.0 ? rho / before : 0.0;
  for (std::size_t k = 0; k < step_.size(); ++k) direction_[k] = step_[k] + kept * direction_[k];
  multiply(direction_, image_);
  const double bend = dot(direction_, image_), length = rho / bend;
  if (!(bend > 0.0 && rho > 0.0 && std::isfinite(length))) return false;
  add(length, direction_, solution_);
  add(-length, image_, residual_);
  before = rho;
  return true;
}

TETSKIN_INSTANTIATE_CLASS(TwoLevelGradient)

}  // namespace tetskin::elastic_detail
