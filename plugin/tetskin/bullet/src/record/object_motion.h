// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to Recorder: hashes that tell which object moves otherwise, and the transforms that the application gives
// its kinematic bodies.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/bullet/src/record/state_patch.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tetskin::bullet_detail {

/// By object of the world: a hash of positions and velocities. Cost O(nodes + objects)
std::vector<std::uint32_t> hashesOfMotion(btDeformableMultiBodyDynamicsWorld& world);
/// The object's place in the world, and what it is.
std::string nameOf(const btCollisionObject& object);

/// Where the motion states of kinematic bodies are: Bullet reads them in the step, no snapshot has them. Empty without
/// such bodies.
Bytes kinematicTargets(btDeformableMultiBodyDynamicsWorld& world);
/// Sets them. Returns false if they are of other bodies.
bool setKinematicTargets(btDeformableMultiBodyDynamicsWorld& world, const Bytes& targets);

}  // namespace tetskin::bullet_detail
