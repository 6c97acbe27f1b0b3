// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: the parts of a world's state, in the order in which they are written and read. Each function
// serves both directions. What is only prepared, or computed anew in each step, is in none of them.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/deformable_world.h>

namespace tetskin::bullet_detail {

/// Motion and settings of rigid bodies, links, multibodies and other objects; of soft bodies, what they have as a
/// btCollisionObject; the world's clock, gravity and settings, and the seed of its solver. objects_state.cpp,
/// multibodies_state.cpp
void visitObjects(WorldStream& stream);
void visitMultiBodies(WorldStream& stream);
/// Joints of rigid bodies and of multibodies. joints_state.cpp
void visitJoints(WorldStream& stream);
/// False for classes other than Bullet's own.
bool isSaved(const btTypedConstraint& joint);
bool isSaved(const btMultiBodyConstraint& joint);
/// Number of the joint's class. `isSaved(joint)` must be true.
int classOfJoint(const btTypedConstraint& joint);
/// Boxes, trees and ids of the broadphase. broadphase_state.cpp
void visitBroadphase(WorldStream& stream);
/// Overlapping pairs with what their algorithms remember: contact caches with impulses. pairs_state.cpp
void visitPairs(WorldStream& stream);
/// Before all others while a snapshot is restored: pairs are found by ids, which change. pairs_state.cpp
void removePairs(WorldStream& stream);
/// True if it is of Bullet's own class, and not of one that derives from it.
bool isBulletsDispatcher(const btDispatcher& dispatcher);
/// Nodes of a soft body, and what Bullet remembers of it. soft_bodies_state.cpp
void visitSoftBodies(WorldStream& stream);

}  // namespace tetskin::bullet_detail
