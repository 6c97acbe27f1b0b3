// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: the parts of a world's state, in the order in which they are written and read. Each function
// serves both directions. Data that is only prepared, or recomputed in each step, is in none of them.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/deformable_world.h>

namespace tetskin::bullet_detail {

/// Motion and settings of rigid bodies, links, multibodies and other objects; the btCollisionObject part of soft
/// bodies; the world's clock, gravity and settings, and its solver's seed. objects_state.cpp, multibodies_state.cpp
void serializeObjects(WorldStream& stream);
void serializeMultiBodies(WorldStream& stream);
/// Joints of rigid bodies and of multibodies. joints_state.cpp
void serializeJoints(WorldStream& stream);
/// False for classes other than Bullet's own.
bool isSaved(const btTypedConstraint& joint);
bool isSaved(const btMultiBodyConstraint& joint);
/// Number of the joint's class. `isSaved(joint)` must be true.
int classOfJoint(const btTypedConstraint& joint);
/// Boxes, trees and ids of the broadphase. broadphase_state.cpp
void serializeBroadphase(WorldStream& stream);
/// Overlapping pairs with what their algorithms remember: manifolds with impulses. pairs_state.cpp
void serializePairs(WorldStream& stream);
/// Call it before all others when restoring: pairs are found by ids, which change. pairs_state.cpp
void removePairs(WorldStream& stream);
/// Nodes of a soft body, and what Bullet remembers of it. soft_bodies_state.cpp
void serializeSoftBodies(WorldStream& stream);

}  // namespace tetskin::bullet_detail
