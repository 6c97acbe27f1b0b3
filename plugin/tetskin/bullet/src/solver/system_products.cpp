// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is added to the products of the bodies' matrices in each iteration: the blocks that rows couple two ends by,
// since the matrices contain the blocks of each end with itself; the few unknowns; and the effect of other forces.
#include <tetskin/bullet/src/solver/system_solve.h>

#include <cassert>

namespace tetskin {

/// Computes the velocities that the body's step gives the rows' ends, and its effect on the few unknowns.
void SystemSolve::read(std::size_t k) {
  assert(k < moving_.size());
  Body& body = bodies_[moving_[k]];
  body.push.setZero(fewSize_);
  for (const CoupledEnd& coupled : body.coupled) {
    const BodyEnd& end = coupled.end;
    const btVector3 velocity = body.ends.stepVelocity(end);
    endSteps_[end.row][end.index] = velocity;
    if (coupled.byFew) addRowPush(end.row, btScalar(-signOf(end.index)) * (coupled.tangent * velocity), body.push);
  }
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    body.push.segment<6>(components_[c].first) -= components_[c].imageProducts(body.matrix().step());
  }
}

void SystemSolve::combine() {
  if (!system_.forces.empty()) step_.multiplySteps(system_);
  if (fewSize_ == 0) return;
  fewOfStep_.setZero(fewSize_);
  for (const Body& body : bodies_) fewOfStep_ += body.push;
  fewOfStep_ = fewMatrix_.solve(std::move(fewOfStep_));
}

const btScalar* SystemSolve::added(std::size_t k) {
  assert(k < moving_.size());
  const Body& body = bodies_[moving_[k]];
  std::vector<btScalar>& sum = step_.extras[body.index];
  if (system_.forces.empty()) sum.assign(body.matrix().wideSize(), btScalar(0));
  addFew(body, fewOfStep_, 1, true, sum.data());
  return sum.data();
}

}  // namespace tetskin
