// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <tetskin/bullet/src/base/build_stream.h>

#include <memory>

namespace tetskin::bullet_detail {

/// Describes a collision shape, or builds it: planes, boxes, spheres, capsules, cylinders, cones, convex hulls, meshes,
/// compounds, and empty ones. Refuses others. Shapes that several objects share are one again.
/// shape  to be described; not used when building
std::shared_ptr<btCollisionShape> buildShape(BuildStream& stream, const btCollisionShape* shape);

}  // namespace tetskin::bullet_detail
