// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is remembered of a body that the application moves elsewhere, or resets, between two steps.
#include <tetskin/solver/src/base/body_channel.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/search/body_contacts.h>
#include <tetskin/solver/src/step/step.h>

#include <cassert>

namespace tetskin {

void DeformableSolver::Impl::forgetTouches(btSoftBody& body) {
  assert(!inStep());
  bodies.forget(body);
  sleepers.forget(body);
  stillness.forget(body);
  impacts.forget(body);
  for (int i = 0; i < forces().size(); ++i) {
    if (InactiveForce* own = inactiveForce(forces()[i])) own->forget(body);
  }
  const BodyChannel* channel = channelOf(body);
  if (!channel) return;
  for (const auto& contacts : {channel->surfaceContacts().lock(), channel->nodeContacts()}) {
    if (contacts) contacts->forgetAll();
  }
}

void Access<DeformableSolver>::reset(DeformableSolver& solver, btSoftBody& body) {
  solver.impl_->forgetTouches(body);
  solver.impl_->driven.forget(body);
  solver.impl_->loads.drop(body);
}

void Access<DeformableSolver>::teleport(DeformableSolver& solver, btSoftBody& body, const Placement& placement,
                                        const std::function<void()>& moveNodes) {
  solver.impl_->forgetTouches(body);
  solver.impl_->driven.carry(body, placement, moveNodes);
}

}  // namespace tetskin
