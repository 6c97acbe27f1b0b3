// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <btBulletDynamicsCommon.h>
#include <tetskin/core/mesh.h>

namespace tetskin::python {

/// The surface of a collision shape, in its own space, without groups; round ones with about 50 sides. For any shape
/// that `Shape` makes, except a plane, which is infinite.
TriangleMesh meshOf(const btCollisionShape& shape);

}  // namespace tetskin::python
