// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: contacts of a body's nodes with a rigid object, in place of Bullet's search.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <tetskin/bullet/src/search/node_paths.h>

namespace tetskin::bullet_detail {

/// Appends to `m_nodeRigidContacts` the nodes that a step would take into the object, or nearer to it than the body's
/// margin: those that Bullet's own search finds. For a plane, box, sphere, capsule or round cylinder the distances are
/// exact; for other shapes, they are those of Bullet's sparse distance field.
/// object  convex, or a triangle of a plane, which stands for the whole plane
/// solved  this solver solves for the contacts, and needs no impulse matrices; otherwise Bullet computes them, with its
///         distances
/// Cost    see NodePaths::near, and O(1) per node near the object's box
void findNodeContacts(btSoftBody& body, const btCollisionObjectWrapper& object, NodePaths& paths, bool solved);

}  // namespace tetskin::bullet_detail
