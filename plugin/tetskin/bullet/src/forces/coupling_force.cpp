// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/coupling_force.h>
#include <tetskin/bullet/src/shared/forces/body_forces.h>

namespace tetskin {

CouplingForce::~CouplingForce() = default;

btDeformableLagrangianForceType CouplingForce::getForceType() {
  return kOwnForceType;
}

}  // namespace tetskin
