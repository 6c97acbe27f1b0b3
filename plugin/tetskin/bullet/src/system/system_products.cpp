// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is added to the products of the bodies' matrices in each iteration: the blocks that rows couple two ends by,
// since the matrices contain the blocks of each end with itself; the reduced unknowns; and the effect of other forces.
#include <tetskin/bullet/src/system/system_solve.h>

#include <cassert>

namespace tetskin::bullet_detail {

/// Computes the velocities that the body's step gives the rows' ends, and its effect on the reduced unknowns.
void SystemSolve::readPoints(std::size_t k) {
  assert(k < moving_.size());
  Body& body = bodies_[moving_[k]];
  body.push.setZero(reducedSize_);
  for (const CoupledEnd& coupled : body.coupled) {
    const BodyEnd& end = coupled.end;
    const btVector3 velocity = body.ends.stepVelocity(end);
    endSteps_[end.row][end.index] = velocity;
    if (coupled.byReduced) addRowPush(end.row, btScalar(-signOf(end.index)) * (coupled.tangent * velocity), body.push);
  }
  for (std::size_t c = body.firstComponent; c < body.lastComponent; ++c) {
    body.push.segment<6>(components_[c].first) -= components_[c].imageProducts(body.matrix().step());
  }
}

void SystemSolve::combine() {
  if (!system_.forces.empty()) in_.others.multiplySteps(system_);
  if (reducedSize_ == 0) return;
  reducedOfStep_.setZero(reducedSize_);
  for (const Body& body : bodies_) reducedOfStep_ += body.push;
  reducedOfStep_ = schurComplement_.solve(std::move(reducedOfStep_));
}

const btScalar* SystemSolve::apply(std::size_t k) {
  assert(k < moving_.size());
  const Body& body = bodies_[moving_[k]];
  std::vector<btScalar>& sum = in_.others.products(body.index);
  if (system_.forces.empty()) sum.assign(body.matrix().wideSize(), btScalar(0));
  addReduced(body, reducedOfStep_, 1, true, sum.data());
  return sum.data();
}

}  // namespace tetskin::bullet_detail
